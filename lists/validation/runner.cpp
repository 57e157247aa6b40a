#include "lists/validation/runner.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_text.h"

namespace sfumato::lists::validation {

using nlohmann::json;

namespace {

constexpr Verdict verdicts[] = {Verdict::Pass,  Verdict::Fail, Verdict::Hang,
                                Verdict::Crash, Verdict::Skip, Verdict::NoPower};

std::string oneLine(const json& text) {
  return base::jsonText(text, -1);
}

// The last line that is not empty.
std::string lastLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const size_t start = text.rfind('\n');
  return start == std::string::npos ? text : text.substr(start + 1);
}

Result crash(std::string finding) {
  return {Verdict::Crash, std::move(finding), "such code ends the program on this driver", {}};
}

Figure figureOf(const json& figure) {
  const json& value = figure.at(1);
  if (value.is_number_integer()) return {figure.at(0), value.get<int64_t>()};
  if (value.is_number()) return {figure.at(0), value.get<double>()};
  return {figure.at(0), value.get<std::string>()};
}

Result parse(const std::string& text) {
  const json object = json::parse(text);
  Result result;
  const auto* verdict = std::find_if(std::begin(verdicts), std::end(verdicts),
                                     [&](Verdict v) { return name(v) == object.at("verdict"); });
  if (verdict == std::end(verdicts)) throw std::runtime_error("no such verdict");
  result.verdict = *verdict;
  result.finding = object.at("finding");
  result.meaning = object.at("meaning");
  for (const json& figure : object.at("figures")) result.figures.push_back(figureOf(figure));
  return result;
}

}  // namespace

Command commandOf(const Run& run, const RunOptions& options) {
  Command command = {options.program, "validate",
                     "--run-check",   run.check.name,
                     "--seed",        fmt::format("{}", options.seed),
                     "--scale",       options.scale == Scale::Small ? "small" : "full"};
  command.insert(command.end(), options.deviceArguments.begin(), options.deviceArguments.end());
  command.insert(command.end(), run.arguments.begin(), run.arguments.end());
  return command;
}

std::string line(const Result& result) {
  json figures = json::array();
  for (const auto& [key, value] : result.figures)
    std::visit([&, &name = key](const auto& v) { figures.push_back({name, v}); }, value);
  return oneLine({{"verdict", name(result.verdict)},
                  {"finding", result.finding},
                  {"meaning", result.meaning},
                  {"figures", figures}});
}

Result resultOf(const Ended& ended, double timeoutSeconds) {
  if (ended.how == Ended::How::TimedOut)
    return {Verdict::Hang,
            fmt::format("not done after {:g} s", timeoutSeconds),
            "such code may never end on this driver",
            {}};
  const std::string last = lastLine(ended.err);
  const std::string said = last.empty() ? std::string() : ": " + last;
  if (ended.how == Ended::How::Signalled)
    return crash(fmt::format("its process died: {}{}", strsignal(ended.code), said));
  if (ended.code != 0) return crash(fmt::format("its process ended with exit code {}{}", ended.code, said));
  try {
    return parse(lastLine(ended.out));
  } catch (const std::exception&) {
    return crash("its process ended without a result" + said);
  }
}

Outcomes runChecks(const std::vector<Run>& runs, const RunOptions& options,
                   const std::function<void()>& onEnd) {
  std::vector<Command> commands;
  for (const Run& run : runs) commands.push_back(commandOf(run, options));
  std::map<size_t, Outcome> done;
  Outcomes outcomes;
  outcomes.interrupted =
      !runCommands(commands, options.jobs, options.timeoutSeconds, [&](size_t i, const Ended& ended) {
        if (ended.how == Ended::How::Interrupted) return;
        done[i] = {runs[i], resultOf(ended, options.timeoutSeconds), ended.seconds};
        onEnd();
      });
  for (auto& [index, outcome] : done) outcomes.all.push_back(std::move(outcome));
  return outcomes;
}

std::string line(const DriverAnswer& answer) {
  return oneLine({{"vendor", answer.driver.vendor},
                  {"renderer", answer.driver.renderer},
                  {"version", answer.driver.version},
                  {"platform", answer.platform},
                  {"software", answer.software}});
}

std::optional<DriverAnswer> askDriver(const RunOptions& options) {
  const Run question{{.name = driverQuestion}, {}, {}};
  Ended ended;
  runCommands({commandOf(question, options)}, 1, options.timeoutSeconds,
              [&](size_t, const Ended& end) { ended = end; });
  if (ended.how == Ended::How::Interrupted) return std::nullopt;
  try {
    if (ended.how == Ended::How::Exited && ended.code == 0) {
      const json text = json::parse(lastLine(ended.out));
      return DriverAnswer{{text.at("vendor"), text.at("renderer"), text.at("version")},
                          text.at("platform"),
                          text.at("software")};
    }
  } catch (const json::exception&) {
  }
  std::string said = lastLine(ended.err);
  constexpr std::string_view prefix = "sfumato: error: ";
  if (said.starts_with(prefix)) said.erase(0, prefix.size());
  if (ended.how == Ended::How::Exited && ended.code == static_cast<int>(base::ExitCode::NoGl))
    base::fail(base::ExitCode::NoGl, "{}", said);
  base::fail(base::ExitCode::NoGl, "no usable OpenGL: the driver does not get as far as a context: {}{}",
             resultOf(ended, options.timeoutSeconds).finding, said.empty() ? "" : " (" + said + ")");
}

}  // namespace sfumato::lists::validation
