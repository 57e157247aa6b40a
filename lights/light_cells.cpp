#include "lights/light_cells.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "lights/light_reach.h"
#include "lights/light_scissor.h"

namespace sfumato::lights {

using glm::dvec2;
using glm::dvec3;

namespace {

constexpr int mostTried = 24;  // cells along a side

// What a light fills in view space: a ball, or of a narrow spot the part of it within a cone.
class LightVolume {
 public:
  LightVolume(const Light& light, const shared::ViewParams& camera) : camera_(camera) {
    centre_ = dvec3(glm::dmat4(camera.viewFromWorld) * glm::dvec4(light.position, 1.0));
    // As far as a ray through a cell can be off the ray through its centre (shaders/lights/proxy.glsl).
    const double reach = lights::reach(light);
    const dvec2 pixel = 2.0 * dvec2(camera.halfExtent) / dvec2(camera.size);
    const double off =
        0.5 * cellSide * glm::length(pixel) * (orthographic() ? 1.0 : std::max(reach - centre_.z, 0.0));
    radius_ = reach + off;
    if (light.type != LightType::Spot || light.outerCone >= widestCone) return;
    cosine_ = std::cos(light.outerCone);
    axis_ = glm::dmat3(camera.viewFromWorld) * light.direction;
    apex_ = centre_ - axis_ * (off / std::max(std::sin(light.outerCone), 1e-4));
  }

  // Where the ball is seen along an axis of the image.
  Extent extent(int axis) const { return extentOf({centre_, radius_}, axis, orthographic()); }

  // Whether a ray meets the volume between the camera's near and far depth.
  bool meets(const dvec2& plane) const {
    const dvec3 start = orthographic() ? dvec3(plane, 0) : dvec3(0);
    const dvec3 perDepth = orthographic() ? dvec3(0, 0, -1) : dvec3(plane, -1);
    const double length = glm::length(perDepth);
    const double middle = glm::dot(centre_ - start, perDepth) / (length * length);
    const double inside = radius_ * radius_ -
                          glm::dot(start + middle * perDepth - centre_, start + middle * perDepth - centre_);
    if (inside < 0) return false;
    const double half = std::sqrt(inside) / length;
    const Extent within = {std::max<double>(middle - half, camera_.depthRange.x),
                           std::min<double>(middle + half, camera_.depthRange.y)};
    return within.low <= within.high && (cosine_ < 0 || meetsCone(start, perDepth, within));
  }

 private:
  static constexpr double widestCone = 1.0471975511965976;  // wider spots are balls

  bool orthographic() const { return camera_.halfExtent.z != 0.f; }

  // How far a point is inside the cone, x . axis - |x| cosine, has one maximum along a ray.
  bool meetsCone(const dvec3& start, const dvec3& perDepth, const Extent& within) const {
    const double length = glm::length(perDepth);
    const dvec3 from = start - apex_;
    const double nearest = -glm::dot(from, perDepth) / (length * length);  // depth
    const double distance = glm::length(from + nearest * perDepth);
    const double slope = glm::dot(perDepth, axis_) / length;
    const double best =
        std::abs(slope) < cosine_
            ? nearest + slope * distance / (std::sqrt(cosine_ * cosine_ - slope * slope) * length)
            : (slope > 0 ? within.high : within.low);
    const dvec3 p = from + std::clamp(best, within.low, within.high) * perDepth;
    return glm::dot(p, axis_) >= cosine_ * glm::length(p);
  }

  const shared::ViewParams& camera_;
  dvec3 centre_{0};
  double radius_ = 0;
  double cosine_ = -1;  // of the cone's half angle; below 0: none
  dvec3 axis_{0};
  dvec3 apex_{0};
};

// Cells, from the first on, of `all` along an axis.
struct CellRange {
  int first = 0;
  int count = 0;
};

// Those within an extent; cells are as wide at the image's edge as anywhere.
CellRange cellsWithin(const Extent& extent, double halfExtent, int pixels) {
  const auto cellOf = [&](double place) {
    const double cell = std::floor((place / halfExtent + 1.0) * 0.5 * pixels / cellSide);
    return static_cast<int>(std::clamp(cell, -1.0, static_cast<double>(cellsAlong(pixels))));
  };
  const int first = std::max(cellOf(extent.low), 0);
  const int last = std::min(cellOf(extent.high), cellsAlong(pixels) - 1);
  return {first, std::max(last - first + 1, 0)};
}

}  // namespace

double cellsReached(const Light& light, const shared::ViewParams& camera) {
  const LightVolume volume(light, camera);
  CellRange ranges[2];
  for (int axis = 0; axis < 2; ++axis)
    ranges[axis] = cellsWithin(volume.extent(axis), camera.halfExtent[axis], camera.size[axis]);
  const glm::ivec2 tried(std::min(ranges[0].count, mostTried), std::min(ranges[1].count, mostTried));
  int met = 0;
  for (int y = 0; y < tried.y; ++y) {
    for (int x = 0; x < tried.x; ++x) {
      // The middle one of each group of cells.
      const glm::ivec2 cell(ranges[0].first + (2 * x + 1) * ranges[0].count / (2 * tried.x),
                            ranges[1].first + (2 * y + 1) * ranges[1].count / (2 * tried.y));
      const dvec2 pixel = (dvec2(cell) + 0.5) * static_cast<double>(cellSide);
      met += volume.meets((pixel / dvec2(camera.size) * 2.0 - 1.0) * dvec2(camera.halfExtent)) ? 1 : 0;
    }
  }
  if (met == 0) return 0;
  return static_cast<double>(met) * ranges[0].count * ranges[1].count / (tried.x * tried.y);
}

}  // namespace sfumato::lights
