#include "lists/driver_verdict.h"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/version.h"

namespace sfumato::lists {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

// FNV-1a, 64 bits.
uint64_t hash(std::string_view text) {
  uint64_t value = 0xcbf29ce484222325ull;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return value;
}

fs::path cacheFolder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && fs::path(cache).is_absolute()) return fs::path(cache) / "sfumato";
  const char* home = std::getenv("HOME");
  return home == nullptr || *home == '\0' ? fs::path() : fs::path(home) / ".cache" / "sfumato";
}

std::optional<Trust> trustOf(std::string_view text) {
  for (const Trust trust : {Trust::Safe, Trust::Unsafe, Trust::NotShown})
    if (name(trust) == text) return trust;
  return std::nullopt;
}

}  // namespace

std::string_view name(Trust trust) {
  constexpr std::string_view names[] = {"safe", "unsafe", "no fault seen"};
  return names[static_cast<size_t>(trust)];
}

bool DriverVerdict::trusted(std::string_view strategy) const {
  const auto found = strategies.find(strategy);
  return found == strategies.end() || found->second != Trust::Unsafe;
}

fs::path verdictFile(const Driver& driver) {
  const fs::path folder = cacheFolder();
  if (folder.empty()) return {};
  return folder / fmt::format("driver-{:016x}.json",
                              hash(driver.vendor + '\n' + driver.renderer + '\n' + driver.version));
}

std::optional<DriverVerdict> loadVerdict(const Driver& driver) {
  const fs::path file = verdictFile(driver);
  std::error_code ignored;
  if (file.empty() || !fs::is_regular_file(file, ignored)) return std::nullopt;
  try {
    const auto bytes = base::readFile(file);
    const json text = json::parse(reinterpret_cast<const char*>(bytes.data()),
                                  reinterpret_cast<const char*>(bytes.data() + bytes.size()));
    DriverVerdict verdict{{text.at("vendor"), text.at("renderer"), text.at("version")}, {}};
    if (verdict.driver != driver || text.at("program") != base::version()) return std::nullopt;
    for (const auto& [strategy, trust] : text.at("strategies").items())
      verdict.strategies[strategy] = trustOf(trust.get<std::string>()).value();
    return verdict;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

void saveVerdict(const DriverVerdict& verdict) {
  const fs::path file = verdictFile(verdict.driver);
  if (file.empty()) return;
  json strategies = json::object();
  for (const auto& [strategy, trust] : verdict.strategies) strategies[strategy] = name(trust);
  const json text = {{"program", base::version()},
                     {"vendor", verdict.driver.vendor},
                     {"renderer", verdict.driver.renderer},
                     {"version", verdict.driver.version},
                     {"strategies", strategies}};
  std::error_code problem;
  fs::create_directories(file.parent_path(), problem);
  if (problem)
    base::fail(base::ExitCode::Input, "{}: cannot be made: {}", file.parent_path().string(),
               problem.message());
  base::writeFile(file, base::jsonText(text));
}

}  // namespace sfumato::lists
