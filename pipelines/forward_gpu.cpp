#include "pipelines/forward_gpu.h"

#include "base/error.h"
#include "gl/program.h"
#include "pipelines/interlaced_gpu.h"
#include "shaders/shared/bindings.h"

namespace sfumato::pipelines {

namespace {

// shaders/pipelines/forward_image.glsl
struct ForwardImage {
  gl::Texture light;
  gl::Texture pass;
  gl::Texture normal;
  gl::Texture depth;
  gl::Texture depthTest;

  void bind() const {
    light.bind(TEXTURE_LAYER_LIGHT);
    pass.bind(TEXTURE_SURFACE_0);
    normal.bind(TEXTURE_SURFACE_1);
    depth.bind(TEXTURE_OPAQUE_DEPTH);
  }
};

ForwardImage emptyImage(const LayeredFrame& frame) {
  const bool table = frame.options().storage == Storage::Table;
  const glm::ivec3 size(frame.view().width, frame.view().height, 1);
  const auto texture = [&](const char* label, gl::Format format) {
    return gl::Texture(frame.device(), label, {.format = format, .size = size});
  };
  return {texture("light", table ? gl::Format::RGBA8 : gl::Format::RGBA32F),
          texture("what is let through", gl::Format::RGBA16F), texture("normals", gl::Format::RGB10A2),
          texture("depth", gl::Format::R32F), texture("depth test", gl::Format::Depth32F)};
}

// Both kinds of surfaces, each with its program.
void drawSurfaces(LayeredFrame& frame, gl::DrawState state, const gl::ShaderDefines& defines) {
  const GeometryGpu& geometry = frame.scene().geometry();
  for (const Layer surfaces : {Layer::Opaque, Layer::Translucent}) {
    if (!geometry.has(surfaces)) continue;
    gl::ShaderDefines all = gl::joined(geometry.defines(), defines);
    if (surfaces == Layer::Translucent) {
      all.emplace_back("TRANSLUCENT", "1");
      all = gl::joined(all, frame.interlaceDefines());
    }
    state.program = &frame.device().program({"scene/surface.vert", "pipelines/forward.frag"}, all);
    gl::setDrawState(state);
    geometry.draw(surfaces, true);
    ++frame.statistics.geometryPasses;
  }
}

void drawAmbient(LayeredFrame& frame, const ForwardImage& image) {
  const gl::Profiler::Scope time(frame.device().profiler(), "ambient");
  const gl::Framebuffer target(
      std::vector<const gl::Texture*>{&image.light, &image.pass, &image.normal, &image.depth},
      &image.depthTest);
  for (int i = 0; i < 3; ++i) target.clearColour(i, glm::vec4(0.f));
  target.clearColour(3, glm::vec4(static_cast<float>(NOTHING_SEEN)));
  target.clearDepth(1.f);
  frame.bind(frame.params());
  drawSurfaces(
      frame,
      {.target = &target, .viewport = {0, 0, frame.view().width, frame.view().height}, .depthTest = true},
      frame.glowDefines());
}

void addLight(LayeredFrame& frame, size_t number, const ForwardImage& image) {
  const gl::Profiler::Scope time(frame.device().profiler(), "lighting");
  const gl::Framebuffer target(std::vector<const gl::Texture*>{&image.light}, &image.depthTest);
  frame.takeTurn(number);
  shared::ResolveParams params = frame.params();
  params.options.w = static_cast<int>(number);
  frame.bind(params);
  drawSurfaces(frame,
               {.target = &target,
                .viewport = {0, 0, frame.view().width, frame.view().height},
                .depthTest = true,
                .depthCompare = gl::Compare::Equal,
                .depthWrite = false,
                .blend = gl::Blend::Add},
               gl::joined(frame.lightingDefines(), {{"LIGHT", "1"}}));
}

}  // namespace

ForwardPipeline::ForwardPipeline(Refraction refraction, gl::Device& device, const scene::Scene& scene,
                                 std::span<const volumes::Medium> media,
                                 const volumes::GridOptions& gridOptions)
    : Pipeline(device, scene, media, gridOptions), refraction_(refraction) {}

Frame ForwardPipeline::render(const scene::Camera& camera, int width, int height, const Quality& quality,
                              const FrameOptions& options) {
  if (quality.deferred.interlace == Interlace::Full)
    base::fail(base::ExitCode::Usage,
               "--interlace full: a forward renderer has one image: choose lines or checkerboard");
  LayeredFrame frame(scene_, camera, width, height, quality, {ShadowKind::Interlaced, true});
  const ForwardImage image = emptyImage(frame);
  drawAmbient(frame, image);
  for (size_t i = 0; i < frame.lightCount(); ++i) addLight(frame, i, image);
  gl::ShaderDefines defines = {{"FORWARD", "1"}};
  if (refraction_ == Refraction::ByMask) defines.emplace_back("REFRACT_BY_MASK", "1");
  options.onTile();
  return composeInterlaced(frame, defines, [&] { image.bind(); });
}

}  // namespace sfumato::pipelines
