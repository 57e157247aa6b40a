#include "pipelines/layers_gpu.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "gl/program.h"
#include "lights/light_reach.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/layers.h"
#include "shaders/shared/surface.h"

namespace sfumato::pipelines {

using gl::Profiler;

namespace {

constexpr size_t proxyVertices = 60;  // shaders/lights/proxy_mesh.glsl
constexpr int maxDispatches = 10000;  // no sane frame needs so many for a segment of its rays
constexpr glm::vec4 nothingSeen(NOTHING_SEEN);

// How much larger than what a light reaches its mesh may be, near plane and all.
constexpr double meshExcess = 1.3;

float depthScale(const std::vector<std::vector<glm::dvec3>>& seen, const scene::Camera& camera) {
  const glm::dmat4 viewFromWorld = glm::inverse(camera.worldFromView);
  double farthest = 1e-30;
  for (const std::vector<glm::dvec3>& part : seen)
    for (const glm::dvec3& p : part) farthest = std::max(farthest, -(viewFromWorld * glm::dvec4(p, 1)).z);
  return static_cast<float>(std::exp2(-std::ceil(std::log2(1.01 * farthest))));
}

// Whether the camera may stand in the mesh of what a light reaches; its far sides show it then.
bool mayBeInside(const lights::Light& light, double reach, const scene::Camera& camera) {
  const glm::dvec3 eye = camera.worldFromView[3];
  if (camera.orthographic) return true;
  return glm::distance(eye, light.position) < meshExcess * reach + 2 * camera.nearDistance;
}

std::vector<lights::ShadowFaces> facesOf(const std::optional<deepshadow::Maps>& shadows, size_t lights) {
  std::vector<lights::ShadowFaces> faces(lights);
  if (shadows)
    std::transform(shadows->lights().begin(), shadows->lights().end(), faces.begin(),
                   [](const deepshadow::LightMap& map) {
                     return lights::ShadowFaces{map.firstFace, map.faces};
                   });
  return faces;
}

}  // namespace

void SurfaceLayer::bind() const {
  surface[0].bind(TEXTURE_SURFACE_0);
  surface[1].bind(TEXTURE_SURFACE_1);
  surface[2].bind(TEXTURE_SURFACE_2);
  depth.bind(TEXTURE_OPAQUE_DEPTH);
}

LayeredFrame::LayeredFrame(const SceneGpu& scene, const scene::Camera& camera, int width, int height,
                           const Quality& quality, ShadowKind usualShadows)
    : scene_(scene),
      view_(viewOf(scene.scene(), camera, width, height)),
      quality_(quality),
      shadowKind_(quality.deferred.shadows.value_or(usualShadows)),
      viewBlock_(scene.device(), "camera view", sizeof(shared::ViewParams)),
      passBlock_(scene.device(), "layer pass", sizeof(shared::ResolveParams)) {
  view_.params.depthRange.z = depthScale(view_.seen, camera);
  viewBlock_.writeValue(view_.params);
  if (shadowKind_ == ShadowKind::Deep) shadows_ = scene.buildShadows(view_, quality);
  const auto faces = facesOf(shadows_, scene.lights().size());
  const Profiler::Scope time(device().profiler(), "light lists");
  lightLists_.emplace(device(), lights::LightListInputs{scene.lights(), faces, viewBlock_, width, height,
                                                        std::nullopt, nullptr, quality.lists});
  statistics.lights = lightLists_->statistics();
}

size_t LayeredFrame::pixels() const {
  return static_cast<size_t>(view_.width) * static_cast<size_t>(view_.height);
}

gl::ShaderDefines LayeredFrame::storageDefines() const {
  return options().storage == Storage::Table ? gl::ShaderDefines{{"TABLE_STORAGE", "1"}}
                                             : gl::ShaderDefines{};
}

gl::ShaderDefines LayeredFrame::lightingDefines() const {
  return gl::joined(scene_.lightingDefines(quality_.scatteringOctaves), storageDefines());
}

const lights::Light& LayeredFrame::light(size_t number) const {
  return scene_.lights()[static_cast<size_t>(lightLists_->order()[number])];
}

shared::ResolveParams LayeredFrame::params() const {
  shared::ResolveParams params{};
  params.march = {static_cast<float>(quality_.stepVoxels), static_cast<float>(quality_.throughputCutoff), 0.f,
                  0.f};
  params.options = {0, tapsOf(quality_.surfaceShadows) + 8 * tapsOf(quality_.smokeShadows),
                    lightLists_->directionalLights(), 0};
  return params;
}

void LayeredFrame::bind(const shared::ResolveParams& params) {
  passBlock_.writeValue(params);
  passBlock_.bindUniform(UNIFORM_PASS);
  viewBlock_.bindUniform(UNIFORM_VIEW);
  lightLists_->bind();
  if (shadows_) shadows_->bind();
  scene_.volumes().bind();
}

std::array<gl::Format, 3> LayeredFrame::surfaceFormats() const {
  if (options().storage == Storage::Table) return {gl::Format::RGBA8, gl::Format::RGB10A2, gl::Format::RGBA8};
  return {gl::Format::RGBA32UI, gl::Format::RGBA32UI, gl::Format::RG32UI};
}

SurfaceLayer LayeredFrame::layer(const std::string& label, bool numbered) const {
  const glm::ivec3 size(view_.width, view_.height, 1);
  SurfaceLayer result;
  for (size_t i = 0; i < std::size(result.surface); ++i)
    result.surface[i] = gl::Texture(device(), label, {.format = surfaceFormats()[i], .size = size});
  result.depth = gl::Texture(device(), label + " depth", {.format = gl::Format::R32F, .size = size});
  result.depthTest =
      gl::Texture(device(), label + " depth test", {.format = gl::Format::Depth32FStencil8, .size = size});
  if (numbered)
    result.id = gl::Texture(device(), label + " numbers", {.format = gl::Format::R32UI, .size = size});
  return result;
}

void LayeredFrame::draw(const SurfaceLayer& target, const LayerDraw& what) {
  const Profiler::Scope time(device().profiler(), "G-buffer");
  std::vector<const gl::Texture*> colours = {&target.surface[0], &target.surface[1], &target.surface[2],
                                             &target.depth};
  if (target.id) colours.push_back(&*target.id);
  const gl::Framebuffer framebuffer(colours, &target.depthTest);
  for (int i = 0; i < 3; ++i) {
    if (options().storage == Storage::Table)
      framebuffer.clearColour(i, glm::vec4(0.f));
    else
      framebuffer.clearColour(i, glm::uvec4(0));
  }
  framebuffer.clearColour(3, nothingSeen);
  if (target.id) framebuffer.clearColour(4, glm::uvec4(0));
  framebuffer.clearDepth(1.f);
  framebuffer.clearStencil(0);

  const auto drawSurfaces = [&](Layer surfaces, gl::ShaderDefines defines) {
    defines = gl::joined(gl::joined(scene_.geometry().defines(), storageDefines()), defines);
    if (surfaces == Layer::Translucent) defines.emplace_back("TRANSLUCENT", "1");
    if (what.before) {
      defines.emplace_back("IN_FRONT", "1");
      what.before->depth.bind(TEXTURE_OPAQUE_DEPTH);
    }
    if (target.id) defines.emplace_back("NUMBERED", "1");
    if (what.behind) {
      defines.emplace_back("PEELED", "1");
      what.behind->depth.bind(TEXTURE_PEELED_DEPTH);
      what.behind->id->bind(TEXTURE_PEELED_ID);
    }
    viewBlock_.bindUniform(UNIFORM_VIEW);
    gl::setDrawState({.program = &device().program({"scene/surface.vert", "pipelines/layer.frag"}, defines),
                      .target = &framebuffer,
                      .viewport = {0, 0, view_.width, view_.height},
                      .depthTest = true,
                      .stencil = what.stencil});
    if (what.instance)
      scene_.geometry().drawInstance(*what.instance, what.cull);
    else
      scene_.geometry().draw(surfaces, true);
  };
  if (what.surfaces != LayerDraw::Surfaces::Translucent) drawSurfaces(Layer::Opaque, {});
  if (what.surfaces == LayerDraw::Surfaces::Translucent) drawSurfaces(Layer::Translucent, {});
  if (what.surfaces == LayerDraw::Surfaces::Interlaced)
    drawSurfaces(Layer::Translucent,
                 {{"INTERLACE", options().interlace == Interlace::Checkerboard ? "INTERLACE_CHECKERBOARD"
                                                                               : "INTERLACE_LINES"}});
}

void LayeredFrame::drawLightVolume(size_t number, gl::DrawState state, const shared::ResolveParams& params) {
  const lights::Light& light = this->light(number);
  shared::ResolveParams ofLight = params;
  ofLight.options.w = static_cast<int>(number);
  bind(ofLight);
  const bool everywhere = light.type == lights::LightType::Directional;
  if (!everywhere)
    state.cull = mayBeInside(light, lights::reach(light), view_.camera) ? gl::Cull::Front : gl::Cull::Back;
  state.depthClamp = true;
  gl::setDrawState(state);
  gl::drawGenerated(device(), everywhere ? 3 : proxyVertices, 1);
}

gl::Texture LayeredFrame::light(const SurfaceLayer& layer) {
  const Profiler::Scope time(device().profiler(), "lighting");
  const bool table = options().storage == Storage::Table;
  gl::Texture result(
      device(), "light",
      {.format = table ? gl::Format::RGBA8 : gl::Format::RGBA32F, .size = {view_.width, view_.height, 1}});
  const gl::Framebuffer target(std::vector<const gl::Texture*>{&result}, nullptr);
  gl::DrawState state{.program = &device().program(
                          {"pipelines/whole_image.vert", "pipelines/layer_glow.frag"}, storageDefines()),
                      .target = &target,
                      .viewport = {0, 0, view_.width, view_.height}};
  layer.bind();
  gl::setDrawState(state);
  gl::drawGenerated(device(), 3, 1);
  addLights(layer, target, false);
  return result;
}

void LayeredFrame::addLights(const SurfaceLayer& layer, const gl::Framebuffer& target, bool finished,
                             const std::optional<gl::StencilTest>& stencil) {
  gl::ShaderDefines defines = lightingDefines();
  if (finished) defines.emplace_back("FINISHED", "1");
  const gl::DrawState state{
      .program = &device().program({"pipelines/light_volume.vert", "pipelines/light_volume.frag"}, defines),
      .target = &target,
      .viewport = {0, 0, view_.width, view_.height},
      .blend = gl::Blend::Add,
      .stencil = stencil};
  layer.bind();
  for (size_t i = 0; i < lightCount(); ++i) drawLightVolume(i, state, params());
}

Walk LayeredFrame::startWalk() const {
  std::vector<shared::RayState> states(
      pixels(), {.depth = view_.params.depthRange.x, .throughputR = 1, .throughputG = 1, .throughputB = 1});
  return {gl::Buffer(device(), "rays", std::span<const shared::RayState>(states)), 0};
}

size_t LayeredFrame::walkTo(const SurfaceLayer& layer, const gl::Texture& light, bool last, Walk& walk) {
  const Profiler::Scope time(device().profiler(), "walk");
  gl::ShaderDefines defines = lightingDefines();
  if (last) defines.emplace_back("LAST", "1");
  const gl::Program& program = device().program({"pipelines/layer_walk.comp"}, defines);
  gl::Buffer counters(device(), "walk counters", sizeof(shared::ResolveCounters));
  shared::ResolveParams params = this->params();
  params.options.x = ++walk.layers;
  params.options.w = static_cast<int>(pixels());
  size_t met = 0;
  for (int i = 0;; ++i) {
    base::check(i < maxDispatches, "the walk ends");
    bind(params);
    layer.bind();
    light.bind(TEXTURE_LAYER_LIGHT);
    counters.clear();
    counters.bindStorage(STORAGE_COUNTERS);
    walk.rays.bindStorage(STORAGE_RAYS);
    gl::dispatchLinear(program, pixels());
    gl::storageBarrier();
    const auto counted = counters.readValue<shared::ResolveCounters>();
    statistics.cutWalks += counted.boundHit;
    met += counted.groups;
    if (counted.unfinished == 0) return met;
  }
}

Frame LayeredFrame::finish(const Walk& walk) {
  Frame frame{.radiance = image::Image(view_.width, view_.height, 3)};
  const auto states = walk.rays.readValues<shared::RayState>(pixels());
  const Tile whole{0, 0, view_.width, view_.height};
  for (size_t pixel = 0; pixel < states.size(); ++pixel) {
    const glm::ivec2 place = whole.placeOf(pixel, view_.height);
    std::copy_n(&states[pixel].radianceR, 3, frame.radiance.pixel(place.x, place.y));
  }
  statistics.triangles = scene_.geometry().triangles();
  statistics.tiles = 1;
  if (shadows_) {
    statistics.shadows = shadows_->lights();
    statistics.shadowMaps = figuresOf(*shadows_);
    statistics.cutWalks += shadows_->cutMarches();
  }
  frame.statistics = statistics;
  return frame;
}

}  // namespace sfumato::pipelines
