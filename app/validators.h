// What the values of options must be. A validator's text is what CLI11 puts after the option's name.
#pragma once

#include <CLI/CLI.hpp>
#include <glm/glm.hpp>
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

// Of "1,0.5,0" or of one number for all three; std::nullopt unless each is from 0 to 1e6.
std::optional<glm::dvec3> parseColour(std::string_view text);
CLI::Validator colour();

// Of "8" or "1..4096", both ends from `low` to `high`, the second not below the first.
std::optional<glm::ivec2> parseRange(std::string_view text, int low, int high);
CLI::Validator range(int low, int high);

// "none", "10%" (above 0, up to 10000), or what base::bytesNamed() takes.
CLI::Validator budget();

CLI::Validator oneOf(const std::vector<std::string>& names);
CLI::Validator fileName();  // not empty
CLI::Validator folder();    // exists

}  // namespace sfumato::app
