#include "app/stress_scene_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "app/shot.h"
#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/size_text.h"
#include "lights/light_cells.h"
#include "lists/stress/audit_gpu.h"
#include "pipelines/linked_lists_gpu.h"

namespace sfumato::app {

using lists::stress::Audit;

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
      all.push_back({.strategy = lists::strategies().named(strategy),
                     .budgetBytes = budget == "none" ? 0 : base::bytesNamed(budget, "--list-memory"),
                     .onOverflow = lists::overflowPolicies().named(options.onOverflow)});
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

// How a kind of lists is called in reports, by its container, and by the pass that builds it.
struct ListKind {
  const char* name;
  const char* label;
  const char* pass;
};
constexpr ListKind shadowLists = {"shadows", "deep shadow lists", "deep shadow maps"};
constexpr ListKind lightLists = {"lights", "light lists", "light lists"};
constexpr ListKind surfaceLists = {"surfaces", "surface lists", "surface lists"};

// A container whose nodes were all found, or why not.
StressRun runOf(const ListKind& kind, const lists::ListStatistics& statistics, const Audit& audit,
                const pipelines::PredictedLists& fromBounds) {
  StressRun run;
  run.load = kind.name;
  run.statistics = statistics;
  run.fromBounds = fromBounds;
  const auto audited = audit.audited().find(kind.label);
  if (audited != audit.audited().end()) {
    run.findings = audited->second.findings;
    run.lookups = audited->second.lookups;
    run.lookupSeconds = audited->second.lookupSeconds;
  }
  const auto blame = [&](size_t& found, size_t count, std::string fault) {
    found = std::max(found, count);
    if (count > 0 && run.findings.fault.empty()) run.findings.fault = std::move(fault);
  };
  const size_t missing = statistics.demand - std::min(statistics.demand, statistics.stored);
  blame(run.findings.lost, missing, fmt::format("{} nodes are in no list", missing));
  blame(run.findings.rebuilt, static_cast<size_t>(statistics.distrusted),
        "the strategy lost nodes: the lists were built again by another one");
  blame(run.findings.hidden, statistics.hidden,
        fmt::format("{} nodes lie behind opaque surfaces", statistics.hidden));
  return run;
}

std::vector<StressRun> runsOf(const pipelines::FrameStatistics& statistics, const Audit& audit,
                              const pipelines::ListPrediction& fromBounds) {
  return {runOf(shadowLists, statistics.shadowLists, audit, fromBounds.allShadows()),
          runOf(lightLists, statistics.lights, audit, fromBounds.lights),
          runOf(surfaceLists, statistics.surfaces, audit, fromBounds.surfaces)};
}

// The nodes of the first width x height cells, rows from the top; nothing where they were not built at once.
LengthGrid gridOf(const Audit& audit, const ListKind& kind, size_t width, size_t height) {
  const auto found = audit.audited().find(kind.label);
  if (found == audit.audited().end() || found->second.lengths.size() < width * height) return {};
  LengthGrid grid{width, height, {}};
  for (size_t y = height; y-- > 0;)
    grid.lengths.insert(grid.lengths.end(), found->second.lengths.begin() + static_cast<long>(y * width),
                        found->second.lengths.begin() + static_cast<long>((y + 1) * width));
  return grid;
}

// Pixels with other bits.
size_t differentPixels(const image::Image& a, const image::Image& b) {
  size_t different = 0;
  for (size_t i = 0; i < a.values.size(); i += 3)
    different += std::memcmp(&a.values[i], &b.values[i], 3 * sizeof(float)) != 0 ? 1 : 0;
  return different;
}

// Draws the scene's frame again and again.
class SceneStress {
 public:
  SceneStress(gl::Device& device, const StressOptions& options, StressResult& result)
      : device_(device),
        options_(options),
        shot_(makeShot(options.shot)),
        bounds_(boundsOf(shot_.scene, shot_.media)),
        ownLights_(shot_.scene.lights),
        pipeline_(device, shot_.scene, shot_.media, {.budgetBytes = shot_.volumeMemory}),
        result_(result) {}

  // As many seeded lights, from now on.
  void setLights(int count) {
    shot_.scene.lights = ownLights_;
    for (const scene::Light& light : seededLights(bounds_, count, options_.seed))
      shot_.scene.lights.push_back(light);
    first_.reset();
  }

  // What a container says by an error is a result here.
  void run(const lists::ListOptions& kind) {
    std::vector<StressRun> runs(1);
    runs.front().load = "frame";
    try {
      runs = drawAndJudge(kind);
    } catch (const base::Error& error) {
      if (error.exitCode == base::ExitCode::Memory)
        runs.front().refused = error.what();
      else if (error.exitCode == base::ExitCode::CheckFailed)
        runs.front().findings = {.lost = 1, .fault = error.what()};  // how many, nobody knows
      else
        throw;
    }
    for (StressRun& run : runs) {
      run.options = kind;
      run.lights = static_cast<int>(shot_.scene.lights.size());
      result_.runs.push_back(std::move(run));
    }
  }

 private:
  pipelines::Frame draw(const lists::ListOptions& kind) {
    device_.profiler().reset();
    shot_.quality.lists = kind;
    return pipeline_.render(shot_.camera, options_.shot.width, options_.shot.height, shot_.quality);
  }

  // The first frame is audited, and compiles shaders; the others are measured.
  std::vector<StressRun> drawAndJudge(const lists::ListOptions& kind) {
    Audit audit;
    audit.allocates(device_);
    lists::ListOptions watched = kind;
    watched.observer = &audit;
    const pipelines::Frame audited = draw(watched);
    audit.allocates(device_);
    std::vector<StressRun> runs =
        runsOf(audited.statistics, audit,
               pipelines::predictLists(shot_.scene, shot_.media, shot_.camera, options_.shot.width,
                                       options_.shot.height, shot_.quality));
    if (!first_) setGrids(audit, audited.statistics.shadows, runs);
    size_t different = differentFromFirst(audited.radiance);
    for (int i = 0; i < options_.repeat; ++i) {
      different += differentFromFirst(draw(kind).radiance);
      setTimes(runs, i == 0);
    }
    StressRun& last = runs.back();
    last.findings.different = different;
    if (different > 0 && last.findings.fault.empty())
      last.findings.fault = fmt::format("{} pixels are others than with the first strategy", different);
    last.findings.overwritten = audit.overwritten();
    if (last.findings.overwritten > 0 && last.findings.fault.empty())
      last.findings.fault =
          fmt::format("{} words beside the lists were overwritten", last.findings.overwritten);
    return runs;
  }

  size_t differentFromFirst(const image::Image& radiance) {
    if (!first_) first_ = radiance;
    return differentPixels(*first_, radiance);
  }

  // One of each kind and number of lights is enough: all strategies make the same lists.
  void setGrids(const Audit& audit, std::span<const deepshadow::LightMap> maps,
                std::vector<StressRun>& runs) const {
    const auto width = static_cast<size_t>(options_.shot.width);
    const auto height = static_cast<size_t>(options_.shot.height);
    const auto map = std::find_if(maps.begin(), maps.end(),
                                  [](const deepshadow::LightMap& light) { return light.faces > 0; });
    if (map != maps.end()) {
      const double faceTexels = static_cast<double>(map->texels) / map->faces;
      const auto side = static_cast<size_t>(std::lround(std::sqrt(faceTexels)));
      runs[0].grid = gridOf(audit, shadowLists, side, side);  // the first face
    }
    runs[1].grid = gridOf(audit, lightLists, static_cast<size_t>(lights::cellsAlong(options_.shot.width)),
                          static_cast<size_t>(lights::cellsAlong(options_.shot.height)));
    runs[2].grid = gridOf(audit, surfaceLists, width, height);
  }

  // Of the last frame; the least count.
  void setTimes(std::vector<StressRun>& runs, bool first) {
    const char* const passes[] = {shadowLists.pass, lightLists.pass, surfaceLists.pass};
    for (size_t i = 0; i < runs.size(); ++i) {
      const double build = secondsOf(device_, passes[i], {"count", "scatter", "link"});
      const double resolve = secondsOf(device_, passes[i], {"gather", "sort"});
      runs[i].buildSeconds = first ? build : std::min(runs[i].buildSeconds, build);
      runs[i].resolveSeconds = first ? resolve : std::min(runs[i].resolveSeconds, resolve);
    }
  }

  gl::Device& device_;
  const StressOptions& options_;
  Shot shot_;
  const scene::Bounds bounds_;
  const std::vector<scene::Light> ownLights_;
  pipelines::LinkedListsPipeline pipeline_;
  StressResult& result_;
  std::optional<image::Image> first_;  // the picture of the first strategy
};

}  // namespace

void stressScene(gl::Device& device, const StressOptions& options, const std::function<bool()>& stop,
                 StressResult& result) {
  const std::vector<lists::ListOptions> kinds = listOptions(options);
  const std::vector<int> counts = lightCounts(options);
  device.profiler().enable();
  SceneStress stress(device, options, result);
  base::Progress progress("stress", static_cast<long>(counts.size() * kinds.size()));
  for (const int count : counts) {
    stress.setLights(count);
    for (const lists::ListOptions& kind : kinds) {
      if (stop()) return;
      stress.run(kind);
      progress.advance();
    }
  }
}

}  // namespace sfumato::app
