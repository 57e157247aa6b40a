#include "app/statistics_gpu.h"

#include "base/json_text.h"

namespace sfumato::app {
namespace {

nlohmann::json toJson(const lists::ListStatistics& lists, const pipelines::PredictedLists& fromBounds) {
  return {{"strategy", lists::nameOf(lists.strategy)},
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
  result["frame"] = {
      {"seconds", times.frameSeconds},          {"passes", toJson(times.framePasses)},
      {"triangles", statistics.triangles},      {"tiles", statistics.tiles},
      {"split_pixels", statistics.splitPixels}, {"resolve_dispatches", statistics.resolveDispatches},
      {"cut_walks", statistics.cutWalks}};
  result["lists"] = {{"surfaces", toJson(statistics.surfaces, fromBounds.surfaces)},
                     {"lights", toJson(statistics.lights, fromBounds.lights)}};
  result["lists"]["shadows"] = nlohmann::json::array();
  for (size_t i = 0; i < statistics.shadows.size(); ++i) {
    const deepshadow::LightMap& map = statistics.shadows[i];
    nlohmann::json light = toJson(map.lists, fromBounds.shadows[i]);
    light["faces"] = map.faces;
    light["texels"] = map.texels;
    light["knots"] = map.knots;
    result["lists"]["shadows"].push_back(light);
  }
  result["memory"] = {{"peak_bytes", device.memory().peakBytes()},
                      {"peak_bytes_by_label", device.memory().peakBytesByLabel()}};
  return base::jsonText(result);
}

}  // namespace sfumato::app
