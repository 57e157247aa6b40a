// What meshes need before they can be drawn: triangles, normals, tangents, the right way round.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace sfumato::scene {

// Separate triangles of a strip and of a fan, wound as glTF 2.0 (section 3.7.2.1) has them. Fewer than three
// indices make none.
std::vector<uint32_t> trianglesOfStrip(std::span<const uint32_t> strip);
std::vector<uint32_t> trianglesOfFan(std::span<const uint32_t> fan);

// Gives each triangle its own three vertices with the triangle's normal; +Z where it has no area.
void makeFlat(Mesh& mesh);

// Makes normals unit length; one that is zero becomes the normal of a triangle around it, or +Z.
void normaliseNormals(Mesh& mesh);

// Makes tangents unit length and their handedness +-1; one that is zero becomes any across the normal.
void normaliseTangents(Mesh& mesh);

// Tangents from normals and the coordinates that `use` reads its texture at: per vertex the mean over its
// triangles of dP/du, weighted by the corner's angle, as MikkTSpace (Mikkelsen 2008) has it; the bitangent
// cross(normal, tangent) * w points to where v falls, as glTF's normal maps want it. A vertex where mirrored
// and unmirrored texture meet becomes two. Normals must be unit length.
void computeTangents(Mesh& mesh, const TextureUse& use);

// The mesh for a mirroring transform: indices reversed and handedness negated, so that counter-clockwise from
// outside and cross(normal, tangent) * w hold after it.
Mesh mirrored(const Mesh& mesh);

// The mesh with the affine transform applied, which may be singular (normals are transformed as areas are).
Mesh transformed(const Mesh& mesh, const glm::dmat4& transform);

}  // namespace sfumato::scene
