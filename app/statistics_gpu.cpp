#include "app/statistics_gpu.h"

#include <algorithm>

#include "base/json_text.h"

namespace sfumato::app {
namespace {

nlohmann::json toJson(const lists::ListStatistics& lists, const pipelines::PredictedLists& fromBounds) {
  return {{"strategy", lists::strategies().nameOf(lists.strategy)},
          {"cells", lists.cells},
          {"nodes_from_bounds", fromBounds.nodes},
          {"nodes_predicted", lists.predicted},
          {"nodes_demanded", lists.demand},
          {"nodes_stored", lists.stored},
          {"nodes_hidden", lists.hidden},
          {"longest", lists.longest},
          {"lengths", lists.lengths},
          {"capacity", lists.capacity},
          {"overflowed", lists.overflowed},
          {"max_spins", lists.maxSpins},
          {"p99_spins", lists.p99Spins},
          {"retries", lists.retries},
          {"builds", lists.builds},
          {"windows", lists.windows},
          {"distrusted", lists.distrusted},
          {"node_bytes", lists.nodeBytes},
          {"bytes_from_bounds", fromBounds.bytes},
          {"predicted_bytes", lists.predictedBytes},
          {"bytes", lists.bytes}};
}

nlohmann::json toJson(const pipelines::Lookups& lookups) {
  const auto perPixel = [&](size_t all, size_t most) {
    const auto pixels = static_cast<double>(std::max<size_t>(lookups.pixels, 1));
    return nlohmann::json{{"mean", static_cast<double>(all) / pixels}, {"max", most}};
  };
  return {{"lights_per_pixel", perPixel(lookups.lights, lookups.mostLights)},
          {"shadows_per_pixel", perPixel(lookups.shadows, lookups.mostShadows)},
          {"smoke_steps", lookups.steps},
          {"smoke_steps_jumped", lookups.jumpedSteps}};
}

nlohmann::json toJson(const std::vector<gl::PassTime>& passes) {
  nlohmann::json result = nlohmann::json::array();
  for (const gl::PassTime& pass : passes)
    result.push_back({{"pass", pass.name},
                      {"gpu_ms", pass.gpuMilliseconds},
                      {"wall_ms", pass.wallMilliseconds},
                      {"calls", pass.calls}});
  return result;
}

}  // namespace

std::string statisticsText(gl::Device& device, const pipelines::FrameStatistics& statistics,
                           const pipelines::ListPrediction& fromBounds, const RunTimes& times) {
  nlohmann::json result;
  result["device"] = device.names().renderer;
  result["startup"] = {{"seconds", times.startupSeconds}, {"passes", toJson(times.startupPasses)}};
  result["frame"] = {{"seconds", times.frameSeconds},
                     {"passes", toJson(times.framePasses)},
                     {"triangles", statistics.triangles},
                     {"geometry_passes", statistics.geometryPasses},
                     {"tiles", statistics.tiles},
                     {"split_pixels", statistics.splitPixels},
                     {"resolve_dispatches", statistics.resolveDispatches},
                     {"cut_walks", statistics.cutWalks},
                     {"lookups", toJson(statistics.lookups)}};
  result["lists"] = {{"surfaces", toJson(statistics.surfaces, fromBounds.surfaces)},
                     {"lights", toJson(statistics.lights, fromBounds.lights)},
                     {"shadows", toJson(statistics.shadowLists, fromBounds.allShadows())}};
  const pipelines::ShadowFigures& maps = statistics.shadowMaps;
  result["shadow_maps"] = {{"resolutions", maps.resolutions},
                           {"error", maps.error},
                           {"lowered", maps.lowered},
                           {"bytes", maps.bytes},
                           {"predicted_bytes", maps.predictedBytes},
                           {"budget_bytes", maps.budgetBytes},
                           {"lights", nlohmann::json::array()}};
  for (size_t i = 0; i < statistics.shadows.size(); ++i) {
    const deepshadow::LightMap& map = statistics.shadows[i];
    result["shadow_maps"]["lights"].push_back({{"faces", map.faces},
                                               {"resolution", map.resolution},
                                               {"texels", map.texels},
                                               {"smoke_texels", map.smokeTexels},
                                               {"knot_bytes", map.knotBytes},
                                               {"nodes_from_bounds", fromBounds.shadows[i].nodes},
                                               {"nodes_stored", map.nodes},
                                               {"nodes_hidden", map.hidden}});
  }
  result["memory"] = {{"peak_bytes", device.memory().peakBytes()},
                      {"program_bytes", device.programBytes()},
                      {"peak_bytes_by_label", device.memory().peakBytesByLabel()}};
  return base::jsonText(result);
}

}  // namespace sfumato::app
