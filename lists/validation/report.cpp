#include "lists/validation/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "base/markup.h"
#include "base/version.h"

namespace sfumato::lists::validation {
namespace {

constexpr const char* strategies[] = {"spinlock", "lockfree", "append", "count"};

bool isBad(Verdict verdict) {
  return verdict == Verdict::Fail || verdict == Verdict::Hang || verdict == Verdict::Crash;
}

bool dependsOn(const Check& check, std::string_view strategy) {
  return std::find(check.strategies.begin(), check.strategies.end(), strategy) != check.strategies.end();
}

const char* scaleName(const Report& report) {
  return report.options.scale == Scale::Small ? "small" : "full";
}

std::string label(const Outcome& outcome) {
  const Run& run = outcome.run;
  return run.mutant.empty() ? run.check.name : run.check.name + ":" + run.mutant;
}

std::string figureText(const Figure& figure) {
  return std::visit([](const auto& value) { return fmt::format("{}", value); }, figure.second);
}

}  // namespace

bool breaksTheEngine(const Outcome& outcome) {
  return isBad(outcome.result.verdict) && !outcome.run.check.strategies.empty();
}

bool breaksTheEngine(const Report& report) {
  const auto& all = report.outcomes.all;
  return std::any_of(all.begin(), all.end(), [](const Outcome& outcome) { return breaksTheEngine(outcome); });
}

std::vector<StrategyTrust> strategyTrusts(const Report& report, const std::vector<Check>& checks) {
  const auto& all = report.outcomes.all;
  std::vector<StrategyTrust> trusts;
  for (const char* strategy : strategies) {
    StrategyTrust& trust = trusts.emplace_back(StrategyTrust{strategy, Trust::Safe, {}});
    const auto because = [&](const std::string& reason) {
      trust.because += (trust.because.empty() ? "" : ", ") + reason;
    };
    size_t notRun = 0;
    for (const Check& check : checks) {
      if (!dependsOn(check, strategy)) continue;
      const auto outcome = std::find_if(all.begin(), all.end(),
                                        [&](const Outcome& o) { return o.run.check.name == check.name; });
      if (outcome == all.end()) {
        ++notRun;
        continue;
      }
      const Verdict verdict = outcome->result.verdict;
      if (verdict == Verdict::Pass) continue;
      because(fmt::format("{} {}", check.name, name(verdict)));
      if (isBad(verdict)) trust.trust = Trust::Unsafe;
      if (trust.trust == Trust::Safe) trust.trust = Trust::NotShown;
    }
    if (notRun != 0) because(fmt::format("{} checks not run", notRun));
    if (notRun != 0 && trust.trust == Trust::Safe) trust.trust = Trust::NotShown;
  }
  return trusts;
}

std::string table(const Report& report, const std::vector<StrategyTrust>& trusts) {
  const Driver& driver = report.driver.driver;
  std::string text = fmt::format("{}, {}\nOpenGL {}, through EGL {}\nseed {}, scale {}, {:g} s a check\n",
                                 driver.renderer, driver.vendor, driver.version, report.driver.platform,
                                 report.options.seed, scaleName(report), report.options.timeoutSeconds);
  std::string group;
  for (const Outcome& outcome : report.outcomes.all) {
    const Check& check = outcome.run.check;
    if (check.group != group) text += fmt::format("\n{}\n", check.group);
    group = check.group;
    const Result& result = outcome.result;
    const bool note = isBad(result.verdict) && check.strategies.empty();
    text += fmt::format("  {:<8} {:<22} {:>6.1f} s  {}{}\n", name(result.verdict), label(outcome),
                        outcome.seconds, note ? "(information) " : "", result.finding);
    if (!result.meaning.empty()) text += fmt::format("{:43}-> {}\n", "", result.meaning);
  }
  if (report.outcomes.interrupted) text += "\ninterrupted: what was not done by then is not listed\n";
  text += fmt::format("\n{} checks in {:.1f} s\n", report.outcomes.all.size(), report.seconds);
  text += "strategies on this driver: ";
  for (const StrategyTrust& trust : trusts)
    text += fmt::format("{}{} {}{}", &trust == trusts.data() ? "" : "; ", trust.strategy, name(trust.trust),
                        trust.because.empty() ? "" : " (" + trust.because + ")");
  return text + "\n";
}

std::string json(const Report& report, const std::vector<StrategyTrust>& trusts) {
  using nlohmann::ordered_json;
  const Driver& driver = report.driver.driver;
  ordered_json checks = ordered_json::array();
  for (const Outcome& outcome : report.outcomes.all) {
    ordered_json figures = ordered_json::object();
    for (const auto& [key, value] : outcome.result.figures)
      std::visit([&, &name = key](const auto& v) { figures[name] = v; }, value);
    ordered_json check = {{"name", outcome.run.check.name},
                          {"group", outcome.run.check.group},
                          {"does", outcome.run.check.does},
                          {"verdict", name(outcome.result.verdict)},
                          {"finding", outcome.result.finding},
                          {"meaning", outcome.result.meaning},
                          {"strategies", outcome.run.check.strategies},
                          {"breaks_engine", breaksTheEngine(outcome)},
                          {"seconds", outcome.seconds},
                          {"figures", figures}};
    if (!outcome.run.mutant.empty()) check["mutant"] = outcome.run.mutant;
    checks.push_back(check);
  }
  ordered_json safe = ordered_json::object();
  for (const StrategyTrust& trust : trusts)
    safe[trust.strategy] = {{"trust", name(trust.trust)}, {"because", trust.because}};
  const ordered_json text = {{"program", base::version()},
                             {"device",
                              {{"vendor", driver.vendor},
                               {"renderer", driver.renderer},
                               {"version", driver.version},
                               {"platform", report.driver.platform},
                               {"software", report.driver.software}}},
                             {"seed", report.options.seed},
                             {"scale", scaleName(report)},
                             {"timeout_seconds", report.options.timeoutSeconds},
                             {"seconds", report.seconds},
                             {"interrupted", report.outcomes.interrupted},
                             {"engine_safe", !breaksTheEngine(report)},
                             {"checks", checks},
                             {"strategies", safe}};
  return base::jsonText(text);
}

namespace {

// Text as an XML attribute may have it; what XML cannot hold is shown as `?`.
std::string escaped(std::string text) {
  for (char& c : text)
    if (c < ' ' || c >= 127) c = '?';
  return base::escapedForMarkup(text);
}

// The element that says how a test case ended; empty for a pass.
std::string junitEnd(const Outcome& outcome) {
  const Result& result = outcome.result;
  if (result.verdict == Verdict::Pass) return {};
  const std::string message =
      escaped(result.finding + (result.meaning.empty() ? "" : " -> " + result.meaning));
  if (!breaksTheEngine(outcome))
    return fmt::format("<skipped message=\"{}: {}\"/>", name(result.verdict), message);
  return fmt::format("<{} type=\"{}\" message=\"{}\"/>",
                     result.verdict == Verdict::Fail ? "failure" : "error", name(result.verdict), message);
}

size_t count(const std::vector<Outcome>& all, bool (*holds)(const Outcome&)) {
  return static_cast<size_t>(std::count_if(all.begin(), all.end(), holds));
}

// What may stand after a TAP directive: one line without its own marks.
std::string tapText(std::string text) {
  for (char& c : text)
    if (c == '#' || static_cast<unsigned char>(c) < ' ') c = '?';
  return text;
}

std::string tapLine(const Outcome& outcome, size_t number) {
  const Result& result = outcome.result;
  const bool bad = isBad(result.verdict);
  std::string text =
      fmt::format("{}ok {} - {} {}", bad ? "not " : "", number, outcome.run.check.group, label(outcome));
  const std::string reason = fmt::format("{}: {}", name(result.verdict), tapText(result.finding));
  if (result.verdict == Verdict::Skip || result.verdict == Verdict::NoPower)
    text += " # SKIP " + reason;
  else if (bad && !breaksTheEngine(outcome))
    text += " # TODO for information: " + reason;
  text += '\n';
  if (!bad) return text;
  const auto quoted = [](const std::string& value) {
    return nlohmann::json(value).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  };
  text += fmt::format("  ---\n  verdict: {}\n  finding: {}\n  meaning: {}\n", name(result.verdict),
                      quoted(result.finding), quoted(result.meaning));
  for (const Figure& figure : result.figures)
    text += fmt::format("  {}: {}\n", quoted(figure.first), quoted(figureText(figure)));
  return text + "  ...\n";
}

}  // namespace

std::string junit(const Report& report) {
  const auto& all = report.outcomes.all;
  const auto failures =
      count(all, [](const Outcome& o) { return breaksTheEngine(o) && o.result.verdict == Verdict::Fail; });
  const auto errors =
      count(all, [](const Outcome& o) { return breaksTheEngine(o) && o.result.verdict != Verdict::Fail; });
  const auto skipped =
      count(all, [](const Outcome& o) { return o.result.verdict != Verdict::Pass && !breaksTheEngine(o); });
  const std::string counts =
      fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{:.3f}\"", all.size(),
                  failures, errors, skipped, report.seconds);
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"sfumato validate\" {0}>\n"
      "<testsuite name=\"{1}\" {0}>\n",
      counts, escaped(report.driver.driver.renderer));
  for (const Outcome& outcome : all) {
    const std::string end = junitEnd(outcome);
    text += fmt::format("  <testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\"",
                        escaped(outcome.run.check.group), escaped(label(outcome)), outcome.seconds);
    text += end.empty() ? "/>\n" : ">" + end + "</testcase>\n";
  }
  return text + "</testsuite>\n</testsuites>\n";
}

std::string tap(const Report& report) {
  const auto& all = report.outcomes.all;
  std::string text = fmt::format("TAP version 13\n1..{}\n", all.size());
  for (size_t i = 0; i < all.size(); ++i) text += tapLine(all[i], i + 1);
  if (report.outcomes.interrupted) text += "Bail out! interrupted\n";
  return text;
}

}  // namespace sfumato::lists::validation
