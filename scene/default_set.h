// What smoke without a scene is shown in: a ground that curves up into a backdrop, a key light, a fill light,
// a camera.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/bounds.h"
#include "scene/scene.h"
#include "volumes/grid.h"

namespace sfumato::scene {

// A perspective camera in front of the box (towards +Z) and a little above, as near as it can be with the
// whole box in a picture of the given aspect (width / height) and some room around it. yfov in radians. A box
// that is empty or a point stands for a metre around the origin.
Camera framingCamera(const Bounds& bounds, double yfov, double aspect);

// Adds the camera that frames the box, matte ground a little below it that fills the camera's picture, a warm
// directional key light from the upper left, and a cool, weak one from the right. Everything is in proportion
// to the box. See framingCamera() for an empty one.
void addDefaultSet(Scene& scene, const Bounds& smoke, double yfov, double aspect);

// For a set without light: a warm directional light from the upper left front, and a cool, weak one from the
// right.
void addDefaultLights(Scene& scene);

// Of fittingScale().
constexpr double fittingOpticalDepth = 8;

// The extinction scale, 1/m, that gives the medium fittingOpticalDepth through its densest part, whatever its
// size: the mean over the tenth of its columns of voxels that hold most, geometric over the three axes. 1 for
// a grid without density.
double fittingScale(const volumes::Medium& medium);

}  // namespace sfumato::scene
