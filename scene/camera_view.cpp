#include "scene/camera_view.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace sfumato::scene {

shared::ViewParams cameraView(const Camera& camera, int width, int height) {
  const double aspect = static_cast<double>(width) / height;
  const double y = camera.orthographic ? camera.yMagnitude : std::tan(camera.yfov * 0.5);
  const double x = y * aspect;
  const bool endless = !std::isfinite(camera.farDistance);
  glm::dmat4 clip;
  if (camera.orthographic)
    clip = glm::ortho(-x, x, -y, y, camera.nearDistance, endless ? 1e6 : camera.farDistance);
  else if (endless)
    clip = glm::infinitePerspective(camera.yfov, aspect, camera.nearDistance);
  else
    clip = glm::perspective(camera.yfov, aspect, camera.nearDistance, camera.farDistance);
  shared::ViewParams view{};
  view.viewFromWorld = glm::inverse(camera.worldFromView);
  view.worldFromView = camera.worldFromView;
  view.clipFromView = clip;
  view.halfExtent =
      glm::vec4(static_cast<float>(x), static_cast<float>(y), camera.orthographic ? 1.f : 0.f, 0.f);
  view.depthRange = {static_cast<float>(camera.nearDistance),
                     endless ? 3e38f : static_cast<float>(camera.farDistance), 0.f, 0.f};
  view.size = {width, height, 0, 0};
  view.tile = view.window = {0, 0, width, height};
  return view;
}

Camera lookAt(const glm::dvec3& from, const glm::dvec3& at, double yfov) {
  const glm::dvec3 forward = glm::normalize(at - from);
  const glm::dvec3 up = std::abs(forward.y) < 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  Camera camera;
  camera.worldFromView = glm::inverse(glm::lookAt(from, at, up));
  camera.yfov = yfov;
  return camera;
}

}  // namespace sfumato::scene
