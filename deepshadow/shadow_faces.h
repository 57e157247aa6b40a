// Projections of deep shadow maps: what each light looks through.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "shaders/shared/deepshadow.h"
#include "shaders/shared/view.h"

namespace sfumato::deepshadow {

// One square projection. View space looks along -Z; depth is the distance along -Z.
struct FaceProjection {
  glm::dmat4 worldFromFace{1.0};  // rotation and translation
  bool orthographic = false;
  glm::dvec2 halfExtent{1.0};  // of the map at depth 1 (perspective) or anywhere (orthographic), m
  int side = 0;                // texels
  bool casters = true;         // whether surfaces cast shadows; where none do, one texel stands for all
  int smokeSide = 0;           // texels of smoke; 0: none
  glm::dvec4 smoke{0};         // where they hold any: see ShadowFace

  size_t texels() const { return static_cast<size_t>(side) * static_cast<size_t>(side); }
  int surfaceSide() const { return casters ? side : 1; }  // texels of surfaces that are stored
};

// The side of a face for a map of `resolution` texels: a multiple of 16, at least 32, so that the faces of a
// cube, which have half, are whole workgroups.
int faceSide(int resolution);

// Texels a side that a face needs for smoke in a box (the image of the unit cube), so that none is wider than
// `width` metres in what is lit of it, which is up to `reach` metres deep.
int smokeSide(const FaceProjection& face, const glm::dmat4& worldFromUnit, double width, double reach);

// Which part of a face, in texels of surfaces, smoke in some boxes (images of the unit cube) can be before,
// with what filters add: from x, y to z, w. Its smokeSide is known.
glm::dvec4 smokePart(const FaceProjection& face, std::span<const glm::dmat4> boxes);

// Texels whose lists are built together.
constexpr size_t windowTexels = size_t{1} << 20;

// How many faces, from the first on, make a stack: they are drawn one above the other, and their lists built
// together. All of one side, and of no more than windowTexels, or one.
size_t stackedFaces(std::span<const FaceProjection* const> faces);

// Half the angle of the widest cone that one perspective face still takes, radians.
constexpr double widestCone = 1.0471975511965976;

// Each has a margin of a texel or more, so that filtering never looks past its edge.

// A directional light along `direction` (unit, where it shines to): one orthographic face over `receivers`
// (world points whose hull holds everything that is seen), in front of `casters` (world points whose hull
// holds everything that casts shadows).
FaceProjection directionalFace(const glm::dvec3& direction, int side, std::span<const glm::dvec3> receivers,
                               std::span<const glm::dvec3> casters);
// A cone at `position` along `direction` with half angle `angle` <= widestCone: one perspective face around
// it.
FaceProjection coneFace(const glm::dvec3& position, const glm::dvec3& direction, double angle, int side);
// The whole sphere around `position`: six faces of half the side, +x -x +y -y +z -z.
std::vector<FaceProjection> cubeFaces(const glm::dvec3& position, int side);

// A face as lookups know it; its texels count from `firstTexel` on.
shared::ShadowFace faceData(const FaceProjection& face, size_t firstTexel);
// A face as something of so many texels a side to draw into. Clip z is 0: fragments tell their depth
// themselves, and draws clamp what is before the near or behind the far plane.
shared::ViewParams faceView(const FaceProjection& face, int side);

}  // namespace sfumato::deepshadow
