// `sfumato validate`: whether this driver can be trusted with atomics, lists and locks.
#include <unistd.h>

#include <chrono>
#include <filesystem>

#include "app/options.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "base/progress.h"
#include "lists/driver_verdict.h"
#include "lists/validation/report.h"
#include "lists/validation/run_here_gpu.h"
#include "lists/validation/runner.h"
#include "lists/validation/self_test_gpu.h"

namespace sfumato::app {
namespace {

namespace fs = std::filesystem;
using namespace lists::validation;

constexpr int interruptedExitCode = 130;  // as shells have it for Ctrl-C

Scale scaleOf(const ValidateOptions& options) {
  return options.scale == "full" ? Scale::Full : Scale::Small;
}

RunOptions runOptions(const ValidateOptions& options) {
  RunOptions run;
  if (!options.device.device.empty()) run.deviceArguments = {"--device", options.device.device};
  if (!options.device.shaderDir.empty())
    run.deviceArguments.insert(run.deviceArguments.end(), {"--shader-dir", options.device.shaderDir});
  run.seed = options.seed;
  run.scale = scaleOf(options);
  run.timeoutSeconds = options.timeoutSeconds.value_or(run.scale == Scale::Full ? 180 : 60);
  run.jobs = options.jobs;
  return run;
}

// What the process of one check does: its result is one line of JSON.
int runCheckHere(const ValidateOptions& options) {
  const gl::DeviceOptions device{
      .choice = options.device.device, .shaderDir = options.device.shaderDir, .examine = true};
  if (options.runCheck == driverQuestion) {
    const gl::DeviceNames names = gl::Device(device).names();
    base::printResult(
        line(DriverAnswer{{names.vendor, names.renderer, names.version}, names.platform, names.software}));
    return 0;
  }
  std::vector<Check> checks = allChecks();
  for (Check& check : faultyChecks()) checks.push_back(std::move(check));
  const Check check = select(checks, {options.runCheck}, {}).front();
  Run again{check, options.mutant, {}};
  if (!options.mutant.empty()) again.arguments = {"--mutant", options.mutant};
  base::printResult(line(runHere(check, {device, options.seed, scaleOf(options), options.mutant,
                                         commandOf(again, runOptions(options))})));
  return 0;
}

int list(const std::vector<Check>& checks) {
  std::string group;
  for (const Check& check : checks) {
    if (check.group != group) base::print("{}{}\n", group.empty() ? "" : "\n", check.group);
    group = check.group;
    std::string strategies;
    for (const std::string& strategy : check.strategies)
      strategies += (strategies.empty() ? " [" : ", ") + strategy;
    base::print("  {:<22} {}{}\n", check.name, check.does, strategies.empty() ? "" : strategies + "]");
  }
  return 0;
}

// The verdict is kept for the engine where it is of the driver alone: everything was run, with our shaders.
void keepVerdict(const ValidateOptions& options, const Report& report,
                 const std::vector<StrategyTrust>& trusts) {
  if (!options.only.empty() || !options.skip.empty() || !options.device.shaderDir.empty() ||
      report.outcomes.interrupted)
    return;
  lists::DriverVerdict verdict{report.driver.driver, {}};
  for (const StrategyTrust& trust : trusts) verdict.strategies[trust.strategy] = trust.trust;
  try {
    saveVerdict(verdict);
  } catch (const base::Error& error) {
    base::warn("{}: the engine will not know what was found", error.what());
  }
}

// A folder for the time of the run.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_(fs::temp_directory_path() / fmt::format("sfumato-validate-{}", getpid())) {
    fs::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Runs them all, with the progress on stderr; interrupted at once when the driver's answer already was.
Report runAll(const std::vector<Run>& runs, const RunOptions& options, const char* what) {
  Report report{.options = options};
  const std::optional<DriverAnswer> driver = askDriver(options);
  report.outcomes.interrupted = !driver;
  if (!driver) return report;
  report.driver = *driver;
  const auto start = std::chrono::steady_clock::now();
  base::Progress progress(what, static_cast<long>(runs.size()));
  report.outcomes = runChecks(runs, options, [&] { progress.advance(); });
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report;
}

int exitCode(const Report& report, bool good) {
  if (report.outcomes.interrupted) return interruptedExitCode;
  return static_cast<int>(good ? base::ExitCode::Done : base::ExitCode::CheckFailed);
}

int selfTest(const ValidateOptions& options, const std::vector<Check>& checks) {
  if (!options.device.shaderDir.empty())
    base::fail(base::ExitCode::Usage,
               "--self-test: puts faults into the built-in shaders: leave out --shader-dir");
  const TemporaryFolder folder;
  const Report report = runAll(mutantRuns(checks, folder.path()), runOptions(options), "self-test");
  base::printResult(options.json ? json(report, {}) : selfTestTable(report));
  return exitCode(report, allCaught(report));
}

int runChecks(const ValidateOptions& options, const std::vector<Check>& checks,
              const std::vector<Check>& all) {
  if (!options.junit.empty()) base::checkWritable(options.junit);
  std::vector<Run> runs;
  for (const Check& check : checks) runs.push_back({check, {}, {}});
  const Report report = runAll(runs, runOptions(options), "validating");
  const std::vector<StrategyTrust> trusts = strategyTrusts(report, all);
  if (!options.junit.empty()) base::writeFile(options.junit, junit(report));
  base::printResult(options.json ? json(report, trusts) : options.tap ? tap(report) : table(report, trusts));
  keepVerdict(options, report, trusts);
  return exitCode(report, !breaksTheEngine(report));
}

}  // namespace

int validate(const ValidateOptions& options) {
  if (!options.runCheck.empty()) return runCheckHere(options);
  const std::vector<Check> all = allChecks();
  std::vector<Check> known = all;
  if (!options.only.empty())
    for (Check& check : faultyChecks()) known.push_back(std::move(check));
  const std::vector<Check> checks = select(known, options.only, options.skip);
  if (options.list) return list(checks);
  return options.selfTest ? selfTest(options, checks) : runChecks(options, checks, all);
}

}  // namespace sfumato::app
