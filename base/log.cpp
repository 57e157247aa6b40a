#include "base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace sfumato::base {
namespace {

spdlog::logger& logger() {
  static const auto instance = [] {
    auto created =
        std::make_shared<spdlog::logger>("sfumato", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    created->set_pattern("sfumato: %^%l%$: %v");
    return created;
  }();
  return *instance;
}

}  // namespace

void setVerbosity(Verbosity verbosity) {
  constexpr spdlog::level::level_enum levels[] = {spdlog::level::err, spdlog::level::warn,
                                                  spdlog::level::info};
  logger().set_level(levels[static_cast<int>(verbosity)]);
}

Verbosity verbosity() {
  if (logger().level() >= spdlog::level::err) return Verbosity::Quiet;
  return logger().level() == spdlog::level::warn ? Verbosity::Normal : Verbosity::Verbose;
}

void logError(const std::string& line) {
  logger().error(line);
}
void logWarning(const std::string& line) {
  logger().warn(line);
}
void logNote(const std::string& line) {
  logger().info(line);
}

}  // namespace sfumato::base
