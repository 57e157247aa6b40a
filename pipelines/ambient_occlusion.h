// How much of the ambient light gets to a pixel's surface: what can be asked for, without OpenGL.
#pragma once

#include "base/choice.h"
#include "scene/scene.h"

namespace sfumato::pipelines {

// One result for each pixel, for 2 x 2 of them, or for 4 x 4 (Ferko 2012, section 7: high, medium and low).
enum class OcclusionSize { Off, Full, Half, Quarter };

struct AmbientOcclusionOptions {
  OcclusionSize size = OcclusionSize::Off;
  double radius = 0;  // m, > 0 unless off: what is farther away occludes nothing
};

// Pixels a side for which there is one result; 1 for Off.
int pixelsAside(OcclusionSize size);
// Results to both sides that the blur reaches: 21 in all for Quarter, 61 for others (Ferko 2012, section 7).
int blurReach(OcclusionSize size);

const base::Choice<OcclusionSize>& occlusionSizes();  // "off", "full", "half", "quarter"

// A radius that suits a scene: a tenth of the diagonal of its middle-sized instance, so that a wide floor
// counts no more than what stands on it; 1 where there is none.
double usualOcclusionRadius(const scene::Scene& scene);

}  // namespace sfumato::pipelines
