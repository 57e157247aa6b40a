// How many fragments a triangle makes, from its shape alone.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

namespace sfumato::pipelines {

// What triangles are projected to: the camera's image, or a face of a light's shadow map. View space looks
// along -Z.
struct ProjectionArea {
  glm::dmat4 viewFromWorld{1.0};
  glm::dvec2 halfExtent{1.0};  // at depth 1 (perspective) or anywhere (orthographic), m
  bool orthographic = false;
  glm::dvec2 size{1.0};                                            // pixels
  double nearDistance = -std::numeric_limits<double>::infinity();  // metres; nothing nearer is drawn
  double farDistance = std::numeric_limits<double>::infinity();
  int samples = 1;  // of a pixel, 1 or 4: a pixel has a fragment when one of them is covered
};

class FragmentCount {
 public:
  explicit FragmentCount(const ProjectionArea& area);
  // The fragments of a triangle (world space), on average over where it might stand within a pixel: its area
  // in the image, in pixels, and of four samples what its edges add. What other surfaces hide counts too.
  // `cull`: none where it is seen from behind, that is clockwise. 0 for a triangle that is not finite.
  double of(const std::array<glm::dvec3, 3>& corners, bool cull) const;

 private:
  ProjectionArea area_;
  std::vector<glm::dvec4> planes_;  // of the frustum in view space
};

}  // namespace sfumato::pipelines
