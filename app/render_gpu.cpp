// `sfumato render`: files to a scene, the scene to a frame, the frame to files.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/options.h"
#include "app/statistics_gpu.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/version.h"
#include "gl/device.h"
#include "image/image_file.h"
#include "pipelines/linked_lists_gpu.h"
#include "scene/camera_view.h"
#include "scene/gltf.h"
#include "scene/media.h"
#include "scene/visible_hull.h"

namespace sfumato::app {

using base::ExitCode;
using base::fail;
using Clock = std::chrono::steady_clock;

namespace {

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

scene::Scene loadScene(const RenderOptions& options) {
  if (options.scene.empty())
    fail(ExitCode::Usage, "no scene: name a .gltf or .glb file, see `sfumato render --help`");
  scene::Scene scene = scene::readGltf(options.scene, options.timeSeconds);
  for (const std::string& file : options.volumes) {
    scene::VolumePlacement volume;
    volume.file = file;
    volume.gridName = options.grid;
    volume.scale = options.volumeScale;
    volume.albedo = options.volumeAlbedo;
    volume.g = options.volumeG;
    scene.volumes.push_back(volume);
  }
  return scene;
}

// A camera in front of everything, a little above it.
scene::Camera framingCamera(const scene::Scene& scene, double yfov) {
  glm::dvec3 low(scene::infinity);
  glm::dvec3 high(-scene::infinity);
  for (const glm::dvec3& p : scene::boundingPoints(scene, {})) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  if (low.x > high.x) return scene::lookAt({0, 1, 4}, {0, 1, 0}, yfov);
  const glm::dvec3 centre = (low + high) * 0.5;
  const double radius = std::max(glm::length(high - low) * 0.5, 1e-6);
  const glm::dvec3 away = glm::normalize(glm::dvec3(0.3, 0.35, 1.0)) * (radius / std::sin(yfov * 0.5));
  return scene::lookAt(centre + away, centre, yfov);
}

scene::Camera chooseCamera(const RenderOptions& options, const scene::Scene& scene) {
  std::optional<scene::Camera> chosen;
  for (const scene::Camera& camera : scene.cameras)
    if (!chosen && (options.camera.empty() || camera.name == options.camera)) chosen = camera;
  if (!options.camera.empty() && !chosen) {
    std::string names;
    for (const scene::Camera& camera : scene.cameras) names += " " + camera.name;
    fail(ExitCode::Usage, "--camera {}: no such camera: the scene has{}", options.camera,
         names.empty() ? " none" : names);
  }
  scene::Camera camera = chosen ? *chosen : framingCamera(scene, 0.7);
  if (options.fovDegrees) {
    camera.yfov = glm::radians(*options.fovDegrees);
    camera.orthographic = false;
    if (!chosen) camera = framingCamera(scene, camera.yfov);
  }
  if (options.lookFrom || options.lookAt) {
    const glm::dvec3 from = options.lookFrom.value_or(glm::dvec3(camera.worldFromView[3]));
    const glm::dvec3 forward = -glm::dvec3(camera.worldFromView[2]);
    const glm::dvec3 at = options.lookAt.value_or(from + forward);
    if (glm::length(at - from) < 1e-9)
      fail(ExitCode::Usage, "--look-at is where --look-from is: choose two points");
    camera.worldFromView = scene::lookAt(from, at, camera.yfov).worldFromView;
  }
  return camera;
}

pipelines::Quality chooseQuality(const RenderOptions& options) {
  pipelines::Quality quality = pipelines::qualityNamed(options.quality);
  if (options.stepVoxels) quality.stepVoxels = *options.stepVoxels;
  if (options.shadowResolution) quality.shadowResolution = *options.shadowResolution;
  return quality;
}

image::Image exposed(image::Image image, double stops) {
  const auto factor = static_cast<float>(std::exp2(stops));
  for (float& value : image.values) value *= factor;
  return image;
}

image::Metadata metadata(const RenderOptions& options, const gl::Device& device,
                         const pipelines::Quality& quality) {
  return {{"Software", fmt::format("sfumato {}", base::version())},
          {"sfumato:device", device.names().renderer},
          {"sfumato:scene", options.scene},
          {"sfumato:quality", options.quality},
          {"sfumato:step_voxels", fmt::format("{}", quality.stepVoxels)},
          {"sfumato:shadow_resolution", fmt::format("{}", quality.shadowResolution)},
          {"sfumato:shadow_error", fmt::format("{}", quality.shadowError)}};
}

void printPlan(const RenderOptions& options, const scene::Scene& scene, const pipelines::Quality& quality) {
  size_t triangles = 0;
  for (const scene::Instance& instance : scene.instances)
    triangles += scene.meshes[static_cast<size_t>(instance.mesh)].indices.size() / 3;
  fmt::print("scene    {}: {} instances, {} triangles, {} materials, {} lights\n", options.scene,
             scene.instances.size(), triangles, scene.materials.size(), scene.lights.size());
  for (const scene::VolumePlacement& volume : scene.volumes)
    fmt::print("volume   {} {}\n", volume.file, volume.gridName);
  fmt::print("frame    {}x{}, quality {}: step {} voxels, shadow maps {} texels a side, error bound {:.5f}\n",
             options.width, options.height, options.quality, quality.stepVoxels, quality.shadowResolution,
             quality.shadowError);
  for (const std::string& output : options.outputs) fmt::print("output   {}\n", output);
}

}  // namespace

int render(const RenderOptions& options) {
  const Clock::time_point start = Clock::now();
  for (const std::string& output : options.outputs) {
    image::checkImageName(output);
    if (!options.dryRun) base::checkWritable(output);
  }
  if (!options.statistics.empty() && !options.dryRun) base::checkWritable(options.statistics);

  const scene::Scene scene = loadScene(options);
  const scene::Camera camera = chooseCamera(options, scene);
  const pipelines::Quality quality = chooseQuality(options);
  if (options.dryRun) {
    printPlan(options, scene, quality);
    return 0;
  }
  if (scene.lights.empty())
    base::warn("{}: no lights: the picture will be black but for what glows", options.scene);
  const std::vector<volumes::Medium> media = scene::readMedia(scene);

  const bool debug = base::verbosity() == base::Verbosity::Verbose;
  gl::Device device({.choice = options.common.device, .debug = debug, .shaderDir = options.common.shaderDir});
  base::note("device: {} ({})", device.names().renderer, device.names().platform);
  if (!options.statistics.empty()) device.profiler().enable();

  RunTimes times;
  pipelines::LinkedListsPipeline pipeline(device, scene, media);
  times.startupPasses = device.profiler().times();
  times.startupSeconds = secondsSince(start);
  base::note("start-up: {:.2f} s", times.startupSeconds);

  base::Progress progress("rendering", options.repeat);
  pipelines::Frame frame;
  for (int i = 0; i < options.repeat; ++i) {
    device.profiler().reset();
    const Clock::time_point frameStart = Clock::now();
    frame = pipeline.render(camera, options.width, options.height, quality);
    times.frameSeconds.push_back(secondsSince(frameStart));
    progress.advance();
  }
  times.framePasses = device.profiler().times();
  base::note("frame: {:.2f} s", times.frameSeconds.back());
  for (const std::string& message : device.debugMessages()) base::warn("driver: {}", message);
  if (frame.statistics.cutWalks > 0)
    base::warn(
        "{} walks were longer than a bound and cut: the picture lacks light or smoke there: use a longer "
        "--step or fewer lights",
        frame.statistics.cutWalks);

  const image::Metadata settings = metadata(options, device, quality);
  for (const std::string& output : options.outputs) {
    const bool display = std::filesystem::path(output).extension() == ".png";
    image::writeImage(output, display ? exposed(frame.radiance, options.exposureStops) : frame.radiance,
                      settings);
    base::note("wrote {}", output);
  }
  if (!options.statistics.empty())
    base::writeFile(options.statistics, statisticsJson(device, frame.statistics, times).dump(2) + "\n");
  return 0;
}

}  // namespace sfumato::app
