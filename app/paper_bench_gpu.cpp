// `sfumato bench papers`: the performance tests of Aladagli 2015 and Ferko 2012 on scenes of their sizes.
#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <tuple>

#include "app/frame_times_gpu.h"
#include "app/paper_bench.h"
#include "app/report_file.h"
#include "app/shot.h"
#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "gl/device.h"
#include "pipelines/pipeline_names.h"

namespace sfumato::app {
namespace {

constexpr double refraction = 0.02;  // of the image's height

bool isThere(const PaperSetting& setting) {
  const auto& names = pipelines::pipelineNames();
  return std::ranges::find(names, setting.pipeline) != names.end();
}

// What is to be drawn, each once, by what it is compared with: of one scene, lights and size.
using GroupKey = std::tuple<PaperScene, int, int, int>;
std::map<GroupKey, std::set<PaperSetting>> settingsOf(const std::vector<PaperTable>& tables) {
  std::map<GroupKey, std::set<PaperSetting>> settings;
  for (const PaperTable& table : tables)
    for (const std::vector<PaperSetting>& row : table.settings)
      for (const PaperSetting& s : row)
        if (isThere(s)) settings[{s.scene, s.lights, s.width, s.height}].insert(s);
  return settings;
}

// Ferko 2012, section 7: the size of the occlusion, and the samples of the A-buffer, which a device may not
// have.
constexpr pipelines::OcclusionSize occlusionSizes[] = {
    pipelines::OcclusionSize::Quarter, pipelines::OcclusionSize::Half, pipelines::OcclusionSize::Full};
constexpr int bufferSamples[] = {4, 8, 8};

pipelines::Quality qualityOf(gl::Device& device, const PaperSetting& setting, const scene::Scene& scene) {
  pipelines::Quality quality = pipelines::qualityNamed("medium");
  quality.samples = 1;
  quality.lists.strategy = lists::chooseStrategy(device);
  quality.shadowResolution = setting.shadowTexels;
  quality.exactShadowResolution = true;
  quality.deferred.storage = pipelines::Storage::Table;
  quality.deferred.shadows = setting.shadows;
  quality.deferred.layers = setting.layers;
  quality.deferred.refraction = setting.refraction ? refraction : 0;
  quality.deferred.samples = bufferSamples[setting.preset];
  if (setting.ambientOcclusion)
    quality.ambientOcclusion = {occlusionSizes[setting.preset], pipelines::usualOcclusionRadius(scene)};
  return quality;
}

// The scenes of a group, and the pipelines that draw them.
class DrawnScenes {
 public:
  explicit DrawnScenes(gl::Device& device) : device_(device) {}

  TimedFrame draw(const PaperSetting& setting) {
    Drawn& drawn = drawn_[{setting.opaque, setting.translucent, setting.drawsTranslucent}];
    if (drawn.made.scene.cameras.empty()) drawn.made = sceneOf(setting);
    auto& pipeline = drawn.pipelines[setting.pipeline];
    if (!pipeline)
      pipeline = pipelines::makePipeline(setting.pipeline, device_, drawn.made.scene, drawn.made.media);
    return timeFrame(*pipeline, drawn.made.scene.cameras.front(), setting.width, setting.height,
                     qualityOf(device_, setting, drawn.made.scene));
  }

 private:
  struct Drawn {
    scene::GeneratedScene made;
    std::map<std::string, std::unique_ptr<pipelines::Pipeline>> pipelines;
  };
  gl::Device& device_;
  std::map<std::tuple<size_t, size_t, bool>, Drawn> drawn_;
};

// The settings of a group take turns, so that what else the machine does meets all of them alike. The first
// turn compiles what is needed.
void measure(gl::Device& device, const PapersOptions& options, PaperResult& result) {
  const auto groups = settingsOf(result.tables);
  base::Progress progress("bench", static_cast<long>(groups.size()) * (options.repeat + 1));
  for (const auto& [key, settings] : groups) {
    DrawnScenes drawn(device);
    for (int turn = 0; turn <= options.repeat; ++turn) {
      for (const PaperSetting& setting : settings) {
        TimedFrame timed = drawn.draw(setting);
        if (turn > 0) result.milliseconds[setting].push_back(timed.milliseconds);
        result.pictures[nameOf(setting)] = std::move(timed.frame.radiance);
      }
      progress.advance();
    }
  }
}

}  // namespace

int benchPapers(const PapersOptions& options) {
  const Clock::time_point start = Clock::now();
  checkReport(options.report);
  gl::Device device({.choice = options.device.device, .shaderDir = options.device.shaderDir});
  base::note("device: {} ({})", device.names().renderer, device.names().platform);
  PaperResult result{.device = device.names().renderer,
                     .commandLine = options.commandLine,
                     .width = options.width,
                     .height = options.height,
                     .tables = plannedTables(options)};
  measure(device, options, result);
  result.seconds = secondsSince(start);
  tell(result, options.json, options.report);
  return static_cast<int>(base::ExitCode::Done);
}

}  // namespace sfumato::app
