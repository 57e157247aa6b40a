// What the values of options must be. A validator's text is what CLI11 puts after the option's name.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sfumato::app {

// Numbers from `low` to `high`, both included, without NaN, which CLI11's own Range lets pass.
CLI::Validator between(double low, double high);
CLI::Validator wholeBetween(int low, int high);

// Of points in the world, metres: wider than any scene, and its squares are still floats.
CLI::Validator coordinate();

struct Resolution {
  int width = 0;
  int height = 0;
};

// Of "640x480"; std::nullopt unless both sides are 1 to 16384.
std::optional<Resolution> parseResolution(std::string_view text);
CLI::Validator resolution();

CLI::Validator oneOf(const std::vector<std::string>& names);
CLI::Validator fileName();  // not empty
CLI::Validator folder();    // exists

}  // namespace sfumato::app
