// Deep images in memory: every pixel holds what lies along its depth, so that it can be composited there.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace sfumato::image {

// A surface, or a stretch of smoke in which the light behind falls exponentially (OpenEXR: "Interpreting
// OpenEXR Deep Pixels"): its part of a fraction f takes 1 - (1 - alpha)^f, and adds colour in the same
// proportion.
struct DeepSample {
  float z = 0;                    // where it begins: metres along the view's axis
  float zBack = 0;                // where it ends; z for a surface
  std::array<float, 3> colour{};  // R, G, B: radiance that it adds, not yet dimmed by the alphas before it
  float alpha = 0;                // of the light behind, what it takes: in [0, 1], of R, G and B together
  std::array<float, 3> takes{};   // the same of each; all are `alpha` where nothing is coloured
  bool operator==(const DeepSample&) const = default;
};

// Row-major, for points as rows (p * M), as OpenEXR has them.
using Matrix = std::array<float, 16>;

// What a deep image is looked at from.
struct DeepView {
  Matrix worldToCamera{};  // +z is the depth
  Matrix worldToNdc{};     // x, y: (0, 0) at the upper left corner, (1, 1) at the lower right one
};

struct DeepImage {
  std::string name;  // of the part of a file that has several
  int width = 0;
  int height = 0;
  // Rows from the top; samples ascend by depth and do not overlap.
  std::vector<std::vector<DeepSample>> pixels;
  DeepView view;

  DeepImage() = default;
  DeepImage(int width, int height)
      : width(width), height(height), pixels(static_cast<size_t>(width) * static_cast<size_t>(height)) {}

  std::vector<DeepSample>& pixel(int x, int y) { return pixels[index(x, y)]; }
  const std::vector<DeepSample>& pixel(int x, int y) const { return pixels[index(x, y)]; }

 private:
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
};

}  // namespace sfumato::image
