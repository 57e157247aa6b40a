#include "lights/light_scissor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lights/light_reach.h"

namespace sfumato::lights {

using glm::dvec3;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// The ball in view space, larger by what the floats of the camera's matrix may be off.
Ball seenFrom(const shared::ViewParams& camera, const Ball& ball) {
  constexpr double rounding = 1e-6;
  const glm::dmat4 viewFromWorld(camera.viewFromWorld);
  return {dvec3(viewFromWorld * glm::dvec4(ball.centre, 1)),
          ball.radius + rounding * (ball.radius + glm::length(ball.centre) + glm::length(viewFromWorld[3]))};
}

// The pixels along an axis that an extent touches: the first, and the one behind the last.
glm::ivec2 pixelsWithin(const Extent& extent, double halfExtent, int pixels) {
  const auto pixelOf = [&](double place) {
    return std::clamp((place / halfExtent + 1) * 0.5 * pixels, 0.0, static_cast<double>(pixels));
  };
  return {static_cast<int>(std::floor(pixelOf(extent.low))),
          static_cast<int>(std::ceil(pixelOf(extent.high)))};
}

}  // namespace

Ball ballAround(const Light& light) {
  const double reach = lights::reach(light);
  if (light.type != LightType::Spot) return {light.position, reach};
  const double cosine = std::cos(light.outerCone);
  const double sine = std::sin(light.outerCone);
  // Wide cones touch it with their rim, narrow ones with their tip as well.
  if (cosine < sine) return {light.position + reach * cosine * light.direction, reach * sine};
  const double radius = reach / (2 * cosine);
  return {light.position + radius * light.direction, radius};
}

Extent extentOf(const Ball& inView, int axis, bool orthographic) {
  const double beside = inView.centre[axis];
  if (orthographic) return {beside - inView.radius, beside + inView.radius};
  const double distance = std::hypot(beside, inView.centre.z);
  if (distance <= inView.radius) return {-infinity, infinity};
  const double middle = std::atan2(beside, -inView.centre.z);
  const double spread = std::asin(inView.radius / distance);
  constexpr double ahead = 1.5707;  // a little less than a right angle
  if (middle - spread > ahead || middle + spread < -ahead) return {infinity, -infinity};
  return {middle - spread < -ahead ? -infinity : std::tan(middle - spread),
          middle + spread > ahead ? infinity : std::tan(middle + spread)};
}

std::optional<glm::ivec4> lightScissor(const Light& light, const shared::ViewParams& camera) {
  if (light.type == LightType::Directional) return glm::ivec4(0, 0, camera.size.x, camera.size.y);
  const Ball ball = seenFrom(camera, ballAround(light));
  const double depth = -ball.centre.z;
  if (depth + ball.radius < camera.depthRange.x || depth - ball.radius > camera.depthRange.y) return {};
  glm::ivec4 rectangle;
  for (int axis = 0; axis < 2; ++axis) {
    const glm::ivec2 pixels = pixelsWithin(extentOf(ball, axis, camera.halfExtent.z != 0.f),
                                           camera.halfExtent[axis], camera.size[axis]);
    if (pixels.x >= pixels.y) return {};
    rectangle[axis] = pixels.x;
    rectangle[axis + 2] = pixels.y - pixels.x;
  }
  return rectangle;
}

}  // namespace sfumato::lights
