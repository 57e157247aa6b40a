// `sfumato render`: files to a scene, the scene to a frame, the frame to files.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <tuple>

#include "app/aov_files.h"
#include "app/deep_files.h"
#include "app/display.h"
#include "app/options.h"
#include "app/shot.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/log.h"
#include "base/size_text.h"
#include "base/version.h"
#include "image/image_file.h"
#include "pipelines/list_prediction.h"
#include "pipelines/pipeline_names.h"
#include "pipelines/reference.h"
#include "scene/camera_view.h"
#include "scene/default_set.h"
#include "scene/gltf.h"
#include "scene/media.h"
#include "scene/visible_hull.h"

namespace sfumato::app {

using base::ExitCode;
using base::fail;

namespace {

double aspectOf(const RenderOptions& options) {
  return static_cast<double>(options.width) / options.height;
}

double yfovOf(const RenderOptions& options) {
  return glm::radians(options.fovDegrees.value_or(40));
}

scene::FirePlacement fireOf(const RenderOptions& options) {
  scene::FirePlacement fire{options.fire, volumes::usualLook(options.fire), options.fireLights};
  if (options.fireKelvin) fire.look = {.kelvin = options.fireKelvin};
  fire.look.strength = options.fireStrength;
  return fire;
}

// Of a volume, for the metadata.
std::string fireText(const scene::FirePlacement& fire) {
  if (fire.gridName.empty()) return "";
  return fmt::format(
      ", fire \"{}\", {}, strength {}, lights {}", fire.gridName,
      fire.look.kelvin ? fmt::format("{} K per unit", *fire.look.kelvin) : std::string("colours"),
      fire.look.strength, fire.lights);
}

void addVolumes(const RenderOptions& options, scene::Scene& scene) {
  for (const std::string& file : options.volumes) {
    scene::VolumePlacement volume;
    volume.file = file;
    volume.gridName = options.grid;
    volume.scale = options.volumeScale.value_or(1);
    volume.extinctionColour = options.volumeExtinction;
    volume.albedo = options.volumeAlbedo;
    volume.g = options.volumeG;
    if (!options.fire.empty()) volume.fire = fireOf(options);
    scene.volumes.push_back(volume);
  }
}

// Smoke without a scene: an extinction scale that shows it, and a set around it.
void addDefaults(const RenderOptions& options, scene::Scene& scene, std::vector<volumes::Medium>& media) {
  for (size_t i = 0; i < media.size() && !options.volumeScale; ++i) {
    media[i].scale = scene.volumes[i].scale = scene::fittingScale(media[i]);
    base::note("{}: --volume-scale {:.4g} chosen, for an optical depth of about {}", scene.volumes[i].file,
               media[i].scale, scene::fittingOpticalDepth);
  }
  scene::addDefaultSet(scene, scene::boundsOf(media), yfovOf(options), aspectOf(options));
}

bool glows(const scene::Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [](const scene::Material& material) {
    return material.unlit || material.emissive != glm::vec3(0.f);
  });
}

// Sets come without lights as often as with them.
void lightTheDark(const RenderOptions& options, scene::Scene& scene) {
  if (!scene.lights.empty()) return;
  if (scene.ambient != glm::dvec3(0)) {
    if (!scene.volumes.empty())
      base::warn(
          "{}: no lights but the ambient one, of which smoke scatters nothing: put lights into the file",
          options.scene);
  } else if (glows(scene)) {
    base::warn("{}: no lights: only what glows is seen", options.scene);
  } else {
    scene::addDefaultLights(scene);
    base::warn("{}: no lights: two directional ones are added: put lights into the file to choose them",
               options.scene);
  }
}

pipelines::AmbientOcclusionOptions chooseOcclusion(const RenderOptions& options, const scene::Scene& scene) {
  const pipelines::OcclusionSize size = pipelines::occlusionSizes().named(options.ambientOcclusion);
  if (size == pipelines::OcclusionSize::Off) return {};
  if (scene.ambient == glm::dvec3(0))
    base::warn("--ssao: there is no ambient light to take from: give some with --ambient");
  return {size, options.ambientOcclusionRadius.value_or(pipelines::usualOcclusionRadius(scene))};
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
  const double yfov = yfovOf(options);
  const scene::Camera* chosen = cameraOfScene(options, scene);
  scene::Camera camera =
      chosen ? *chosen : scene::framingCamera(boundsOf(scene, media), yfov, aspectOf(options));
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

pipelines::DeferredOptions deferredOf(const RenderOptions& options) {
  pipelines::DeferredOptions deferred;
  if (!options.shadows.empty()) deferred.shadows = pipelines::shadowKinds().named(options.shadows);
  deferred.interlace = pipelines::interlaces().named(options.interlace);
  deferred.storage = pipelines::storages().named(options.storage);
  deferred.passes = pipelines::passesNames().named(options.passes);
  deferred.layers = options.layers;
  deferred.samples = options.routedSamples;
  deferred.refraction = options.refraction;
  return deferred;
}

}  // namespace

pipelines::Quality chooseQuality(const RenderOptions& options) {
  pipelines::Quality quality = pipelines::qualityNamed(options.quality);
  if (options.stepVoxels) quality.stepVoxels = *options.stepVoxels;
  quality.shadowResolution =
      options.shadowResolution.value_or(options.mostShadowResolution.value_or(quality.shadowResolution));
  quality.exactShadowResolution = options.shadowResolution.has_value();
  quality.shadowError = options.shadowError.value_or(quality.shadowError);
  quality.exactShadowError = options.shadowError.has_value();
  if (!options.shadowFilter.empty())
    quality.surfaceShadows = quality.smokeShadows = pipelines::shadowFilters().named(options.shadowFilter);
  if (!options.shadowMemory.empty())
    quality.shadowMemory = base::bytesNamed(options.shadowMemory, "--shadow-memory");
  quality.scatteringOctaves = options.scatteringOctaves;
  quality.depthsFirst = options.depthsFirst;
  quality.smokeRaySpacing = options.smokeSpacing.value_or(quality.smokeRaySpacing);
  quality.halfResolutionSmoke = options.halfResolutionSmoke;
  if (!options.lists.empty()) quality.lists.strategy = lists::strategyNamed(options.lists);
  if (!options.listMemory.empty())
    quality.lists.budgetBytes = base::bytesNamed(options.listMemory, "--list-memory");
  quality.lists.onOverflow = lists::onOverflowNamed(options.onOverflow);
  quality.deferred = deferredOf(options);
  return quality;
}

namespace {

std::string numbers(const glm::dvec3& v) {
  return fmt::format("{} {} {}", v.x + 0.0, v.y + 0.0, v.z + 0.0);  // + 0.0: none is shown as -0
}

// Everything that makes the picture what it is, and nothing of when and where: the same run makes the same
// file.
image::Metadata metadata(const RenderOptions& options, const Shot& shot, const std::string& device) {
  const scene::Camera& camera = shot.camera;
  image::Metadata result = {{"Software", fmt::format("sfumato {}", base::version())},
                            {"sfumato:device", device},
                            {"sfumato:command_line", options.commandLine},
                            {"sfumato:scene", options.scene.empty() ? "default set" : options.scene},
                            {"sfumato:size", fmt::format("{}x{}", options.width, options.height)},
                            {"sfumato:pipeline", options.pipeline},
                            {"sfumato:quality", options.quality},
                            {"sfumato:step_voxels", fmt::format("{}", shot.quality.stepVoxels)},
                            {"sfumato:scattering_octaves", fmt::format("{}", options.scatteringOctaves)},
                            {"sfumato:exposure_stops", fmt::format("{}", options.display.exposureStops)},
                            {"sfumato:camera_position", numbers(camera.worldFromView[3])},
                            {"sfumato:camera_direction", numbers(-glm::dvec3(camera.worldFromView[2]))},
                            {"sfumato:camera_up", numbers(camera.worldFromView[1])},
                            camera.orthographic ? std::pair{std::string("sfumato:camera_height_metres"),
                                                            fmt::format("{}", 2 * camera.yMagnitude)}
                                                : std::pair{std::string("sfumato:camera_fov_degrees"),
                                                            fmt::format("{}", glm::degrees(camera.yfov))}};
  if (options.reference) {
    result.emplace_back("sfumato:samples", fmt::format("{}", options.samples * options.samples));
  } else {
    result.emplace_back("sfumato:samples_at_edges", fmt::format("{}", shot.quality.samples));
    result.emplace_back("sfumato:shadow_resolution", fmt::format("{}", shot.quality.shadowResolution));
    result.emplace_back("sfumato:shadow_error", fmt::format("{}", shot.quality.shadowError));
    result.emplace_back("sfumato:shadow_filter",
                        fmt::format("{} on surfaces, {} in smoke",
                                    pipelines::shadowFilters().nameOf(shot.quality.surfaceShadows),
                                    pipelines::shadowFilters().nameOf(shot.quality.smokeShadows)));
    result.emplace_back("sfumato:throughput_cutoff", fmt::format("{}", shot.quality.throughputCutoff));
    result.emplace_back("sfumato:smoke_spacing_voxels", fmt::format("{}", shot.quality.smokeRaySpacing));
  }
  if (shot.scene.ambient != glm::dvec3(0))
    result.emplace_back("sfumato:ambient", numbers(shot.scene.ambient));
  if (const auto& occlusion = shot.quality.ambientOcclusion; occlusion.size != pipelines::OcclusionSize::Off)
    result.emplace_back(
        "sfumato:ssao",
        fmt::format("{}, radius {} m", pipelines::occlusionSizes().nameOf(occlusion.size), occlusion.radius));
  for (size_t i = 0; i < shot.media.size(); ++i)
    result.emplace_back(
        fmt::format("sfumato:volume{}", i),
        fmt::format("{}: grid \"{}\", scale {}, extinction {}, albedo {}, g {}{}", shot.scene.volumes[i].file,
                    shot.media[i].grid.name, shot.media[i].scale, numbers(shot.media[i].extinctionColour),
                    numbers(shot.media[i].albedo), shot.media[i].g, fireText(shot.scene.volumes[i].fire)));
  return result;
}

// Where a file is, whatever it is called.
std::filesystem::path placeOf(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(std::filesystem::absolute(file, ignored), ignored);
}

// What a pipeline does not do is not left out silently.
void checkPipeline(const RenderOptions& options) {
  pipelines::checkPipelineName(options.pipeline);
  const bool core = options.pipeline == "lund";
  const RenderOptions usual;
  const std::tuple<const char*, bool, bool> flags[] = {
      {"--aov", !options.aovs.empty(), core},
      {"--deep", !options.deep.empty(), core},
      {"--deep-shadow", !options.deepShadows.empty(), core},
      {"--half-res-smoke", options.halfResolutionSmoke, core},
      {"--smoke-spacing", options.smokeSpacing.has_value(), core},
      {"--reference", options.reference, core},
      {"--shadows", options.shadows != usual.shadows, !core},
      {"--interlace", options.interlace != usual.interlace, !core},
      {"--storage", options.storage != usual.storage, !core},
      {"--passes", options.passes != usual.passes, options.pipeline == "reentrant"},
      {"--layers", options.layers != usual.layers, options.pipeline == "peeling"},
      {"--refraction", options.refraction != usual.refraction,
       !core && options.pipeline != "stencil-routed"}};
  for (const auto& [flag, given, known] : flags)
    if (given && !known)
      fail(ExitCode::Usage, "{}: --pipeline {} has no such thing: leave out one of them", flag,
           options.pipeline);
}

// Every output is checked before the long work: it can be written, and is no other file of this run.
void checkOutputs(const RenderOptions& options) {
  const std::vector<std::string> deep = deepFiles(options);
  if (options.outputs.empty() && deep.empty() && !options.dryRun)
    fail(ExitCode::Usage, "render: no output: name an image with -o, e.g. -o {}.png",
         std::filesystem::path(options.scene.empty() ? options.volumes.front() : options.scene)
             .stem()
             .string());
  std::vector<std::string> outputs = options.outputs;
  for (const std::string& output : outputs) image::checkImageName(output);
  for (const std::string& file : heatMapFiles(options)) outputs.push_back(file);
  outputs.insert(outputs.end(), deep.begin(), deep.end());
  if (!options.statistics.empty()) outputs.push_back(options.statistics);
  std::set<std::filesystem::path> places = {placeOf(options.scene)};
  for (const std::string& volume : options.volumes) places.insert(placeOf(volume));
  for (const std::string& output : outputs) {
    if (!places.insert(placeOf(output)).second)
      fail(ExitCode::Usage, "{}: is named twice: give the output another name", output);
    if (!options.dryRun) base::checkWritable(output);
  }
}

std::string wayOfDrawing(const RenderOptions& options, const pipelines::Quality& quality) {
  if (options.reference) return fmt::format("CPU reference, {0} x {0} samples a pixel", options.samples);
  return fmt::format("{} samples at edges, shadow maps {} texels a side, error bound {:.5f}", quality.samples,
                     quality.shadowResolution, quality.shadowError);
}

// What the lists will hold at most about, as far as their bounds tell.
void printLists(const RenderOptions& options, const Shot& shot) {
  const pipelines::ListPrediction lists = pipelines::predictLists(
      shot.scene, shot.media, shot.camera, options.width, options.height, shot.quality);
  const auto line = [](const char* name, const pipelines::PredictedLists& predicted) {
    base::print("lists    {}: about {} nodes in {} lists, {}\n", name, predicted.nodes, predicted.cells,
                base::sizeText(predicted.bytes));
  };
  line("surfaces", lists.surfaces);
  line("lights", lists.lights);
  line("shadows", lists.allShadows());
}

void printPlan(const RenderOptions& options, const Shot& shot) {
  const scene::Scene& scene = shot.scene;
  size_t triangles = 0;
  for (const scene::Instance& instance : scene.instances)
    triangles += scene.meshes[static_cast<size_t>(instance.mesh)].indices.size() / 3;
  base::print("scene    {}: instances {}, triangles {}, materials {}, lights {}\n",
              options.scene.empty() ? "default set" : options.scene, scene.instances.size(), triangles,
              scene.materials.size(), scene.lights.size());
  for (size_t i = 0; i < shot.media.size(); ++i) {
    const volumes::DensityGrid& grid = shot.media[i].grid;
    base::print("volume   {}: grid \"{}\", {} x {} x {} voxels, {}\n", scene.volumes[i].file, grid.name,
                grid.size.x, grid.size.y, grid.size.z, base::sizeText(grid.bytes()));
    if (shot.media[i].fire)
      base::print("fire     grid \"{}\", {}\n", shot.media[i].fire->grid.name,
                  base::sizeText(shot.media[i].fire->grid.bytes()));
  }
  const scene::Camera* camera = cameraOfScene(options, scene);
  base::print("camera   {}\n", camera ? "\"" + camera->name + "\"" : "placed so that it sees everything");
  base::print("frame    {}x{}, quality {}: step {} voxels, {}\n", options.width, options.height,
              options.quality, shot.quality.stepVoxels, wayOfDrawing(options, shot.quality));
  if (!options.reference) printLists(options, shot);
  for (const std::string& output : options.outputs) base::print("output   {}\n", output);
  for (const std::string& file : heatMapFiles(options)) base::print("output   {}\n", file);
  for (const std::string& file : deepFiles(options)) base::print("output   {}\n", file);
  if (!options.statistics.empty()) base::print("output   {}\n", options.statistics);
}

void writeOutputs(const RenderOptions& options, const Shot& shot, Drawn drawn,
                  const image::Metadata& settings) {
  writeHeatMaps(options, drawn.aovs, settings);
  writeDeepFiles(options, drawn, settings);
  std::vector<image::Layer> layers;
  for (auto& [aov, image] : drawn.aovs) layers.push_back(layerOf(aov, std::move(image)));
  for (const std::string& output : options.outputs) {
    if (!image::holdsLayers(output)) continue;
    image::writeLayers(output, drawn.radiance, layers, settings);
    base::note("wrote {}", output);
  }
  image::Metadata pictureSettings = settings;
  std::ranges::copy(displayMetadata(options, shot, drawn), std::back_inserter(pictureSettings));
  for (const std::string& output : options.outputs) {
    if (image::holdsLayers(output)) continue;
    image::writeImage(output, drawn.display ? *drawn.display : drawn.radiance, pictureSettings, false,
                      toneMappingOf(options.display, drawn.brightness));
    base::note("wrote {}", output);
  }
}

// The frame by the CPU reference, --repeat times.
Drawn drawReference(const RenderOptions& options, const Shot& shot, Clock::time_point start) {
  const PostProcess postProcess = openPostProcess(options, shot);
  Drawn drawn{.device = "CPU reference"};
  const double startupSeconds = secondsSince(start);
  std::vector<double> seconds;
  for (int i = 0; i < options.repeat; ++i) {
    const Clock::time_point frameStart = Clock::now();
    pipelines::ReferenceFrame frame =
        pipelines::traceReference(shot.scene, shot.camera, shot.media,
                                  {.width = options.width,
                                   .height = options.height,
                                   .samples = options.samples,
                                   .stepVoxels = shot.quality.stepVoxels,
                                   .shadowStepVoxels = shot.quality.stepVoxels,
                                   .scatteringOctaves = options.scatteringOctaves,
                                   .showProgress = true,
                                   .aovs = shot.aovsToDraw()});
    drawn.radiance = std::move(frame.radiance);
    drawn.aovs = std::move(frame.aovs);
    seconds.push_back(secondsSince(frameStart));
  }
  base::note("frame: {:.2f} s", seconds.back());
  postProcess(drawn);
  drawn.statistics = base::jsonText(nlohmann::json{{"device", drawn.device},
                                                   {"startup", {{"seconds", startupSeconds}}},
                                                   {"frame", {{"seconds", seconds}}}});
  return drawn;
}

}  // namespace

scene::Bounds boundsOf(const scene::Scene& scene, const std::vector<volumes::Medium>& media) {
  std::vector<glm::dmat4> mediaBoxes;
  for (const volumes::Medium& medium : media) mediaBoxes.push_back(volumes::worldFromUnit(medium));
  return scene::boundsOf(scene::boundingPoints(scene, mediaBoxes));
}

bool isOfScene(const RenderOptions& options) {
  return !options.scene.empty() || !options.volumes.empty();
}

void checkWithoutScene(const RenderOptions& options) {
  const std::pair<const char*, bool> given[] = {{"--grid", !options.grid.empty()},
                                                {"--volume-scale", options.volumeScale.has_value()},
                                                {"--camera", !options.camera.empty()},
                                                {"--time", options.timeSeconds.has_value()},
                                                {"--look-from", options.lookFrom.has_value()},
                                                {"--look-at", options.lookAt.has_value()},
                                                {"--fov", options.fovDegrees.has_value()}};
  for (const auto& [name, is] : given)
    if (is) fail(ExitCode::Usage, "{}: is for a scene: name a .gltf or .glb file", name);
}

Shot makeShot(const RenderOptions& options) {
  Shot shot;
  if (!options.scene.empty()) shot.scene = scene::readGltf(options.scene, options.timeSeconds);
  addVolumes(options, shot.scene);
  shot.media = scene::readMedia(shot.scene);
  scene::addFireLights(shot.scene, shot.media);
  if (options.scene.empty()) addDefaults(options, shot.scene, shot.media);
  shot.scene.ambient = options.ambient.value_or(shot.scene.ambient);
  lightTheDark(options, shot.scene);
  shot.camera = chooseCamera(options, shot.scene, shot.media);
  shot.quality = chooseQuality(options);
  shot.quality.ambientOcclusion = chooseOcclusion(options, shot.scene);
  if (!options.volumeMemory.empty())
    shot.volumeMemory = base::bytesNamed(options.volumeMemory, "--volume-memory");
  shot.aovs = wantedAovs(options);
  shot.deepShadows = deepShadowLights(options, shot.scene);
  shot.post = wantedPostProcessing(options);
  return shot;
}

int render(const RenderOptions& options) {
  const Clock::time_point start = Clock::now();
  if (!isOfScene(options))
    fail(ExitCode::Usage, "render: no scene: name a .gltf or .glb file, or smoke with --volume FILE.vdb");
  checkPipeline(options);
  checkOutputs(options);
  const Shot shot = makeShot(options);
  if (options.dryRun) {
    printPlan(options, shot);
    return 0;
  }
  Drawn drawn = options.reference ? drawReference(options, shot, start) : drawOnGpu(options, shot, start);
  const image::Metadata settings = metadata(options, shot, drawn.device);
  const std::string statistics = std::move(drawn.statistics);
  writeOutputs(options, shot, std::move(drawn), settings);
  if (!options.statistics.empty()) {
    base::writeFile(options.statistics, statistics);
    base::note("wrote {}", options.statistics);
  }
  return 0;
}

}  // namespace sfumato::app
