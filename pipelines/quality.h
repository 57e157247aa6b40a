// What a frame may cost.
#pragma once

#include <string>
#include <vector>

#include "lists/strategy.h"
#include "pipelines/ambient_occlusion.h"
#include "pipelines/deferred_options.h"

namespace sfumato::pipelines {

constexpr int maxScatteringOctaves = 8;
constexpr int usualScatteringOctaves = 4;  // where none are asked for by number

// What a lookup in a deep shadow map asks: the nearest texel, the four around it, or sixteen, under a cubic
// B-spline, so that edges of shadows are smooth.
enum class ShadowFilter { Nearest, Bilinear, Soft };

struct Quality {
  int samples = 4;                 // of a pixel where edges cross it: 1, or 4
  int shadowResolution = 1024;     // texels a side of a deep shadow map, at most
  double stepVoxels = 1.0;         // of every march through smoke, in voxels of the finest volume
  double shadowError = 1.0 / 512;  // bound of the error of a deep shadow map's transmittance; 0: none
  // Otherwise maps of lights that cover little of the image are smaller (shadow_resolution.h), and all are
  // where they would not fit; the same of the error.
  bool exactShadowResolution = true;
  bool exactShadowError = true;
  size_t shadowMemory = 0;  // bytes of all maps together; 0: what the device reads
  // Smoke is marched once for 2 x 2 or 4 x 4 pixels where the rays are at most so many voxels apart then; 0: for
  // every pixel. Only the core pipeline asks.
  double smokeRaySpacing = 0;
  bool halfResolutionSmoke = false;  // for 2 x 2 pixels at least
  bool depthsFirst = false;          // opaque surfaces are drawn twice, depths alone first
  double throughputCutoff = 1e-3;    // a ray ends where less than this of what is behind would be seen
  ShadowFilter surfaceShadows = ShadowFilter::Bilinear;
  ShadowFilter smokeShadows = ShadowFilter::Nearest;
  // Octaves of multiple scattering beside single scattering, 0 to maxScatteringOctaves: see
  // shaders/pipelines/multiple_scattering.glsl. No named quality has any.
  int scatteringOctaves = 0;
  // For comparisons only, no named quality has it: light and shadow lists as Lindbeck 2015 has them, linked
  // under spin locks and walked from their heads by every lookup, with so many nodes of smoke for each texel.
  // 0: runs.
  int walkedSmokeNodes = 0;
  // How all lists are built. The budget is for those that are there at one time: of a window of a light's
  // shadow map, or of the lights and surfaces of a window of the image.
  lists::ListOptions lists{};
  AmbientOcclusionOptions ambientOcclusion{};
  DeferredOptions deferred{};
};

// Texels a side.
int tapsOf(ShadowFilter filter);
const base::Choice<ShadowFilter>& shadowFilters();  // "nearest", "bilinear", "soft"

// "draft", "medium", "high" or "reference".
const std::vector<std::string>& qualityNames();
// Throws Usage for another name.
Quality qualityNamed(const std::string& name);

}  // namespace sfumato::pipelines
