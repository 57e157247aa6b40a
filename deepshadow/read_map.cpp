#include "deepshadow/read_map.h"

#include <algorithm>
#include <cmath>

namespace sfumato::deepshadow {

using shared::ShadowKnot;

namespace {

using Knots = std::span<const ShadowKnot>;

glm::vec3 tauOf(const ShadowKnot& knot) {
  return {knot.tauR, knot.tauG, knot.tauB};
}

// A function that is walked front to back, and how much it counts.
struct Cursor {
  float weight = 0;
  Knots knots;
  size_t next = 0;

  float nextDepth() const { return next < knots.size() ? knots[next].depth : NOTHING_OPAQUE; }
  void passTo(float depth) {
    while (next < knots.size() && knots[next].depth <= depth) ++next;
  }
  // Somewhere between the last knot that was passed and the next.
  glm::vec3 tau(float depth) const {
    if (next == 0) return glm::vec3(0);
    const ShadowKnot& before = knots[next - 1];
    if (next == knots.size()) return tauOf(before);
    const float along = (depth - before.depth) / (knots[next].depth - before.depth);
    return glm::mix(tauOf(before), tauOf(knots[next]), std::clamp(along, 0.f, 1.f));
  }
};

using Around = std::array<Cursor, 4>;

// The texels of smoke around the middle of a texel of surfaces.
Around smokeAround(const FaceProjection& face, const ReadMap& smoke, size_t texel) {
  Around around;
  if (face.smokeSide == 0) return around;
  const glm::ivec2 place(texel % static_cast<size_t>(face.side), texel / static_cast<size_t>(face.side));
  const glm::vec2 middle =
      (glm::vec2(place) + 0.5f) * (static_cast<float>(face.smokeSide) / static_cast<float>(face.side)) - 0.5f;
  const glm::vec2 corner = glm::floor(middle);
  const glm::vec2 share = middle - corner;
  for (int i = 0; i < 4; ++i) {
    const glm::ivec2 offset(i & 1, i >> 1);
    const glm::vec2 weights = glm::mix(1.f - share, share, glm::vec2(offset));
    const glm::ivec2 at = glm::clamp(glm::ivec2(corner) + offset, 0, face.smokeSide - 1);
    const float weight = weights.x * weights.y;
    if (weight > 0)
      around[static_cast<size_t>(i)] = {weight,
                                        smoke.knotsOf(static_cast<size_t>(at.y * face.smokeSide + at.x))};
  }
  return around;
}

void append(Knots surfaces, Around smoke, std::vector<ShadowKnot>& joined) {
  glm::vec3 surfaceTau(0);
  const auto add = [&](float depth) {
    glm::vec3 tau = surfaceTau;
    for (const Cursor& cursor : smoke) tau += cursor.weight * cursor.tau(depth);
    joined.push_back({depth, tau.r, tau.g, tau.b});
  };
  for (size_t surface = 0;;) {
    float depth = NOTHING_OPAQUE;
    for (const Cursor& cursor : smoke) depth = std::min(depth, cursor.nextDepth());
    if (surface < surfaces.size() && surfaces[surface].depth <= depth) {
      surfaceTau = tauOf(surfaces[surface]);
      add(surfaces[surface].depth);
      ++surface;
    } else if (depth < NOTHING_OPAQUE) {
      for (Cursor& cursor : smoke) cursor.passTo(depth);
      add(depth);
    } else {
      return;
    }
  }
}

}  // namespace

ReadMap decoded(std::span<const shared::ShadowTexel> texels, Knots units, size_t firstUnit) {
  ReadMap result;
  for (const shared::ShadowTexel& texel : texels) {
    const size_t count = texel.count & SHADOW_KNOTS;
    const size_t first = texel.first - firstUnit;
    result.texels.push_back({result.knots.size(), count, texel.opaqueDepth});
    for (size_t i = 0; i < count; ++i) {
      if ((texel.count & SHADOW_GREY) == 0) {
        result.knots.push_back(units[first + i]);
      } else {
        const ShadowKnot& pair = units[first + i / 2];
        const float depth = i % 2 == 0 ? pair.depth : pair.tauG;
        const float tau = i % 2 == 0 ? pair.tauR : pair.tauB;
        result.knots.push_back({depth, tau, tau, tau});
      }
    }
  }
  return result;
}

void appendJoined(const FaceProjection& face, const ReadMap& surfaces, const ReadMap& smoke,
                  ReadMap& joined) {
  for (size_t i = 0; i < surfaces.texels.size(); ++i) {
    const size_t first = joined.knots.size();
    append(surfaces.knotsOf(i), smokeAround(face, smoke, i), joined.knots);
    joined.texels.push_back({first, joined.knots.size() - first, surfaces.texels[i].opaqueDepth});
  }
}

}  // namespace sfumato::deepshadow
