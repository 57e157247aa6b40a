// `sfumato render`: files to a scene, the scene to a frame, the frame to files.
#include <fmt/format.h>
#include <strings.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <set>

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
  scene::Scene scene = scene::readGltf(options.scene);
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
scene::Camera framingCamera(const scene::Scene& scene, const std::vector<volumes::Medium>& media, double yfov,
                            double aspect) {
  std::vector<glm::dmat4> mediaBoxes;
  for (const volumes::Medium& medium : media) mediaBoxes.push_back(volumes::worldFromUnit(medium));
  glm::dvec3 low(scene::infinity);
  glm::dvec3 high(-scene::infinity);
  for (const glm::dvec3& p : scene::boundingPoints(scene, mediaBoxes)) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  if (low.x > high.x) return scene::lookAt({0, 1, 4}, {0, 1, 0}, yfov);
  const glm::dvec3 centre = (low + high) * 0.5;
  const double radius = std::max(glm::length(high - low) * 0.5, 1e-6);
  const double narrowest = std::atan(std::tan(yfov * 0.5) * std::min(aspect, 1.0));
  const glm::dvec3 away = glm::normalize(glm::dvec3(0.3, 0.35, 1.0)) * (radius / std::sin(narrowest));
  scene::Camera camera = scene::lookAt(centre + away, centre, yfov);
  camera.nearDistance = radius * 1e-3;
  return camera;
}

// The camera that --camera names, the first one, or nothing.
const scene::Camera* cameraOfScene(const RenderOptions& options, const scene::Scene& scene) {
  if (options.camera.empty()) return scene.cameras.empty() ? nullptr : &scene.cameras.front();
  std::vector<std::string> names;
  for (const scene::Camera& camera : scene.cameras) {
    if (camera.name == options.camera) return &camera;
    names.push_back("\"" + camera.name + "\"");
  }
  fail(ExitCode::Usage, "--camera: no camera \"{}\" in {}: {}", options.camera, options.scene,
       names.empty() ? "it has none, leave --camera out"
                     : fmt::format("choose one of {}", fmt::join(names, ", ")));
}

scene::Camera chooseCamera(const RenderOptions& options, const scene::Scene& scene,
                           const std::vector<volumes::Medium>& media) {
  const double aspect = static_cast<double>(options.width) / options.height;
  const double yfov = glm::radians(options.fovDegrees.value_or(40));
  const scene::Camera* chosen = cameraOfScene(options, scene);
  scene::Camera camera = chosen ? *chosen : framingCamera(scene, media, yfov, aspect);
  if (options.fovDegrees) {
    camera.yfov = yfov;
    camera.orthographic = false;
  }
  if (options.lookFrom || options.lookAt) {
    const glm::dvec3 from = options.lookFrom.value_or(glm::dvec3(camera.worldFromView[3]));
    const glm::dvec3 forward = -glm::dvec3(camera.worldFromView[2]);
    const glm::dvec3 at = options.lookAt.value_or(from + forward);
    if (glm::length(at - from) < 1e-9)
      fail(ExitCode::Usage, "--look-at: is where the camera stands: choose two points");
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

// Where a file is, whatever it is called.
std::filesystem::path placeOf(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(std::filesystem::absolute(file, ignored), ignored);
}

// Every output is checked before the long work: it can be written, and is no other file of this run.
void checkOutputs(const RenderOptions& options) {
  if (options.outputs.empty() && !options.dryRun)
    fail(ExitCode::Usage, "render: no output: name an image with -o, e.g. -o {}.png",
         std::filesystem::path(options.scene).stem().string());
  std::vector<std::string> outputs = options.outputs;
  for (const std::string& output : outputs) image::checkImageName(output);
  if (!options.statistics.empty()) outputs.push_back(options.statistics);
  std::set<std::filesystem::path> places = {placeOf(options.scene)};
  for (const std::string& volume : options.volumes) places.insert(placeOf(volume));
  for (const std::string& output : outputs) {
    if (!places.insert(placeOf(output)).second)
      fail(ExitCode::Usage, "{}: is named twice: give the output another name", output);
    if (!options.dryRun) base::checkWritable(output);
  }
}

void printPlan(const RenderOptions& options, const scene::Scene& scene,
               const std::vector<volumes::Medium>& media, const pipelines::Quality& quality) {
  size_t triangles = 0;
  for (const scene::Instance& instance : scene.instances)
    triangles += scene.meshes[static_cast<size_t>(instance.mesh)].indices.size() / 3;
  base::print("scene    {}: instances {}, triangles {}, materials {}, lights {}\n", options.scene,
              scene.instances.size(), triangles, scene.materials.size(), scene.lights.size());
  for (size_t i = 0; i < media.size(); ++i) {
    const volumes::DensityGrid& grid = media[i].grid;
    base::print("volume   {}: grid \"{}\", {} x {} x {} voxels, {:.1f} MiB\n", scene.volumes[i].file,
                grid.name, grid.size.x, grid.size.y, grid.size.z,
                static_cast<double>(grid.values.size() * sizeof(float)) / 0x1p20);
  }
  const scene::Camera* camera = cameraOfScene(options, scene);
  base::print("camera   {}\n", camera ? "\"" + camera->name + "\"" : "placed so that it sees everything");
  base::print(
      "frame    {}x{}, quality {}: step {} voxels, shadow maps {} texels a side, error bound {:.5f}\n",
      options.width, options.height, options.quality, quality.stepVoxels, quality.shadowResolution,
      quality.shadowError);
  for (const std::string& output : options.outputs) base::print("output   {}\n", output);
  if (!options.statistics.empty()) base::print("output   {}\n", options.statistics);
}

struct Drawn {
  pipelines::Frame frame;
  std::vector<double> seconds;  // wall clock of each
};

// Draws the frame --repeat times; the profiler keeps the times of the last one.
Drawn drawFrames(gl::Device& device, pipelines::LinkedListsPipeline& pipeline, const scene::Camera& camera,
                 const RenderOptions& options, const pipelines::Quality& quality) {
  Drawn drawn;
  base::Progress progress("rendering", options.repeat);
  for (int i = 0; i < options.repeat; ++i) {
    device.profiler().reset();
    const Clock::time_point start = Clock::now();
    drawn.frame = pipeline.render(camera, options.width, options.height, quality);
    drawn.seconds.push_back(secondsSince(start));
    progress.advance();
  }
  return drawn;
}

void writeOutputs(const RenderOptions& options, const image::Image& radiance,
                  const image::Metadata& settings) {
  for (const std::string& output : options.outputs) {
    const bool display = strcasecmp(std::filesystem::path(output).extension().c_str(), ".png") == 0;
    image::writeImage(output, display ? exposed(radiance, options.exposureStops) : radiance, settings);
    base::note("wrote {}", output);
  }
}

}  // namespace

int render(const RenderOptions& options) {
  const Clock::time_point start = Clock::now();
  if (options.scene.empty()) fail(ExitCode::Usage, "render: no scene: name a .gltf or .glb file");
  checkOutputs(options);
  const scene::Scene scene = loadScene(options);
  const std::vector<volumes::Medium> media = scene::readMedia(scene);
  const scene::Camera camera = chooseCamera(options, scene, media);
  const pipelines::Quality quality = chooseQuality(options);
  if (scene.lights.empty())
    base::warn("{}: no lights: the picture will be black but for what glows", options.scene);
  if (options.dryRun) {
    printPlan(options, scene, media, quality);
    return 0;
  }

  const bool debug = base::verbosity() == base::Verbosity::Verbose;
  gl::Device device({.choice = options.common.device, .debug = debug, .shaderDir = options.common.shaderDir});
  base::note("device: {} ({})", device.names().renderer, device.names().platform);
  if (!options.statistics.empty()) device.profiler().enable();

  RunTimes times;
  pipelines::LinkedListsPipeline pipeline(device, scene, media);
  times.startupPasses = device.profiler().times();
  times.startupSeconds = secondsSince(start);
  base::note("start-up: {:.2f} s", times.startupSeconds);

  const Drawn drawn = drawFrames(device, pipeline, camera, options, quality);
  const pipelines::FrameStatistics& statistics = drawn.frame.statistics;
  times.frameSeconds = drawn.seconds;
  times.framePasses = device.profiler().times();
  base::note("frame: {:.2f} s", times.frameSeconds.back());
  for (const std::string& message : device.debugMessages()) base::warn("driver: {}", message);
  if (statistics.cutWalks > 0)
    base::warn(
        "{} walks were longer than a bound and cut: the picture lacks light or smoke there: use a longer "
        "--step or fewer lights",
        statistics.cutWalks);

  writeOutputs(options, drawn.frame.radiance, metadata(options, device, quality));
  if (!options.statistics.empty()) {
    base::writeFile(options.statistics, statisticsText(device, statistics, times));
    base::note("wrote {}", options.statistics);
  }
  return 0;
}

}  // namespace sfumato::app
