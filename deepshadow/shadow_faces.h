// Projections of deep shadow maps: what each light looks through.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace sfumato::deepshadow {

// One square projection. View space looks along -Z; depth is the distance along -Z.
struct FaceProjection {
  glm::dmat4 worldFromFace{1.0};  // rotation and translation
  bool orthographic = false;
  glm::dvec2 halfExtent{1.0};  // of the map at depth 1 (perspective) or anywhere (orthographic), m
  int side = 0;                // texels
};

// The faces of a light at `resolution` texels a side (a multiple of 16 is taken, so that faces of cubes have
// whole workgroups; at least 32):
//  - directional: one orthographic face over `receivers` (world points whose hull holds everything that is
//  seen), in
//    front of `casters` (world points whose hull holds everything that casts shadows);
//  - spot up to 60 degrees off its axis: one perspective face around the cone;
//  - point, and wider spots: six faces of half the resolution, +x -x +y -y +z -z.
// Each has a margin of one texel or more, so that filtering never looks past its edge.
std::vector<FaceProjection> shadowFaces(const scene::Light& light, int resolution,
                                        std::span<const glm::dvec3> receivers,
                                        std::span<const glm::dvec3> casters);

}  // namespace sfumato::deepshadow
