// How many nodes the lists of a frame will hold, and what they take, from the scene's shapes alone: no
// OpenGL, and milliseconds whatever the scene's size. For planning; a count pass knows exactly
// (lists/lists_gpu.h).
#pragma once

#include <span>
#include <vector>

#include "pipelines/quality.h"
#include "scene/scene.h"
#include "volumes/grid.h"

namespace sfumato::pipelines {

struct PredictedLists {
  size_t cells = 0;
  size_t nodes = 0;
  size_t bytes = 0;  // of those that are there at one time, when no budget makes them fewer

  PredictedLists& operator+=(const PredictedLists& other);  // lists that are there one after the other
};

struct ListPrediction {
  PredictedLists surfaces;              // of the camera
  PredictedLists lights;                // light lists
  std::vector<PredictedLists> shadows;  // a light each, as in the scene

  PredictedLists allShadows() const;
};

// Fragments are counted by the area of triangles in the image or shadow map, clipped to it. What opaque
// surfaces hide, and what textures cut out, is counted as well: the true number of nodes of surfaces and
// shadows is at most about this. Of meshes with very many triangles a sample is looked at. Lights are counted
// cell by cell, or by a sample of cells where they cover many, also in cells that show nothing to light.
// Shadow maps are those of the quality, whatever memory they may take.
ListPrediction predictLists(const scene::Scene& scene, std::span<const volumes::Medium> media,
                            const scene::Camera& camera, int width, int height, const Quality& quality);

}  // namespace sfumato::pipelines
