// Presets of effects: after Ferko 2012 ("Real-time Lighting Effects using Deferred Shading", section 7, Table
// 1).
#pragma once

#include <string>
#include <vector>

namespace sfumato::app {

// All presets have Reinhard's tone mapping, mipmap bloom and edges blurred as well.
struct Effects {
  std::string name;
  std::string ambientOcclusion;  // as --ssao takes it
  int shadowResolution;          // most texels a side of a shadow map
  int routedSamples;             // a pixel, of stencil-routed fragments, where the driver has them
};

const std::vector<Effects>& allEffects();
const std::vector<std::string>& effectsNames();  // "low", "medium", "high"

}  // namespace sfumato::app
