#include "pipelines/aovs_gpu.h"

#include <algorithm>
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

}  // namespace sfumato::pipelines
