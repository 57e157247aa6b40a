// World points that bound what is seen and what is there.
#pragma once

#include <vector>

#include "scene/bounds.h"
#include "scene/scene.h"

namespace sfumato::scene {

// Corners of every piece of the scene's triangles that lies inside the camera's frustum at the given aspect
// (width / height), instance by instance: the hull of each holds what is seen of it.
std::vector<std::vector<glm::dvec3>> visibleParts(const Scene& scene, const Camera& camera, double aspect);
// The same of boxes (worldFromUnit: images of the unit cube), whose insides are seen, too.
std::vector<std::vector<glm::dvec3>> visibleParts(const std::vector<glm::dmat4>& worldFromUnit,
                                                  const Camera& camera, double aspect);
// All of them together. Their hull holds everything that is seen.
std::vector<glm::dvec3> visiblePoints(const Scene& scene, const std::vector<glm::dmat4>& worldFromUnit,
                                      const Camera& camera, double aspect);

// What is seen, gathered from parts of it.
struct Seen {
  std::vector<glm::dvec3> points;  // their hull holds it
  std::vector<Bounds> parts;       // around each

  void add(const std::vector<std::vector<glm::dvec3>>& visibleParts);
};

// Boxes around every mesh instance, as images of the unit cube; flat where the mesh is.
std::vector<glm::dmat4> boundingBoxes(const Scene& scene);

// Their corners, and of the unit boxes.
std::vector<glm::dvec3> boundingPoints(const Scene& scene, const std::vector<glm::dmat4>& worldFromUnit);

}  // namespace sfumato::scene
