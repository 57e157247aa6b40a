// What the checks found, for people and for other programs.
#pragma once

#include <string>
#include <vector>

#include "lists/driver_verdict.h"
#include "lists/validation/runner.h"

namespace sfumato::lists::validation {

struct Report {
  DriverAnswer driver;
  RunOptions options;
  Outcomes outcomes;
  double seconds = 0;  // of all checks together
};

// Whether the engine depends on the check and it was FAIL, HANG or CRASH.
bool breaksTheEngine(const Outcome& outcome);
bool breaksTheEngine(const Report& report);

// Whether lists may be built so on this driver, and which checks said otherwise.
struct StrategyTrust {
  std::string strategy;
  Trust trust = Trust::Safe;
  std::string because;  // "list-cas FAIL, …"; empty when safe
};
// Of every strategy of the engine; `checks` are all that there are, run or not.
std::vector<StrategyTrust> strategyTrusts(const Report& report, const std::vector<Check>& checks);

// The columns verdict, check, seconds and finding; a second line for what a finding means; the last line says
// which strategies are safe.
std::string table(const Report& report, const std::vector<StrategyTrust>& trusts);
std::string json(const Report& report, const std::vector<StrategyTrust>& trusts);
// JUnit XML: <failure> and <error> only where the engine depends on the check; elsewhere <skipped>.
std::string junit(const Report& report);
// TAP 13: what the engine does not depend on is `# TODO`, which harnesses do not count.
std::string tap(const Report& report);

}  // namespace sfumato::lists::validation
