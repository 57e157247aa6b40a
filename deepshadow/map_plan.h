// How fine the shadow maps of a frame are, within one memory budget for all of them.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace sfumato::deepshadow {

struct MapPlan {
  std::vector<int> resolutions;  // texels a side of each light's map, at least 32; 0: it has none
  double error = 1.0 / 512;      // bound of what compression adds to the transmittance of smoke; 0: nothing
};

struct MapBudget {
  size_t bytes = 0;             // of all maps; 0: what the device holds
  bool lowerResolution = true;  // what may be given up for it
  bool loosenError = true;
};

// A coarser plan where `plan` takes `excess` (above 1) times what there is: lower resolutions, evenly, down
// to a quarter of `asked`; then up to eight times the error bound, at most 1/32; then lower resolutions
// still. Nothing where there is no more to give up. Its knots are to be counted anew.
std::optional<MapPlan> coarser(const MapPlan& plan, const MapPlan& asked, const MapBudget& budget,
                               double excess);

// Throws Memory: the `maps` ("deep shadow maps") take `excess` times their budget, and there is no more to
// give up.
[[noreturn]] void failOverBudget(const char* maps, double excess, size_t budgetBytes);

}  // namespace sfumato::deepshadow
