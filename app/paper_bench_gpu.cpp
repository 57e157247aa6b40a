// `sfumato bench papers`: the performance tests of Aladagli 2015 and Ferko 2012 on scenes of their sizes.
#include <algorithm>
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

// What is to be drawn, each once, scene by scene.
std::set<PaperSetting> settingsOf(const std::vector<PaperTable>& tables) {
  std::set<PaperSetting> settings;
  for (const PaperTable& table : tables)
    for (const std::vector<PaperSetting>& row : table.settings)
      for (const PaperSetting& setting : row)
        if (isThere(setting)) settings.insert(setting);
  return settings;
}

bool sameScene(const PaperSetting& a, const PaperSetting& b) {
  const auto key = [](const PaperSetting& s) {
    return std::tuple(s.scene, s.opaque, s.translucent, s.drawsTranslucent, s.lights, s.width, s.height);
  };
  return key(a) == key(b);
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

void measure(gl::Device& device, const PapersOptions& options, PaperResult& result) {
  const std::set<PaperSetting> settings = settingsOf(result.tables);
  base::Progress progress("bench", static_cast<long>(settings.size()));
  scene::GeneratedScene made;
  const PaperSetting* last = nullptr;
  for (const PaperSetting& setting : settings) {
    if (last == nullptr || !sameScene(*last, setting)) made = sceneOf(setting);
    last = &setting;
    const auto pipeline = pipelines::makePipeline(setting.pipeline, device, made.scene, made.media);
    TimedFrames frames = timeFrames(*pipeline, made.scene.cameras.front(), setting.width, setting.height,
                                    qualityOf(device, setting), options.repeat);
    result.milliseconds[setting] = std::move(frames.milliseconds);
    result.pictures[nameOf(setting)] = std::move(frames.last.radiance);
    progress.advance();
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
