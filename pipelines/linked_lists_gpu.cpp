#include "pipelines/linked_lists_gpu.h"

#include <algorithm>

#include "base/error.h"
#include "gl/commands.h"
#include "gl/program.h"
#include "pipelines/gbuffer_gpu.h"
#include "pipelines/surface_lists_gpu.h"
#include "scene/camera_view.h"
#include "scene/visible_hull.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/resolve.h"

namespace sfumato::pipelines {

using gl::Profiler;

namespace {

// A dispatch does RESOLVE_WORK_LIMIT of a pixel's work; no sane frame needs this many.
constexpr int maxResolveDispatches = 10000;

std::vector<lights::ShadowFaces> shadowFacesOf(const deepshadow::Maps& maps) {
  std::vector<lights::ShadowFaces> faces;
  for (const deepshadow::LightMap& map : maps.lights()) faces.push_back({map.firstFace, map.faces});
  return faces;
}

gl::ShaderDefines resolveDefines(const volumes::VolumesGpu& volumes, const GeometryGpu& geometry,
                                 size_t samples) {
  gl::ShaderDefines defines = {{"SAMPLES", std::to_string(samples)}};
  if (geometry.hasNotSelf()) defines.emplace_back("SHADOW_OBJECTS", "1");
  if (volumes.empty()) return defines;
  for (const auto& define : volumes.defines()) defines.push_back(define);
  defines.emplace_back("SMOKE", "1");
  return defines;
}

struct ResolveInputs {
  const gl::Buffer& view;
  const GBuffer& gbuffer;
  const lists::LinkedLists& surfaces;
  const lights::LightLists& lights;
  const deepshadow::Maps& shadows;
  const volumes::VolumesGpu& volumes;
  const GeometryGpu& geometry;
  int width = 0;
  int height = 0;
  Quality quality;
};

struct ResolveOutputs {
  image::Image radiance;
  size_t splitPixels = 0;
  int dispatches = 0;
  size_t cutWalks = 0;
};

// Pixels that are walked sample by sample: see shaders/shared/resolve.h.
struct Split {
  gl::Buffer groups;  // pixelGroups
  size_t count = 0;   // of groups
};

void bindRayInputs(const ResolveInputs& inputs) {
  inputs.view.bindUniform(UNIFORM_VIEW);
  inputs.surfaces.bind(STORAGE_OLD_HEADS, STORAGE_OLD_LINKS, STORAGE_OLD_PAYLOADS);
  inputs.gbuffer.depth.bind(TEXTURE_OPAQUE_DEPTH);
  inputs.gbuffer.surface0.bind(TEXTURE_SURFACE_0);
  inputs.gbuffer.surface1.bind(TEXTURE_SURFACE_1);
}

shared::ResolveParams resolveParams(const ResolveInputs& inputs) {
  shared::ResolveParams params{};
  const double step = inputs.volumes.empty() ? 1.0 : inputs.quality.stepVoxels * inputs.volumes.voxelSize();
  params.march = {static_cast<float>(step), static_cast<float>(inputs.quality.throughputCutoff), 0.f, 0.f};
  params.options = {1, inputs.quality.bilinearSmokeShadows ? 1 : 0, inputs.lights.directionalLights(), 0};
  glm::vec2 positions[MAX_SAMPLES] = {};
  std::copy(inputs.gbuffer.samplePositions.begin(), inputs.gbuffer.samplePositions.end(), positions);
  params.samples01 = glm::vec4(positions[0], positions[1]);
  params.samples23 = glm::vec4(positions[2], positions[3]);
  return params;
}

Split splitPixels(gl::Device& device, const ResolveInputs& inputs) {
  const size_t pixels = static_cast<size_t>(inputs.width) * static_cast<size_t>(inputs.height);
  Split split;
  if (inputs.gbuffer.samplePositions.size() == 1) {
    split.groups = gl::Buffer(device, "pixel groups", pixels * sizeof(uint32_t));
    split.groups.clear();
    return split;
  }
  gl::Buffer counters(device, "resolve counters", sizeof(shared::ResolveCounters));
  const gl::Program& program = device.program(
      {"pipelines/split.comp"}, {{"SAMPLES", std::to_string(inputs.gbuffer.samplePositions.size())}});
  size_t capacity = pixels / 8;
  for (;;) {
    split.groups = gl::Buffer(device, "pixel groups", (pixels + capacity) * sizeof(uint32_t));
    counters.clear();
    bindRayInputs(inputs);
    split.groups.bindStorage(STORAGE_PIXEL_GROUPS);
    counters.bindStorage(STORAGE_COUNTERS);
    gl::dispatch(program, {gl::groupsFor(static_cast<size_t>(inputs.width), 8),
                           gl::groupsFor(static_cast<size_t>(inputs.height), 8), 1});
    gl::storageBarrier();
    split.count = counters.readValue<shared::ResolveCounters>().groups;
    if (split.count <= capacity) return split;
    capacity = split.count;
  }
}

// Rows from the top, as images have them; the GPU's start at the bottom. A split pixel is the mean of its
// samples.
image::Image readRadiance(const gl::Buffer& rays, const Split& split, size_t rayCount,
                          const ResolveInputs& inputs) {
  const auto states = rays.readValues<shared::RayState>(rayCount);
  const size_t pixels = static_cast<size_t>(inputs.width) * static_cast<size_t>(inputs.height);
  const auto groups = split.groups.readValues<uint32_t>(pixels);
  const size_t further = inputs.gbuffer.samplePositions.size() - 1;
  image::Image image(inputs.width, inputs.height, 3);
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    glm::vec3 sum(states[pixel].radianceR, states[pixel].radianceG, states[pixel].radianceB);
    if (groups[pixel] != 0) {
      const size_t firstRay = pixels + (groups[pixel] - 1) * further;
      for (size_t ray = firstRay; ray < firstRay + further; ++ray)
        sum += glm::vec3(states[ray].radianceR, states[ray].radianceG, states[ray].radianceB);
      sum /= static_cast<float>(further + 1);
    }
    const auto width = static_cast<size_t>(inputs.width);
    float* target =
        image.pixel(static_cast<int>(pixel % width), inputs.height - 1 - static_cast<int>(pixel / width));
    std::copy_n(&sum.x, 3, target);
  }
  return image;
}

ResolveOutputs resolve(gl::Device& device, const ResolveInputs& inputs) {
  const Split split = splitPixels(device, inputs);
  const size_t samples = inputs.gbuffer.samplePositions.size();
  const size_t pixels = static_cast<size_t>(inputs.width) * static_cast<size_t>(inputs.height);
  const size_t rayCount = pixels + split.count * (samples - 1);
  const gl::Program& program =
      device.program({"pipelines/resolve.comp"}, resolveDefines(inputs.volumes, inputs.geometry, samples));
  gl::Buffer rays(device, "resolve rays", rayCount * sizeof(shared::RayState));
  gl::Buffer passBlock(device, "resolve pass", sizeof(shared::ResolveParams));
  gl::Buffer counters(device, "resolve counters", sizeof(shared::ResolveCounters));
  shared::ResolveParams params = resolveParams(inputs);
  params.options.w = static_cast<int>(rayCount);

  ResolveOutputs outputs;
  outputs.splitPixels = split.count;
  shared::ResolveCounters counted{};
  do {
    base::check(outputs.dispatches < maxResolveDispatches, "the resolve ends");
    passBlock.writeValue(params);
    counters.clear();
    bindRayInputs(inputs);
    passBlock.bindUniform(UNIFORM_PASS);
    rays.bindStorage(STORAGE_RAYS);
    split.groups.bindStorage(STORAGE_PIXEL_GROUPS);
    counters.bindStorage(STORAGE_COUNTERS);
    inputs.lights.bind();
    inputs.shadows.bind();
    inputs.volumes.bind();
    gl::dispatchLinear(program, rayCount);
    gl::storageBarrier();
    counted = counters.readValue<shared::ResolveCounters>();
    outputs.cutWalks += counted.boundHit;
    ++outputs.dispatches;
    params.options.x = 0;
  } while (counted.unfinished > 0);
  outputs.radiance = readRadiance(rays, split, rayCount, inputs);
  return outputs;
}

}  // namespace

LinkedListsPipeline::LinkedListsPipeline(gl::Device& device, const scene::Scene& scene,
                                         std::span<const volumes::Medium> media)
    : device_(device), scene_(scene), geometry_(device, scene), volumes_(device, media) {
  for (const volumes::Medium& medium : media) mediaBoxes_.push_back(volumes::worldFromUnit(medium));
  // The largest program of a frame that is anti-aliased; the small ones are built when they are first used.
  const int samples = std::min(MAX_SAMPLES, device.limits().samples);
  device.program({"pipelines/resolve.comp"},
                 resolveDefines(volumes_, geometry_, static_cast<size_t>(samples)));
}

Frame LinkedListsPipeline::render(const scene::Camera& camera, int width, int height,
                                  const Quality& quality) {
  Frame frame;
  gl::Buffer view(device_, "camera view", sizeof(shared::ViewParams));
  view.writeValue(scene::cameraView(camera, width, height));

  const int samples = std::clamp(quality.samples, 1, std::min(MAX_SAMPLES, device_.limits().samples));
  const GBuffer gbuffer = [&] {
    const Profiler::Scope time(device_.profiler(), "opaque G-buffer");
    return drawGBuffer(device_, {geometry_, view, width, height, samples});
  }();

  const deepshadow::Maps shadows = [&] {
    const Profiler::Scope time(device_.profiler(), "deep shadow maps");
    const auto receivers =
        scene::visiblePoints(scene_, mediaBoxes_, camera, static_cast<double>(width) / height);
    const auto castingPoints = scene::boundingPoints(scene_, mediaBoxes_);
    deepshadow::Casters casters{.opaque = [&] { geometry_.draw(Layer::ShadowDepth, false); },
                                .once = geometry_.hasShadowOnce()};
    if (geometry_.has(Layer::ShadowLists))
      casters.listed = [&] { geometry_.draw(Layer::ShadowLists, false); };
    const double step = volumes_.empty() ? 1.0 : quality.stepVoxels * volumes_.voxelSize();
    return deepshadow::Maps(device_, {.lights = scene_.lights,
                                      .casters = casters,
                                      .volumes = volumes_,
                                      .receivers = receivers,
                                      .castingPoints = castingPoints,
                                      .resolution = quality.shadowResolution,
                                      .stepMetres = step,
                                      .error = quality.shadowError});
  }();
  frame.statistics.shadows = shadows.lights();

  const std::vector<lights::ShadowFaces> faces = shadowFacesOf(shadows);
  const lights::LightLists lightLists = [&] {
    const Profiler::Scope time(device_.profiler(), "light lists");
    return lights::LightLists(device_, {scene_.lights, faces, view, width, height});
  }();
  frame.statistics.lights = lightLists.statistics();

  const SurfaceLists surfaces = [&] {
    const Profiler::Scope time(device_.profiler(), "surface lists");
    return buildSurfaceLists(device_, {geometry_, view, gbuffer, width, height});
  }();
  frame.statistics.surfaces = surfaces.statistics;

  const Profiler::Scope time(device_.profiler(), "resolve");
  ResolveOutputs resolved = resolve(device_, {view, gbuffer, surfaces.lists, lightLists, shadows, volumes_,
                                              geometry_, width, height, quality});
  frame.radiance = std::move(resolved.radiance);
  frame.statistics.splitPixels = resolved.splitPixels;
  frame.statistics.resolveDispatches = resolved.dispatches;
  frame.statistics.cutWalks = resolved.cutWalks + shadows.cutMarches();
  frame.statistics.triangles = geometry_.triangles();
  return frame;
}

}  // namespace sfumato::pipelines
