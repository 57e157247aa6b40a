// Point lights in place of the light that fires cast, which a march along the ray shows but nothing gathers.
#pragma once

#include <span>
#include <vector>

#include "lights/light.h"
#include "volumes/grid.h"

namespace sfumato::scene {

// `count` point lights or fewer, where the fire is hottest: its voxels are cut at their median of power again
// and again, the part that is brightest and widest first and along its longest axis (after the median cut of
// Debevec 2008), and a light stands in the middle of each part. Together they have the power that all voxels
// emit, colour by colour, as if no smoke took any; the same fire gives the same lights. None for a fire that
// is dark.
std::vector<lights::Light> fireLights(const volumes::Fire& fire, int count);

}  // namespace sfumato::scene
