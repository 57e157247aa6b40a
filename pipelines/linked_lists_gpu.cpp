#include "pipelines/linked_lists_gpu.h"

#include <algorithm>
#include <optional>

#include "pipelines/aovs_gpu.h"
#include "pipelines/gbuffer_gpu.h"
#include "pipelines/receivers_gpu.h"
#include "pipelines/resolve_gpu.h"
#include "pipelines/smoke_rays.h"
#include "pipelines/surface_lists_gpu.h"
#include "scene/camera_view.h"
#include "shaders/shared/aovs.h"
#include "shaders/shared/resolve.h"

namespace sfumato::pipelines {

using gl::Profiler;

namespace {

// Of the G-buffer's pixels; without surfaces there are no edges.
int samplesOf(const SceneGpu& scene, const Quality& quality) {
  if (scene.geometry().triangles() == 0) return 1;
  return std::clamp(quality.samples, 1, std::min(MAX_SAMPLES, scene.device().limits().samples));
}

int smokeBlockSideOf(const SceneGpu& scene, const scene::Camera& camera, int height, const Quality& quality) {
  return quality.walkedSmokeNodes > 0 ? 1
                                      : smokeBlockSide(scene.volumes().extents(), camera, height, quality);
}

// Of a window: whose rays and AOVs fit one buffer each. Empty lists take less.
size_t mostPixels(const gl::Device& device) {
  constexpr size_t bytes = std::max(sizeof(shared::RayState), sizeof(shared::AovPixel));
  return static_cast<size_t>(device.limits().storageBlockBytes) / bytes;
}

// What all tiles of a frame are drawn from.
struct TileInputs {
  const SceneGpu& scene;
  const deepshadow::Maps& shadows;
  const Quality& quality;
  const AmbientOcclusion* occlusion;  // or null
  shared::ViewParams view;            // of the whole image
  int width = 0;
  int height = 0;
  int smokeBlockSide = 1;  // pixels
  bool countLookups = false;
  DeepLimits deepLimits;
};

// Draws a frame tile by tile.
class TilePainter {
 public:
  TilePainter(gl::Device& device, const TileInputs& inputs, size_t windowPixels, Frame& frame)
      : device_(device),
        inputs_(inputs),
        faces_(facesOf(inputs.shadows)),
        hasListedLights_(std::any_of(
            inputs.scene.lights().begin(), inputs.scene.lights().end(),
            [](const lights::Light& light) { return light.type != lights::LightType::Directional; })),
        windowPixels_(std::min(windowPixels, mostPixels(device))),
        view_(device, "camera view", sizeof(shared::ViewParams)),
        frame_(frame) {}

  void draw(const Tile& tile) {
    useView(tile, tile);
    const GBuffer gbuffer = [&] {
      const Profiler::Scope time(device_.profiler(), "opaque G-buffer");
      const int samples = samplesOf(inputs_.scene, inputs_.quality);
      const bool baseColour = frame_.aovs.contains(Aov::Albedo);
      return drawGBuffer(device_, {inputs_.scene.geometry(), view_, inputs_.width, inputs_.height, samples,
                                   tile, baseColour, inputs_.quality.depthsFirst});
    }();
    drawWindow(gbuffer, tile);
    ++frame_.statistics.tiles;
  }

 private:
  // A window that does not fit is drawn as two. Those that follow begin as small as that.
  void drawWindow(const GBuffer& gbuffer, const Tile& window) {
    if (window.pixels() <= windowPixels_) {
      if (tryDrawWindow(gbuffer, window)) return;
      windowPixels_ = window.pixels() / 2;
    }
    for (const Tile& half : halves(window)) drawWindow(gbuffer, half);
  }

  // False when the lists or rays are over the device's limits; throws Memory where a single pixel's are.
  bool tryDrawWindow(const GBuffer& gbuffer, const Tile& window) {
    const bool smallest = window.pixels() == 1;
    useView(gbuffer.tile, window);
    const auto surfaces = [&] {
      const Profiler::Scope time(device_.profiler(), "surface lists");
      const SurfaceListInputs of{
          inputs_.scene.geometry(), view_, gbuffer, inputs_.width, inputs_.height, window,
          inputs_.quality.lists};
      return smallest ? std::optional(buildSurfaceLists(device_, of)) : tryBuildSurfaceLists(device_, of);
    }();
    if (!surfaces) return false;
    const Split split = [&] {
      const Profiler::Scope time(device_.profiler(), "split pixels");
      return splitPixels(device_, {view_, gbuffer, surfaces->lists, window});
    }();
    const auto lightLists = [&] {
      const Profiler::Scope time(device_.profiler(), "light lists");
      std::optional<gl::Buffer> receivers;
      if (hasListedLights_)
        receivers = receiverDepths(device_, {view_, gbuffer, surfaces->lists, split.groups,
                                             inputs_.scene.volumes(), inputs_.width, inputs_.height, window});
      const lights::LightListInputs of{inputs_.scene.lights(),
                                       faces_,
                                       view_,
                                       inputs_.width,
                                       inputs_.height,
                                       window.corners(),
                                       receivers ? &*receivers : nullptr,
                                       remaining(surfaces->statistics.bytes),
                                       inputs_.quality.walkedSmokeNodes > 0};
      return smallest ? std::optional(lights::LightLists(device_, of))
                      : lights::LightLists::tryBuild(device_, of);
    }();
    if (!lightLists) return false;
    const Profiler::Scope time(device_.profiler(), "resolve");
    const RayInputs rays{view_,
                         gbuffer,
                         surfaces->lists,
                         split,
                         *lightLists,
                         inputs_.shadows,
                         inputs_.scene,
                         inputs_.quality,
                         window,
                         inputs_.smokeBlockSide,
                         inputs_.countLookups};
    if (!resolve(device_, {rays, inputs_.occlusion, inputs_.deepLimits}, frame_)) return false;
    const size_t ofRays = frame_.aovs.count(Aov::Transmittance);
    if (frame_.aovs.size() > ofRays)
      drawAovs(device_, {view_, gbuffer, surfaces->lists, *lightLists, inputs_.shadows, window}, frame_.aovs);
    frame_.statistics.lights += lightLists->statistics();
    frame_.statistics.surfaces += surfaces->statistics;
    return true;
  }

  // What the lists of surfaces leave of the budget.
  lists::ListOptions remaining(size_t used) const {
    lists::ListOptions options = inputs_.quality.lists;
    if (options.budgetBytes != 0)
      options.budgetBytes = options.budgetBytes > used ? options.budgetBytes - used : 1;
    return options;
  }

  void useView(const Tile& tile, const Tile& window) {
    shared::ViewParams view = inputs_.view;
    view.tile = tile.corners();
    view.window = window.corners();
    view_.writeValue(view);
  }

  gl::Device& device_;
  const TileInputs& inputs_;
  const std::vector<lights::ShadowFaces> faces_;
  const bool hasListedLights_;
  size_t windowPixels_;  // that are tried at a time
  gl::Buffer view_;
  Frame& frame_;
};

}  // namespace

void LinkedListsPipeline::prepare(const scene::Camera& camera, int height, const Quality& quality,
                                  const FrameOptions& options) {
  const int side = smokeBlockSideOf(scene_, camera, height, quality);
  const WalkOptions walk{static_cast<size_t>(samplesOf(scene_, quality)), side, options.countLookups,
                         options.deep, options.aovs.contains(Aov::Transmittance)};
  scene_.device().program({"pipelines/resolve.comp"}, resolveDefines(scene_, quality, walk));
}

Frame LinkedListsPipeline::render(const scene::Camera& camera, int width, int height, const Quality& quality,
                                  const FrameOptions& options) {
  const FrameView view = viewOf(scene_.scene(), camera, width, height);
  shadows_ = scene_.buildShadows(view, quality, std::move(shadows_));
  Frame frame{.radiance = image::Image(width, height, 3), .aovs = emptyImages(options.aovs, width, height)};
  const DeepLimits deepLimits = withinMemory(options.deepLimits);
  if (options.deep) {
    frame.deep = image::DeepImage(width, height);
    frame.deep->view = deepView(scene::cameraView(camera, width, height));
  }
  for (const size_t light : options.deepShadows)
    frame.deepShadows.push_back(deepShadow(shadows_, light, deepLimits));
  const auto occlusion = scene_.drawOcclusion(view, quality);
  const TileInputs inputs{scene_,
                          shadows_,
                          quality,
                          occlusion ? &*occlusion : nullptr,
                          view.params,
                          width,
                          height,
                          smokeBlockSideOf(scene_, camera, height, quality),
                          options.countLookups,
                          deepLimits};
  TilePainter painter(scene_.device(), inputs, options.windowPixels, frame);
  for (const Tile& tile : tilesOf(width, height, options.tilePixels)) {
    painter.draw(tile);
    options.onTile();
  }
  frame.statistics.shadows = shadows_.lights();
  frame.statistics.shadowLists = shadows_.lists();
  frame.statistics.shadowMaps = figuresOf(shadows_);
  frame.statistics.cutWalks += shadows_.cutMarches();
  frame.statistics.triangles = scene_.geometry().triangles();
  return frame;
}

}  // namespace sfumato::pipelines
