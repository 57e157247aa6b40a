// The runs of `sfumato stress`: which there are, and how they are told.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/options.h"
#include "base/random.h"
#include "image/report.h"
#include "lists/strategy.h"
#include "lists/stress/load.h"
#include "lists/stress/verification.h"
#include "pipelines/list_prediction.h"

namespace sfumato::app {

// Nodes of each list, where cells make a picture; rows from the top.
struct LengthGrid {
  size_t width = 0;
  size_t height = 0;
  std::vector<uint32_t> lengths;
};

// One container of lists, built and judged.
struct StressRun {
  std::string load;  // the distribution; of a scene "surfaces", "lights", "shadows"
  std::optional<lists::stress::Load> synthetic;
  int lights = 0;                        // of a scene
  pipelines::PredictedLists fromBounds;  // of a scene
  LengthGrid grid;                       // of a scene, where all its cells were built at once
  lists::ListOptions options;

  std::string refused;  // why it was not built, or empty; then nothing of what follows is there
  lists::ListStatistics statistics;
  lists::stress::Findings findings;
  double buildSeconds = 0;    // drawing the nodes into the container
  double resolveSeconds = 0;  // making sorted runs of them
  double lookupSeconds = 0;
  size_t lookups = 0;

  bool good() const { return findings.good(); }
};

struct StressResult {
  std::string device;
  std::string commandLine;
  bool soak = false;
  bool interrupted = false;
  double seconds = 0;
  std::vector<StressRun> runs;

  size_t lost() const;     // nodes, of all runs
  size_t badRuns() const;  // with any fault
  size_t refusedRuns() const;
};

// The sweep: every combination, the loads outside, the strategies inside. Throws Usage for a load that is too
// large.
std::vector<StressRun> plannedRuns(const StressOptions& options);
// A run of a soak: a load and a budget within what the options allow, of every size alike.
StressRun drawnRun(const StressOptions& options, base::Random& random);

// For people: a line for each run; of a soak a line for each strategy, and for each bad run.
std::string tableOf(const StressResult& result);
// One line that says what is wrong, or that nothing is.
std::string verdictOf(const StressResult& result);
nlohmann::json jsonOf(const StressResult& result);
image::Table rowsOf(const StressResult& result);
image::Report reportOf(const StressResult& result);

}  // namespace sfumato::app
