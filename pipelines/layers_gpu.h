// A frame of a pipeline that draws layers of surfaces, one surface a pixel, and lights them one layer at a
// time by drawing what each light reaches (deferred shading); and the pieces that such pipelines are put
// together from. One sample a pixel, at its centre; the whole image at once.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "deepshadow/interlaced_maps_gpu.h"
#include "deepshadow/maps_gpu.h"
#include "gl/buffer.h"
#include "gl/commands.h"
#include "gl/texture.h"
#include "image/image.h"
#include "lights/light_lists_gpu.h"
#include "pipelines/frame_gpu.h"
#include "pipelines/quality.h"
#include "pipelines/scene_gpu.h"
#include "shaders/shared/resolve.h"

namespace sfumato::pipelines {

// What is seen at each pixel, or nothing. Exact storage: the words of shared::PackedSurface, 40 bytes a
// pixel; table storage (Aladagli 2015, table 3.1): colour and alpha, normal, and specular, roughness,
// metallic and transmission in 8, 10 and 8 bits, 12 bytes. Beside them 4 bytes of depth in metres
// (NOTHING_SEEN), 8 of depth and stencil tests, and, in layers that others are peeled from, 4 of the
// fragment's number.
struct SurfaceLayer {
  gl::Texture surface[3];
  gl::Texture depth;
  gl::Texture depthTest;
  std::optional<gl::Texture> id;

  // For shaders that include shaders/pipelines/layer.glsl.
  void bind() const;
};

// Where something is drawn: what the stencil lets pass in a rectangle of the image; without them everywhere.
struct Mask {
  std::optional<gl::StencilTest> stencil;
  std::optional<glm::ivec4> area;  // x, y from the bottom, width, height
};

struct LayerDraw {
  enum class Surfaces { Opaque, Translucent, Interlaced };
  Surfaces surfaces = Surfaces::Opaque;
  const SurfaceLayer* before = nullptr;  // only what is before these
  const SurfaceLayer* behind = nullptr;  // only what is behind these, by depth and order; they have numbers
  Mask mask;
  std::optional<size_t> instance;  // of the scene: only this one, translucent
  gl::Cull cull = gl::Cull::None;  // of that instance's faces
};

// Rays, one a pixel, that are taken from layer to layer and gather what is seen.
struct Walk {
  gl::Buffer rays;   // shared::RayState
  int layers = 0;    // that they were taken to
  gl::Buffer bends;  // of what is seen through the first surface, where walkTo() refracts
};

// Which shadows a pipeline has by itself. Where it adds up each light once, interlaced maps need room for
// that light alone, unless smoke asks for all of them (Aladagli 2015, section 3.2.1).
struct UsualShadows {
  ShadowKind kind = ShadowKind::Deep;
  bool lightsOnce = false;
};

class LayeredFrame {
 public:
  // Builds the shadows and the light lists of a frame. `usual`: where the options name no shadows. Throws
  // Memory where the image is larger than a texture.
  LayeredFrame(const SceneGpu& scene, const scene::Camera& camera, int width, int height,
               const Quality& quality, const UsualShadows& usual = {});

  // An empty layer.
  SurfaceLayer layer(const std::string& label, bool numbered = false) const;
  // Clears the layer, where the mask's area is, and draws the nearest surfaces into it.
  void draw(const SurfaceLayer& target, const LayerDraw& what);
  // Light on a layer's surfaces; exact: radiance, 16 bytes a pixel; table storage: see layer.glsl, 4 bytes.
  gl::Texture light(const SurfaceLayer& layer);
  // Adds what lights give to a layer's surfaces; `finished`: as radiance, in table storage, too.
  void addLights(const SurfaceLayer& layer, const gl::Framebuffer& target, bool finished,
                 const Mask& mask = {});

  Walk startWalk() const;
  // Through the smoke up to the layer's surfaces and past them; `last`: and no further. How many rays met
  // one.
  size_t walkTo(const SurfaceLayer& layer, const gl::Texture& light, bool last, Walk& walk);

  // Dispatches a program that takes all rays on, or params.options.w of them, until none says that it is
  // unfinished. How many met a surface.
  size_t dispatchWalk(const gl::Program& program, shared::ResolveParams params,
                      const std::function<void()>& bindInputs, Walk& walk);

  // What the rays gathered, and the figures of the frame.
  Frame finish(const Walk& walk);

  gl::Device& device() const { return scene_.device(); }
  const SceneGpu& scene() const { return scene_; }
  const FrameView& view() const { return view_; }
  const Quality& quality() const { return quality_; }
  const DeferredOptions& options() const { return quality_.deferred; }
  size_t pixels() const;
  gl::ShaderDefines storageDefines() const;
  gl::ShaderDefines interlaceDefines() const;
  std::array<gl::Format, 3> surfaceFormats() const;
  // Of programs that begin with what surfaces give by themselves (shaders/pipelines/layer_ambient.glsl).
  gl::ShaderDefines glowDefines() const;
  // Of programs that march or light surfaces.
  gl::ShaderDefines lightingDefines() const;
  // Lights in the order of the light lists.
  size_t lightCount() const { return lightLists_->order().size(); }
  shared::ResolveParams params() const;
  // Before a light is added up: builds its shadow map, where lights have one after the other.
  void takeTurn(size_t number);
  // View, lights, shadows and smoke, and a pass's parameters.
  void bind(const shared::ResolveParams& params);

  FrameStatistics statistics;

 private:
  std::vector<lights::ShadowFaces> buildShadows(bool lightsOnce);
  // Of lights of the scene.
  deepshadow::InterlacedInputs interlacedInputs(const ShadowInputs& inputs, size_t first, size_t count) const;
  const lights::Light& light(size_t number) const;
  // Draws what a light reaches, within the state's scissor, with a state whose program starts with
  // shaders/pipelines/light_volume.vert.
  void drawLightVolume(size_t number, gl::DrawState state, const shared::ResolveParams& params);

  const SceneGpu& scene_;
  FrameView view_;
  Quality quality_;
  ShadowKind shadowKind_;
  gl::Buffer viewBlock_;
  gl::Buffer passBlock_;
  std::optional<deepshadow::Maps> shadows_;
  std::optional<deepshadow::InterlacedMaps> interlaced_;
  std::optional<ShadowInputs> turns_;  // where a map is built for each light in its turn
  std::optional<lights::LightLists> lightLists_;
  std::optional<AmbientOcclusion> occlusion_;
};

}  // namespace sfumato::pipelines
