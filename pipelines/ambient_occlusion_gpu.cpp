#include "pipelines/ambient_occlusion_gpu.h"

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <utility>

#include "base/error.h"
#include "gl/commands.h"
#include "shaders/shared/ambient_occlusion.h"
#include "shaders/shared/bindings.h"

namespace sfumato::pipelines {

using gl::Profiler;

namespace {

// Point i of OCCLUSION_SAMPLES in the unit ball: directions along a Fibonacci spiral, and as many near the
// middle as far from it, as what is near takes most of the light.
glm::dvec3 pointOfBall(int i) {
  constexpr int count = OCCLUSION_SAMPLES;
  constexpr double goldenAngle = std::numbers::pi * (3 - 2.2360679774997896);
  const double z = 1 - (2 * i + 1.0) / count;
  const double angle = goldenAngle * i;
  const double across = std::sqrt(1 - z * z);
  constexpr int stride = 7;  // has no factor in common with the count: neighbours are not equally far out
  const double distance = (stride * i % count + 0.5) / count;
  return distance * glm::dvec3(across * std::cos(angle), across * std::sin(angle), z);
}

shared::OcclusionParams paramsOf(const AmbientOcclusionInputs& inputs, glm::ivec2 size) {
  shared::OcclusionParams params{};
  for (int i = 0; i < OCCLUSION_SAMPLES; ++i) params.offsets[i] = glm::vec4(pointOfBall(i), 0);
  params.size = {size.x, size.y, pixelsAside(inputs.options.size), blurReach(inputs.options.size)};
  params.distances = {inputs.options.radius, inputs.surfacesApart, inputs.blurredWithin, 0};
  return params;
}

gl::Texture resultsOf(gl::Device& device, glm::ivec2 size) {
  return gl::Texture(device, "ambient occlusion",
                     {.format = gl::Format::RGBA32UI, .size = {size.x, size.y, 1}});
}

}  // namespace

gl::ShaderDefines occlusionDefines(OcclusionSize size) {
  if (size == OcclusionSize::Off) return {};
  return {{"SSAO", std::to_string(pixelsAside(size))}};
}

void AmbientOcclusion::bind() const {
  occlusion.bind(TEXTURE_OCCLUSION);
}

AmbientOcclusion drawAmbientOcclusion(gl::Device& device, const AmbientOcclusionInputs& inputs) {
  base::check(inputs.options.size != OcclusionSize::Off && inputs.options.radius > 0,
              "ambient occlusion has a size and a radius");
  const int aside = pixelsAside(inputs.options.size);
  const glm::ivec2 size((inputs.width + aside - 1) / aside, (inputs.height + aside - 1) / aside);
  const gl::ShaderDefines oneSample = {{"SAMPLES", "1"}};
  gl::Texture results = resultsOf(device, size);
  shared::OcclusionParams params = paramsOf(inputs, size);
  gl::Buffer passBlock(device, "occlusion pass", sizeof params);
  passBlock.writeValue(params);
  inputs.view.bindUniform(UNIFORM_VIEW);
  passBlock.bindUniform(UNIFORM_PASS);
  {
    const Profiler::Scope time(device.profiler(), "ambient occlusion");
    inputs.depth.bind(TEXTURE_OPAQUE_DEPTH);
    inputs.surface0.bind(TEXTURE_SURFACE_0);
    results.bindImage(IMAGE_RESULT);
    gl::dispatch(
        device.program({"pipelines/ssao.comp"}, oneSample),
        {gl::groupsFor(static_cast<size_t>(size.x), 8), gl::groupsFor(static_cast<size_t>(size.y), 8), 1});
    gl::barrierBefore(gl::Reader::TextureFetch);
  }
  const Profiler::Scope time(device.profiler(), "occlusion blur");
  gl::Texture blurred = resultsOf(device, size);
  for (const int axis : {0, 1}) {
    params.along = axis == 0 ? glm::ivec4(1, 0, 0, 0) : glm::ivec4(0, 1, 0, 0);
    passBlock.writeValue(params);
    results.bind(TEXTURE_OCCLUSION);
    blurred.bindImage(IMAGE_RESULT);
    gl::dispatch(
        device.program({"pipelines/ssao_blur.comp"}, oneSample),
        {gl::groupsFor(static_cast<size_t>(size[axis]), 64), static_cast<unsigned>(size[1 - axis]), 1});
    gl::barrierBefore(gl::Reader::TextureFetch);
    std::swap(results, blurred);
  }
  return {std::move(results)};
}

}  // namespace sfumato::pipelines
