// A camera as shaders want it.
#pragma once

#include "scene/scene.h"
#include "shaders/shared/view.h"

namespace sfumato::scene {

// Of an image of width x height pixels; aspect is their ratio, the vertical angle is the camera's.
// Tile and window are all of it.
shared::ViewParams cameraView(const Camera& camera, int width, int height);

// A perspective camera at `from` that looks at `at`, Y up (or any up, when it looks along Y); yfov in
// radians.
Camera lookAt(const glm::dvec3& from, const glm::dvec3& at, double yfov);

}  // namespace sfumato::scene
