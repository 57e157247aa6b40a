#include <chrono>
#include <csignal>
#include <iterator>
#include <thread>

#include "lists/validation/check.h"

namespace sfumato::lists::validation {

std::vector<Check> faultyChecks() {
  const auto check = [](const char* name, const char* does, std::function<Result(const Context&)> run) {
    return Check{.name = name, .group = "faulty", .does = does, .run = std::move(run)};
  };
  return {
      check("hangs", "never ends",
            [](const Context&) {
              while (true) std::this_thread::sleep_for(std::chrono::seconds(1));
              return Result{};
            }),
      check("crashes", "dies by a signal",
            [](const Context&) {
              std::raise(SIGKILL);
              return Result{};
            }),
      check("leaves", "ends without an answer", [](const Context&) -> Result { std::_Exit(0); }),
  };
}

std::vector<Check> allChecks() {
  std::vector<Check> all;
  const auto add = [&](std::vector<Check> group) {
    std::move(group.begin(), group.end(), std::back_inserter(all));
  };
  add(contextChecks());
  add(atomicsChecks());
  add(listsChecks());
  add(loopsChecks());
  add(engineChecks());
  add(locksChecks());
  add(progressChecks());
  add(memoryModelChecks());
  add(rasterChecks());
  add(memoryChecks());
  add(determinismChecks());
  return all;
}

}  // namespace sfumato::lists::validation
