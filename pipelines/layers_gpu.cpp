#include "pipelines/layers_gpu.h"

#include <algorithm>

#include "base/error.h"
#include "gl/program.h"
#include "lights/light_reach.h"
#include "lights/light_scissor.h"
#include "pipelines/gbuffer_gpu.h"
#include "scene/light_faces.h"
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

// Whether the camera may stand in the mesh of what a light reaches; its far sides show it then.
bool mayBeInside(const lights::Light& light, double reach, const scene::Camera& camera) {
  const glm::dvec3 eye = camera.worldFromView[3];
  if (camera.orthographic) return true;
  return glm::distance(eye, light.position) < meshExcess * reach + 2 * camera.nearDistance;
}

// Of two rectangles; nothing where they have none.
std::optional<glm::ivec4> commonPart(const glm::ivec4& a, const glm::ivec4& b) {
  const glm::ivec2 low = glm::max(glm::ivec2(a), glm::ivec2(b));
  const glm::ivec2 high = glm::min(glm::ivec2(a.x + a.z, a.y + a.w), glm::ivec2(b.x + b.z, b.y + b.w));
  if (glm::any(glm::greaterThanEqual(low, high))) return {};
  return glm::ivec4(low, high - low);
}

deepshadow::InterlacedKind interlacedKind(ShadowKind kind, Storage storage) {
  if (kind == ShadowKind::Opaque) return deepshadow::InterlacedKind::Opaque;
  return storage == Storage::Table ? deepshadow::InterlacedKind::Thesis
                                   : deepshadow::InterlacedKind::Transmittance;
}

}  // namespace

void SurfaceLayer::bind() const {
  surface[0].bind(TEXTURE_SURFACE_0);
  surface[1].bind(TEXTURE_SURFACE_1);
  surface[2].bind(TEXTURE_SURFACE_2);
  depth.bind(TEXTURE_OPAQUE_DEPTH);
}

LayeredFrame::LayeredFrame(const SceneGpu& scene, const scene::Camera& camera, int width, int height,
                           const Quality& quality, const UsualShadows& usual)
    : scene_(scene),
      view_(viewOf(scene.scene(), camera, width, height)),
      quality_(quality),
      shadowKind_(quality.deferred.shadows.value_or(usual.kind)),
      viewBlock_(scene.device(), "camera view", sizeof(shared::ViewParams)),
      passBlock_(scene.device(), "layer pass", sizeof(shared::ResolveParams)) {
  viewBlock_.writeValue(view_.params);
  const auto faces = buildShadows(usual.lightsOnce);
  occlusion_ = scene.drawOcclusion(view_, quality);
  const Profiler::Scope time(device().profiler(), "light lists");
  lightLists_.emplace(device(), lights::LightListInputs{scene.lights(), faces, viewBlock_, width, height,
                                                        std::nullopt, nullptr, quality.lists});
  statistics.lights = lightLists_->statistics();
}

// Where the lights find their shadows.
std::vector<lights::ShadowFaces> LayeredFrame::buildShadows(bool lightsOnce) {
  std::vector<lights::ShadowFaces> none(scene_.lights().size());
  if (shadowKind_ == ShadowKind::None) return none;
  if (shadowKind_ == ShadowKind::Deep) {
    shadows_ = scene_.buildShadows(view_, quality_);
    return facesOf(*shadows_);
  }
  interlaced_.emplace();
  ShadowInputs inputs = scene_.shadowInputs(view_, quality_);
  const bool inTurns = lightsOnce && scene_.volumes().empty();
  const size_t count = none.size();
  auto plan = deepshadow::planOf(
      device(), interlacedInputs(inputs, 0, count), inputs.budget,
      inTurns ? deepshadow::InterlacedStand::InTurns : deepshadow::InterlacedStand::Together);
  inputs.resolutions = plan.resolutions;
  statistics.shadowMaps = {
      .resolutions = std::move(plan.resolutions), .lowered = plan.lowered, .budgetBytes = plan.budgetBytes};
  if (inTurns) {
    turns_ = std::move(inputs);
    for (size_t i = 0; i < count; ++i)
      if (scene_.lights()[i].castsShadow && turns_->resolutions[i] > 0)
        none[i] = {0, scene::faceCount(scene_.lights()[i])};
    return none;
  }
  interlaced_->build(device(), interlacedInputs(inputs, 0, count));
  return facesOf(*interlaced_);
}

deepshadow::InterlacedInputs LayeredFrame::interlacedInputs(const ShadowInputs& inputs, size_t first,
                                                            size_t count) const {
  return {.lights = std::span(scene_.lights()).subspan(first, count),
          .resolutions = std::span(inputs.resolutions).subspan(first, count),
          .casters = inputs.casters,
          .receivers = inputs.receivers,
          .castingPoints = inputs.castingPoints,
          .kind = interlacedKind(shadowKind_, options().storage)};
}

void LayeredFrame::takeTurn(size_t number) {
  if (turns_)
    interlaced_->build(device(),
                       interlacedInputs(*turns_, static_cast<size_t>(lightLists_->order()[number]), 1));
}

size_t LayeredFrame::pixels() const {
  return static_cast<size_t>(view_.width) * static_cast<size_t>(view_.height);
}

gl::ShaderDefines LayeredFrame::storageDefines() const {
  return options().storage == Storage::Table ? gl::ShaderDefines{{"TABLE_STORAGE", "1"}}
                                             : gl::ShaderDefines{};
}

gl::ShaderDefines LayeredFrame::lightingDefines() const {
  const gl::ShaderDefines shadows =
      interlaced_ ? deepshadow::lookupDefines(interlacedKind(shadowKind_, options().storage))
                  : gl::ShaderDefines{};
  return gl::joined({{"SAMPLES", "1"}},
                    gl::joined(gl::joined(scene_.lightingDefines(quality_), storageDefines()), shadows));
}

gl::ShaderDefines LayeredFrame::interlaceDefines() const {
  return {{"INTERLACE",
           options().interlace == Interlace::Checkerboard ? "INTERLACE_CHECKERBOARD" : "INTERLACE_LINES"}};
}

gl::ShaderDefines LayeredFrame::glowDefines() const {
  return gl::joined(lightingDefines(), occlusionDefines(scene_.occlusionOf(quality_)));
}

const lights::Light& LayeredFrame::light(size_t number) const {
  return scene_.lights()[static_cast<size_t>(lightLists_->order()[number])];
}

shared::ResolveParams LayeredFrame::params() const {
  shared::ResolveParams params = scene_.lightingParams(quality_, lightLists_->directionalLights());
  params.march.z = static_cast<float>(options().refraction * view_.height);
  return params;
}

void LayeredFrame::bind(const shared::ResolveParams& params) {
  passBlock_.writeValue(params);
  passBlock_.bindUniform(UNIFORM_PASS);
  viewBlock_.bindUniform(UNIFORM_VIEW);
  lightLists_->bind();
  if (shadows_) shadows_->bind();
  if (interlaced_) interlaced_->bind();
  scene_.volumes().bind();
  if (occlusion_) occlusion_->bind();
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
  const auto& area = what.mask.area;
  for (int i = 0; i < 3; ++i) {
    if (options().storage == Storage::Table)
      framebuffer.clearColour(i, glm::vec4(0.f), area);
    else
      framebuffer.clearColour(i, glm::uvec4(0), area);
  }
  framebuffer.clearColour(3, nothingSeen, area);
  if (target.id) framebuffer.clearColour(4, glm::uvec4(0), area);
  framebuffer.clearDepth(1.f, area);
  framebuffer.clearStencil(0, area);

  const auto drawSurfaces = [&](Layer surfaces, gl::ShaderDefines defines) {
    statistics.geometryPasses += surfaces == Layer::Opaque && quality_.depthsFirst ? 2 : 1;
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
    const gl::DrawState state{
        .program = &device().program({"scene/surface.vert", "pipelines/layer.frag"}, defines),
        .target = &framebuffer,
        .viewport = {0, 0, view_.width, view_.height},
        .scissor = area,
        .depthTest = true,
        .stencil = what.mask.stencil};
    if (surfaces == Layer::Opaque) {
      drawOpaque(device(), scene_.geometry(), state, target.depthTest, quality_.depthsFirst);
      return;
    }
    gl::setDrawState(state);
    if (what.instance)
      scene_.geometry().drawInstance(*what.instance, what.cull);
    else
      scene_.geometry().draw(surfaces, true);
  };
  if (what.surfaces != LayerDraw::Surfaces::Translucent) drawSurfaces(Layer::Opaque, {});
  if (what.surfaces == LayerDraw::Surfaces::Translucent) drawSurfaces(Layer::Translucent, {});
  if (what.surfaces == LayerDraw::Surfaces::Interlaced) drawSurfaces(Layer::Translucent, interlaceDefines());
}

void LayeredFrame::drawLightVolume(size_t number, gl::DrawState state, const shared::ResolveParams& params) {
  const lights::Light& light = this->light(number);
  auto scissor = lights::lightScissor(light, view_.params);
  if (scissor && state.scissor) scissor = commonPart(*scissor, *state.scissor);
  if (!scissor) return;
  state.scissor = scissor;
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
                          {"pipelines/whole_image.vert", "pipelines/layer_glow.frag"}, glowDefines()),
                      .target = &target,
                      .viewport = {0, 0, view_.width, view_.height}};
  bind(params());
  layer.bind();
  gl::setDrawState(state);
  gl::drawGenerated(device(), 3, 1);
  addLights(layer, target, false);
  return result;
}

void LayeredFrame::addLights(const SurfaceLayer& layer, const gl::Framebuffer& target, bool finished,
                             const Mask& mask) {
  gl::ShaderDefines defines = lightingDefines();
  if (finished) defines.emplace_back("FINISHED", "1");
  const gl::DrawState state{
      .program = &device().program({"pipelines/light_volume.vert", "pipelines/light_volume.frag"}, defines),
      .target = &target,
      .viewport = {0, 0, view_.width, view_.height},
      .scissor = mask.area,
      .blend = gl::Blend::Add,
      .stencil = mask.stencil};
  for (size_t i = 0; i < lightCount(); ++i) {
    takeTurn(i);
    layer.bind();
    drawLightVolume(i, state, params());
  }
}

Walk LayeredFrame::startWalk() const {
  std::vector<shared::RayState> states(
      pixels(), {.depth = view_.params.depthRange.x, .throughputR = 1, .throughputG = 1, .throughputB = 1});
  return {gl::Buffer(device(), "rays", std::span<const shared::RayState>(states)), 0, {}};
}

size_t LayeredFrame::walkTo(const SurfaceLayer& layer, const gl::Texture& light, bool last, Walk& walk) {
  const Profiler::Scope time(device().profiler(), "walk");
  gl::ShaderDefines defines = lightingDefines();
  if (last) defines.emplace_back("LAST", "1");
  const bool bent = options().refraction > 0;
  if (bent) defines.emplace_back("BENT", "1");
  if (bent && walk.bends.bytes() == 0) {
    walk.bends = gl::Buffer(device(), "bends", pixels() * sizeof(glm::uvec2));
    walk.bends.clear();
  }
  shared::ResolveParams params = this->params();
  params.options.x = ++walk.layers;
  return dispatchWalk(
      device().program({"pipelines/layer_walk.comp"}, defines), params,
      [&] {
        layer.bind();
        light.bind(TEXTURE_LAYER_LIGHT);
        if (bent) walk.bends.bindStorage(STORAGE_BENDS);
      },
      walk);
}

size_t LayeredFrame::dispatchWalk(const gl::Program& program, shared::ResolveParams params,
                                  const std::function<void()>& bindInputs, Walk& walk) {
  gl::Buffer counters(device(), "walk counters", sizeof(shared::ResolveCounters));
  if (params.options.w == 0) params.options.w = static_cast<int>(pixels());
  size_t met = 0;
  for (int i = 0;; ++i) {
    base::check(i < maxDispatches, "the walk ends");
    bind(params);
    bindInputs();
    counters.clear();
    counters.bindStorage(STORAGE_COUNTERS);
    walk.rays.bindStorage(STORAGE_RAYS);
    gl::dispatchLinear(program, static_cast<size_t>(params.options.w));
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
    statistics.shadowLists = shadows_->lists();
    statistics.shadowMaps = figuresOf(*shadows_);
    statistics.cutWalks += shadows_->cutMarches();
  }
  if (interlaced_) statistics.shadowMaps.bytes = interlaced_->bytes();
  frame.statistics = statistics;
  return frame;
}

}  // namespace sfumato::pipelines
