#include "deepshadow/shadow_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/box.h"

namespace sfumato::deepshadow {

using glm::dmat4;
using glm::dvec2;
using glm::dvec3;

namespace {

constexpr double marginTexels = 2;
constexpr int leastSmokeShare = 16;  // so that a texel of smoke does not stand for very many of surfaces
constexpr double infinity = std::numeric_limits<double>::infinity();

// A space at `origin` that looks along `forward` (unit) with -Z.
dmat4 lookingAlong(const dvec3& forward, const dvec3& origin) {
  const dvec3 z = -forward;
  const dvec3 helper = std::abs(z.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
  const dvec3 x = glm::normalize(glm::cross(helper, z));
  const dvec3 y = glm::cross(z, x);
  return dmat4(glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0), glm::dvec4(origin, 1));
}

// Half extent of a face whose inner part, all but the margin on each side, is `inner`.
double withMargin(double inner, int side) {
  return inner * side / (side - 2 * marginTexels);
}

FaceProjection perspectiveFace(const dvec3& forward, const dvec3& origin, double tangent, int side) {
  FaceProjection face;
  face.worldFromFace = lookingAlong(forward, origin);
  face.halfExtent = dvec2(withMargin(tangent, side));
  face.side = side;
  return face;
}

}  // namespace

size_t stackedFaces(std::span<const FaceProjection* const> faces) {
  constexpr size_t mostLines = 16384;  // of a texture, everywhere
  const int side = faces.front()->surfaceSide();
  const auto lines = static_cast<size_t>(side);
  const size_t most = std::clamp(windowTexels / (lines * lines), size_t{1}, mostLines / lines);
  size_t count = 1;
  while (count < std::min(most, faces.size()) && faces[count]->surfaceSide() == side) ++count;
  return count;
}

int faceSide(int resolution) {
  return std::max(32, resolution / 16 * 16);
}

int smokeSide(const FaceProjection& face, const dmat4& worldFromUnit, double width, double reach) {
  const double farthest = base::farthestDepth(face.worldFromFace, worldFromUnit);
  const double extent = 2 * std::max(face.halfExtent.x, face.halfExtent.y);
  const double widest = face.orthographic ? extent : extent * std::min(farthest, reach);
  const double texels = std::clamp(std::ceil(widest / width), 1.0, double(face.side));
  return std::max(static_cast<int>(texels), (face.side - 1) / leastSmokeShare + 1);
}

glm::dvec4 smokePart(const FaceProjection& face, std::span<const dmat4> boxes) {
  const int side = face.surfaceSide();
  const dvec2 scale = double(side) / (2.0 * face.halfExtent);
  dvec2 low(infinity);
  dvec2 high(-infinity);
  for (const dmat4& worldFromUnit : boxes) {
    dvec2 boxLow(infinity);
    dvec2 boxHigh(-infinity);
    int before = 0;  // corners
    for (const dvec3& p : base::boxCorners(glm::inverse(face.worldFromFace) * worldFromUnit)) {
      before += -p.z > 0;
      const dvec2 xy = face.orthographic ? dvec2(p) : dvec2(p) / std::max(-p.z, 1e-30);
      boxLow = glm::min(boxLow, xy);
      boxHigh = glm::max(boxHigh, xy);
    }
    if (!face.orthographic && before == 0) continue;
    if (!face.orthographic && before < 8) return {0, 0, side, side};
    low = glm::min(low, boxLow);
    high = glm::max(high, boxHigh);
  }
  const double margin = 1 + static_cast<double>(side) / std::max(face.smokeSide, 1);
  return {low * scale + side / 2.0 - margin, high * scale + side / 2.0 + margin};
}

FaceProjection directionalFace(const dvec3& direction, int side, std::span<const dvec3> receivers,
                               std::span<const dvec3> casters) {
  const dmat4 rotation = lookingAlong(direction, dvec3(0));
  const glm::dmat3 faceFromWorld = glm::transpose(glm::dmat3(rotation));
  dvec2 low(infinity);
  dvec2 high(-infinity);
  for (const dvec3& p : receivers) {
    const dvec2 xy(faceFromWorld * p);
    low = glm::min(low, xy);
    high = glm::max(high, xy);
  }
  double nearest = -infinity;  // largest z: the caster nearest to the light
  for (const dvec3& p : casters) nearest = std::max(nearest, (faceFromWorld * p).z);
  if (receivers.empty() || casters.empty()) {
    low = dvec2(-1);
    high = dvec2(1);
    nearest = 0;
  }
  const dvec2 half = glm::max((high - low) * 0.5, dvec2(1e-6 * (1 + glm::length(high))));
  const dvec3 centre((low + high) * 0.5, nearest + 1e-3 * glm::length(half) + 1e-6);
  FaceProjection face;
  face.worldFromFace = lookingAlong(direction, glm::dmat3(rotation) * centre);
  face.orthographic = true;
  face.halfExtent = {withMargin(half.x, side), withMargin(half.y, side)};
  face.side = side;
  return face;
}

FaceProjection coneFace(const dvec3& position, const dvec3& direction, double angle, int side) {
  return perspectiveFace(direction, position, std::tan(angle), side);
}

std::vector<FaceProjection> cubeFaces(const dvec3& position, int side) {
  std::vector<FaceProjection> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      dvec3 forward(0);
      forward[axis] = sign;
      faces.push_back(perspectiveFace(forward, position, 1.0, side / 2));
    }
  }
  return faces;
}

shared::ShadowFace faceData(const FaceProjection& face, size_t firstTexel) {
  shared::ShadowFace data{};
  data.faceFromWorld = glm::inverse(face.worldFromFace);
  const int side = face.surfaceSide();
  const glm::dvec2 scale = static_cast<double>(side) / (2.0 * face.halfExtent);
  data.projection = glm::vec4(glm::vec2(scale), glm::vec2(side / 2.0));
  data.texels = {static_cast<int>(firstTexel), side, face.orthographic ? 0 : 1, face.smokeSide};
  data.smoke = face.smoke;
  return data;
}

shared::ViewParams faceView(const FaceProjection& face, int side) {
  shared::ViewParams view{};
  view.viewFromWorld = glm::inverse(face.worldFromFace);
  view.worldFromView = face.worldFromFace;
  glm::mat4 clip(0.f);
  clip[0][0] = static_cast<float>(1.0 / face.halfExtent.x);
  clip[1][1] = static_cast<float>(1.0 / face.halfExtent.y);
  if (face.orthographic)
    clip[3][3] = 1.f;
  else
    clip[2][3] = -1.f;
  view.clipFromView = clip;
  view.halfExtent = glm::vec4(glm::vec2(face.halfExtent), face.orthographic ? 1.f : 0.f, 0.f);
  view.depthRange = {0.f, 3e38f, 0.f, 0.f};
  view.size = {side, side, 0, 0};
  return view;
}

}  // namespace sfumato::deepshadow
