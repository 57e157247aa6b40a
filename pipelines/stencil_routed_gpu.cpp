#include "pipelines/stencil_routed_gpu.h"

#include <algorithm>
#include <string>
#include <vector>

#include "gl/commands.h"
#include "gl/program.h"
#include "pipelines/layers_gpu.h"
#include "pipelines/tiles.h"
#include "shaders/shared/bindings.h"

namespace sfumato::pipelines {

using gl::Profiler;

namespace {

constexpr int taken = 2;  // the stencil value of the sample that takes the next fragment
constexpr int highestStencil = 255;
constexpr size_t usualBandBytes = size_t{512} << 20;

int passesFor(int fragments, int samples) {
  return (fragments + samples - 1) / samples;
}

gl::ShaderDefines samplesDefine(int samples) {
  return {{"ROUTED_SAMPLES", std::to_string(samples)}};
}

// As a texture has them: a single one makes no multisample texture, which some drivers do not read well.
int textureSamples(int samples) {
  return samples > 1 ? samples : 0;
}

gl::Texture stencilFor(gl::Device& device, glm::ivec2 size, int samples) {
  return gl::Texture(device, "routing stencil",
                     {.format = gl::Format::Depth32FStencil8,
                      .size = {size.x, size.y, 1},
                      .samples = textureSamples(samples)});
}

// Sample i of every pixel begins with `first` + i.
void startStencil(gl::Device& device, const gl::Texture& stencil, int samples, int first) {
  const gl::Framebuffer target({}, &stencil);
  gl::DrawState state{
      .program = &device.program({"pipelines/whole_image.vert", "pipelines/stencil_only.frag"}),
      .target = &target,
      .viewport = {0, 0, target.size().x, target.size().y}};
  for (int i = 0; i < samples; ++i) {
    state.stencil = gl::StencilTest{.reference = first + i, .passed = gl::StencilChange::Replace};
    state.sampleMask = 1u << i;
    gl::setDrawState(state);
    gl::drawGenerated(device, 3, 1);
  }
}

// Draws what comes into the samples that take it; all samples of a pixel count it.
gl::DrawState routingState(const gl::Program& program, const gl::Framebuffer& target, glm::ivec4 viewport,
                           bool covering) {
  return {.program = &program,
          .target = &target,
          .viewport = viewport,
          .stencil = gl::StencilTest{.compare = gl::Compare::Equal,
                                     .reference = taken,
                                     .passed = gl::StencilChange::Decrement,
                                     .failed = gl::StencilChange::Decrement},
          .multisample = covering};
}

// A program of triangles, or of rectangles about them.
const gl::Program& triangleProgram(gl::Device& device, std::vector<std::string> stages,
                                   const std::string& coveringStage, gl::ShaderDefines defines,
                                   bool covering) {
  if (covering) {
    stages.push_back(coveringStage);
    defines.emplace_back("COVERING", "1");
  }
  return device.program(stages, defines);
}

// Whether each sample of a pixel takes its own of as many fragments at the centre.
bool isRouted(gl::Device& device, int samples, bool covering) {
  const gl::Texture image(device, "routing probe", {.format = gl::Format::R32UI, .samples = samples});
  const gl::Texture stencil = stencilFor(device, {1, 1}, samples);
  const gl::Framebuffer target(std::vector<const gl::Texture*>{&image}, &stencil);
  target.clearColour(0, glm::uvec4(0));
  startStencil(device, stencil, samples, taken);
  gl::Buffer view(device, "camera view", sizeof(shared::ViewParams));
  view.writeValue(shared::ViewParams{.size = {1, 1, 0, 0}});
  view.bindUniform(UNIFORM_VIEW);
  const gl::Program& program =
      triangleProgram(device, {"pipelines/routing_probe.vert", "pipelines/routing_probe.frag"},
                      "scene/covering_only.geom", {}, covering);
  gl::setDrawState(routingState(program, target, {0, 0, 1, 1}, covering));
  gl::drawGenerated(device, 3 * static_cast<size_t>(samples), 1);
  gl::Buffer counters(device, "walk counters", sizeof(shared::ResolveCounters));
  counters.clear();
  counters.bindStorage(STORAGE_COUNTERS);
  image.bind(TEXTURE_ROUTED_KEYS);
  gl::dispatch(device.program({"pipelines/routing_probe.comp"}, samplesDefine(samples)), {1, 1, 1});
  gl::storageBarrier();
  return counters.readValue<shared::ResolveCounters>().groups == static_cast<uint32_t>(samples);
}

// Translucent fragments of one band of the image.
struct Samples {
  gl::Texture surface[3];  // arrays: a layer a pass
  gl::Texture keys;        // depth, number
  gl::Texture stencil;
};

class Router {
 public:
  Router(LayeredFrame& frame, const SurfaceLayer& opaque, const Routing& routing)
      : frame_(frame),
        opaque_(opaque),
        samples_(routing.samples),
        covering_(routing.covering && routing.samples > 1),
        bandView_(frame.device(), "camera view", sizeof(shared::ViewParams)),
        passBlock_(frame.device(), "layer pass", sizeof(shared::ResolveParams)) {
    count();
  }

  // Takes the rays past all translucent surfaces.
  void walk(Walk& walk) {
    for (int first = 0; first < frame_.view().height;) {
      const Band band = bandFrom(first);
      if (band.fragments > 0) {
        useView(band.tile);
        walkPast(band, route(band), walk);
      }
      walk.layers = std::max(walk.layers, band.fragments);
      first += band.tile.height;
    }
  }

 private:
  struct Band {
    Tile tile;
    int fragments = 0;  // of its fullest pixel
  };

  const gl::Program& surfaces(const std::string& fragmentStage, const gl::ShaderDefines& defines) {
    return triangleProgram(frame_.device(), {"scene/surface.vert", fragmentStage}, "scene/covering.geom",
                           defines, covering_);
  }

  // How many fragments each pixel has, and the most in each row.
  void count() {
    const Profiler::Scope time(frame_.device().profiler(), "fragment count");
    const FrameView& view = frame_.view();
    counts_ = gl::Texture(frame_.device(), "fragment counts",
                          {.format = gl::Format::R32F, .size = {view.width, view.height, 1}});
    const gl::Framebuffer target(std::vector<const gl::Texture*>{&counts_}, nullptr);
    target.clearColour(0, glm::vec4(0.f));
    useView({0, 0, view.width, view.height});
    opaque_.depth.bind(TEXTURE_OPAQUE_DEPTH);
    gl::setDrawState(
        {.program = &surfaces("pipelines/fragment_count.frag", frame_.scene().geometry().defines()),
         .target = &target,
         .viewport = {0, 0, view.width, view.height},
         .blend = gl::Blend::Add});
    frame_.scene().geometry().draw(Layer::Translucent, true);
    ++frame_.statistics.geometryPasses;
    std::vector<float> counted(frame_.pixels());
    counts_.read(std::as_writable_bytes(std::span(counted)));
    for (auto row = counted.begin(); row != counted.end(); row += view.width)
      fullest_.push_back(static_cast<int>(*std::max_element(row, row + view.width)));
  }

  size_t bandBytes(int rows, int fragments) const {
    const size_t fragmentBytes = frame_.options().storage == Storage::Table ? 20 : 48;
    const auto passes = static_cast<size_t>(passesFor(fragments, samples_));
    const size_t ofSample = passes * fragmentBytes + 8;
    return static_cast<size_t>(rows) * static_cast<size_t>(frame_.view().width) *
           (static_cast<size_t>(samples_) * ofSample + 8);
  }

  // As many rows as fit.
  Band bandFrom(int first) const {
    const size_t budget = frame_.quality().lists.budgetBytes;
    const size_t allowed = budget > 0 ? budget : usualBandBytes;
    Band band{{0, first, frame_.view().width, 1}, fullest_[static_cast<size_t>(first)]};
    for (int next = first + 1; next < frame_.view().height; ++next) {
      const int fragments = std::max(band.fragments, fullest_[static_cast<size_t>(next)]);
      if (bandBytes(band.tile.height + 1, fragments) > allowed) break;
      ++band.tile.height;
      band.fragments = fragments;
    }
    return band;
  }

  void useView(const Tile& tile) {
    shared::ViewParams view = frame_.view().params;
    view.tile = tile.corners();
    bandView_.writeValue(view);
    bandView_.bindUniform(UNIFORM_VIEW);
  }

  Samples samplesFor(const Band& band) const {
    const glm::ivec3 size(band.tile.width, band.tile.height, passesFor(band.fragments, samples_));
    const auto image = [&](gl::Format format) {
      return gl::Texture(
          frame_.device(), "routed fragments",
          {.format = format, .size = size, .samples = textureSamples(samples_), .array = true});
    };
    Samples samples;
    for (size_t i = 0; i < std::size(samples.surface); ++i)
      samples.surface[i] = image(frame_.surfaceFormats()[i]);
    samples.keys = image(gl::Format::RG32UI);
    samples.stencil = stencilFor(frame_.device(), {size.x, size.y}, samples_);
    return samples;
  }

  // All fragments of a band, in the order in which they are drawn.
  Samples route(const Band& band) {
    const Profiler::Scope time(frame_.device().profiler(), "routing");
    Samples samples = samplesFor(band);
    const int pagePasses = (highestStencil - taken + 1) / samples_;
    gl::Texture pageEnd;
    for (int pass = 0; pass < passesFor(band.fragments, samples_); ++pass) {
      if (pass > 0 && pass % pagePasses == 0) pageEnd = lastFragments(band, samples, pass - 1);
      startStencil(frame_.device(), samples.stencil, samples_, taken + pass % pagePasses * samples_);
      routePass(band, samples, pass, pass >= pagePasses ? &pageEnd : nullptr);
    }
    return samples;
  }

  void routePass(const Band& band, const Samples& samples, int pass, const gl::Texture* pageEnd) {
    const gl::Framebuffer target(std::vector<const gl::Texture*>{&samples.surface[0], &samples.surface[1],
                                                                 &samples.surface[2], &samples.keys},
                                 &samples.stencil, pass);
    target.clearColour(3, glm::uvec4(0xffffffffu));
    const GeometryGpu& geometry = frame_.scene().geometry();
    gl::ShaderDefines defines = gl::joined(geometry.defines(), frame_.storageDefines());
    defines = gl::joined(defines, {{"TRANSLUCENT", "1"}, {"IN_FRONT", "1"}, {"ROUTED", "1"}});
    opaque_.depth.bind(TEXTURE_OPAQUE_DEPTH);
    if (pageEnd != nullptr) {
      defines.emplace_back("PAGED", "1");
      pageEnd->bind(TEXTURE_ROUTED_PAGE);
    }
    gl::setDrawState(routingState(surfaces("pipelines/layer.frag", defines), target,
                                  {-band.tile.x, -band.tile.y, frame_.view().width, frame_.view().height},
                                  covering_));
    geometry.draw(Layer::Translucent, true);
    ++frame_.statistics.geometryPasses;
  }

  // The number of each pixel's last fragment in a pass; the highest one where it has none.
  gl::Texture lastFragments(const Band& band, const Samples& samples, int pass) {
    gl::Texture last(frame_.device(), "routing page",
                     {.format = gl::Format::R32UI, .size = {band.tile.width, band.tile.height, 1}});
    const gl::Framebuffer target(std::vector<const gl::Texture*>{&last}, nullptr);
    passBlock_.writeValue(shared::ResolveParams{.options = {pass, 0, 0, 0}});
    passBlock_.bindUniform(UNIFORM_PASS);
    samples.keys.bind(TEXTURE_ROUTED_KEYS);
    gl::setDrawState(
        {.program = &frame_.device().program({"pipelines/whole_image.vert", "pipelines/routed_page.frag"},
                                             samplesDefine(samples_)),
         .target = &target,
         .viewport = {0, 0, band.tile.width, band.tile.height}});
    gl::drawGenerated(frame_.device(), 3, 1);
    return last;
  }

  void walkPast(const Band& band, const Samples& samples, Walk& walk) {
    const Profiler::Scope time(frame_.device().profiler(), "walk");
    const gl::Buffer met(frame_.device(), "routed walk", band.tile.pixels() * sizeof(glm::uvec2));
    shared::ResolveParams params = frame_.params();
    params.options.w = static_cast<int>(band.tile.pixels());
    frame_.dispatchWalk(
        frame_.device().program({"pipelines/routed_walk.comp"},
                                gl::joined(frame_.lightingDefines(), samplesDefine(samples_))),
        params,
        [&] {
          bandView_.bindUniform(UNIFORM_VIEW);
          samples.surface[0].bind(TEXTURE_SURFACE_0);
          samples.surface[1].bind(TEXTURE_SURFACE_1);
          samples.surface[2].bind(TEXTURE_SURFACE_2);
          samples.keys.bind(TEXTURE_ROUTED_KEYS);
          counts_.bind(TEXTURE_ROUTED_COUNTS);
          met.bindStorage(STORAGE_ROUTED_MET);
        },
        walk);
  }

  LayeredFrame& frame_;
  const SurfaceLayer& opaque_;
  const int samples_;
  const bool covering_;
  gl::Buffer bandView_;
  gl::Buffer passBlock_;
  gl::Texture counts_;
  std::vector<int> fullest_;  // of each row
};

}  // namespace

Routing routingOf(gl::Device& device) {
  const int samples = device.limits().samples;
  if (samples <= 1) return {};
  if (isRouted(device, samples, false)) return {samples, false};
  if (isRouted(device, samples, true)) return {samples, true};
  return {};
}

StencilRoutedPipeline::StencilRoutedPipeline(gl::Device& device, const scene::Scene& scene,
                                             std::span<const volumes::Medium> media,
                                             const volumes::GridOptions& gridOptions)
    : Pipeline(device, scene, media, gridOptions), routing_(routingOf(device)) {}

Frame StencilRoutedPipeline::render(const scene::Camera& camera, int width, int height,
                                    const Quality& quality, const FrameOptions& options) {
  LayeredFrame frame(scene_, camera, width, height, quality);
  const SurfaceLayer opaque = frame.layer("opaque layer");
  frame.draw(opaque, {});
  Walk walk = frame.startWalk();
  Routing routing = routing_;
  if (const int wanted = quality.deferred.samples; wanted > 0)
    routing.samples = std::min(wanted, routing.samples);
  if (scene_.geometry().has(Layer::Translucent)) Router(frame, opaque, routing).walk(walk);
  frame.walkTo(opaque, frame.light(opaque), true, walk);
  options.onTile();
  return frame.finish(walk);
}

}  // namespace sfumato::pipelines
