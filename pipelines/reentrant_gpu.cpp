#include "pipelines/reentrant_gpu.h"

#include <algorithm>
#include <vector>

#include "gl/commands.h"
#include "gl/program.h"
#include "scene/visible_hull.h"
#include "shaders/shared/bindings.h"

namespace sfumato::pipelines {

using gl::Profiler;

namespace {

// Translucent instances that are seen, from back to front by their centres.
std::vector<size_t> backToFront(const SceneGpu& scene, const FrameView& view) {
  const glm::dmat4 viewFromWorld = glm::inverse(view.camera.worldFromView);
  const std::vector<glm::dmat4> boxes = scene::boundingBoxes(scene.scene());
  const auto depth = [&](size_t instance) {
    return -(viewFromWorld * boxes[instance] * glm::dvec4(0.5, 0.5, 0.5, 1)).z;
  };
  std::vector<size_t> order;
  for (size_t i = 0; i < boxes.size(); ++i)
    if (scene.geometry().isTranslucent(i) && !view.seen[i].empty()) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return depth(a) > depth(b); });
  return order;
}

}  // namespace

std::vector<LayerDraw> translucentPasses(const LayeredFrame& frame, const FinishedLight& finished) {
  const LayerDraw all{
      .surfaces = LayerDraw::Surfaces::Translucent, .before = &finished.seen, .mask = {drawn}};
  if (!frame.scene().geometry().has(Layer::Translucent)) return {};
  if (frame.options().passes == Passes::One) return {all};
  std::vector<LayerDraw> passes;
  const auto add = [&](size_t instance, gl::Cull cull) {
    passes.push_back(all);
    passes.back().mask.area = frame.view().areaOf(instance);
    passes.back().instance = instance;
    passes.back().cull = cull;
  };
  for (const size_t instance : backToFront(frame.scene(), frame.view())) {
    if (frame.scene().geometry().isDoubleSided(instance)) add(instance, gl::Cull::Front);
    add(instance, gl::Cull::Back);
  }
  return passes;
}

namespace {

enum class Segment { BehindLayer, ToCamera };

// What comes through the smoke of a segment of each ray of an area, all without one, and through the layer's
// surface before it. How many rays have one.
size_t gather(LayeredFrame& frame, const SurfaceLayer& layer, const FinishedLight& finished, Segment segment,
              const std::optional<glm::ivec4>& area, Walk& walk) {
  const Profiler::Scope time(frame.device().profiler(), "walk");
  gl::ShaderDefines defines = frame.lightingDefines();
  if (segment == Segment::ToCamera) defines.emplace_back("TO_CAMERA", "1");
  shared::ResolveParams params = frame.params();
  params.options.x = ++walk.layers;
  params.area = area.value_or(glm::ivec4(0, 0, frame.view().width, frame.view().height));
  params.options.w = params.area.z * params.area.w;
  return frame.dispatchWalk(
      frame.device().program({"pipelines/reentrant_segment.comp"}, defines), params,
      [&] {
        layer.bind();
        finished.radiance.bind(TEXTURE_FINISHED_LIGHT);
        finished.seen.depth.bind(TEXTURE_FINISHED_DEPTH);
      },
      walk);
}

}  // namespace

FinishedLight noLight(const LayeredFrame& frame) {
  const bool table = frame.options().storage == Storage::Table;
  const glm::ivec3 size(frame.view().width, frame.view().height, 1);
  FinishedLight light;
  light.radiance = gl::Texture(frame.device(), "finished light",
                               {.format = table ? gl::Format::RGBA16F : gl::Format::RGBA32F, .size = size});
  light.seen.depth =
      gl::Texture(frame.device(), "finished depth", {.format = gl::Format::R32F, .size = size});
  const gl::Framebuffer target(std::vector<const gl::Texture*>{&light.radiance, &light.seen.depth}, nullptr);
  target.clearColour(0, glm::vec4(0.f));
  target.clearColour(1, glm::vec4(NOTHING_SEEN));
  return light;
}

void shadeOver(LayeredFrame& frame, const SurfaceLayer& layer, const Walk* background, const Mask& mask,
               const FinishedLight& light) {
  const Profiler::Scope time(frame.device().profiler(), "lighting");
  const gl::Framebuffer start(std::vector<const gl::Texture*>{&light.radiance, &light.seen.depth},
                              &layer.depthTest);
  gl::DrawState state{
      .program = &frame.device().program({"pipelines/whole_image.vert", "pipelines/reentrant_start.frag"},
                                         frame.glowDefines()),
      .target = &start,
      .viewport = {0, 0, frame.view().width, frame.view().height},
      .scissor = mask.area,
      .stencil = mask.stencil};
  frame.bind(frame.params());
  layer.bind();
  gl::setDrawState(state);
  gl::drawGenerated(frame.device(), 3, 1);

  const gl::Framebuffer target(std::vector<const gl::Texture*>{&light.radiance}, &layer.depthTest);
  frame.addLights(layer, target, true, mask);
  if (background == nullptr) return;
  state.program =
      &frame.device().program({"pipelines/whole_image.vert", "pipelines/reentrant_background.frag"});
  state.target = &target;
  state.blend = gl::Blend::Add;
  background->rays.bindStorage(STORAGE_RAYS);
  gl::setDrawState(state);
  gl::drawGenerated(frame.device(), 3, 1);
}

void drawOver(LayeredFrame& frame, const LayerDraw& pass, const SurfaceLayer& layer,
              const FinishedLight& finished, Walk& walk) {
  frame.draw(layer, pass);
  if (gather(frame, layer, finished, Segment::BehindLayer, pass.mask.area, walk) > 0)
    shadeOver(frame, layer, &walk, {whereDrawn, pass.mask.area}, finished);
}

Frame ReentrantPipeline::render(const scene::Camera& camera, int width, int height, const Quality& quality,
                                const FrameOptions& options) {
  LayeredFrame frame(scene_, camera, width, height, quality);
  const FinishedLight finished = noLight(frame);
  const SurfaceLayer layer = frame.layer("layer");
  frame.draw(layer, {.mask = {drawn}});
  shadeOver(frame, layer, nullptr, {whereDrawn}, finished);
  Walk walk = frame.startWalk();
  for (const LayerDraw& pass : translucentPasses(frame, finished))
    drawOver(frame, pass, layer, finished, walk);
  gather(frame, layer, finished, Segment::ToCamera, {}, walk);
  options.onTile();
  return frame.finish(walk);
}

}  // namespace sfumato::pipelines
