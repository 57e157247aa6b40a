// The frame of `sfumato render` on the GPU.
#include <fmt/format.h>

#include <functional>
#include <map>

#include "app/display_gpu.h"
#include "app/shot.h"
#include "app/statistics_gpu.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/size_text.h"
#include "gl/device.h"
#include "pipelines/aovs_gpu.h"
#include "pipelines/list_prediction.h"
#include "pipelines/pipeline_gpu.h"

namespace sfumato::app {
namespace {

pipelines::FrameOptions frameOptions(const RenderOptions& options, const Shot& shot) {
  return {.aovs = shot.aovsToDraw(),
          .deep = !options.deep.empty(),
          .deepShadows = shot.deepShadows,
          .countLookups = !options.statistics.empty()};
}

// Draws the frame --repeat times; the profiler keeps the times of the last one.
pipelines::Frame drawFrames(gl::Device& device, pipelines::Pipeline& pipeline, const Shot& shot,
                            const RenderOptions& options, std::vector<double>& seconds) {
  pipelines::Quality quality = shot.quality;
  if (options.lists.empty()) quality.lists.strategy = lists::chooseStrategy(device);
  pipelines::Frame frame;
  const auto tiles = pipelines::tilesOf(options.width, options.height).size();
  base::Progress progress("rendering", options.repeat * static_cast<long>(tiles));
  pipelines::FrameOptions ofFrame = frameOptions(options, shot);
  ofFrame.onTile = [&] { progress.advance(); };
  for (int i = 0; i < options.repeat; ++i) {
    device.profiler().reset();
    const Clock::time_point start = Clock::now();
    frame = pipeline.render(shot.camera, options.width, options.height, quality, ofFrame);
    seconds.push_back(secondsSince(start));
  }
  return frame;
}

void warnOfProblems(gl::Device& device, const pipelines::FrameStatistics& statistics) {
  for (const std::string& message : device.debugMessages()) base::warn("driver: {}", message);
  if (statistics.cutWalks > 0)
    base::warn(
        "{} walks were longer than a bound and cut: the picture lacks light or smoke there: use a longer "
        "--step or fewer lights",
        statistics.cutWalks);
}

void noteShadowMaps(const pipelines::ShadowFigures& maps) {
  std::map<int, int, std::greater<>> lights;  // by resolution
  for (const int resolution : maps.resolutions)
    if (resolution > 0) ++lights[resolution];
  std::string resolutions;
  for (const auto& [resolution, count] : lights)
    resolutions += fmt::format("{}{} of {}", resolutions.empty() ? "" : ", ", count, resolution);
  if (resolutions.empty()) return base::note("shadow maps: none");
  base::note("shadow maps: {} texels a side{}: {} of {}{}", resolutions,
             maps.error > 0 ? fmt::format(", error bound {:.5f}", maps.error) : "",
             base::sizeText(maps.bytes), base::sizeText(maps.budgetBytes),
             maps.lowered ? ": coarser, to fit" : "");
}

}  // namespace

Drawn drawOnGpu(const RenderOptions& options, const Shot& shot, Clock::time_point start) {
  gl::Device device({.choice = options.device.device,
                     .debug = base::verbosity() == base::Verbosity::Verbose,
                     .shaderDir = options.device.shaderDir});
  base::note("device: {} ({})", device.names().renderer, device.names().platform);
  if (!options.statistics.empty()) device.profiler().enable();

  RunTimes times;
  const auto pipeline = pipelines::makePipeline(options.pipeline, device, shot.scene, shot.media,
                                                {.budgetBytes = shot.volumeMemory});
  pipeline->prepare(shot.camera, options.height, shot.quality, frameOptions(options, shot));
  times.startupPasses = device.profiler().times();
  times.startupSeconds = secondsSince(start);
  base::note("start-up: {:.2f} s", times.startupSeconds);

  pipelines::Frame frame = drawFrames(device, *pipeline, shot, options, times.frameSeconds);
  if (frame.aovs.empty() && !shot.aovsToDraw().empty()) {  // a pipeline that tells none by itself
    frame.aovs = pipelines::emptyImages(shot.aovsToDraw(), options.width, options.height);
    pipelines::drawSurfaceAovs(pipeline->scene(), shot.camera, frame.aovs);
  }
  Drawn drawn{std::move(frame.radiance), std::move(frame.aovs), std::move(frame.deep),
              std::move(frame.deepShadows), device.names().renderer};
  postProcess(device, options, shot, drawn);
  times.framePasses = device.profiler().times();
  base::note("frame: {:.2f} s", times.frameSeconds.back());
  noteShadowMaps(frame.statistics.shadowMaps);
  warnOfProblems(device, frame.statistics);
  if (options.statistics.empty()) return drawn;
  const pipelines::ListPrediction fromBounds = pipelines::predictLists(
      shot.scene, shot.media, shot.camera, options.width, options.height, shot.quality);
  drawn.statistics = statisticsText(device, frame.statistics, fromBounds, times);
  return drawn;
}

}  // namespace sfumato::app
