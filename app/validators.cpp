#include "app/validators.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "base/error.h"
#include "base/size_text.h"
#include "lists/strategy.h"

namespace sfumato::app {
namespace {

// The number that the whole text is.
template <typename T>
std::optional<T> parse(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

template <typename T>
CLI::Validator inRange(const char* kind, T low, T high) {
  const auto check = [=](const std::string& text) -> std::string {
    const std::optional<T> value = parse<T>(text);
    if (value && *value >= low && *value <= high) return {};
    return fmt::format("\"{}\" is not a {} from {} to {}", text, kind, low, high);
  };
  return CLI::Validator(check, "");
}

}  // namespace

CLI::Validator between(double low, double high) {
  return inRange("number", low, high);
}

CLI::Validator wholeBetween(int low, int high) {
  return inRange("whole number", low, high);
}

CLI::Validator coordinate() {
  return between(-1e9, 1e9);
}

std::optional<Resolution> parseResolution(std::string_view text) {
  const size_t cross = text.find('x');
  if (cross == std::string_view::npos) return std::nullopt;
  const auto width = parse<int>(text.substr(0, cross));
  const auto height = parse<int>(text.substr(cross + 1));
  const auto fits = [](std::optional<int> side) { return side && *side >= 1 && *side <= 16384; };
  if (!fits(width) || !fits(height)) return std::nullopt;
  return Resolution{*width, *height};
}

CLI::Validator resolution() {
  const auto check = [](const std::string& text) -> std::string {
    if (parseResolution(text)) return {};
    return fmt::format("\"{}\" is not WIDTHxHEIGHT with 1 to 16384 pixels a side, e.g. 1280x720", text);
  };
  return CLI::Validator(check, "");
}

std::optional<glm::dvec3> parseColour(std::string_view text) {
  std::vector<double> parts;
  for (bool more = true; more;) {
    const size_t comma = text.find(',');
    const auto value = parse<double>(text.substr(0, comma));
    if (!value || !(*value >= 0 && *value <= 1e6)) return std::nullopt;
    parts.push_back(*value);
    more = comma != std::string_view::npos;
    if (more) text.remove_prefix(comma + 1);
  }
  if (parts.size() == 1) return glm::dvec3(parts[0]);
  if (parts.size() != 3) return std::nullopt;
  return glm::dvec3(parts[0], parts[1], parts[2]);
}

CLI::Validator colour() {
  const auto check = [](const std::string& text) -> std::string {
    if (parseColour(text)) return {};
    return fmt::format("\"{}\" is not a colour R,G,B, or one number for all, from 0 to 1e6 each", text);
  };
  return CLI::Validator(check, "");
}

std::optional<glm::ivec2> parseRange(std::string_view text, int low, int high) {
  const size_t dots = text.find("..");
  const auto first = parse<int>(text.substr(0, dots));
  const auto last = dots == std::string_view::npos ? first : parse<int>(text.substr(dots + 2));
  if (!first || !last || *first < low || *last > high || *first > *last) return std::nullopt;
  return glm::ivec2(*first, *last);
}

CLI::Validator range(int low, int high) {
  const auto check = [=](const std::string& text) -> std::string {
    if (parseRange(text, low, high)) return {};
    return fmt::format("\"{}\" is not a range FROM..TO of whole numbers from {} to {}", text, low, high);
  };
  return CLI::Validator(check, "");
}

CLI::Validator budget() {
  const auto check = [](const std::string& text) -> std::string {
    if (text == "none") return {};
    if (text.ends_with('%')) {
      const auto percent = parse<double>(text.substr(0, text.size() - 1));
      if (percent && *percent > 0 && *percent <= 10000) return {};
    } else {
      try {
        if (base::bytesNamed(text, "") > 0) return {};
      } catch (const base::Error&) {  // told below
      }
    }
    return fmt::format("\"{}\" is no budget: write none, 256M, or 10% of what the nodes take", text);
  };
  return CLI::Validator(check, "");
}

CLI::Validator oneOf(const std::vector<std::string>& names) {
  const auto check = [names](const std::string& text) -> std::string {
    if (std::find(names.begin(), names.end(), text) != names.end()) return {};
    return fmt::format("\"{}\" is none of {}", text, fmt::join(names, ", "));
  };
  return CLI::Validator(check, "");
}

CLI::Validator fileName() {
  return CLI::Validator([](const std::string& text) { return text.empty() ? "\"\" is no file" : ""; }, "");
}

CLI::Validator folder() {
  const auto check = [](const std::string& text) -> std::string {
    std::error_code ignored;
    if (std::filesystem::is_directory(text, ignored)) return {};
    return fmt::format("\"{}\" is not a folder", text);
  };
  return CLI::Validator(check, "");
}

}  // namespace sfumato::app
