// What the user reads: messages on stderr, one line each (`sfumato: warning: …`), and results on stdout.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace sfumato::base {

enum class Verbosity { Quiet, Normal, Verbose };  // Quiet: errors only; Verbose: notes as well

void setVerbosity(Verbosity verbosity);
Verbosity verbosity();

// Control characters, which names of files may have, are shown as `?`, so that a line stays one.
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

void printResult(const std::string& text);
// Throws Input unless all results reached stdout.
void flushResults();

template <typename... Args>
void print(fmt::format_string<Args...> format, Args&&... args) {
  printResult(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace sfumato::base
