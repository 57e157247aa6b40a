// One check of the driver validation: what it is called, what it does, and what it found. A check runs alone
// in a process of its own, on a device of its own, under a time limit (lists/validation/runner.h).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace sfumato::gl {
class Device;
}

namespace sfumato::lists::validation {

enum class Verdict {
  Pass,
  Fail,     // the driver did wrong
  Hang,     // the time limit ended it
  Crash,    // its process died, or the context was reset
  Skip,     // something that it needs is absent; the finding names it
  NoPower,  // its control shows that the bad outcome could not have been seen here
};

// As it is shown: "PASS", "FAIL", "HANG", "CRASH", "SKIP", "NO POWER".
std::string_view name(Verdict verdict);

enum class Scale { Small, Full };

// What is measured beside the verdict: name and value, in the order in which people should read them.
using Figure = std::pair<std::string, std::variant<int64_t, double, std::string>>;

struct Result {
  Verdict verdict = Verdict::Pass;
  std::string finding;  // one line: what was seen; may be empty on Pass
  std::string meaning;  // one line: what it means for list code on this driver; empty on Pass
  std::vector<Figure> figures;
};

struct Context {
  gl::Device& device;
  uint64_t seed = 1;
  Scale scale = Scale::Small;
  std::string mutant;  // one of Check::mutants, or empty: the check's own shaders as they are
  // The command that runs this check alone once more, in a process of its own; empty where there is none.
  std::vector<std::string> again;
};

struct Check {
  std::string name;   // as in `--only`, lower case with dashes
  std::string group;  // one of the functions below, with dashes
  std::string does;   // one line
  // What the engine builds lists with that cannot be trusted when this check fails: "spinlock", "lockfree",
  // "append", "count"; all four: the engine depends on it; none: information only.
  std::vector<std::string> strategies;
  // Faults of ours that can be put into its shaders; with any of them the check must not pass. Each is a
  // define that the shaders know: MUTANT_<NAME>.
  std::vector<std::string> mutants;
  std::function<Result(const Context&)> run;
};

// One file a group; allChecks() has them in the order of the table in docs/validate.md.
std::vector<Check> contextChecks();
std::vector<Check> atomicsChecks();
std::vector<Check> listsChecks();
std::vector<Check> loopsChecks();
std::vector<Check> engineChecks();
std::vector<Check> locksChecks();
std::vector<Check> progressChecks();
std::vector<Check> memoryModelChecks();
std::vector<Check> rasterChecks();
std::vector<Check> memoryChecks();
std::vector<Check> determinismChecks();

// These end their process as a bad driver would, to test what runs the checks. Only a name asks for them.
std::vector<Check> faultyChecks();

std::vector<Check> allChecks();

// The checks whose names or groups are in `only` (all when it is empty) and not in `skip`, in their order.
// Throws Usage, with the names that are near, for one that there is not.
std::vector<Check> select(const std::vector<Check>& checks, const std::vector<std::string>& only,
                          const std::vector<std::string>& skip);

}  // namespace sfumato::lists::validation
