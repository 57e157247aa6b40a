#include "pipelines/resolve_gpu.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "pipelines/smoke_blocks_gpu.h"
#include "shaders/shared/bindings.h"

namespace sfumato::pipelines {

using gl::Profiler;

namespace {

// A dispatch does RESOLVE_WORK_LIMIT of a pixel's work; no sane frame needs this many.
constexpr int maxResolveDispatches = 10000;

// Of programs that march through smoke.
gl::ShaderDefines marchDefines(const SceneGpu& scene, const Quality& quality, const WalkOptions& options) {
  gl::ShaderDefines defines =
      gl::joined({{"SAMPLES", std::to_string(options.samples)}}, scene.lightingDefines(quality));
  if (options.countLookups) defines.emplace_back("COUNT_LOOKUPS", "1");
  return defines;
}

// Of the program that tells the rays that are to be walked.
gl::ShaderDefines passingDefines(const WalkOptions& options) {
  gl::ShaderDefines defines = {{"SAMPLES", std::to_string(options.samples)}};
  if (options.takesBlocks()) defines.emplace_back("SMOKE_BLOCKS", "1");
  if (options.countLookups) defines.emplace_back("COUNT_LOOKUPS", "1");
  if (options.transmittance) defines.emplace_back("TRANSMITTANCE", "1");
  return defines;
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

// Takes all rays of a window into the frame.
class Resolver {
 public:
  Resolver(gl::Device& device, const ResolveInputs& inputs, size_t rays, Frame& frame)
      : device_(device),
        inputs_(inputs),
        options_{inputs.rays.gbuffer.samplePositions.size(), inputs.rays.smokeBlockSide,
                 inputs.rays.countLookups, frame.deep.has_value(), frame.aovs.contains(Aov::Transmittance)},
        rays_(rays),
        frame_(frame),
        pass_(device, inputs.rays),
        seen_(device, "seen by rays", rays * sizeof(glm::vec3) * (options_.transmittance ? 2 : 1)),
        lookups_(device, "lookups", options_.countLookups ? rays * sizeof(glm::uvec4) : 0) {
    if (options_.takesBlocks())
      smoke_ = SmokeBlocks(device, inputs.rays,
                           marchDefines(inputs.rays.scene, inputs.rays.quality, options_), frame.statistics);
  }

  void run() {
    const size_t pixels = inputs_.rays.window.pixels();
    const Split& split = inputs_.rays.split;
    const SplitRays ofPixels{
        pixels, split.count > 0 ? split.groups.readValues<uint32_t>(pixels) : std::vector<uint32_t>(),
        options_.samples - 1};
    const size_t walked = options_.passes(inputs_.rays.scene) ? tellPassing() : rays_;
    states_ = gl::Buffer(device_, "resolve rays", walked * sizeof(shared::RayState));
    if (frame_.deep)
      recordDeep(device_, {inputs_.rays.window, ofPixels, [&](size_t count) { walk(count); }},
                 inputs_.deepLimits, *frame_.deep);
    else if (walked > 0)
      walk(walked);
    frame_.statistics.splitPixels += split.count;
    readSeen(device_, seen_, ofPixels, rays_, inputs_.rays.window, frame_);
    if (options_.countLookups) readLookups(lookups_, ofPixels, rays_, frame_.statistics.lookups);
  }

 private:
  // Of a dispatch over so many rays; binds what it reads and writes.
  shared::ResolveParams paramsOf(size_t rays) const {
    shared::ResolveParams params = rayParams(inputs_.rays);
    params.options.w = static_cast<int>(rays);
    params.blocks.x = options_.smokeBlockSide;
    seen_.bindStorage(STORAGE_SEEN);
    lookups_.bindStorage(STORAGE_LOOKUPS);
    smoke_.bind();
    return params;
  }

  // Lists the rays that are to be walked, and returns how many these are.
  size_t tellPassing() {
    const Profiler::Scope time(device_.profiler(), "passing rays");
    walked_ = gl::Buffer(device_, "walked rays", rays_ * sizeof(uint32_t));
    walked_.bindStorage(STORAGE_WALKED_RAYS);
    const gl::Program& program = device_.program({"pipelines/passing_rays.comp"}, passingDefines(options_));
    return pass_.dispatch(program, paramsOf(rays_)).groups;
  }

  // The first so many of those that are bound: listed here or by a recorder.
  void walk(size_t count) {
    const Profiler::Scope time(device_.profiler(), "walk");
    const gl::Program& program = device_.program(
        {"pipelines/resolve.comp"}, resolveDefines(inputs_.rays.scene, inputs_.rays.quality, options_));
    shared::ResolveParams params = paramsOf(count);
    states_.bindStorage(STORAGE_RAYS);
    if (inputs_.occlusion) inputs_.occlusion->bind();
    int dispatches = 0;
    for (bool unfinished = true; unfinished; params.options.x = 0) {
      base::check(dispatches < maxResolveDispatches, "the resolve ends");
      const shared::ResolveCounters counted = pass_.dispatch(program, params);
      frame_.statistics.cutWalks += counted.boundHit;
      ++dispatches;
      unfinished = counted.unfinished > 0;
    }
    frame_.statistics.resolveDispatches += dispatches;
  }

  gl::Device& device_;
  const ResolveInputs& inputs_;
  const WalkOptions options_;
  const size_t rays_;
  Frame& frame_;
  RayPass pass_;
  SmokeBlocks smoke_;
  gl::Buffer seen_;
  gl::Buffer lookups_;
  gl::Buffer walked_;
  gl::Buffer states_;
};

}  // namespace

gl::ShaderDefines resolveDefines(const SceneGpu& scene, const Quality& quality, const WalkOptions& options) {
  gl::ShaderDefines defines = gl::joined(passingDefines(options), scene.lightingDefines(quality));
  if (options.passes(scene)) defines.emplace_back("PASSING_RAYS", "1");
  if (quality.walkedSmokeNodes > 0) defines.emplace_back("WALK_LISTS", "1");
  if (options.deep) defines.emplace_back("DEEP", "1");
  return gl::joined(defines, occlusionDefines(scene.occlusionOf(quality)));
}

bool resolve(gl::Device& device, const ResolveInputs& inputs, Frame& frame) {
  const size_t furtherSamples = inputs.rays.gbuffer.samplePositions.size() - 1;
  const size_t rays = inputs.rays.window.pixels() + inputs.rays.split.count * furtherSamples;
  if (rays > mostRays(device)) return false;
  Resolver(device, inputs, rays, frame).run();
  return true;
}

}  // namespace sfumato::pipelines
