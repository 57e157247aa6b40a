// Runs checks, each in a process of its own: a driver that hangs, crashes or resets loses one check, not the
// run. The process is this program, started as `sfumato validate --run-check NAME …`; it writes its result
// as one line of JSON.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lists/driver_verdict.h"
#include "lists/validation/check.h"
#include "lists/validation/process.h"

namespace sfumato::lists::validation {

struct RunOptions {
  std::string program = thisProgram();
  std::vector<std::string> deviceArguments;  // --device and --shader-dir, as they were given
  uint64_t seed = 1;
  Scale scale = Scale::Small;
  double timeoutSeconds = 60;  // of one check
  int jobs = 1;                // checks at a time
};

// One check to run, as it is or with a fault put into its shaders.
struct Run {
  Check check;
  std::string mutant;                  // the fault's name, for the report
  std::vector<std::string> arguments;  // that put it there
};

// The command of its process.
Command commandOf(const Run& run, const RunOptions& options);

struct Outcome {
  Run run;
  Result result;
  double seconds = 0;
};

struct Outcomes {
  std::vector<Outcome> all;  // in the order of the runs, whatever ended first
  bool interrupted = false;  // the user ended it: only what was done until then is here
};

// `onEnd` is called after each, for the progress.
Outcomes runChecks(
    const std::vector<Run>& runs, const RunOptions& options, const std::function<void()>& onEnd = [] {});

// The driver that the checks will run on.
struct DriverAnswer {
  Driver driver;
  std::string platform;  // how EGL reached it
  bool software = false;
};
// Asks for it in a process of its own as well; nothing when the user interrupts. Throws NoGl when there is no
// driver, in the words of that process.
std::optional<DriverAnswer> askDriver(const RunOptions& options);

// What passes between the two processes.
inline constexpr const char* driverQuestion = "driver";  // in place of a check's name
std::string line(const DriverAnswer& answer);
std::string line(const Result& result);
// The verdict on a process: its own, or Hang or Crash.
Result resultOf(const Ended& ended, double timeoutSeconds);

}  // namespace sfumato::lists::validation
