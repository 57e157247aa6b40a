#include "pipelines/aovs_gpu.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "gl/commands.h"
#include "gl/program.h"
#include "shaders/shared/aovs.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/resolve.h"

namespace sfumato::pipelines {
namespace {

glm::vec3 valueOf(Aov aov, const shared::AovPixel& pixel) {
  const auto count = [](uint32_t number) { return glm::vec3(static_cast<float>(number)); };
  switch (aov) {
    case Aov::Depth:
      return glm::vec3(pixel.depth < static_cast<float>(NOTHING_SEEN)
                           ? pixel.depth
                           : std::numeric_limits<float>::infinity());
    case Aov::Normal:
      return {pixel.normalX, pixel.normalY, pixel.normalZ};
    case Aov::Albedo:
      return {pixel.albedoR, pixel.albedoG, pixel.albedoB};
    case Aov::Lights:
      return count(pixel.lights);
    case Aov::Fragments:
      return count(pixel.fragments);
    default:
      return count(pixel.shadowNodes);
  }
}

// As shaders/shared/math.glsl packs it (Cigolle et al. 2014).
glm::vec3 unitFromOctahedral(glm::vec2 p) {
  glm::vec3 n(p, 1.f - std::abs(p.x) - std::abs(p.y));
  const float fold = std::max(-n.z, 0.f);
  n.x += n.x >= 0.f ? -fold : fold;
  n.y += n.y >= 0.f ? -fold : fold;
  return glm::normalize(n);
}

template <typename Texel>
std::vector<Texel> texelsOf(const gl::Texture& texture) {
  std::vector<Texel> texels(texture.bytes() / sizeof(Texel));
  texture.read(std::as_writable_bytes(std::span(texels)));
  return texels;
}

}  // namespace

void drawAovs(gl::Device& device, const AovInputs& inputs, AovImages& images) {
  const Tile& window = inputs.window;
  gl::ShaderDefines defines = {{"SAMPLES", std::to_string(inputs.gbuffer.samplePositions.size())}};
  if (inputs.gbuffer.baseColour) defines.emplace_back("ALBEDO", "1");
  gl::Buffer pixels(device, "AOVs", window.pixels() * sizeof(shared::AovPixel));
  gl::Buffer passBlock(device, "AOV pass", sizeof(shared::ResolveParams));
  shared::ResolveParams params{};
  params.options.z = inputs.lights.directionalLights();
  setSamples(params, inputs.gbuffer);
  passBlock.writeValue(params);

  inputs.view.bindUniform(UNIFORM_VIEW);
  passBlock.bindUniform(UNIFORM_PASS);
  inputs.gbuffer.depth.bind(TEXTURE_OPAQUE_DEPTH);
  inputs.gbuffer.surface0.bind(TEXTURE_SURFACE_0);
  if (inputs.gbuffer.baseColour) inputs.gbuffer.baseColour->bind(TEXTURE_BASE_COLOUR);
  inputs.surfaces.bind(TEXTURE_LIST_RUNS, TEXTURE_LIST_KEYS, TEXTURE_LIST_PAYLOADS);
  inputs.lights.bind();
  inputs.shadows.bind();
  pixels.bindStorage(STORAGE_AOVS);
  gl::dispatch(device.program({"pipelines/aovs.comp"}, defines),
               {gl::groupsFor(static_cast<size_t>(window.width), 8),
                gl::groupsFor(static_cast<size_t>(window.height), 8), 1});
  gl::storageBarrier();

  const auto values = pixels.readValues<shared::AovPixel>(window.pixels());
  for (auto& [aov, image] : images) {
    if (aov == Aov::Transmittance) continue;
    for (size_t i = 0; i < values.size(); ++i) {
      const glm::ivec2 place = window.placeOf(i, image.height);
      const glm::vec3 value = valueOf(aov, values[i]);
      std::copy_n(&value.x, image.channels, image.pixel(place.x, place.y));
    }
  }
}

void drawSurfaceAovs(const SceneGpu& scene, const scene::Camera& camera, AovImages& images) {
  const gl::Profiler::Scope time(scene.device().profiler(), "surfaces for edges");
  image::Image& depths = images.at(Aov::Depth);
  image::Image& normals = images.at(Aov::Normal);
  const FrameView whole = viewOf(scene.scene(), camera, depths.width, depths.height);
  gl::Buffer view(scene.device(), "camera view", sizeof(shared::ViewParams));
  for (const Tile& tile : tilesOf(depths.width, depths.height)) {
    shared::ViewParams params = whole.params;
    params.tile = params.window = tile.corners();
    view.writeValue(params);
    const GBuffer gbuffer =
        drawGBuffer(scene.device(), {scene.geometry(), view, depths.width, depths.height, 1, tile, false});
    const auto depthTexels = texelsOf<float>(gbuffer.depth);
    const auto surfaceTexels = texelsOf<glm::uvec4>(gbuffer.surface0);
    for (size_t i = 0; i < tile.pixels(); ++i) {
      const bool seen = depthTexels[i] < static_cast<float>(NOTHING_SEEN);
      const glm::vec3 normal =
          seen ? unitFromOctahedral(glm::unpackSnorm2x16(surfaceTexels[i].x)) : glm::vec3(0.f);
      const glm::ivec2 place = tile.placeOf(i, depths.height);
      *depths.pixel(place.x, place.y) = seen ? depthTexels[i] : std::numeric_limits<float>::infinity();
      std::copy_n(&normal.x, 3, normals.pixel(place.x, place.y));
    }
  }
}

}  // namespace sfumato::pipelines
