// Meshes in another shape than the file stores: morph targets and skins, as glTF 2.0 (section 3.7) has them.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "scene/scene.h"

namespace sfumato::scene {

// What the morph targets add to a vertex, their weights in it.
struct MorphOffset {
  glm::dvec3 position{0.0};
  glm::dvec3 normal{0.0};
  glm::dvec3 tangent{0.0};
};

// Adds an offset to each vertex. Normals and tangents come out unit length, or zero.
void morph(Mesh& mesh, std::span<const MorphOffset> offsets);

// The joints that a vertex follows; weights are 0 or more and sum up to 1.
struct Influences {
  std::array<uint32_t, 8> joints{};
  std::array<float, 8> weights{};
};

// Takes each vertex by the weighted mean of its joints' matrices, which are affine, to the world. Normals and
// tangents come out unit length, or zero. Where most matrices mirror, triangles are wound the other way, so
// that front faces stay counter-clockwise.
void skin(Mesh& mesh, std::span<const Influences> influences, std::span<const glm::dmat4> worldFromRest);

}  // namespace sfumato::scene
