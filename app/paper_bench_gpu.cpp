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
#include "base/file.h"
#include "base/json_text.h"
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

// What is to be drawn, each once, by the scene and its size.
using SceneKey = std::tuple<PaperScene, size_t, size_t, int, int, int>;
std::map<SceneKey, std::set<PaperSetting>> settingsOf(const std::vector<PaperTable>& tables) {
  std::map<SceneKey, std::set<PaperSetting>> settings;
  for (const PaperTable& table : tables)
    for (const std::vector<PaperSetting>& row : table.settings)
      for (const PaperSetting& s : row)
        if (isThere(s)) settings[{s.scene, s.opaque, s.translucent, s.lights, s.width, s.height}].insert(s);
  return settings;
}

pipelines::Quality qualityOf(gl::Device& device, const PaperSetting& setting) {
  pipelines::Quality quality = pipelines::qualityNamed("medium");
  quality.samples = 1;
  quality.lists.strategy = lists::chooseStrategy(device);
  quality.shadowResolution = setting.shadowTexels;
  quality.exactShadowResolution = true;
  quality.deferred.storage = pipelines::Storage::Table;
  quality.deferred.shadows = setting.shadows;
  quality.deferred.layers = setting.layers;
  quality.deferred.refraction = setting.refraction ? refraction : 0;
  return quality;
}

// A scene with and without its translucent objects, and the pipelines that draw it.
class DrawnScene {
 public:
  explicit DrawnScene(gl::Device& device) : device_(device) {}

  TimedFrame draw(const PaperSetting& setting) {
    scene::GeneratedScene& made = scenes_[setting.drawsTranslucent];
    if (made.scene.cameras.empty()) made = sceneOf(setting);
    auto& pipeline = pipelines_[{setting.drawsTranslucent, setting.pipeline}];
    if (!pipeline) pipeline = pipelines::makePipeline(setting.pipeline, device_, made.scene, made.media);
    return timeFrame(*pipeline, made.scene.cameras.front(), setting.width, setting.height,
                     qualityOf(device_, setting));
  }

 private:
  gl::Device& device_;
  std::map<bool, scene::GeneratedScene> scenes_;
  std::map<std::pair<bool, std::string>, std::unique_ptr<pipelines::Pipeline>> pipelines_;
};

// The settings of a scene take turns, so that what else the machine does meets all of them alike. The first
// turn compiles what is needed.
void measure(gl::Device& device, const PapersOptions& options, PaperResult& result) {
  const auto scenes = settingsOf(result.tables);
  base::Progress progress("bench", static_cast<long>(scenes.size()) * (options.repeat + 1));
  for (const auto& [key, settings] : scenes) {
    DrawnScene drawn(device);
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

void tell(const PapersOptions& options, const PaperResult& result) {
  base::printResult(options.json ? base::jsonText(jsonOf(result)) : tableOf(result));
  if (options.report.empty()) return;
  image::Report report = reportOf(result);
  writePictures(result, options.report, report);
  base::writeFile(pageOf(options.report), image::reportPage(report));
  base::note("wrote {}", pageOf(options.report).string());
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
  tell(options, result);
  return static_cast<int>(base::ExitCode::Done);
}

}  // namespace sfumato::app
