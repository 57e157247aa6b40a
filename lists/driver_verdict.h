// What `sfumato validate` found out about a driver, kept for later runs of the engine.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace sfumato::lists {

// The driver's own words; another version of it is another driver.
struct Driver {
  std::string vendor;
  std::string renderer;
  std::string version;
  bool operator==(const Driver&) const = default;
};

enum class Trust {
  Safe,      // every check that the strategy depends on has passed
  Unsafe,    // one of them has not
  NotShown,  // nothing speaks against it, but some could not be run, or could not have seen a fault
};

// As it is shown: "safe", "unsafe", "no fault seen".
std::string_view name(Trust trust);

struct DriverVerdict {
  Driver driver;
  std::map<std::string, Trust, std::less<>> strategies;  // "spinlock", "lockfree", "append", "count"

  // False only where the validation has shown that lists built so are wrong on this driver.
  bool trusted(std::string_view strategy) const;
};

// Where the verdict on a driver is kept: $XDG_CACHE_HOME/sfumato, or ~/.cache/sfumato; empty without either.
std::filesystem::path verdictFile(const Driver& driver);

// Nothing when the driver was not validated by this version of the program, or the file cannot be understood.
std::optional<DriverVerdict> loadVerdict(const Driver& driver);
// Throws Input when the file cannot be written; does nothing when there is no place for it.
void saveVerdict(const DriverVerdict& verdict);

}  // namespace sfumato::lists
