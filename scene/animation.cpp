#include "scene/animation.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace sfumato::scene {
namespace {

glm::dquat unitQuaternion(const float* v) {
  const glm::dquat q(v[3], v[0], v[1], v[2]);
  const double length = glm::length(q);
  return length > 0 ? q / length : q;
}

std::vector<double> turned(const float* from, const float* to, double s) {
  const glm::dquat q = glm::slerp(unitQuaternion(from), unitQuaternion(to), s);
  return {q.x, q.y, q.z, q.w};
}

}  // namespace

std::vector<double> valueAt(const Keyframes& k, double seconds) {
  const bool cubic = k.interpolation == Interpolation::CubicSpline;
  const size_t stride = cubic ? 3 * k.width : k.width;
  const auto value = [&](size_t key) { return k.values.data() + key * stride + (cubic ? k.width : 0); };

  const auto after = std::upper_bound(k.times.begin(), k.times.end(), seconds);
  const auto next = static_cast<size_t>(after - k.times.begin());
  const size_t last = next == 0 ? 0 : next - 1;
  if (next == 0 || next == k.times.size() || k.interpolation == Interpolation::Step)
    return {value(last), value(last) + k.width};

  const double duration = double(k.times[next]) - double(k.times[last]);
  const double s = (seconds - k.times[last]) / duration;
  if (k.rotation && !cubic) return turned(value(last), value(next), s);

  // Hermite's cubic; tangents are per second.
  const float* outTangent = value(last) + k.width;
  const float* inTangent = value(next) - k.width;
  std::vector<double> result(k.width);
  for (size_t i = 0; i < k.width; ++i) {
    const double a = value(last)[i], b = value(next)[i];
    result[i] = a + (b - a) * s;
    if (cubic)
      result[i] = a + (b - a) * s * s * (3 - 2 * s) +
                  duration * s * (1 - s) * (outTangent[i] * (1 - s) - inTangent[i] * s);
  }
  return result;
}

}  // namespace sfumato::scene
