// The results of a stress test as a table and as JSON.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "app/stress.h"
#include "app/text_table.h"
#include "base/size_text.h"

namespace sfumato::app {
namespace {

using Json = nlohmann::json;

// Millions a second.
std::string rate(size_t count, double seconds) {
  return seconds > 0 ? fmt::format("{:.2f}", static_cast<double>(count) / seconds / 1e6) : "-";
}

std::string sizeOf(const StressRun& run) {
  return run.synthetic ? fmt::format("{}x{}", run.synthetic->width, run.synthetic->height)
                       : std::to_string(run.statistics.cells);
}

Row headOf(const StressResult& result) {
  const bool scene = !result.runs.empty() && !result.runs.front().synthetic;
  return {"strategy",
          scene ? "lists" : "load",
          "cells",
          scene ? "lights" : "layers",
          scene ? "from bounds" : "payload",
          "budget",
          "demanded",
          "stored",
          "lost",
          "faults",
          "B/node",
          "predicted",
          "peak",
          "windows",
          "builds",
          "spins",
          "longest",
          "build",
          "resolve",
          "lookups"};
}

Row rowOf(const StressRun& run) {
  const lists::ListStatistics& s = run.statistics;
  Row row = {lists::strategies().nameOf(run.options.strategy),
             run.load,
             sizeOf(run),
             std::to_string(run.synthetic ? run.synthetic->layers : run.lights),
             run.synthetic
                 ? std::to_string(run.synthetic->payloadWords * 4)
                 : fmt::format("{} / {}", run.fromBounds.nodes, base::sizeText(run.fromBounds.bytes)),
             run.options.budgetBytes == 0 ? "-" : base::sizeText(run.options.budgetBytes)};
  if (!run.refused.empty()) {
    row.push_back("refused");
    row.resize(20, "-");
    return row;
  }
  for (const std::string& cell :
       {std::to_string(s.demand), std::to_string(s.stored), std::to_string(run.findings.lost),
        std::to_string(run.findings.faults()), std::to_string(s.nodeBytes), base::sizeText(s.predictedBytes),
        base::sizeText(s.bytes), std::to_string(s.windows), std::to_string(s.builds),
        s.maxSpins == 0 ? "-" : fmt::format("{}/{}", s.p99Spins, s.maxSpins), std::to_string(s.longest),
        rate(s.stored, run.buildSeconds), rate(s.stored, run.resolveSeconds),
        rate(run.lookups, run.lookupSeconds)})
    row.push_back(cell);
  return row;
}

std::string unitsOf(const StressResult& result) {
  const bool scene = !result.runs.empty() && !result.runs.front().synthetic;
  return std::string(scene ? "from bounds: nodes and bytes predicted from the scene's shapes; " : "") +
         "spins: of 99 % and of all; build, resolve: million nodes/s; lookups: million/s\n";
}

std::string describe(const StressRun& run) {
  if (!run.synthetic)
    return fmt::format("{} of {} lights, {}", run.load, run.lights,
                       lists::strategies().nameOf(run.options.strategy));
  return fmt::format("{} {} layers {} payload {} seed {} budget {} {}", sizeOf(run), run.load,
                     run.synthetic->layers, run.synthetic->payloadWords * 4, run.synthetic->seed,
                     run.options.budgetBytes, lists::strategies().nameOf(run.options.strategy));
}

// A soak has too many runs for a line each.
std::string soakTable(const StressResult& result) {
  struct Sum {
    size_t runs = 0, refused = 0, windows = 0, stored = 0, lost = 0, faults = 0, spins = 0, longest = 0;
    double buildSeconds = 0, resolveSeconds = 0;
  };
  std::map<lists::Strategy, Sum> sums;
  for (const StressRun& run : result.runs) {
    Sum& sum = sums[run.options.strategy];
    ++sum.runs;
    sum.refused += run.refused.empty() ? 0 : 1;
    sum.windows = std::max(sum.windows, static_cast<size_t>(run.statistics.windows));
    sum.stored += run.statistics.stored;
    sum.lost += run.findings.lost;
    sum.faults += run.findings.faults();
    sum.spins = std::max(sum.spins, run.statistics.maxSpins);
    sum.longest = std::max(sum.longest, run.statistics.longest);
    sum.buildSeconds += run.buildSeconds;
    sum.resolveSeconds += run.resolveSeconds;
  }
  std::vector<Row> rows = {{"strategy", "runs", "refused", "most windows", "stored", "lost", "faults",
                            "most spins", "longest", "build", "resolve"}};
  for (const auto& [strategy, sum] : sums) {
    Row row = {lists::strategies().nameOf(strategy)};
    for (const size_t value :
         {sum.runs, sum.refused, sum.windows, sum.stored, sum.lost, sum.faults, sum.spins, sum.longest})
      row.push_back(std::to_string(value));
    row.push_back(rate(sum.stored, sum.buildSeconds));
    row.push_back(rate(sum.stored, sum.resolveSeconds));
    rows.push_back(row);
  }
  return aligned(rows, 1);
}

Json lengthsJson(const lists::ListStatistics& statistics) {
  Json classes = Json::array();
  for (size_t k = 0; k < statistics.lengths.size(); ++k) {
    if (statistics.lengths[k] == 0) continue;
    const size_t most = k == 0 ? 0 : size_t{1} << (k - 1);
    classes.push_back(
        {{"from", k < 2 ? most : most / 2 + 1}, {"to", most}, {"cells", statistics.lengths[k]}});
  }
  return classes;
}

Json rateJson(size_t count, double seconds) {
  return seconds > 0 ? Json(static_cast<double>(count) / seconds) : Json();
}

Json settingsJson(const StressRun& run) {
  Json json = {{"strategy", lists::strategies().nameOf(run.options.strategy)},
               {"on_overflow", lists::overflowPolicies().nameOf(run.options.onOverflow)},
               {"budget_bytes", run.options.budgetBytes == 0 ? Json() : Json(run.options.budgetBytes)}};
  if (!run.synthetic) {
    json.update({{"lists", run.load},
                 {"lights", run.lights},
                 {"nodes_from_bounds", run.fromBounds.nodes},
                 {"bytes_from_bounds", run.fromBounds.bytes}});
    return json;
  }
  const lists::stress::Load& load = *run.synthetic;
  json.update({{"distribution", run.load},
               {"width", load.width},
               {"height", load.height},
               {"layers", load.layers},
               {"payload_bytes", load.payloadWords * 4},
               {"seed", load.seed}});
  return json;
}

Json runJson(const StressRun& run) {
  Json json = settingsJson(run);
  if (!run.refused.empty()) {
    json["refused"] = run.refused;
    json["lost"] = 0;
    return json;
  }
  const lists::ListStatistics& s = run.statistics;
  const lists::stress::Findings& f = run.findings;
  json.update(
      {{"cells", s.cells},
       {"demanded", s.demand},
       {"stored", s.stored},
       {"lost", f.lost},
       {"twice", f.twice},
       {"foreign", f.foreign},
       {"unsorted", f.unsorted},
       {"torn", f.torn},
       {"broken", f.broken},
       {"misread", f.misread},
       {"different", f.different},
       {"rebuilt", f.rebuilt},
       {"overwritten", f.overwritten},
       {"hidden", f.hidden},
       {"fault", f.fault},
       {"bytes_per_node", s.nodeBytes},
       {"nodes_counted", s.predicted},
       {"predicted_bytes", s.predictedBytes},
       {"peak_bytes", s.bytes},
       {"capacity", s.capacity},
       {"windows", s.windows},
       {"builds", s.builds},
       {"spins_max", s.maxSpins},
       {"spins_p99", s.p99Spins},
       {"retries", s.retries},
       {"overflowed", s.overflowed},
       {"distrusted", s.distrusted},
       {"longest", s.longest},
       {"lengths", lengthsJson(s)},
       {"seconds",
        {{"build", run.buildSeconds}, {"resolve", run.resolveSeconds}, {"lookup", run.lookupSeconds}}},
       {"build_nodes_per_second", rateJson(s.stored, run.buildSeconds)},
       {"resolve_nodes_per_second", rateJson(s.stored, run.resolveSeconds)},
       {"lookups_per_second", rateJson(run.lookups, run.lookupSeconds)}});
  return json;
}

}  // namespace

size_t StressResult::lost() const {
  size_t sum = 0;
  for (const StressRun& run : runs) sum += run.findings.lost;
  return sum;
}

size_t StressResult::badRuns() const {
  return static_cast<size_t>(
      std::count_if(runs.begin(), runs.end(), [](const auto& run) { return !run.good(); }));
}

size_t StressResult::refusedRuns() const {
  return static_cast<size_t>(
      std::count_if(runs.begin(), runs.end(), [](const auto& run) { return !run.refused.empty(); }));
}

std::string verdictOf(const StressResult& result) {
  size_t stored = 0;
  for (const StressRun& run : result.runs) stored += run.statistics.stored;
  std::string line = fmt::format("{} runs, {} nodes: ", result.runs.size(), stored);
  const bool scene = !result.runs.empty() && !result.runs.front().synthetic;
  line += result.badRuns() == 0
              ? (scene ? "none lost, none twice, all sorted, the same picture from every strategy"
                       : "none lost, none twice, all sorted")
              : fmt::format("{} runs are bad, {} nodes are lost", result.badRuns(), result.lost());
  if (result.refusedRuns() > 0)
    line += fmt::format("; {} runs refused by their budget", result.refusedRuns());
  if (result.interrupted) line += "; interrupted";
  return line;
}

std::string tableOf(const StressResult& result) {
  std::string text = "device   " + result.device + "\n\n";
  if (result.soak) {
    text += soakTable(result);
  } else if (!result.runs.empty()) {
    std::vector<Row> rows = {headOf(result)};
    for (const StressRun& run : result.runs) rows.push_back(rowOf(run));
    text += aligned(rows, 2) + unitsOf(result);
  }
  text += fmt::format("\n{}\n", verdictOf(result));
  for (const StressRun& run : result.runs)
    if (!run.good()) text += fmt::format("bad: {}: {}\n", describe(run), run.findings.fault);
  return text;
}

image::Table rowsOf(const StressResult& result) {
  image::Table table{.title = "All runs", .caption = unitsOf(result), .header = headOf(result)};
  for (const StressRun& run : result.runs) {
    if (!run.good()) table.highlighted.push_back(table.rows.size());
    table.rows.push_back(rowOf(run));
  }
  return table;
}

nlohmann::json jsonOf(const StressResult& result) {
  Json json = {{"device", result.device},
               {"command", result.commandLine},
               {"seconds", result.seconds},
               {"interrupted", result.interrupted},
               {"lost", result.lost()},
               {"bad_runs", result.badRuns()},
               {"refused_runs", result.refusedRuns()},
               {"runs", Json::array()}};
  for (const StressRun& run : result.runs) json["runs"].push_back(runJson(run));
  return json;
}

}  // namespace sfumato::app
