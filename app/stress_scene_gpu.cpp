#include "app/stress_scene_gpu.h"

#include <fmt/format.h>

#include <cstring>

#include "app/shot.h"
#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "pipelines/linked_lists_gpu.h"

namespace sfumato::app {
namespace {

// A deep shadow map for each of thousands of lights would take more than all else.
constexpr int shadowCasters = 4;
constexpr double lightReach = 0.25;  // range of a light, in radii of the scene

// From, twice that, and so on; one run without lights of ours where none are asked for.
std::vector<int> lightCounts(const StressOptions& options) {
  if (!options.lights) return {0};
  std::vector<int> counts;
  for (int count = options.lights->x; count <= options.lights->y; count *= 2) counts.push_back(count);
  return counts;
}

std::vector<lists::ListOptions> listOptions(const StressOptions& options) {
  std::vector<lists::ListOptions> all;
  const std::vector<std::string> unlimited = {"none"};
  for (const std::string& budget : options.listMemory.empty() ? unlimited : options.listMemory)
    for (const std::string& strategy : options.lists)
      all.push_back({.strategy = lists::strategyNamed(strategy),
                     .budgetBytes = budget == "none" ? 0 : lists::bytesNamed(budget, "--list-memory"),
                     .onOverflow = lists::onOverflowNamed(options.onOverflow)});
  return all;
}

// Point lights anywhere in the scene, together as bright as one; more lights are the same and others.
std::vector<scene::Light> seededLights(const scene::Bounds& bounds, int count, int seed) {
  base::Random random(static_cast<uint64_t>(seed));
  std::vector<scene::Light> lights;
  for (int i = 0; i < count; ++i) {
    scene::Light light{.name = fmt::format("stress {}", i)};
    for (int axis = 0; axis < 3; ++axis)
      light.position[axis] = random.uniform(bounds.low[axis], bounds.high[axis]);
    light.intensity = glm::dvec3(bounds.radius() * bounds.radius() / count);
    light.range = std::max(bounds.radius() * lightReach, 1e-3);
    light.castsShadow = i < shadowCasters;
    lights.push_back(light);
  }
  return lights;
}

// Of the passes of these names below `prefix`.
double secondsOf(gl::Device& device, const std::string& prefix, std::initializer_list<const char*> names) {
  double milliseconds = 0;
  for (const gl::PassTime& time : device.profiler().times())
    for (const char* name : names)
      if (time.name.starts_with(prefix + "/") && time.name.ends_with(std::string("/") + name))
        milliseconds += time.wallMilliseconds;
  return milliseconds / 1000;
}

StressRun runOf(gl::Device& device, const char* name, const std::string& pass,
                const lists::ListStatistics& statistics) {
  StressRun run;
  run.load = name;
  run.statistics = statistics;
  run.findings.lost = statistics.demand - std::min(statistics.demand, statistics.stored);
  if (run.findings.lost > 0) run.findings.fault = fmt::format("{} nodes are in no list", run.findings.lost);
  run.findings.rebuilt = static_cast<size_t>(statistics.distrusted);
  if (run.findings.rebuilt > 0)
    run.findings.fault = "the strategy lost nodes: the lists were built again by another one";
  run.buildSeconds = secondsOf(device, pass, {"count", "scatter", "link"});
  run.resolveSeconds = secondsOf(device, pass, {"gather", "sort"});
  return run;
}

std::vector<StressRun> runsOf(gl::Device& device, const pipelines::FrameStatistics& statistics) {
  lists::ListStatistics shadows;
  for (const deepshadow::LightMap& map : statistics.shadows) shadows += map.lists;
  return {runOf(device, "shadows", "deep shadow maps", shadows),
          runOf(device, "lights", "light lists", statistics.lights),
          runOf(device, "surfaces", "surface lists", statistics.surfaces)};
}

// Pixels with other bits.
size_t differentPixels(const image::Image& a, const image::Image& b) {
  size_t different = 0;
  for (size_t i = 0; i < a.values.size(); i += 3)
    different += std::memcmp(&a.values[i], &b.values[i], 3 * sizeof(float)) != 0 ? 1 : 0;
  return different;
}

}  // namespace

void stressScene(gl::Device& device, const StressOptions& options, const std::function<bool()>& stop,
                 StressResult& result) {
  Shot shot = makeShot(options.shot);
  const scene::Bounds bounds = boundsOf(shot.scene, shot.media);
  const std::vector<scene::Light> ownLights = shot.scene.lights;
  const std::vector<lists::ListOptions> kinds = listOptions(options);
  const std::vector<int> counts = lightCounts(options);
  device.profiler().enable();
  pipelines::LinkedListsPipeline pipeline(device, shot.scene, shot.media);
  base::Progress progress("stress", static_cast<long>(counts.size() * kinds.size()));
  for (const int count : counts) {
    shot.scene.lights = ownLights;
    for (const scene::Light& light : seededLights(bounds, count, options.seed))
      shot.scene.lights.push_back(light);
    std::optional<image::Image> first;
    for (const lists::ListOptions& kind : kinds) {
      if (stop()) return;
      shot.quality.lists = kind;
      std::vector<StressRun> runs(1);
      runs.front().load = "frame";
      try {
        pipelines::Frame frame;
        for (int i = 0; i < options.repeat + 1; ++i) {  // the first one compiles shaders
          device.profiler().reset();
          frame = pipeline.render(shot.camera, options.shot.width, options.shot.height, shot.quality);
        }
        runs = runsOf(device, frame.statistics);
        if (!first) first = frame.radiance;
        if (const size_t different = differentPixels(*first, frame.radiance)) {
          runs.back().findings.different = different;
          runs.back().findings.fault =
              fmt::format("{} pixels are others than with the first strategy", different);
        }
      } catch (const base::Error& error) {
        if (error.exitCode == base::ExitCode::Memory) {
          runs.front().refused = error.what();
        } else if (error.exitCode == base::ExitCode::CheckFailed) {
          runs.front().findings = {.lost = 1, .fault = error.what()};  // how many, nobody knows
        } else {
          throw;
        }
      }
      for (StressRun& run : runs) {
        run.options = kind;
        run.lights = static_cast<int>(shot.scene.lights.size());
        result.runs.push_back(run);
      }
      progress.advance();
    }
  }
}

}  // namespace sfumato::app
