// The whole frame in double precision on the CPU, by tracing rays: the oracle for the GPU's pictures.
// It shares scene values with the GPU's passes, and no code.
#pragma once

#include <span>

#include "image/image.h"
#include "pipelines/aovs.h"
#include "scene/scene.h"
#include "volumes/grid.h"

namespace sfumato::pipelines {

struct ReferenceOptions {
  int width = 64;
  int height = 48;
  // Per pixel side: 1 looks through the pixel's centre, n through n x n subpixel centres; more where smoke
  // shows a lamp.
  int samples = 1;
  double stepVoxels = 0.5;  // of the camera's march, in voxels
  double shadowStepVoxels = 0.5;
  int scatteringOctaves = 0;  // of multiple scattering, as Quality::scatteringOctaves
  bool showProgress = false;
  AovSet aovs;  // none that isOfLists()
};

struct ReferenceFrame {
  image::Image radiance;  // linear RGB
  AovImages aovs;
};

// Linear RGB radiance. Per pixel: all surfaces along the ray, sorted, each lit (Lambert and GGX as glTF has
// them) and letting t = 1 - a (1 - tau b) through; between them single scattering in the media; for every lit
// point a shadow ray to each light through all surfaces and media, as their materials say that they shadow.
// Ambient light reaches all surfaces alike (Scene::ambient); no bounces; the background is 0. Back faces of
// materials that are not double-sided are not seen, but shadow. A surface gathers light on the side that is
// seen, where both its triangle and its shading normal face the light; its shadow rays start 1e-6 of the
// scene's extent off it. Throws Bug unless steps and samples are positive.
image::Image renderReference(const scene::Scene& scene, const scene::Camera& camera,
                             std::span<const volumes::Medium> media, const ReferenceOptions& options);

// The same with the AOVs that the options name.
ReferenceFrame traceReference(const scene::Scene& scene, const scene::Camera& camera,
                              std::span<const volumes::Medium> media, const ReferenceOptions& options);

}  // namespace sfumato::pipelines
