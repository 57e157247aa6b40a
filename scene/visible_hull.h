// World points that bound what is seen and what is there.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace sfumato::scene {

// Corners of every piece of the scene's triangles and of the boxes (worldFromUnit: images of the unit cube)
// that lies inside the camera's frustum at the given aspect (width / height). Their hull holds everything
// that is seen.
std::vector<glm::dvec3> visiblePoints(const Scene& scene, const std::vector<glm::dmat4>& worldFromUnit,
                                      const Camera& camera, double aspect);

// Boxes around every mesh instance, as images of the unit cube; flat where the mesh is.
std::vector<glm::dmat4> boundingBoxes(const Scene& scene);

// Their corners, and of the unit boxes.
std::vector<glm::dvec3> boundingPoints(const Scene& scene, const std::vector<glm::dmat4>& worldFromUnit);

}  // namespace sfumato::scene
