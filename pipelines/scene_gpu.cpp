#include "pipelines/scene_gpu.h"

#include <algorithm>
#include <cmath>

#include "pipelines/gbuffer_gpu.h"
#include "pipelines/image_bounds.h"
#include "pipelines/shadow_resolution.h"
#include "scene/camera_view.h"
#include "scene/visible_hull.h"

namespace sfumato::pipelines {

using gl::Profiler;

namespace {

shared::ViewParams tightView(const scene::Camera& camera, int width, int height,
                             const std::vector<std::vector<glm::dvec3>>& seen) {
  shared::ViewParams view = scene::cameraView(camera, width, height);
  const glm::dmat4 viewFromWorld = glm::inverse(camera.worldFromView);
  double nearest = scene::infinity;
  double farthest = 0;
  for (const std::vector<glm::dvec3>& part : seen) {
    for (const glm::dvec3& p : part) {
      const double depth = -(viewFromWorld * glm::dvec4(p, 1)).z;
      nearest = std::min(nearest, depth);
      farthest = std::max(farthest, depth);
    }
  }
  constexpr double nothing = 1e-30;  // in place of the depth of surfaces where none is seen
  view.depthRange.z =
      static_cast<float>(std::exp2(-std::ceil(std::log2(1.01 * std::max(farthest, nothing)))));
  if (nearest > farthest) return view;
  constexpr double slack = 1e-3;
  constexpr double leastRatio = 1e-6;  // of nearest to farthest, for floats to tell anything apart
  scene::Camera tight = camera;
  tight.nearDistance = std::max({camera.nearDistance, (1 - slack) * nearest, leastRatio * farthest});
  tight.farDistance = std::min(camera.farDistance, (1 + slack) * farthest);
  view.clipFromView = scene::cameraView(tight, width, height).clipFromView;
  return view;
}

}  // namespace

FrameView viewOf(const scene::Scene& scene, const scene::Camera& camera, int width, int height) {
  FrameView view{.camera = camera, .width = width, .height = height};
  view.seen = scene::visibleParts(scene, camera, static_cast<double>(width) / height);
  view.params = tightView(camera, width, height, view.seen);
  return view;
}

glm::ivec4 FrameView::areaOf(size_t instance) const {
  const std::vector<glm::dvec3>& points = seen[instance];
  const ImageBounds bounds = boundsOnImage(points, camera);
  // What floats of vertices and matrices may be off, in pixels at the nearest point; and those that it
  // touches.
  constexpr double rounding = 1e-6;
  const glm::dmat4 viewFromWorld = glm::inverse(camera.worldFromView);
  double margin = 1;
  for (const glm::dvec3& p : points) {
    const double off = rounding * (glm::length(p) + glm::length(viewFromWorld[3]));
    margin = std::max(margin,
                      1 + off * height * imageHeightsPerMetre(-(viewFromWorld * glm::dvec4(p, 1)).z, camera));
  }
  const glm::dvec2 size(width, height);
  const auto pixels = [&](const glm::dvec2& place) { return place * size.y + size / 2.0; };
  const glm::ivec2 low(glm::clamp(glm::floor(pixels(bounds.low) - margin), glm::dvec2(0), size - 1.0));
  const glm::ivec2 high(glm::clamp(glm::ceil(pixels(bounds.high) + margin), glm::dvec2(low + 1), size));
  return {low, high - low};
}

SceneGpu::SceneGpu(gl::Device& device, const scene::Scene& scene, std::span<const volumes::Medium> media,
                   const volumes::GridOptions& gridOptions)
    : device_(device), scene_(scene), geometry_(device, scene), volumes_(device, media, gridOptions) {
  for (const volumes::Medium& medium : media) mediaBoxes_.push_back(volumes::worldFromUnit(medium));
}

gl::ShaderDefines SceneGpu::lightingDefines(const Quality& quality) const {
  gl::ShaderDefines defines;
  if (geometry_.hasNotSelf()) defines.emplace_back("SHADOW_OBJECTS", "1");
  if (!geometry_.has(Layer::ShadowLists) && quality.walkedSmokeNodes == 0) {
    defines.emplace_back("OPAQUE_SHADOWS", "1");
    if (!geometry_.has(Layer::ShadowDepth)) defines.emplace_back("NO_CASTERS", "1");
  }
  if (scene_.ambient != glm::dvec3(0)) defines.emplace_back("AMBIENT", "1");
  if (volumes_.empty()) return defines;
  defines.emplace_back("SMOKE", "1");
  if (volumes_.burning()) defines.emplace_back("FIRE", "1");
  if (quality.smokeShadows == ShadowFilter::Nearest) defines.emplace_back("NEAREST_SMOKE_SHADOWS", "1");
  if (quality.scatteringOctaves > 0)
    defines.emplace_back("SCATTER_OCTAVES", std::to_string(quality.scatteringOctaves));
  return gl::joined(defines, volumes_.defines());
}

shared::ResolveParams SceneGpu::lightingParams(const Quality& quality, int directionalLights) const {
  shared::ResolveParams params{};
  params.march = {quality.stepVoxels, quality.throughputCutoff, 0, 0};
  params.options = {0, tapsOf(quality.surfaceShadows) + 8 * tapsOf(quality.smokeShadows), directionalLights,
                    0};
  params.ambient = glm::vec4(scene_.ambient, quality.ambientOcclusion.radius);
  return params;
}

OcclusionSize SceneGpu::occlusionOf(const Quality& quality) const {
  return scene_.ambient == glm::dvec3(0) ? OcclusionSize::Off : quality.ambientOcclusion.size;
}

std::optional<AmbientOcclusion> SceneGpu::drawOcclusion(const FrameView& view, const Quality& quality) const {
  if (occlusionOf(quality) == OcclusionSize::Off) return std::nullopt;
  gl::Buffer viewBlock(device_, "camera view", sizeof(shared::ViewParams));
  viewBlock.writeValue(view.params);
  const GBuffer gbuffer = [&] {
    const Profiler::Scope time(device_.profiler(), "occlusion G-buffer");
    return drawGBuffer(
        device_, {.geometry = geometry_, .view = viewBlock, .width = view.width, .height = view.height});
  }();
  return drawAmbientOcclusion(device_, {gbuffer.depth, gbuffer.surface0, viewBlock, view.width, view.height,
                                        quality.ambientOcclusion});
}

deepshadow::Casters castersOf(const GeometryGpu& geometry) {
  const auto draws = [&](Layer layer) {
    return geometry.has(layer) ? [&geometry, layer] { geometry.draw(layer, false); }
                               : std::function<void()>();
  };
  return {.opaque = draws(Layer::ShadowDepth),
          .listed = draws(Layer::ShadowLists),
          .once = geometry.hasShadowOnce(),
          .notSelf = geometry.hasNotSelf(),
          .defines = geometry.defines()};
}

ShadowInputs SceneGpu::shadowInputs(const FrameView& view, const Quality& quality) const {
  scene::Seen all;
  all.add(scene::visibleParts(mediaBoxes_, view.camera, static_cast<double>(view.width) / view.height));
  all.add(view.seen);
  return {castersOf(geometry_), all.points, scene::boundingPoints(scene_, mediaBoxes_),
          shadowResolutions(scene_.lights, all.parts, view.camera, view.width, view.height, quality),
          deepshadow::MapBudget{.bytes = quality.shadowMemory,
                                .lowerResolution = !quality.exactShadowResolution,
                                .loosenError = !quality.exactShadowError}};
}

deepshadow::Maps SceneGpu::buildShadows(const FrameView& view, const Quality& quality,
                                        deepshadow::Maps former) const {
  const Profiler::Scope time(device_.profiler(), "deep shadow maps");
  const ShadowInputs inputs = shadowInputs(view, quality);
  return deepshadow::Maps(device_,
                          {.lights = scene_.lights,
                           .casters = inputs.casters,
                           .volumes = volumes_,
                           .receivers = inputs.receivers,
                           .castingPoints = inputs.castingPoints,
                           .plan = {inputs.resolutions, quality.shadowError},
                           .budget = inputs.budget,
                           .stepVoxels = quality.stepVoxels,
                           .lists = quality.lists,
                           .linkedSmokeNodes = quality.walkedSmokeNodes},
                          std::move(former));
}

ShadowFigures figuresOf(const deepshadow::Maps& shadows) {
  return {.resolutions = shadows.plan().resolutions,
          .error = shadows.plan().error,
          .lowered = shadows.lowered(),
          .bytes = shadows.bytes(),
          .predictedBytes = shadows.predictedBytes(),
          .budgetBytes = shadows.budgetBytes()};
}

}  // namespace sfumato::pipelines
