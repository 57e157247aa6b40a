// Deep shadow maps on the CPU: what a light's texels and units of the pool say (shaders/shared/deepshadow.h).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "deepshadow/shadow_faces.h"
#include "shaders/shared/deepshadow.h"

namespace sfumato::deepshadow {

// Functions of texels: transmittance is 0 behind the opaque depth; before it, exp(-tau), with tau linear
// between knots (0 before the first, the last one's behind it).
struct ReadMap {
  struct Texel {
    size_t firstKnot;
    size_t knots;
    float opaqueDepth;  // NOTHING_OPAQUE of shaders/shared/deepshadow.h: there is nothing
  };
  std::vector<Texel> texels;  // face after face, rows from the bottom
  std::vector<shared::ShadowKnot> knots;

  std::span<const shared::ShadowKnot> knotsOf(size_t texel) const {
    return std::span(knots).subspan(texels[texel].firstKnot, texels[texel].knots);
  }
};

// What the knots are of. The step of a surface is stored as one; here it is two of one depth.
enum class Knotted { Surfaces, Smoke };

// The functions of texels as they are stored; `units` are the pool's from number `firstUnit` on.
ReadMap decoded(std::span<const shared::ShadowTexel> texels, std::span<const glm::uvec4> units,
                size_t firstUnit, Knotted what);

// Appends a face whose texels have surfaces, and smoke of texels of its own, interpolated bilinearly in their
// middle: at each knot of one of them there is one.
void appendJoined(const FaceProjection& face, const ReadMap& surfaces, const ReadMap& smoke, ReadMap& joined);

}  // namespace sfumato::deepshadow
