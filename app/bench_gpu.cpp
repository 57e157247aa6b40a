// `sfumato bench pipelines`: one scene, drawn in every way, and held against the exact answer.
#include <fmt/format.h>

#include <algorithm>

#include "app/bench.h"
#include "app/frame_times_gpu.h"
#include "app/report_file.h"
#include "app/shot.h"
#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "gl/device.h"
#include "image/image_file.h"
#include "pipelines/reference.h"
#include "scene/generated_scenes.h"

namespace sfumato::app {
namespace {

using base::ExitCode;
using pipelines::Aov;

constexpr int smokeVoxels = 96;

// More rays to lights than this would take the CPU minutes.
constexpr size_t mostReferenceRays = 2'000'000;

Shot shotOf(const BenchOptions& options) {
  if (isOfScene(options.shot)) return makeShot(options.shot);
  checkWithoutScene(options.shot);
  scene::GeneratedScene made =
      scene::layersScene(static_cast<double>(options.shot.width) / options.shot.height, smokeVoxels);
  Shot shot{.scene = std::move(made.scene), .media = std::move(made.media)};
  shot.camera = shot.scene.cameras.front();
  shot.quality = chooseQuality(options.shot);
  return shot;
}

std::string sceneName(const RenderOptions& options) {
  if (!options.scene.empty()) return options.scene;
  return isOfScene(options) ? "default set" : "1, 2, 4 and 8 panes and smoke (generated)";
}

struct Exact {
  image::Image radiance;
  image::Image layers;
  std::string by;
};

// One ray through each pixel's centre, as the pipelines have it.
Exact exactByReference(const BenchOptions& options, const Shot& shot) {
  pipelines::ReferenceFrame frame =
      pipelines::traceReference(shot.scene, shot.camera, shot.media,
                                {.width = options.shot.width,
                                 .height = options.shot.height,
                                 .scatteringOctaves = shot.quality.scatteringOctaves,
                                 .showProgress = true,
                                 .aovs = {Aov::Fragments}});
  return {std::move(frame.radiance), std::move(frame.aovs.at(Aov::Fragments)),
          "CPU reference, one ray through the centre of each pixel"};
}

Exact exactByLund(gl::Device& device, const BenchOptions& options, const Shot& shot) {
  pipelines::Quality quality = pipelines::qualityNamed("reference");
  quality.samples = 1;
  quality.scatteringOctaves = shot.quality.scatteringOctaves;
  quality.lists = shot.quality.lists;
  const auto pipeline =
      pipelines::makePipeline("lund", device, shot.scene, shot.media, {.budgetBytes = shot.volumeMemory});
  pipelines::Frame frame = pipeline->render(shot.camera, options.shot.width, options.shot.height, quality,
                                            {.aovs = {Aov::Fragments}});
  return {std::move(frame.radiance), std::move(frame.aovs.at(Aov::Fragments)),
          "lund at --quality reference, one sample at the centre of each pixel"};
}

bool takesReference(const BenchOptions& options, const Shot& shot) {
  if (options.exact != "auto") return options.exact == "cpu";
  const auto pixels = static_cast<size_t>(options.shot.width) * static_cast<size_t>(options.shot.height);
  return pixels * (shot.scene.lights.size() + 1) <= mostReferenceRays;
}

// The passes that do not consist of others.
std::vector<PassCalls> leavesOf(const std::vector<gl::PassTime>& times) {
  std::vector<PassCalls> leaves;
  for (const gl::PassTime& time : times)
    if (std::ranges::none_of(times,
                             [&](const auto& other) { return other.name.starts_with(time.name + "/"); }))
      leaves.push_back({time.name, time.calls, time.wallMilliseconds});
  return leaves;
}

// What a frame adds to what was there when the ledger's peaks were restarted.
std::map<std::string, size_t> addedPeaks(const gl::MemoryLedger& memory,
                                         const std::map<std::string, size_t>& before) {
  std::map<std::string, size_t> added;
  for (const auto& [label, peak] : memory.peakBytesByLabel()) {
    const auto there = before.find(label);
    const size_t bytes = peak - (there == before.end() ? 0 : there->second);
    if (bytes > 0) added.emplace(label, bytes);
  }
  return added;
}

void draw(gl::Device& device, const BenchOptions& options, const Shot& shot, VariantRun& run) {
  pipelines::Quality quality = shot.quality;
  quality.deferred = run.variant.deferred;
  const int width = options.shot.width, height = options.shot.height;
  const auto pipeline = pipelines::makePipeline(run.variant.pipeline, device, shot.scene, shot.media,
                                                {.budgetBytes = shot.volumeMemory});
  pipeline->render(shot.camera, width, height, quality);  // compiles what is needed
  for (int i = 0; i < options.repeat; ++i) {
    TimedFrame timed = timeFrame(*pipeline, shot.camera, width, height, quality);
    run.radiance = std::move(timed.frame.radiance);
    run.milliseconds.push_back(timed.milliseconds);
  }
  // One more, whose passes are waited for one by one, and whose memory is counted.
  device.profiler().reset();
  device.profiler().enable();
  device.memory().restartPeaks();
  const auto before = device.memory().peakBytesByLabel();
  run.sceneBytes = device.memory().bytes();
  pipeline->render(shot.camera, width, height, quality);
  run.frameBytes = device.memory().peakBytes() - run.sceneBytes;
  run.frameBytesByLabel = addedPeaks(device.memory(), before);
  run.passes = leavesOf(device.profiler().times());
  device.profiler().enable(false);
}

// What a pipeline cannot do, within its memory or at all, is a result here.
VariantRun runOf(gl::Device& device, const BenchOptions& options, const Shot& shot, const Exact& exact,
                 const Variant& variant) {
  VariantRun run{.variant = variant};
  try {
    draw(device, options, shot, run);
  } catch (const base::Error& error) {
    if (error.exitCode != ExitCode::Memory && error.exitCode != ExitCode::Usage) throw;
    return {.variant = variant, .refused = error.what(), .refusal = error.exitCode};
  }
  run.difference = image::compare(run.radiance, exact.radiance);
  if (image::readsAndWritesImages()) run.perceptual = image::perceptualFailures(run.radiance, exact.radiance);
  run.layers = errorsByLayers(run.radiance, exact.radiance, exact.layers);
  return run;
}

}  // namespace

int bench(const BenchOptions& options) {
  checkReport(options.report);
  Shot shot = shotOf(options);
  gl::Device device({.choice = options.shot.device.device, .shaderDir = options.shot.device.shaderDir});
  base::note("device: {} ({})", device.names().renderer, device.names().platform);
  shot.quality.samples = 1;  // as the exact answer has
  shot.quality.lists.strategy = lists::chooseStrategy(device);

  Comparison comparison{.device = device.names().renderer,
                        .commandLine = options.shot.commandLine,
                        .scene = sceneName(options.shot),
                        .quality = options.shot.quality,
                        .width = options.shot.width,
                        .height = options.shot.height};
  const Clock::time_point start = Clock::now();
  const Exact exact =
      takesReference(options, shot) ? exactByReference(options, shot) : exactByLund(device, options, shot);
  comparison.exactMilliseconds = 1000 * secondsSince(start);
  comparison.exact = exact.radiance;
  comparison.exactBy = exact.by;

  const std::vector<Variant> variants = variantsOf(options.pipelines, shot.quality.deferred);
  base::Progress progress("bench", static_cast<long>(variants.size()));
  for (const Variant& variant : variants) {
    comparison.runs.push_back(runOf(device, options, shot, exact, variant));
    progress.advance();
  }
  tell(comparison, options.json, options.report);
  const auto refused =
      std::ranges::find_if(comparison.runs, [](const auto& run) { return !run.refused.empty(); });
  return static_cast<int>(refused == comparison.runs.end() ? ExitCode::Done : refused->refusal);
}

}  // namespace sfumato::app
