// Which runs a stress test has.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "app/stress.h"
#include "base/error.h"
#include "base/size_text.h"

namespace sfumato::app {
namespace {

using lists::stress::Distribution;
using lists::stress::Load;

// What there is one of, whatever the lists hold.
constexpr size_t smallestBudget = 16384;

// What the finished lists take: a place and a length for each cell; depth, id and payload for each node.
size_t listBytes(const Load& load) {
  return load.cells() * 8 + load.nodes() * (8 + load.payloadWords * 4);
}

// Of "none", "256M" or "10%" of what the finished lists take.
size_t budgetOf(const std::string& text, const Load& load) {
  if (text == "none") return 0;
  if (!text.ends_with('%')) return base::bytesNamed(text, "--list-memory");
  const double percent = std::stod(text);
  return std::max<size_t>(1, static_cast<size_t>(static_cast<double>(listBytes(load)) * percent / 100));
}

// What a budget has to have room for, whatever the strategy: its longest list, several times over while it is
// built, and what there is one of.
bool holdsLongestList(size_t budget, const Load& load) {
  const std::vector<uint32_t> lengths = lengthsOf(load);
  const size_t longest = *std::max_element(lengths.begin(), lengths.end());
  return budget > 3 * longest * (8 + load.payloadWords * 4) + smallestBudget;
}

std::vector<size_t> budgetsOf(const StressOptions& options, const Load& load) {
  std::vector<size_t> budgets;
  for (const std::string& text : options.listMemory) budgets.push_back(budgetOf(text, load));
  if (!budgets.empty()) return budgets;
  const size_t tenth = budgetOf("10%", load);
  return holdsLongestList(tenth, load) ? std::vector<size_t>{0, tenth} : std::vector<size_t>{0};
}

void checkSize(const Load& load) {
  const size_t nodes = load.nodes();
  if (nodes > lists::stress::maxNodes)
    base::fail(base::ExitCode::Usage,
               "stress: {}x{} cells, {} layers: {} nodes are more than {}: lower one of them", load.width,
               load.height, load.layers, nodes, lists::stress::maxNodes);
}

StressRun runOf(const Load& load, lists::Strategy strategy, size_t budget, lists::OnOverflow onOverflow) {
  StressRun run;
  run.load = lists::stress::distributions().nameOf(load.distribution);
  run.synthetic = load;
  run.options = {.strategy = strategy, .budgetBytes = budget, .onOverflow = onOverflow};
  return run;
}

template <typename T>
const T& oneOf(const std::vector<T>& values, base::Random& random) {
  return values[random.next() % values.size()];
}

// From 1 to `most`, as many below a size as above it on a logarithmic scale.
int drawnSize(int most, base::Random& random) {
  return std::clamp(static_cast<int>(std::exp(random.uniform(0, std::log(most + 1.0)))), 1, most);
}

}  // namespace

std::vector<StressRun> plannedRuns(const StressOptions& options) {
  std::vector<StressRun> runs;
  for (const glm::ivec2 cells : options.cells)
    for (const std::string& distribution : options.distributions)
      for (const int layers : options.layers)
        for (const int nodeBytes : options.nodeBytes) {
          const Load load{.width = cells.x,
                          .height = cells.y,
                          .layers = layers,
                          .distribution = lists::stress::distributions().named(distribution),
                          .payloadWords = static_cast<uint32_t>(nodeBytes / 4),
                          .seed = static_cast<uint32_t>(options.seed)};
          checkSize(load);
          for (const size_t budget : budgetsOf(options, load))
            for (const std::string& strategy : options.lists)
              runs.push_back(runOf(load, lists::strategies().named(strategy), budget,
                                   lists::overflowPolicies().named(options.onOverflow)));
        }
  return runs;
}

StressRun drawnRun(const StressOptions& options, base::Random& random) {
  const glm::ivec2 cells = oneOf(options.cells, random);
  Load load{.width = drawnSize(cells.x, random),
            .height = drawnSize(cells.y, random),
            .layers = drawnSize(oneOf(options.layers, random), random),
            .distribution = lists::stress::distributions().named(oneOf(options.distributions, random)),
            .payloadWords = static_cast<uint32_t>(oneOf(options.nodeBytes, random) / 4),
            .seed = random.next()};
  checkSize(load);
  const size_t budget = random.next() % 2 == 0
                            ? oneOf(budgetsOf(options, load), random)
                            : budgetOf(fmt::format("{}%", 5 + random.next() % 150), load) + smallestBudget;
  return runOf(load, lists::strategies().named(oneOf(options.lists, random)), budget,
               lists::overflowPolicies().named(options.onOverflow));
}

}  // namespace sfumato::app
