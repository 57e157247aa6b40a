#include "lists/validation/runner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "base/error.h"

namespace sfumato::lists::validation {
namespace {

using How = Ended::How;

Command shell(const std::string& script) {
  return {"/bin/sh", "-c", script};
}

std::vector<Ended> endsOf(const std::vector<Command>& commands, int jobs = 1, double timeout = 20) {
  std::vector<Ended> ends(commands.size());
  EXPECT_TRUE(runCommands(commands, jobs, timeout, [&](size_t i, const Ended& ended) { ends[i] = ended; }));
  return ends;
}

TEST(ValidationProcess, TellsHowAProgramEndedAndWhatItWrote) {
  const auto ends = endsOf({shell("echo out; echo err >&2; exit 3"),
                            shell("kill -SEGV $$"),
                            {"/nonexistent/program"},
                            shell("head -c 300000 /dev/zero")});
  EXPECT_EQ(ends[0].how, How::Exited);
  EXPECT_EQ(ends[0].code, 3);
  EXPECT_EQ(ends[0].out, "out\n");
  EXPECT_EQ(ends[0].err, "err\n");
  EXPECT_EQ(ends[1].how, How::Signalled);
  EXPECT_EQ(ends[1].code, SIGSEGV);
  EXPECT_EQ(ends[2].code, 127);
  EXPECT_EQ(ends[3].out.size(), 300000u);  // more than a pipe holds
}

TEST(ValidationProcess, KillsWhatTakesTooLongAndGoesOn) {
  const auto ends = endsOf({shell("sleep 100"), shell("echo after")}, 1, 0.3);
  EXPECT_EQ(ends[0].how, How::TimedOut);
  EXPECT_GE(ends[0].seconds, 0.3);
  EXPECT_LT(ends[0].seconds, 10);
  EXPECT_EQ(ends[1].out, "after\n");
}

TEST(ValidationProcess, KillsAlsoWhatClosedItsStreams) {
  const auto ends = endsOf({shell("exec >&- 2>&-; sleep 100")}, 1, 0.3);
  EXPECT_EQ(ends[0].how, How::TimedOut);
  EXPECT_LT(ends[0].seconds, 10);
}

TEST(ValidationProcess, RunsSeveralAtATime) {
  // Each waits until the other is there.
  const std::string folder = testing::TempDir() + "/validation_jobs_" + std::to_string(getpid());
  const std::string meet = "mkdir -p " + folder + "; touch " + folder + "/$0; n=0; " + "while [ ! -e " +
                           folder + "/$1 ] && [ $n -lt 500 ]; do sleep 0.01; n=$((n+1)); done; echo $n";
  const auto ends = endsOf({{"/bin/sh", "-c", meet, "a", "b"}, {"/bin/sh", "-c", meet, "b", "a"}}, 2);
  for (const Ended& ended : ends) EXPECT_LT(std::stoi(ended.out), 500);
  endsOf({{"/bin/rm", "-r", folder}});
}

TEST(ValidationProcess, EndsItsChildrenWhenItIsInterrupted) {
  for (const char* signal : {"INT", "TERM"}) {
    std::vector<How> hows;
    const bool done =
        runCommands({shell("echo first"), shell(std::string("kill -") + signal + " $PPID; sleep 100"),
                     shell("echo never")},
                    1, 20, [&](size_t, const Ended& ended) { hows.push_back(ended.how); });
    EXPECT_FALSE(done);
    EXPECT_EQ(hows, (std::vector{How::Exited, How::Interrupted}));
  }
}

// ---- results
// -------------------------------------------------------------------------------------------------

Ended exited(int code, std::string out, std::string err = {}) {
  return {How::Exited, code, std::move(out), std::move(err), 0.1};
}

TEST(ValidationRunner, AResultPassesThroughItsLine) {
  const Result result{Verdict::NoPower,
                      "nothing \"lost\"\n\xff",
                      "means little",
                      {{"count", int64_t{1} << 40}, {"ratio", 0.1}, {"which", std::string("both")}}};
  const std::string text = line(result);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  const Result read = resultOf(exited(0, "a driver says hello\n" + text), 20);
  EXPECT_EQ(read.verdict, Verdict::NoPower);
  EXPECT_EQ(read.finding, "nothing \"lost\"\n\xef\xbf\xbd");
  EXPECT_EQ(read.meaning, result.meaning);
  EXPECT_EQ(read.figures, result.figures);
}

TEST(ValidationRunner, EveryVerdictPassesThroughItsLine) {
  for (const Verdict verdict :
       {Verdict::Pass, Verdict::Fail, Verdict::Hang, Verdict::Crash, Verdict::Skip, Verdict::NoPower})
    EXPECT_EQ(resultOf(exited(0, line(Result{.verdict = verdict})), 20).verdict, verdict);
}

TEST(ValidationRunner, TellsHangsAndCrashesFromAnswers) {
  Ended late{How::TimedOut, SIGKILL, "", "", 5};
  EXPECT_EQ(resultOf(late, 5).verdict, Verdict::Hang);
  EXPECT_EQ(resultOf(late, 5).finding, "not done after 5 s");

  Ended dead{How::Signalled, SIGSEGV, line(Result{}), "first\nLLVM ERROR: out of registers\n", 1};
  EXPECT_EQ(resultOf(dead, 5).verdict, Verdict::Crash);  // whatever it wrote before
  EXPECT_EQ(resultOf(dead, 5).finding, "its process died: Segmentation fault: LLVM ERROR: out of registers");

  EXPECT_EQ(resultOf(exited(6, "", "bug\n"), 5).verdict, Verdict::Crash);
  for (const char* text :
       {"", "hello\n", "{}\n", "[1]\n",
        "{\"verdict\":\"GOOD\",\"finding\":\"\",\"meaning\":\"\",\"figures\":[]}\n",
        "{\"verdict\":\"PASS\"}\n", "{\"verdict\":\"PASS\",\"finding\":1,\"meaning\":\"\",\"figures\":[]}\n",
        "{\"verdict\":\"PASS\",\"finding\":\"\",\"meaning\":\"\",\"figures\":[[]]}\n"})
    EXPECT_EQ(resultOf(exited(0, text), 5).verdict, Verdict::Crash) << text;
}

validation::Run runOf(const std::string& name) {
  return {{.name = name, .group = "g"}, {}, {}};
}

// A program that answers as the check that it is asked for is called: PASS, or not at all.
RunOptions answering(const std::string& script) {
  RunOptions options;
  options.program = script;
  return options;
}

TEST(ValidationRunner, KeepsTheOrderOfTheRunsAndWhatTheyWere) {
  // As a shell, `validate` is the script's name and the arguments follow.
  const std::string path = testing::TempDir() + "/validation_program_" + std::to_string(getpid());
  const std::string script =
      "#!/bin/sh\n[ $3 = slow ] && sleep 0.3\n"
      "echo '{\"verdict\":\"PASS\",\"finding\":\"'$*'\",\"meaning\":\"\",\"figures\":[]}'\n";
  FILE* file = std::fopen(path.c_str(), "w");
  ASSERT_NE(file, nullptr);
  std::fputs(script.c_str(), file);
  std::fclose(file);
  endsOf({{"/bin/chmod", "+x", path}});

  RunOptions options = answering(path);
  options.jobs = 2;
  options.seed = 7;
  options.scale = Scale::Full;
  options.deviceArguments = {"--device", "software"};
  validation::Run last = runOf("last");
  last.arguments = {"--mutant", "M"};
  int ended = 0;
  const Outcomes outcomes = runChecks({runOf("slow"), runOf("quick"), last}, options, [&] { ++ended; });
  EXPECT_EQ(ended, 3);
  EXPECT_FALSE(outcomes.interrupted);
  ASSERT_EQ(outcomes.all.size(), 3u);
  EXPECT_EQ(outcomes.all[0].run.check.name, "slow");
  EXPECT_EQ(outcomes.all[0].result.finding,
            "validate --run-check slow --seed 7 --scale full --device software");
  EXPECT_EQ(outcomes.all[1].run.check.name, "quick");
  EXPECT_EQ(outcomes.all[2].result.finding,
            "validate --run-check last --seed 7 --scale full --device software --mutant M");
  endsOf({{"/bin/rm", path}});
}

TEST(ValidationRunner, WithoutADriverSaysWhatItsProcessSaid) {
  try {
    askDriver(answering("/bin/false"));
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.exitCode, base::ExitCode::NoGl);
    EXPECT_NE(std::string(error.what()).find("exit code 1"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace sfumato::lists::validation
