#include "deepshadow/map_plan.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/size_text.h"

namespace sfumato::deepshadow {

namespace {

constexpr int leastResolution = 32;
constexpr double loosestError = 1.0 / 32;
constexpr double firstError = 1.0 / 4096;  // after none at all

// Resolutions that give `share` of the texels, none below `least` of those in `asked`; nothing when all stay.
std::optional<MapPlan> scaled(MapPlan plan, const MapPlan& asked, double share, double least) {
  bool changed = false;
  for (size_t i = 0; i < plan.resolutions.size(); ++i) {
    int& resolution = plan.resolutions[i];
    const int smallest = std::max(leastResolution, static_cast<int>(least * asked.resolutions[i]));
    if (resolution <= smallest) continue;
    // Sides are multiples of 16 in the end.
    const int lower = static_cast<int>(resolution * std::sqrt(share)) / 16 * 16;
    resolution = std::clamp(lower, smallest, resolution - 1);
    changed = true;
  }
  if (!changed) return {};
  return plan;
}

}  // namespace

std::optional<MapPlan> coarser(const MapPlan& plan, const MapPlan& asked, const MapBudget& budget,
                               double excess) {
  const double share = 1 / excess;
  if (budget.lowerResolution)
    if (auto lower = scaled(plan, asked, share, 0.25)) return lower;
  const double loosest = std::min(loosestError, 8 * std::max(asked.error, firstError));
  if (budget.loosenError && plan.error < loosest) {
    MapPlan looser = plan;
    looser.error = std::min(loosest, std::max(2 * plan.error, firstError));
    return looser;
  }
  if (budget.lowerResolution) return scaled(plan, asked, share, 0);
  return {};
}

void failOverBudget(const char* maps, double excess, size_t budgetBytes) {
  base::fail(base::ExitCode::Memory,
             "{}: take {:.2g} times the {} that they may: give them more with --shadow-memory, or lower "
             "--shadow-res",
             maps, excess, base::sizeText(budgetBytes));
}

}  // namespace sfumato::deepshadow
