// `sfumato validate` as a shell sees it: every check in a process of its own, whatever becomes of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/program.h"
#include "tests/gl/test_device.h"

namespace sfumato::test {
namespace {

using nlohmann::json;

// Runs in an empty folder, with a cache of its own.
class Validate : public testing::Test {
 protected:
  Outcome run(Arguments arguments, std::vector<std::string> environment = {}, int seconds = 120) const {
    arguments.insert(arguments.begin(), "validate");
    environment.push_back("XDG_CACHE_HOME=" + (folder.path() / "cache").string());
    return runProgram(folder.path(), arguments, {.environment = environment, .seconds = seconds});
  }
  std::filesystem::path path(const std::string& name) const { return folder.path() / name; }

  TemporaryFolder folder{"validate"};
};

// The same where checks are run: skips without a device.
class ValidateDevice : public Validate {
 protected:
  void SetUp() override { tests::needDevice(); }
};

// The same on the driver whose faults are known.
class ValidateLlvmpipe : public ValidateDevice {
 protected:
  void SetUp() override {
    ValidateDevice::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    const std::string& renderer = tests::testDevice()->names().renderer;
    if (!renderer.starts_with("llvmpipe"))
      GTEST_SKIP() << "the verdicts are those of llvmpipe, this is " << renderer;
  }
};

const json& checkIn(const json& report, const std::string& name) {
  for (const json& check : report.at("checks"))
    if (check.at("name") == name) return check;
  static const json none;
  ADD_FAILURE() << "no check " << name;
  return none;
}

// ---- bad use
// -------------------------------------------------------------------------------------------------

TEST_F(Validate, NamesWhatIsWrongWithACommandLine) {
  std::filesystem::create_directory(path("folder"));
  expectErrors(folder.path(),
               {{{"validate", "--only", "tickte"}, 2, "tickte: no such check or group: near are ticket"},
                {{"validate", "--skip", "nothing-like-it"}, 2, "nothing-like-it: no such check"},
                {{"validate", "--scale", "huge"}, 2, "--scale"},
                {{"validate", "--timeout", "0"}, 2, "--timeout"},
                {{"validate", "--seed", "-1"}, 2, "--seed"},
                {{"validate", "--json", "--tap"}, 2, "--json"},
                {{"validate", "--self-test", "--shader-dir", "folder"}, 2, "--shader-dir"},
                {{"validate", "--run-check", "no-such"}, 2, "no-such: no such check"},
                {{"validate", "--only", "ctx", "--junit", "folder"}, 3, "folder: is a folder"},
                {{"validate", "--only", "ctx", "--junit", "missing/report.xml"},
                 3,
                 "missing/report.xml: cannot be written"}});
}

TEST_F(Validate, ListsItsChecksWithoutADevice) {
  const Outcome outcome = run({"--list"}, {"LIBGL_DRIVERS_PATH=/nonexistent"});
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_NE(outcome.out.find("\n  ticket "), std::string::npos) << outcome.out;
}

TEST_F(Validate, WithoutADriverSaysSo) {
  const Outcome outcome =
      run({}, {"LIBGL_DRIVERS_PATH=/nonexistent", "__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent"});
  EXPECT_EQ(outcome.exitCode, 4);
  EXPECT_EQ(outcome.out, "");
  EXPECT_TRUE(outcome.err.starts_with("sfumato: error: no")) << outcome.err;
}

TEST_F(ValidateLlvmpipe, SaysWhatAnOldDriverLacks) {
  const Outcome outcome = run({}, {"GALLIUM_DRIVER=softpipe"});
  EXPECT_EQ(outcome.exitCode, 4);
  EXPECT_NE(outcome.err.find("no OpenGL 4.3 core context (softpipe has 3.3"), std::string::npos)
      << outcome.err;
}

// ---- checks that hang or crash
// ---------------------------------------------------------------------------------

TEST_F(ValidateDevice, ABadCheckLosesOnlyItself) {
  const Outcome outcome =
      run({"--only", "ctx", "hangs", "crashes", "leaves", "--timeout", "2", "--json", "-q"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;  // no strategy depends on these
  const json report = json::parse(outcome.out);
  EXPECT_EQ(report.at("checks").size(), 4u);
  EXPECT_EQ(checkIn(report, "ctx").at("verdict"), "PASS");
  EXPECT_EQ(checkIn(report, "hangs").at("verdict"), "HANG");
  EXPECT_EQ(checkIn(report, "hangs").at("finding"), "not done after 2 s");
  EXPECT_EQ(checkIn(report, "crashes").at("verdict"), "CRASH");
  EXPECT_EQ(checkIn(report, "crashes").at("finding"), "its process died: Killed");
  EXPECT_EQ(checkIn(report, "leaves").at("verdict"), "CRASH");
}

// ---- Ctrl-C
// ----------------------------------------------------------------------------------------------------

// Processes that still run and were started with this argument.
size_t processesWith(const std::string& argument) {
  size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string commandLine = contentOf(entry.path() / "cmdline");
    count += commandLine.find(argument) != std::string::npos;
  }
  return count;
}

TEST_F(ValidateDevice, WhenInterruptedEndsItsChildrenAndPrintsWhatThereIs) {
  const std::string seed = std::to_string(1000000000ll + getpid());  // tells our children from others'
  const auto interruptSoon = [] {
    // The child of this fork is the program; its own child sends the signal when the check that hangs is
    // running.
    const pid_t program = getpid();
    if (fork() == 0) {
      for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) close(stream);
      sleep(3);
      kill(program, SIGINT);
      _exit(0);
    }
  };
  const Outcome outcome = runProgram(
      folder.path(), {"validate", "--only", "ctx", "hangs", "--seed", seed, "--timeout", "100", "-q"},
      {.environment = {"XDG_CACHE_HOME=" + folder.path().string()}, .inChild = interruptSoon, .seconds = 60});
  EXPECT_EQ(outcome.exitCode, 130);
  EXPECT_NE(outcome.out.find("PASS     ctx"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("hangs"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("interrupted"), std::string::npos) << outcome.out;
  EXPECT_EQ(processesWith(seed), 0u);
}

// ---- reports
// ---------------------------------------------------------------------------------------------------

TEST_F(ValidateDevice, WritesTheReportBesideTheTable) {
  const Outcome outcome = run({"--only", "ctx", "ticket", "--junit", "report.xml", "--tap", "-q"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("TAP version 13\n1..2\nok 1 - context ctx\n")) << outcome.out;
  const std::string xml = contentOf(path("report.xml"));
  EXPECT_NE(xml.find("<testcase classname=\"atomics\" name=\"ticket\""), std::string::npos) << xml;
  EXPECT_FALSE(std::filesystem::exists(path("cache/sfumato")));  // no verdict is kept of a part of the checks
}

TEST_F(ValidateDevice, TheSelfTestSeesEveryFaultPutIntoAShader) {
  const Outcome outcome = run({"--self-test", "--only", "ticket", "list-overflow", "loop-engine", "-q"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("ticket: NO_ATOMIC"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("NOT SEEN"), std::string::npos) << outcome.out;
}

// ---- the verdicts of llvmpipe
// ----------------------------------------------------------------------------------

TEST_F(ValidateLlvmpipe, FindsItsKnownFaultsAndIsSafeForTheEngine) {
  const Outcome outcome = run({"--json", "-q"}, {}, 280);
  const json report = json::parse(outcome.out);
  const auto finding = [&](const std::string& name) {
    return checkIn(report, name).at("finding").get<std::string>();
  };
  // Faults that the engine is written around.
  for (const char* name : {"live-out", "loop-limit", "opaque-tiles"})
    EXPECT_EQ(checkIn(report, name).at("verdict"), "FAIL") << name;
  EXPECT_NE(finding("loop-limit").find("ends after 65535 iterations"), std::string::npos)
      << finding("loop-limit");
  // What the engine depends on holds, as far as two cores can show it.
  std::set<std::string> passed;
  for (const json& check : report.at("checks")) {
    if (check.at("strategies").empty()) continue;
    const std::string verdict = check.at("verdict");
    EXPECT_TRUE(verdict == "PASS" || verdict == "NO POWER") << check.dump(2);
    if (verdict == "PASS") passed.insert(check.at("name"));
  }
  for (const char* name :
       {"ctx", "ops", "ticket", "ticket-spread", "inactive-lanes", "list-exchange", "list-cas",
        "list-overflow", "list-reuse", "live-out-safe", "loop-engine", "break-continue"})
    EXPECT_TRUE(passed.contains(name)) << name;
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  for (const char* strategy : {"spinlock", "lockfree", "append", "count"})
    EXPECT_NE(report.at("strategies").at(strategy).at("trust"), "unsafe") << strategy;
  // The verdict is kept for the engine.
  const auto kept = listing(folder.path() / "cache" / "sfumato");
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(json::parse(kept.begin()->second).at("strategies").at("count"),
            report.at("strategies").at("count").at("trust"));
}

}  // namespace
}  // namespace sfumato::test
