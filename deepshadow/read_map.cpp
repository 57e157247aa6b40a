#include "deepshadow/read_map.h"

#include <algorithm>
#include <bit>
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

bool isGrey(const shared::ShadowTexel& texel) {
  return (texel.count & SHADOW_GREY) != 0;
}

ShadowKnot longKnot(const shared::ShadowTexel& texel, std::span<const glm::uvec4> units, size_t number) {
  if (!isGrey(texel)) return std::bit_cast<ShadowKnot>(units[number]);
  const auto pair = std::bit_cast<glm::vec4>(units[number / 2]);
  const glm::vec2 knot = number % 2 == 0 ? glm::vec2(pair.x, pair.y) : glm::vec2(pair.z, pair.w);
  return {knot.x, knot.y, knot.y, knot.y};
}

// As shaders/deepshadow/smoke_knot.glsl has it.
ShadowKnot shortKnot(const shared::ShadowTexel& texel, std::span<const glm::uvec4> units, size_t number) {
  const auto word = [&](size_t i) { return units[i / 4][static_cast<int>(i % 4)]; };
  const auto tau = [](uint32_t bits) {
    const auto root = static_cast<float>(static_cast<double>(bits & SHADOW_TAU_MASK) / SHADOW_SHORT_TAUS);
    return root * root * static_cast<float>(SHADOW_SHORT_TAU);
  };
  const uint32_t first = word(isGrey(texel) ? number : 2 * number);
  const uint32_t startBits = texel.count >> SHADOW_START_BIT & SHADOW_START_MASK;
  const double start = texel.opaqueDepth * (startBits / SHADOW_STARTS);
  const double steps = first >> SHADOW_TAU_BITS;
  const auto depth = static_cast<float>(start + steps * ((texel.opaqueDepth - start) / SHADOW_SHORT_DEPTHS));
  if (isGrey(texel)) return {depth, tau(first), tau(first), tau(first)};
  const uint32_t second = word(2 * number + 1);
  return {depth, tau(first), tau(second >> SHADOW_TAU_BITS), tau(second)};
}

}  // namespace

ReadMap decoded(std::span<const shared::ShadowTexel> texels, std::span<const glm::uvec4> units,
                size_t firstUnit, Knotted what) {
  ReadMap result;
  for (const shared::ShadowTexel& texel : texels) {
    const bool isShort = (texel.count & SHADOW_SHORT) != 0;
    const size_t count = texel.count & (isShort ? SHADOW_SHORT_KNOTS : SHADOW_KNOTS);
    const auto stored = count > 0 ? units.subspan(texel.first - firstUnit) : std::span<const glm::uvec4>();
    const size_t first = result.knots.size();
    ShadowKnot before{};
    for (size_t i = 0; i < count; ++i) {
      const ShadowKnot knot = isShort ? shortKnot(texel, stored, i) : longKnot(texel, stored, i);
      if (what == Knotted::Surfaces)
        result.knots.push_back({knot.depth, before.tauR, before.tauG, before.tauB});
      result.knots.push_back(knot);
      before = knot;
    }
    result.texels.push_back({first, result.knots.size() - first, texel.opaqueDepth});
  }
  return result;
}

void appendJoined(const FaceProjection& face, const ReadMap& surfaces, const ReadMap& smoke,
                  ReadMap& joined) {
  for (size_t i = 0; i < face.texels(); ++i) {
    const size_t first = joined.knots.size();
    const size_t own = face.casters ? i : 0;
    append(surfaces.knotsOf(own), smokeAround(face, smoke, i), joined.knots);
    joined.texels.push_back({first, joined.knots.size() - first, surfaces.texels[own].opaqueDepth});
  }
}

}  // namespace sfumato::deepshadow
