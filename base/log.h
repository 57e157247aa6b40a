// Messages for the user, on stderr, one line each: `sfumato: warning: …`.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace sfumato::base {

enum class Verbosity { Quiet, Normal, Verbose };  // Quiet: errors only; Verbose: notes as well

void setVerbosity(Verbosity verbosity);
Verbosity verbosity();

void logError(const std::string& line);
void logWarning(const std::string& line);
void logNote(const std::string& line);  // shown only when verbose

template <typename... Args>
void warn(fmt::format_string<Args...> format, Args&&... args) {
  logWarning(fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args>
void note(fmt::format_string<Args...> format, Args&&... args) {
  logNote(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace sfumato::base
