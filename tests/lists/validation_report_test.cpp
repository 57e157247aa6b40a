#include "lists/validation/report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "base/error.h"

namespace sfumato::lists::validation {
namespace {

Check checkOf(const std::string& name, std::vector<std::string> strategies,
              const std::string& group = "atomics") {
  return {.name = name, .group = group, .does = "does " + name, .strategies = std::move(strategies)};
}

const std::vector<Check> checks = {
    checkOf("good", {"spinlock", "lockfree", "append", "count"}),
    checkOf("lock", {"spinlock"}),
    checkOf("swap", {"lockfree"}, "lists"),
    checkOf("curious", {}, "lists"),
    checkOf("push", {"append"}, "lists"),
};

Outcome outcomeOf(const Check& check, Verdict verdict, std::string finding = {}, std::string meaning = {}) {
  return {{check, {}, {}}, {verdict, std::move(finding), std::move(meaning), {{"count", int64_t{3}}}}, 0.25};
}

Report reportOf(std::vector<Outcome> outcomes) {
  Report report;
  report.driver = {{"Maker", "Renderer <1> & \"co\"", "4.5"}, "surfaceless", true};
  report.outcomes.all = std::move(outcomes);
  report.seconds = 1.5;
  return report;
}

Report mixed() {
  return reportOf({outcomeOf(checks[0], Verdict::Pass),
                   outcomeOf(checks[1], Verdict::Fail, "2 < 3 & \"lost\" #1\x01", "locks <leak>"),
                   outcomeOf(checks[2], Verdict::Hang, "not done after 5 s", "may never end"),
                   outcomeOf(checks[3], Verdict::Fail, "odd", "no matter"),
                   outcomeOf(checks[4], Verdict::NoPower, "the control held", "")});
}

// ---- strategies
// --------------------------------------------------------------------------------------------

std::string trustText(const Report& report) {
  std::string text;
  for (const StrategyTrust& trust : strategyTrusts(report, checks))
    text += trust.strategy + "=" + std::string(name(trust.trust)) + "(" + trust.because + ") ";
  return text;
}

TEST(ValidationReport, SaysWhichStrategiesAreSafe) {
  std::vector<Outcome> all;
  for (const Check& check : checks) all.push_back(outcomeOf(check, Verdict::Pass));
  EXPECT_EQ(trustText(reportOf(all)), "spinlock=safe() lockfree=safe() append=safe() count=safe() ");
  EXPECT_EQ(trustText(mixed()),
            "spinlock=unsafe(lock FAIL) lockfree=unsafe(swap HANG) append=no fault seen(push NO POWER) "
            "count=safe() ");
  EXPECT_EQ(trustText(reportOf({outcomeOf(checks[1], Verdict::Crash)})),
            "spinlock=unsafe(lock CRASH, 1 checks not run) lockfree=no fault seen(2 checks not run) "
            "append=no fault seen(2 checks not run) count=no fault seen(1 checks not run) ");
}

TEST(ValidationReport, OnlyChecksThatTheEngineDependsOnBreakIt) {
  EXPECT_TRUE(breaksTheEngine(mixed()));
  for (const Verdict verdict : {Verdict::Fail, Verdict::Hang, Verdict::Crash}) {
    EXPECT_TRUE(breaksTheEngine(outcomeOf(checks[1], verdict)));
    EXPECT_FALSE(breaksTheEngine(outcomeOf(checks[3], verdict)));
  }
  for (const Verdict verdict : {Verdict::Pass, Verdict::Skip, Verdict::NoPower})
    EXPECT_FALSE(breaksTheEngine(outcomeOf(checks[1], verdict)));
}

// ---- for people
// --------------------------------------------------------------------------------------------

TEST(ValidationReport, TheTableExplainsEachFailureAndEndsWithTheStrategies) {
  const Report report = mixed();
  const std::string text = table(report, strategyTrusts(report, checks));
  for (const char* part :
       {"Renderer <1>", "seed 1, scale small, 60 s a check", "FAIL     lock", "-> locks <leak>",
        "HANG     swap", "(information) odd", "-> no matter", "NO POWER push"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  EXPECT_TRUE(
      text.ends_with("strategies on this driver: spinlock unsafe (lock FAIL); lockfree unsafe (swap HANG); "
                     "append no fault seen (push NO POWER); count safe\n"))
      << text;
}

// ---- JSON
// --------------------------------------------------------------------------------------------------

TEST(ValidationReport, JsonHasDeviceAndChecks) {
  const Report report = mixed();
  const auto text = nlohmann::json::parse(json(report, strategyTrusts(report, checks)));
  EXPECT_EQ(text["device"]["renderer"], "Renderer <1> & \"co\"");
  EXPECT_EQ(text["seed"], 1);
  EXPECT_EQ(text["scale"], "small");
  EXPECT_EQ(text["engine_safe"], false);
  EXPECT_EQ(text["interrupted"], false);
  ASSERT_EQ(text["checks"].size(), 5u);
  for (const auto& check : text["checks"]) {
    for (const char* key : {"name", "group", "does", "verdict", "finding", "meaning"})
      EXPECT_TRUE(check[key].is_string()) << key;
    EXPECT_TRUE(check["strategies"].is_array());
    EXPECT_TRUE(check["seconds"].is_number());
    EXPECT_EQ(check["figures"]["count"], 3);
  }
  EXPECT_EQ(text["checks"][1]["verdict"], "FAIL");
  EXPECT_EQ(text["checks"][1]["meaning"], "locks <leak>");
  EXPECT_EQ(text["checks"][1]["breaks_engine"], true);
  EXPECT_EQ(text["checks"][3]["breaks_engine"], false);
  EXPECT_EQ(text["strategies"]["count"]["trust"], "safe");
}

// ---- JUnit
// -------------------------------------------------------------------------------------------------

// The elements of an XML text in the order of their starts, or what is not well-formed about it.
std::vector<std::string> elementsOf(const std::string& xml) {
  static const std::regex token(
      R"rx(<\?xml[^?]*\?>|</([a-z]+)>|<([a-z]+)((?: [a-z]+="(?:[^<>&"]|&(?:amp|lt|gt|quot);)*")*)(/?)>|([^<>]+))rx");
  std::vector<std::string> names, open;
  auto at = xml.cbegin();
  std::smatch match;
  while (at != xml.cend() &&
         std::regex_search(at, xml.cend(), match, token, std::regex_constants::match_continuous)) {
    if (match[2].matched) {
      names.push_back(match[2]);
      if (match[4].length() == 0) open.push_back(match[2]);
    } else if (match[1].matched) {
      if (open.empty() || open.back() != match[1]) return {"not closed in order: " + match.str()};
      open.pop_back();
    } else if (match[5].matched && match.str().find_first_not_of(" \n") != std::string::npos) {
      return {"text: " + match.str()};
    }
    at = match[0].second;
  }
  if (at != xml.cend() || !open.empty()) return {"not well-formed: " + std::string(at, xml.cend())};
  return names;
}

TEST(ValidationReport, TheXmlReaderOfTheseTestsSeesFaults) {
  EXPECT_EQ(elementsOf("<a><b/></a>"), (std::vector<std::string>{"a", "b"}));
  for (const char* bad :
       {"<a>", "<a></b>", "<a x=\"<\"/>", "<a x=\"&\"/>", "<a x=1/>", "<a>text</a>", "</a>"})
    EXPECT_NE(elementsOf(bad).front().find_first_of(": "), std::string::npos) << bad;
}

TEST(ValidationReport, JunitIsXmlThatCountsOnlyWhatBreaksTheEngine) {
  const std::string text = junit(mixed());
  EXPECT_EQ(elementsOf(text),
            (std::vector<std::string>{"testsuites", "testsuite", "testcase", "testcase", "failure",
                                      "testcase", "error", "testcase", "skipped", "testcase", "skipped"}))
      << text;
  EXPECT_NE(text.find("tests=\"5\" failures=\"1\" errors=\"1\" skipped=\"2\""), std::string::npos) << text;
  EXPECT_NE(text.find("classname=\"lists\" name=\"swap\" time=\"0.250\""), std::string::npos) << text;
  EXPECT_NE(text.find("2 &lt; 3 &amp; &quot;lost&quot; #1?"), std::string::npos) << text;
}

// ---- TAP
// ---------------------------------------------------------------------------------------------------

TEST(ValidationReport, TapCountsOnlyWhatBreaksTheEngine) {
  const std::string text = tap(mixed());
  std::istringstream lines(text);
  std::vector<std::string> points;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("ok") || line.starts_with("not ok")) points.push_back(line);
  EXPECT_TRUE(text.starts_with("TAP version 13\n1..5\n"));
  EXPECT_EQ(points, (std::vector<std::string>{"ok 1 - atomics good", "not ok 2 - atomics lock",
                                              "not ok 3 - lists swap",
                                              "not ok 4 - lists curious # TODO for information: FAIL: odd",
                                              "ok 5 - lists push # SKIP NO POWER: the control held"}));
}

TEST(ValidationReport, AnInterruptedRunSaysSo) {
  Report report = reportOf({outcomeOf(checks[0], Verdict::Pass)});
  report.outcomes.interrupted = true;
  EXPECT_NE(table(report, {}).find("interrupted"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(json(report, {}))["interrupted"], true);
  EXPECT_NE(tap(report).find("Bail out!"), std::string::npos);
}

// ---- which checks
// ------------------------------------------------------------------------------------------

std::string selected(const std::vector<std::string>& only, const std::vector<std::string>& skip) {
  std::string names;
  for (const Check& check : select(checks, only, skip)) names += check.name + " ";
  return names;
}

TEST(ValidationSelect, TakesNamesAndGroups) {
  EXPECT_EQ(selected({}, {}), "good lock swap curious push ");
  EXPECT_EQ(selected({"lists"}, {}), "swap curious push ");
  EXPECT_EQ(selected({"push", "atomics"}, {"lock"}), "good push ");
  EXPECT_EQ(selected({}, {"atomics", "push"}), "swap curious ");
}

TEST(ValidationSelect, NamesWhatIsNearToAnUnknownCheck) {
  for (const auto& [only, skip] :
       {std::pair<std::vector<std::string>, std::vector<std::string>>{{"lokc"}, {}}, {{}, {"lokc"}}}) {
    try {
      select(checks, only, skip);
      FAIL() << "no error";
    } catch (const base::Error& error) {
      EXPECT_EQ(error.exitCode, base::ExitCode::Usage);
      EXPECT_TRUE(std::string(error.what()).starts_with("lokc: no such check or group: near are lock"))
          << error.what();
    }
  }
}

}  // namespace
}  // namespace sfumato::lists::validation
