// Keyframes of an animated value, interpolated as glTF 2.0 (appendix C) has it.
#pragma once

#include <cstddef>
#include <vector>

namespace sfumato::scene {

enum class Interpolation { Step, Linear, CubicSpline };

struct Keyframes {
  Interpolation interpolation = Interpolation::Linear;
  bool rotation = false;     // values are quaternions x, y, z, w, and turn at constant speed when Linear
  size_t width = 1;          // numbers of a value
  std::vector<float> times;  // seconds, ascending, at least one
  std::vector<float>
      values;  // a value for each time; CubicSpline: in-tangent, value and out-tangent for each
};

// The value at a time in seconds, which is that of the first key before it and of the last one after it. A
// rotation need not come out at unit length.
std::vector<double> valueAt(const Keyframes& keyframes, double seconds);

}  // namespace sfumato::scene
