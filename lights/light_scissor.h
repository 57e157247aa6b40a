// Where in an image a light can light anything: what its draws are cut to.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "lights/light.h"
#include "shaders/shared/view.h"

namespace sfumato::lights {

// What a light reaches lies in this; world.
struct Ball {
  glm::dvec3 centre;
  double radius;  // metres
};

// The smallest ball around what a point or spot light reaches (light_reach.h): of a spot, around its cone.
Ball ballAround(const Light& light);

// Where a ball, whose centre is in view space, is seen along an axis (0: x, 1: y) of the image plane at depth
// 1, or anywhere for an orthographic camera: between the two planes through the eye that touch it and are
// parallel to the other axis (Policarpo and Fonseca 2005, section 3.4.2). Infinite towards a side where it
// comes beside the eye; low > high where all of it is behind the eye.
struct Extent {
  double low;
  double high;
};
Extent extentOf(const Ball& inView, int axis, bool orthographic);

// The pixels of a camera's whole image in which something that the light reaches may be seen: x, y from the
// bottom, width, height. All of them for a directional light; nothing where there is none. Never too small;
// where the ball is before the camera, it is a pixel too large at the most.
std::optional<glm::ivec4> lightScissor(const Light& light, const shared::ViewParams& camera);

}  // namespace sfumato::lights
