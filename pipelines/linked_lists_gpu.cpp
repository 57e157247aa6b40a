#include "pipelines/linked_lists_gpu.h"

#include <algorithm>

#include "base/error.h"
#include "gl/commands.h"
#include "gl/program.h"
#include "pipelines/gbuffer_gpu.h"
#include "scene/camera_view.h"
#include "scene/visible_hull.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/resolve.h"
#include "shaders/shared/surface.h"

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

gl::ShaderDefines resolveDefines(const volumes::VolumesGpu& volumes) {
  gl::ShaderDefines defines;
  if (volumes.empty()) return defines;
  defines = volumes.defines();
  defines.emplace_back("SMOKE", "1");
  return defines;
}

struct SurfaceListInputs {
  const GeometryGpu& geometry;
  const gl::Buffer& view;
  const GBuffer& gbuffer;
  int width = 0;
  int height = 0;
};

struct SurfaceLists {
  lists::Lists lists;
  lists::ListStatistics statistics;
};

// Translucent surfaces before the opaque depth, a list each pixel.
SurfaceLists buildSurfaceLists(gl::Device& device, const SurfaceListInputs& inputs) {
  const size_t pixels = static_cast<size_t>(inputs.width) * static_cast<size_t>(inputs.height);
  SurfaceLists result{
      lists::Lists(device, "surface lists", pixels, sizeof(shared::PackedSurface), pixels / 4), {}};
  const gl::Framebuffer noTarget({inputs.width, inputs.height});
  result.statistics = result.lists.build(device, [&] {
    if (!inputs.geometry.has(Layer::Translucent)) return;
    inputs.view.bindUniform(UNIFORM_VIEW);
    inputs.gbuffer.depth.bind(TEXTURE_OPAQUE_DEPTH);
    gl::setDrawState({.program = &device.program({"scene/surface.vert", "pipelines/translucent.frag"}),
                      .target = &noTarget,
                      .viewport = {0, 0, inputs.width, inputs.height}});
    inputs.geometry.draw(Layer::Translucent, true);
  });
  return result;
}

struct ResolveInputs {
  const gl::Buffer& view;
  const GBuffer& gbuffer;
  const lists::Lists& surfaces;
  const lights::LightLists& lights;
  const deepshadow::Maps& shadows;
  const volumes::VolumesGpu& volumes;
  int width = 0;
  int height = 0;
  Quality quality;
};

struct ResolveOutputs {
  image::Image radiance;
  int dispatches = 0;
  size_t cutWalks = 0;
};

// Rows from the top, as images have them; the GPU's start at the bottom.
image::Image readRadiance(const gl::Buffer& pixels, int width, int height) {
  const auto states =
      pixels.readValues<shared::PixelState>(static_cast<size_t>(width) * static_cast<size_t>(height));
  image::Image image(width, height, 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const shared::PixelState& state =
          states[static_cast<size_t>(height - 1 - y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
      float* pixel = image.pixel(x, y);
      pixel[0] = state.radianceR;
      pixel[1] = state.radianceG;
      pixel[2] = state.radianceB;
    }
  }
  return image;
}

ResolveOutputs resolve(gl::Device& device, const ResolveInputs& inputs) {
  const gl::Program& program = device.program({"pipelines/resolve.comp"}, resolveDefines(inputs.volumes));
  gl::Buffer pixels(
      device, "resolve pixels",
      static_cast<size_t>(inputs.width) * static_cast<size_t>(inputs.height) * sizeof(shared::PixelState));
  gl::Buffer passBlock(device, "resolve pass", sizeof(shared::ResolveParams));
  gl::Buffer counters(device, "resolve counters", sizeof(shared::ResolveCounters));
  shared::ResolveParams params{};
  const double step = inputs.volumes.empty() ? 1.0 : inputs.quality.stepVoxels * inputs.volumes.voxelSize();
  params.march = {static_cast<float>(step), static_cast<float>(inputs.quality.throughputCutoff), 0.f, 0.f};
  params.options = {1, inputs.quality.bilinearSmokeShadows ? 1 : 0, inputs.lights.directionalLights(), 0};

  ResolveOutputs outputs;
  shared::ResolveCounters counted{};
  do {
    base::check(outputs.dispatches < maxResolveDispatches, "the resolve ends");
    passBlock.writeValue(params);
    counters.clear();
    inputs.view.bindUniform(UNIFORM_VIEW);
    passBlock.bindUniform(UNIFORM_PASS);
    pixels.bindStorage(STORAGE_PIXELS);
    counters.bindStorage(STORAGE_COUNTERS);
    inputs.surfaces.bind(STORAGE_LIST_HEADS, STORAGE_LIST_LINKS, STORAGE_LIST_PAYLOADS);
    inputs.lights.bind();
    inputs.shadows.bind();
    inputs.volumes.bind();
    inputs.gbuffer.depth.bind(TEXTURE_OPAQUE_DEPTH);
    inputs.gbuffer.surface0.bind(TEXTURE_SURFACE_0);
    inputs.gbuffer.surface1.bind(TEXTURE_SURFACE_1);
    gl::dispatch(program, {gl::groupsFor(static_cast<size_t>(inputs.width), 8),
                           gl::groupsFor(static_cast<size_t>(inputs.height), 8), 1});
    gl::storageBarrier();
    counted = counters.readValue<shared::ResolveCounters>();
    outputs.cutWalks += counted.boundHit;
    ++outputs.dispatches;
    params.options.x = 0;
  } while (counted.unfinished > 0);
  outputs.radiance = readRadiance(pixels, inputs.width, inputs.height);
  return outputs;
}

}  // namespace

LinkedListsPipeline::LinkedListsPipeline(gl::Device& device, const scene::Scene& scene,
                                         std::span<const volumes::Medium> media)
    : device_(device), scene_(scene), geometry_(device, scene), volumes_(device, media) {
  for (const volumes::Medium& medium : media) mediaBoxes_.push_back(volumes::worldFromUnit(medium));
  device.program({"pipelines/resolve.comp"}, resolveDefines(volumes_));
}

Frame LinkedListsPipeline::render(const scene::Camera& camera, int width, int height,
                                  const Quality& quality) {
  Frame frame;
  gl::Buffer view(device_, "camera view", sizeof(shared::ViewParams));
  view.writeValue(scene::cameraView(camera, width, height));

  const GBuffer gbuffer = [&] {
    const Profiler::Scope time(device_.profiler(), "opaque G-buffer");
    return drawGBuffer(device_, {geometry_, view, width, height});
  }();

  const deepshadow::Maps shadows = [&] {
    const Profiler::Scope time(device_.profiler(), "deep shadow maps");
    const auto receivers =
        scene::visiblePoints(scene_, mediaBoxes_, camera, static_cast<double>(width) / height);
    const auto castingPoints = scene::boundingPoints(scene_, mediaBoxes_);
    deepshadow::Casters casters{.opaque = [&] { geometry_.draw(Layer::Opaque, false); }, .translucent = {}};
    if (geometry_.has(Layer::Translucent))
      casters.translucent = [&] { geometry_.draw(Layer::Translucent, false); };
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
  ResolveOutputs resolved = resolve(
      device_, {view, gbuffer, surfaces.lists, lightLists, shadows, volumes_, width, height, quality});
  frame.radiance = std::move(resolved.radiance);
  frame.statistics.resolveDispatches = resolved.dispatches;
  frame.statistics.cutWalks = resolved.cutWalks + shadows.cutMarches();
  frame.statistics.triangles = geometry_.triangles();
  return frame;
}

}  // namespace sfumato::pipelines
