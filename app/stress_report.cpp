// The results of a stress test as a page for a browser.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

#include "app/stress.h"

namespace sfumato::app {
namespace {

using image::Plot;
using image::Series;
using lists::Strategy;
using lists::stress::Load;

constexpr size_t mostMapCells = 128;  // a side of the heat maps

using Runs = std::vector<const StressRun*>;

// In order of first appearance.
template <typename T>
std::vector<T> distinct(const Runs& runs, const std::function<T(const StressRun&)>& value) {
  std::vector<T> values;
  for (const StressRun* run : runs)
    if (std::find(values.begin(), values.end(), value(*run)) == values.end()) values.push_back(value(*run));
  return values;
}

Runs where(const Runs& runs, const std::function<bool(const StressRun&)>& holds) {
  Runs result;
  std::copy_if(runs.begin(), runs.end(), std::back_inserter(result),
               [&](const StressRun* run) { return holds(*run); });
  return result;
}

std::string strategyOf(const StressRun& run) {
  return lists::strategies().nameOf(run.options.strategy);
}

std::string loadOf(const StressRun& run) {
  return run.load;
}

// What grows from run to run: layers, or the lights of a scene.
int sizeOf(const StressRun& run) {
  return run.synthetic ? run.synthetic->layers : run.lights;
}

double nanosecondsPerNode(const StressRun& run, double seconds) {
  return run.statistics.stored == 0 ? 0 : seconds / static_cast<double>(run.statistics.stored) * 1e9;
}

double cost(const StressRun& run) {
  return nanosecondsPerNode(run, run.buildSeconds + run.resolveSeconds);
}

double mean(const Runs& runs, const std::function<double(const StressRun&)>& value) {
  double sum = 0;
  for (const StressRun* run : runs) sum += value(*run);
  return runs.empty() ? 0 : sum / static_cast<double>(runs.size());
}

// The plain runs of the largest of what was swept: one budget, one grid, one size of nodes.
Runs plainRuns(const Runs& runs) {
  const StressRun& first = *runs.front();
  return where(runs, [&](const StressRun& run) {
    if (run.options.budgetBytes != 0) return false;
    return !run.synthetic || (run.synthetic->width == first.synthetic->width &&
                              run.synthetic->height == first.synthetic->height &&
                              run.synthetic->payloadWords == first.synthetic->payloadWords);
  });
}

Runs largestRuns(const Runs& runs) {
  int largest = 0;
  for (const StressRun* run : runs) largest = std::max(largest, sizeOf(*run));
  return where(runs, [&](const StressRun& run) { return sizeOf(run) == largest; });
}

std::string setting(const StressRun& run) {
  if (!run.synthetic) return fmt::format("{} lights", run.lights);
  return fmt::format("{} x {} cells, {} layers, {} bytes of payload", run.synthetic->width,
                     run.synthetic->height, run.synthetic->layers, run.synthetic->payloadWords * 4);
}

// A bar for each load, which are the plot's categories, and strategy.
void addBars(Plot& plot, const Runs& runs, const std::function<double(const StressRun&)>& value) {
  for (const std::string& strategy : distinct<std::string>(runs, strategyOf)) {
    Series series{.name = strategy};
    for (const std::string& load : plot.categories)
      series.points.emplace_back(
          0,
          mean(where(runs,
                     [&](const StressRun& run) { return run.load == load && strategyOf(run) == strategy; }),
               value));
    plot.series.push_back(series);
  }
}

Plot sideBySide(const Runs& largest) {
  Plot plot{.title = "Strategies side by side",
            .caption = "Time to build and resolve, a node: " + setting(*largest.front()) + ", no budget.",
            .kind = Plot::Kind::Bars,
            .yTitle = "ns a node",
            .logarithmicY = true,
            .categories = distinct<std::string>(largest, loadOf)};
  addBars(plot, largest, cost);
  return plot;
}

Plot partsOfTime(const Runs& largest) {
  Plot plot{
      .title = "Where the time goes",
      .caption = fmt::format("The load \"{}\" of the plot beside: build is drawing the nodes, resolve makes "
                             "sorted runs of them.",
                             largest.front()->load),
      .kind = Plot::Kind::StackedBars,
      .yTitle = "ns a node",
      .categories = distinct<std::string>(largest, strategyOf)};
  const auto part = [&](const char* name, double StressRun::*seconds) {
    Series series{.name = name};
    for (const std::string& strategy : plot.categories)
      series.points.emplace_back(
          0, mean(where(largest,
                        [&](const StressRun& run) {
                          return run.load == largest.front()->load && strategyOf(run) == strategy;
                        }),
                  [&](const StressRun& run) { return nanosecondsPerNode(run, run.*seconds); }));
    plot.series.push_back(series);
  };
  part("build", &StressRun::buildSeconds);
  part("resolve", &StressRun::resolveSeconds);
  return plot;
}

Plot costAgainstSize(const Runs& plain, const std::string& load) {
  const bool scene = !plain.front()->synthetic;
  Plot plot{.title = fmt::format("Cost against {}: {}", scene ? "lights" : "layers", load),
            .caption = "Time to build and resolve, a node, without a budget.",
            .kind = Plot::Kind::Lines,
            .xTitle = scene ? "lights" : "layers",
            .yTitle = "ns a node",
            .logarithmicX = true,
            .logarithmicY = true};
  for (const std::string& strategy : distinct<std::string>(plain, strategyOf)) {
    Series series{.name = strategy};
    for (const StressRun* run : plain)
      if (run->load == load && strategyOf(*run) == strategy)
        series.points.emplace_back(sizeOf(*run), cost(*run));
    std::sort(series.points.begin(), series.points.end());
    plot.series.push_back(series);
  }
  return plot;
}

// By strategy, and with a dashed line where both are equal.
Plot againstDemand(const Runs& runs, Plot plot, const std::function<double(const StressRun&)>& x,
                   const std::function<double(const StressRun&)>& y) {
  plot.kind = Plot::Kind::Points;
  plot.logarithmicX = plot.logarithmicY = true;
  double low = 1e300, high = 0;
  for (const std::string& strategy : distinct<std::string>(runs, strategyOf)) {
    Series series{.name = strategy};
    for (const StressRun* run : runs) {
      if (strategyOf(*run) != strategy || run->statistics.demand == 0) continue;
      series.points.emplace_back(x(*run), y(*run));
      low = std::min(low, x(*run));
      high = std::max(high, x(*run));
    }
    plot.series.push_back(series);
  }
  plot.series.push_back({.name = "equal", .points = {{low, low}, {high, high}}, .reference = true});
  return plot;
}

Plot requestedAgainstCapacity(const Runs& runs) {
  return againstDemand(
      runs,
      {.title = "Requested against capacity",
       .caption = "Nodes that the load asks for, and nodes that the pool held at once. Below the line the "
                  "lists were "
                  "built in windows; nothing is dropped there.",
       .xTitle = "nodes requested",
       .yTitle = "nodes of the pool"},
      [](const StressRun& run) { return static_cast<double>(run.statistics.demand); },
      [](const StressRun& run) { return static_cast<double>(run.statistics.capacity); });
}

Plot predictedAgainstPeak(const Runs& runs) {
  return againstDemand(
      where(runs, [](const StressRun& run) { return run.statistics.predictedBytes > 0; }),
      {.title = "Predicted against peak memory",
       .caption = "Bytes told before a node was stored, and the most that was allocated at one time.",
       .xTitle = "predicted MiB",
       .yTitle = "peak MiB"},
      [](const StressRun& run) { return static_cast<double>(run.statistics.predictedBytes) / 0x1p20; },
      [](const StressRun& run) { return static_cast<double>(run.statistics.bytes) / 0x1p20; });
}

bool sameLoad(const StressRun& a, const StressRun& b) {
  const Load &x = *a.synthetic, &y = *b.synthetic;
  return a.load == b.load && x.width == y.width && x.height == y.height && x.layers == y.layers &&
         x.payloadWords == y.payloadWords && x.seed == y.seed && a.options.strategy == b.options.strategy;
}

// The time of a run over that of the same run without a budget; 0 where there is none.
double timesAsLong(const StressRun& run, const Runs& runs) {
  const auto free = std::find_if(runs.begin(), runs.end(), [&](const StressRun* other) {
    return other->options.budgetBytes == 0 && sameLoad(run, *other);
  });
  return free == runs.end() ? 0 : cost(run) / cost(**free);
}

std::string budgetOf(const StressRun& run) {
  const auto demand = static_cast<double>(run.statistics.demand * run.statistics.nodeBytes);
  return fmt::format("{}, {:.2g}%", run.load, 100 * static_cast<double>(run.options.budgetBytes) / demand);
}

Plot costOfBudget(const Runs& runs) {
  const Runs budgeted = where(runs, [](const StressRun& run) { return run.options.budgetBytes != 0; });
  Plot plot{
      .title = "What a budget costs",
      .caption = "Time within a budget (% of what the nodes take) over that of the same run without one.",
      .kind = Plot::Kind::Bars,
      .yTitle = "times as long"};
  if (budgeted.empty()) return plot;
  const Runs largest = largestRuns(budgeted);
  plot.categories = distinct<std::string>(largest, budgetOf);
  for (const std::string& strategy : distinct<std::string>(largest, strategyOf)) {
    Series series{.name = strategy};
    for (const std::string& budget : plot.categories)
      series.points.emplace_back(0, mean(where(largest,
                                               [&](const StressRun& run) {
                                                 return budgetOf(run) == budget &&
                                                        strategyOf(run) == strategy;
                                               }),
                                         [&](const StressRun& run) { return timesAsLong(run, runs); }));
    plot.series.push_back(series);
  }
  return plot;
}

Plot lookupRates(const Runs& largest) {
  Plot plot{.title = "Lookups",
            .caption = "Visibility lookups along a march, 64 a cell, in the resolved runs.",
            .kind = Plot::Kind::Bars,
            .yTitle = "million a second",
            .categories = distinct<std::string>(largest, loadOf)};
  addBars(plot, largest, [](const StressRun& run) {
    return run.lookupSeconds > 0 ? static_cast<double>(run.lookups) / run.lookupSeconds / 1e6 : 0;
  });
  return plot;
}

std::string className(size_t k) {
  if (k < 2) return std::to_string(k);
  const size_t most = size_t{1} << (k - 1);
  return most / 2 + 1 == most ? std::to_string(most) : fmt::format("{}-{}", most / 2 + 1, most);
}

Plot histogram(const Runs& largest) {
  Plot plot{.title = "List lengths",
            .caption = "Cells by the nodes in their list: " + setting(*largest.front()) + ".",
            .kind = Plot::Kind::Bars,
            .xTitle = "nodes in the list",
            .yTitle = "cells",
            .logarithmicY = true};
  size_t classes = 0;
  for (const StressRun* run : largest)
    for (size_t k = 0; k < run->statistics.lengths.size(); ++k)
      if (run->statistics.lengths[k] > 0) classes = std::max(classes, k + 1);
  for (size_t k = 0; k < classes; ++k) plot.categories.push_back(className(k));
  for (const std::string& load : distinct<std::string>(largest, loadOf)) {
    const Runs runs = where(largest, [&](const StressRun& run) { return run.load == load; });
    Series series{.name = load};
    for (size_t k = 0; k < classes; ++k)
      series.points.emplace_back(0, static_cast<double>(runs.front()->statistics.lengths[k]));
    plot.series.push_back(series);
  }
  return plot;
}

LengthGrid gridOf(const Load& load) {
  return {static_cast<size_t>(load.width), static_cast<size_t>(load.height), lengthsOf(load)};
}

// The longest list of each block of cells where there are more than fit the page.
image::CountMap lengthMap(const StressRun& run) {
  const LengthGrid grid = run.synthetic ? gridOf(*run.synthetic) : run.grid;
  const size_t columns = grid.width, rows = grid.height;
  const size_t block = (std::max(columns, rows) + mostMapCells - 1) / mostMapCells;
  image::CountMap map{
      .title = "Heat map of list lengths: " + run.load,
      .caption = setting(run) +
                 (block > 1 ? fmt::format("; of each {0} x {0} cells the longest list.", block) : "."),
      .width = (columns + block - 1) / block,
      .height = (rows + block - 1) / block,
      .unit = "nodes"};
  map.counts.resize(map.width * map.height);
  for (size_t y = 0; y < rows; ++y)
    for (size_t x = 0; x < columns; ++x) {
      uint32_t& count = map.counts[y / block * map.width + x / block];
      count = std::max(count, grid.lengths[y * columns + x]);
    }
  return map;
}

void addSweepPlots(const Runs& runs, image::Report& report) {
  const Runs plain = plainRuns(runs);
  if (!plain.empty()) {
    const Runs largest = largestRuns(plain);
    report.parts.emplace_back(sideBySide(largest));
    report.parts.emplace_back(partsOfTime(largest));
    if (distinct<int>(plain, sizeOf).size() > 1)
      for (const std::string& load : distinct<std::string>(plain, loadOf))
        report.parts.emplace_back(costAgainstSize(plain, load));
    if (std::any_of(largest.begin(), largest.end(), [](const StressRun* run) { return run->lookups > 0; }))
      report.parts.emplace_back(lookupRates(largest));
  }
  if (runs.front()->synthetic) {
    const Plot budgets = costOfBudget(runs);
    if (!budgets.series.empty()) report.parts.emplace_back(budgets);
  }
}

void addLengths(const Runs& runs, image::Report& report) {
  const Runs largest = largestRuns(plainRuns(runs).empty() ? runs : plainRuns(runs));
  report.parts.emplace_back(histogram(largest));
  for (const std::string& load : distinct<std::string>(largest, loadOf)) {
    const Runs shown = where(largest, [&](const StressRun& run) {
      return run.load == load && (run.synthetic || run.grid.width > 0);
    });
    if (!shown.empty()) report.parts.emplace_back(lengthMap(*shown.front()));
  }
}

}  // namespace

image::Report reportOf(const StressResult& result) {
  image::Report report{.title = "Sfumato: lists under stress",
                       .facts = {{"Device", result.device},
                                 {"Command", result.commandLine},
                                 {"Time", fmt::format("{:.1f} s", result.seconds)}},
                       .verdict = verdictOf(result),
                       .good = result.badRuns() == 0};
  Runs runs;
  for (const StressRun& run : result.runs)
    if (run.refused.empty()) runs.push_back(&run);
  if (!runs.empty()) {
    if (!result.soak) addSweepPlots(runs, report);
    report.parts.emplace_back(requestedAgainstCapacity(runs));
    report.parts.emplace_back(predictedAgainstPeak(runs));
    if (!result.soak) addLengths(runs, report);
  }
  report.parts.emplace_back(rowsOf(result));
  return report;
}

}  // namespace sfumato::app
