#include "base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>

#include "base/error.h"

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

std::string oneLine(std::string text) {
  const auto isControl = [](unsigned char c) { return c < ' ' || c == 127; };
  std::replace_if(text.begin(), text.end(), isControl, '?');
  return text;
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
  logger().error(oneLine(line));
}
void logWarning(const std::string& line) {
  logger().warn(oneLine(line));
}
void logNote(const std::string& line) {
  logger().info(oneLine(line));
}

void printResult(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
}

void flushResults() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    fail(ExitCode::Input, "standard output: cannot be written: see whether it is closed or its disk full");
}

}  // namespace sfumato::base
