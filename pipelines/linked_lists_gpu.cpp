#include "pipelines/linked_lists_gpu.h"

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "gl/commands.h"
#include "gl/program.h"
#include "pipelines/ambient_occlusion_gpu.h"
#include "pipelines/aovs_gpu.h"
#include "pipelines/gbuffer_gpu.h"
#include "pipelines/receivers_gpu.h"
#include "pipelines/smoke_rays.h"
#include "pipelines/surface_lists_gpu.h"
#include "scene/camera_view.h"
#include "shaders/shared/aovs.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/resolve.h"

namespace sfumato::pipelines {

using gl::Profiler;

namespace {

// A dispatch does RESOLVE_WORK_LIMIT of a pixel's work; no sane frame needs this many.
constexpr int maxResolveDispatches = 10000;

// Of the G-buffer's pixels; without surfaces there are no edges.
int samplesOf(const SceneGpu& scene, const Quality& quality) {
  if (scene.geometry().triangles() == 0) return 1;
  return std::clamp(quality.samples, 1, std::min(MAX_SAMPLES, scene.device().limits().samples));
}

int smokeBlockSideOf(const SceneGpu& scene, const scene::Camera& camera, int height, const Quality& quality) {
  return quality.walkedSmokeNodes > 0 ? 1
                                      : smokeBlockSide(scene.volumes().extents(), camera, height, quality);
}

// What a frame's rays are walked for.
struct WalkOptions {
  size_t samples;
  int smokeBlockSide;  // pixels
  bool countLookups;
  bool deep;
  bool transmittance;  // of each ray is kept

  bool takesBlocks() const { return smokeBlockSide > 1 && !deep; }
  // Rays that march smoke by themselves, and those that are recorded, are all walked.
  bool passes(const SceneGpu& scene) const { return !deep && (scene.volumes().empty() || takesBlocks()); }
};

// Of programs that march through smoke.
gl::ShaderDefines marchDefines(const SceneGpu& scene, const Quality& quality, const WalkOptions& options) {
  gl::ShaderDefines defines =
      gl::joined({{"SAMPLES", std::to_string(options.samples)}}, scene.lightingDefines(quality));
  if (options.countLookups) defines.emplace_back("COUNT_LOOKUPS", "1");
  return defines;
}

// Of the program that walks the rays.
gl::ShaderDefines resolveDefines(const SceneGpu& scene, const Quality& quality, const WalkOptions& options) {
  gl::ShaderDefines defines = marchDefines(scene, quality, options);
  if (options.takesBlocks()) defines.emplace_back("SMOKE_BLOCKS", "1");
  if (options.passes(scene)) defines.emplace_back("PASSING_RAYS", "1");
  if (quality.walkedSmokeNodes > 0) defines.emplace_back("WALK_LISTS", "1");
  if (options.deep) defines.emplace_back("DEEP", "1");
  if (options.transmittance) defines.emplace_back("TRANSMITTANCE", "1");
  return gl::joined(defines, occlusionDefines(scene.occlusionOf(quality)));
}

// Of the program that tells the rays that are to be walked.
gl::ShaderDefines passingDefines(const WalkOptions& options) {
  gl::ShaderDefines defines = {{"SAMPLES", std::to_string(options.samples)}};
  if (options.takesBlocks()) defines.emplace_back("SMOKE_BLOCKS", "1");
  if (options.countLookups) defines.emplace_back("COUNT_LOOKUPS", "1");
  if (options.transmittance) defines.emplace_back("TRANSMITTANCE", "1");
  return defines;
}

// Pixels that are walked sample by sample: see shaders/shared/resolve.h.
struct Split {
  gl::Buffer groups;  // pixelGroups
  size_t count = 0;   // of groups
};

// Of a window of the image.
struct SplitInputs {
  const gl::Buffer& view;
  const GBuffer& gbuffer;
  const lists::Lists& surfaces;
  Tile window;
};

struct ResolveInputs {
  const gl::Buffer& view;
  const GBuffer& gbuffer;
  const lists::Lists& surfaces;
  const Split& split;
  const lights::LightLists& lights;
  const deepshadow::Maps& shadows;
  const SceneGpu& scene;
  const Quality& quality;
  const AmbientOcclusion* occlusion;  // of the image, or null
  Tile window;
  int smokeBlockSide;  // pixels
  bool countLookups;
  DeepLimits deepLimits;
};

template <typename Inputs>
void bindRayInputs(const Inputs& inputs) {
  inputs.view.bindUniform(UNIFORM_VIEW);
  inputs.surfaces.bind(TEXTURE_LIST_RUNS, TEXTURE_LIST_KEYS, TEXTURE_LIST_PAYLOADS);
  inputs.gbuffer.depth.bind(TEXTURE_OPAQUE_DEPTH);
  inputs.gbuffer.surface0.bind(TEXTURE_SURFACE_0);
  inputs.gbuffer.surface1.bind(TEXTURE_SURFACE_1);
}

shared::ResolveParams resolveParams(const ResolveInputs& inputs) {
  shared::ResolveParams params =
      inputs.scene.lightingParams(inputs.quality, inputs.lights.directionalLights());
  params.options.x = 1;
  setSamples(params, inputs.gbuffer);
  return params;
}

Split splitPixels(gl::Device& device, const SplitInputs& inputs) {
  const size_t pixels = inputs.window.pixels();
  Split split;
  if (inputs.gbuffer.samplePositions.size() == 1) {
    split.groups = gl::Buffer(device, "pixel groups", 0);
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
    gl::dispatch(program, {gl::groupsFor(static_cast<size_t>(inputs.window.width), 8),
                           gl::groupsFor(static_cast<size_t>(inputs.window.height), 8), 1});
    gl::storageBarrier();
    split.count = counters.readValue<shared::ResolveCounters>().groups;
    if (split.count <= capacity) return split;
    capacity = split.count;
  }
}

// What the rays of the window's pixels saw, radiance and then transmittance where that is wanted: see
// shaders/pipelines/rays.glsl. A split pixel is the mean of its samples.
void readSeen(gl::Device& device, const gl::Buffer& seen, const SplitRays& ofPixels, size_t rayCount,
              const Tile& window, Frame& frame) {
  const Profiler::Scope time(device.profiler(), "read back");
  const auto transmittance = frame.aovs.find(Aov::Transmittance);
  const bool both = transmittance != frame.aovs.end();
  seen.withValues<glm::vec3>(rayCount * (both ? 2 : 1), [&](std::span<const glm::vec3> values) {
    const auto write = [&](std::span<const glm::vec3> ofRays, image::Image& image) {
      base::parallelFor(window.height, [&](long row) {
        const auto across = static_cast<size_t>(window.width);
        for (size_t pixel = static_cast<size_t>(row) * across, end = pixel + across; pixel < end; ++pixel) {
          glm::vec3 mean(0.f);
          float count = 0;
          ofPixels.forEachRay(pixel, [&](size_t ray) {
            mean += ofRays[ray];
            ++count;
          });
          mean /= count;
          const glm::ivec2 place = window.placeOf(pixel, image.height);
          std::copy_n(&mean.x, 3, image.pixel(place.x, place.y));
        }
      });
    };
    write(values.first(rayCount), frame.radiance);
    if (both) write(values.last(rayCount), transmittance->second);
  });
}

void add(const glm::u64vec4& counted, Lookups& all) {
  all.lights += counted.x;
  all.shadows += counted.y;
  all.steps += counted.z;
  all.jumpedSteps += counted.w;
}

// Adds what the window's pixels looked up; that of a split pixel is the sum over its samples.
void readLookups(const gl::Buffer& lookups, const SplitRays& ofPixels, size_t rayCount, Lookups& all) {
  const auto ofRays = lookups.readValues<glm::uvec4>(rayCount);
  const size_t pixels = ofPixels.pixels;
  for (size_t pixel = 0; pixel < pixels; ++pixel) {
    glm::u64vec4 sum(0);
    ofPixels.forEachRay(pixel, [&](size_t ray) { sum += ofRays[ray]; });
    add(sum, all);
    all.mostLights = std::max<size_t>(all.mostLights, sum.x);
    all.mostShadows = std::max<size_t>(all.mostShadows, sum.y);
  }
  all.pixels += pixels;
}

size_t mostRays(const gl::Device& device) {
  return static_cast<size_t>(device.limits().storageBlockBytes) / sizeof(shared::RayState);
}

// Of a window: whose rays and AOVs fit one buffer each. Empty lists take less.
size_t mostPixels(const gl::Device& device) {
  constexpr size_t bytes = std::max(sizeof(shared::RayState), sizeof(shared::AovPixel));
  return static_cast<size_t>(device.limits().storageBlockBytes) / bytes;
}

// What the passes that walk rays read and write, beside what only one of them does.
class Walk {
 public:
  Walk(gl::Device& device, const ResolveInputs& inputs)
      : inputs_(inputs),
        passBlock_(device, "resolve pass", sizeof(shared::ResolveParams)),
        counters_(device, "resolve counters", sizeof(shared::ResolveCounters)) {}

  // One dispatch, over `params.options.w` rays.
  shared::ResolveCounters dispatch(const gl::Program& program, const shared::ResolveParams& params) {
    passBlock_.writeValue(params);
    counters_.clear();
    bindRayInputs(inputs_);
    passBlock_.bindUniform(UNIFORM_PASS);
    inputs_.split.groups.bindStorage(STORAGE_PIXEL_GROUPS);
    counters_.bindStorage(STORAGE_COUNTERS);
    inputs_.lights.bind();
    inputs_.shadows.bind();
    inputs_.scene.volumes().bind();
    gl::dispatchLinear(program, static_cast<size_t>(params.options.w));
    gl::storageBarrier();
    return counters_.readValue<shared::ResolveCounters>();
  }

 private:
  const ResolveInputs& inputs_;
  gl::Buffer passBlock_;
  gl::Buffer counters_;
};

// Smoke that was marched for blocks of the window's pixels (SmokeBlock), where rays may be so far apart.
class SmokeBlocks {
 public:
  SmokeBlocks() = default;

  SmokeBlocks(gl::Device& device, const ResolveInputs& inputs, const gl::ShaderDefines& defines,
              FrameStatistics& statistics) {
    const Profiler::Scope time(device.profiler(), "smoke");
    const int side = inputs.smokeBlockSide;
    const size_t count = blocksAlong(inputs.window.x, inputs.window.width, side) *
                         blocksAlong(inputs.window.y, inputs.window.height, side);
    shared::ResolveParams params = resolveParams(inputs);
    params.blocks = {side, 0, 0, static_cast<int>(count)};
    params.options.w = static_cast<int>(count);
    march(device, inputs, device.program({"pipelines/smoke_blocks.comp"}, defines), params, statistics);

    const gl::Buffer parents(device, "smoke parents", count * sizeof(uint32_t));
    parents.bindStorage(STORAGE_SMOKE_PARENTS);
    bind();
    blocks_.bindStorage(STORAGE_RAYS);
    const size_t refined = Walk(device, inputs)
                               .dispatch(device.program({"pipelines/smoke_refine.comp"}, defines), params)
                               .groups;
    if (refined == 0) return;
    params.options.w = static_cast<int>(refined) * side * side;
    parents.bindStorage(STORAGE_SMOKE_PARENTS);
    march(device, inputs,
          device.program({"pipelines/smoke_blocks.comp"}, gl::joined(defines, {{"REFINED", "1"}})), params,
          statistics);
  }

  void bind() const {
    blockTexture_.bind(TEXTURE_SMOKE_BLOCKS);
    knotTexture_.bind(TEXTURE_SMOKE_KNOTS);
  }

 private:
  static constexpr size_t knotBytes = sizeof(glm::uvec4);

  static size_t blocksAlong(int first, int pixels, int side) {
    return static_cast<size_t>((first + pixels + side - 1) / side - first / side);
  }

  static gl::Buffer grown(gl::Device& device, const char* label, const gl::Buffer& buffer, size_t bytes) {
    gl::Buffer result(device, label, buffer.bytes() + bytes);
    if (buffer.bytes() > 0) result.copyFrom(buffer, buffer.bytes());
    return result;
  }

  // Marches `params.options.w` more blocks.
  void march(gl::Device& device, const ResolveInputs& inputs, const gl::Program& program,
             shared::ResolveParams params, FrameStatistics& statistics) {
    const auto count = static_cast<size_t>(params.options.w);
    const size_t most = std::min(static_cast<size_t>(device.limits().textureBufferTexels),
                                 static_cast<size_t>(device.limits().storageBlockBytes) / knotBytes);
    params.blocks.y = static_cast<int>((most - knots_) / count);
    params.blocks.z = -1;
    blocks_ = grown(device, "smoke blocks", blocks_, count * sizeof(shared::SmokeBlock));
    Walk walk(device, inputs);
    blocks_.bindStorage(STORAGE_RAYS);
    const bool surfaces = inputs.scene.geometry().triangles() > 0;  // without them nothing stops in the smoke
    const size_t knots = surfaces ? walk.dispatch(program, params).groups : 0;
    params.blocks.z = static_cast<int>(knots_);
    knotBuffer_ = grown(device, "smoke knots", knotBuffer_, knots * knotBytes);
    knots_ += knots;
    const gl::Buffer lookups(device, "lookups", inputs.countLookups ? count * sizeof(glm::uvec4) : 0);
    for (shared::ResolveCounters counted{.unfinished = 1}; counted.unfinished > 0; params.options.x = 0) {
      knotBuffer_.bindStorage(STORAGE_SMOKE_KNOTS);
      lookups.bindStorage(STORAGE_LOOKUPS);
      counted = walk.dispatch(program, params);
      statistics.cutWalks += counted.boundHit;
    }
    if (inputs.countLookups)
      for (const glm::uvec4& ofBlock : lookups.readValues<glm::uvec4>(count))
        add(ofBlock, statistics.lookups);
    blockTexture_ = gl::BufferTexture(device, blocks_, gl::BufferFormat::RGBA32F);
    knotTexture_ = gl::BufferTexture(device, knotBuffer_, gl::BufferFormat::RGBA32UI);
  }

  gl::Buffer blocks_;
  gl::Buffer knotBuffer_;
  size_t knots_ = 0;  // in it
  gl::BufferTexture blockTexture_;
  gl::BufferTexture knotTexture_;
};

// Lights the window's pixels into the frame; false when their rays do not fit one buffer.
bool resolve(gl::Device& device, const ResolveInputs& inputs, Frame& frame) {
  const Split& split = inputs.split;
  const size_t samples = inputs.gbuffer.samplePositions.size();
  const size_t rayCount = inputs.window.pixels() + split.count * (samples - 1);
  if (rayCount > mostRays(device)) return false;
  const bool transmittance = frame.aovs.contains(Aov::Transmittance);
  const WalkOptions options{samples, inputs.smokeBlockSide, inputs.countLookups, frame.deep.has_value(),
                            transmittance};
  SmokeBlocks smoke;
  if (options.takesBlocks())
    smoke =
        SmokeBlocks(device, inputs, marchDefines(inputs.scene, inputs.quality, options), frame.statistics);
  const gl::Buffer seen(device, "seen by rays", rayCount * sizeof(glm::vec3) * (transmittance ? 2 : 1));
  const gl::Buffer lookups(device, "lookups", inputs.countLookups ? rayCount * sizeof(glm::uvec4) : 0);
  Walk walk(device, inputs);
  const auto paramsOf = [&](size_t count) {
    shared::ResolveParams params = resolveParams(inputs);
    params.options.w = static_cast<int>(count);
    params.blocks.x = inputs.smokeBlockSide;
    seen.bindStorage(STORAGE_SEEN);
    lookups.bindStorage(STORAGE_LOOKUPS);
    smoke.bind();
    return params;
  };
  size_t walkedCount = rayCount;
  gl::Buffer walked;
  if (options.passes(inputs.scene)) {
    const Profiler::Scope time(device.profiler(), "passing rays");
    walked = gl::Buffer(device, "walked rays", rayCount * sizeof(uint32_t));
    walked.bindStorage(STORAGE_WALKED_RAYS);
    const gl::Program& program = device.program({"pipelines/passing_rays.comp"}, passingDefines(options));
    walkedCount = walk.dispatch(program, paramsOf(rayCount)).groups;
  }
  const gl::Buffer rays(device, "resolve rays", walkedCount * sizeof(shared::RayState));
  const auto walkRays = [&](size_t count) {
    const Profiler::Scope time(device.profiler(), "walk");
    const gl::Program& program =
        device.program({"pipelines/resolve.comp"}, resolveDefines(inputs.scene, inputs.quality, options));
    shared::ResolveParams params = paramsOf(count);
    rays.bindStorage(STORAGE_RAYS);
    if (inputs.occlusion) inputs.occlusion->bind();
    int dispatches = 0;
    for (bool unfinished = true; unfinished; params.options.x = 0) {
      base::check(dispatches < maxResolveDispatches, "the resolve ends");
      const shared::ResolveCounters counted = walk.dispatch(program, params);
      frame.statistics.cutWalks += counted.boundHit;
      ++dispatches;
      unfinished = counted.unfinished > 0;
    }
    frame.statistics.resolveDispatches += dispatches;
  };
  const SplitRays ofPixels{
      inputs.window.pixels(),
      split.count > 0 ? split.groups.readValues<uint32_t>(inputs.window.pixels()) : std::vector<uint32_t>(),
      samples - 1};
  if (frame.deep)
    recordDeep(device, {inputs.window, ofPixels, walkRays}, inputs.deepLimits, *frame.deep);
  else if (walkedCount > 0)
    walkRays(walkedCount);
  frame.statistics.splitPixels += split.count;
  readSeen(device, seen, ofPixels, rayCount, inputs.window, frame);
  if (inputs.countLookups) readLookups(lookups, ofPixels, rayCount, frame.statistics.lookups);
  return true;
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
    if (!resolve(device_,
                 {view_, gbuffer, surfaces->lists, split, *lightLists, inputs_.shadows, inputs_.scene,
                  inputs_.quality, inputs_.occlusion, window, inputs_.smokeBlockSide, inputs_.countLookups,
                  inputs_.deepLimits},
                 frame_))
      return false;
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
  const deepshadow::Maps shadows = scene_.buildShadows(view, quality, linkedNodes_);
  Frame frame{.radiance = image::Image(width, height, 3), .aovs = emptyImages(options.aovs, width, height)};
  const DeepLimits deepLimits = withinMemory(options.deepLimits);
  if (options.deep) {
    frame.deep = image::DeepImage(width, height);
    frame.deep->view = deepView(scene::cameraView(camera, width, height));
  }
  for (const size_t light : options.deepShadows)
    frame.deepShadows.push_back(deepShadow(shadows, light, deepLimits));
  const auto occlusion = scene_.drawOcclusion(view, quality);
  const TileInputs inputs{scene_,
                          shadows,
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
  frame.statistics.shadows = shadows.lights();
  frame.statistics.shadowMaps = figuresOf(shadows);
  if (shadows.linkedNodes() > 0) linkedNodes_ = shadows.linkedNodes();
  frame.statistics.cutWalks += shadows.cutMarches();
  frame.statistics.triangles = scene_.geometry().triangles();
  return frame;
}

}  // namespace sfumato::pipelines
