// `sfumato stress`: builds lists of every kind under load, and judges every node of them.
#include <csignal>
#include <set>

#include "app/report_file.h"
#include "app/shot.h"
#include "app/stress.h"
#include "app/stress_scene_gpu.h"
#include "base/error.h"
#include "base/file.h"
#include "base/interruption.h"
#include "base/json_text.h"
#include "base/log.h"
#include "base/progress.h"
#include "gl/device.h"
#include "lists/stress/stress_gpu.h"

namespace sfumato::app {

using base::ExitCode;
using base::fail;

namespace {

void checkOptions(const StressOptions& options) {
  if (isOfScene(options.shot)) {
    for (const std::string& budget : options.listMemory)
      if (budget.ends_with('%'))
        fail(ExitCode::Usage,
             "--list-memory: \"{}\" is of what a synthetic load takes: name a size, e.g. 64M", budget);
    if (options.minutes > 0) fail(ExitCode::Usage, "--minutes: is for synthetic loads: leave the scene out");
    return;
  }
  if (options.lights) fail(ExitCode::Usage, "--lights: is for a scene: name a .gltf or .glb file");
  checkWithoutScene(options.shot);
  plannedRuns(options);  // throws where one is too large
}

// Compiles what a run needs, so that its times hold none of that: the same on few cells, with all the budget
// that they could want.
void warmUp(gl::Device& device, const StressRun& run) {
  lists::stress::Load load = *run.synthetic;
  load.width = std::min(load.width, 64);
  load.height = std::min(load.height, 64);
  lists::ListOptions options = run.options;
  if (options.budgetBytes != 0) options.budgetBytes = size_t{1} << 40;
  lists::stress::measure(device, load, options);
}

// One run, as often as it is repeated: the least times, the faults of all.
void measureRun(gl::Device& device, StressRun& run, int repeat) {
  warmUp(device, run);
  for (int i = 0; i < repeat; ++i) {
    const lists::stress::Measured measured = lists::stress::measure(device, *run.synthetic, run.options);
    const auto keepLeast = [&](double& least, double seconds) {
      least = i == 0 ? seconds : std::min(least, seconds);
    };
    keepLeast(run.buildSeconds, measured.buildSeconds);
    keepLeast(run.resolveSeconds, measured.resolveSeconds);
    keepLeast(run.lookupSeconds, measured.lookupSeconds);
    run.statistics = measured.statistics;
    run.lookups = measured.lookups;
    run.findings += measured.findings;
  }
}

// What the container says by an error is a result here.
void doRun(gl::Device& device, StressRun& run, int repeat) {
  try {
    measureRun(device, run, repeat);
  } catch (const base::Error& error) {
    if (error.exitCode == ExitCode::Memory)
      run.refused = error.what();
    else if (error.exitCode == ExitCode::CheckFailed)
      run.findings = {.lost = run.synthetic->nodes(), .fault = error.what()};
    else
      throw;
  }
}

void sweep(gl::Device& device, const StressOptions& options, const base::Interruption& interruption,
           StressResult& result) {
  std::vector<StressRun> runs = plannedRuns(options);
  base::Progress progress("stress", static_cast<long>(runs.size()));
  for (StressRun& run : runs) {
    if (interruption.happened()) break;
    doRun(device, run, options.repeat);
    result.runs.push_back(std::move(run));
    progress.advance();
  }
}

void soak(gl::Device& device, const StressOptions& options, const base::Interruption& interruption,
          StressResult& result) {
  const Clock::time_point start = Clock::now();
  const double seconds = options.minutes * 60;
  base::Progress progress("soak", 1000);
  base::Random random(static_cast<uint64_t>(options.seed));
  for (long shown = 0; !interruption.happened() && secondsSince(start) < seconds;) {
    StressRun run = drawnRun(options, random);
    doRun(device, run, options.repeat);
    result.runs.push_back(std::move(run));
    const long done = std::min(1000L, static_cast<long>(secondsSince(start) / seconds * 1000));
    progress.advance(done - shown);
    shown = done;
  }
}

void tell(const StressOptions& options, const StressResult& result) {
  if (options.json)
    base::printResult(base::jsonText(jsonOf(result)));
  else
    base::printResult(tableOf(result));
  if (options.report.empty()) return;
  base::writeFile(pageOf(options.report), image::reportPage(reportOf(result)));
  base::note("wrote {}", pageOf(options.report).string());
}

// Each reason once.
void warnOfRefusals(const StressResult& result) {
  std::set<std::string> reasons;
  for (const StressRun& run : result.runs)
    if (!run.refused.empty() && reasons.insert(run.refused).second) base::warn("{}", run.refused);
}

// Bad runs decide; runs that their budget refused are a fault of the budget, but in a soak, which draws it.
int exitCodeOf(const StressResult& result) {
  if (result.badRuns() > 0) return static_cast<int>(ExitCode::CheckFailed);
  if (result.refusedRuns() > 0 && !result.soak) return static_cast<int>(ExitCode::Memory);
  return static_cast<int>(ExitCode::Done);
}

}  // namespace

int stress(const StressOptions& options) {
  const Clock::time_point start = Clock::now();
  checkOptions(options);
  checkReport(options.report);
  gl::Device device({.choice = options.shot.device.device, .shaderDir = options.shot.device.shaderDir});
  base::note("device: {} ({})", device.names().renderer, device.names().platform);

  StressResult result{.device = device.names().renderer,
                      .commandLine = options.shot.commandLine,
                      .soak = options.minutes > 0};
  const base::Interruption interruption({SIGINT});
  if (isOfScene(options.shot))
    stressScene(
        device, options, [&] { return interruption.happened(); }, result);
  else if (result.soak)
    soak(device, options, interruption, result);
  else
    sweep(device, options, interruption, result);
  result.interrupted = interruption.happened();
  result.seconds = secondsSince(start);

  // A test of which nothing was built is an error, and no result.
  if (!result.runs.empty() && result.refusedRuns() == result.runs.size())
    fail(ExitCode::Memory, "{}", result.runs.front().refused);
  tell(options, result);
  if (!result.soak) warnOfRefusals(result);
  return exitCodeOf(result);
}

}  // namespace sfumato::app
