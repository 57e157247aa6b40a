// What a frame may cost.
#pragma once

#include <string>
#include <vector>

#include "lists/strategy.h"

namespace sfumato::pipelines {

constexpr int maxScatteringOctaves = 8;
constexpr int usualScatteringOctaves = 4;  // where none are asked for by number

struct Quality {
  int samples = 4;                    // of a pixel where edges cross it: 1, or 4
  int shadowResolution = 1024;        // texels a side of a deep shadow map
  double stepVoxels = 1.0;            // of every march through smoke, in voxels of the finest volume
  double shadowError = 1.0 / 512;     // bound of the error of a deep shadow map's transmittance
  double throughputCutoff = 1e-3;     // a ray ends where less than this of what is behind would be seen
  bool bilinearSmokeShadows = false;  // four texels instead of the nearest for every lookup in smoke
  // Octaves of multiple scattering beside single scattering, 0 to maxScatteringOctaves: see
  // shaders/pipelines/multiple_scattering.glsl. No named quality has any.
  int scatteringOctaves = 0;
  // How all lists are built. The budget is for those that are there at one time: of a window of a light's
  // shadow map, or of the lights and surfaces of a window of the image.
  lists::ListOptions lists{};
};

// "draft", "medium", "high" or "reference".
const std::vector<std::string>& qualityNames();
// Throws Usage for another name.
Quality qualityNamed(const std::string& name);

}  // namespace sfumato::pipelines
