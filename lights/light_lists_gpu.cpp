#include "lights/light_lists_gpu.h"

#include <algorithm>
#include <cmath>

#include "gl/commands.h"
#include "lights/light_reach.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/lights.h"

namespace sfumato::lights {

namespace {

constexpr size_t proxyVertices = 60;  // of the icosahedron; the cone's pyramid uses 48 of them

shared::LightData lightData(const Light& light, const ShadowFaces& shadow, int number) {
  shared::LightData data{};
  const double distance = reach(light);
  data.position =
      glm::vec4(glm::vec3(light.position), std::isfinite(distance) ? static_cast<float>(distance) : 3e38f);
  const bool spot = light.type == LightType::Spot;
  data.direction =
      glm::vec4(glm::vec3(light.direction), spot ? static_cast<float>(std::cos(light.outerCone)) : -1.f);
  const double window = std::isfinite(light.range) ? std::pow(light.range, -4.0) : 0.0;
  data.intensity = glm::vec4(glm::vec3(light.intensity), static_cast<float>(window));
  data.cone = {0.f, 1.f, 1.f, 0.f};
  if (spot) {
    const double scale = 1.0 / std::max(0.001, std::cos(light.innerCone) - std::cos(light.outerCone));
    data.cone = glm::vec4(scale, -std::cos(light.outerCone) * scale, std::sin(light.outerCone),
                          std::min(std::tan(light.outerCone), 1e6));
  }
  data.indices = {static_cast<int>(light.type), light.castsShadow ? shadow.first : -1, shadow.count, number};
  return data;
}

size_t cellsAlong(int pixels) {
  return static_cast<size_t>((pixels + LightLists::cellSide - 1) / LightLists::cellSide);
}

}  // namespace

LightLists::LightLists(gl::Device& device, const LightListInputs& inputs)
    : order_(lightOrder(inputs.lights)),
      lists_(device, "light lists", cellsAlong(inputs.width) * cellsAlong(inputs.height), sizeof(float),
             cellsAlong(inputs.width) * cellsAlong(inputs.height) * 4) {
  std::vector<shared::LightData> data;
  size_t points = 0;
  size_t spots = 0;
  for (const int number : order_) {
    const Light& light = inputs.lights[static_cast<size_t>(number)];
    data.push_back(lightData(light, inputs.shadows[static_cast<size_t>(number)], number));
    directional_ += light.type == LightType::Directional;
    points += light.type == LightType::Point;
    spots += light.type == LightType::Spot;
  }
  lights_ = gl::Buffer(device, "lights", std::span<const shared::LightData>(data));

  const glm::ivec2 cells(cellsAlong(inputs.width), cellsAlong(inputs.height));
  shared::LightPassParams params{};
  params.cells = {cells.x, cells.y, cellSide, directional_};
  gl::Buffer passBlock(device, "light list pass", sizeof params);
  passBlock.writeValue(params);

  const gl::Program& program = device.program({"lights/light_lists.vert", "lights/light_lists.frag"});
  const gl::Framebuffer noTarget(cells);
  statistics_ = lists_.build(device, [&] {
    lights_.bindStorage(STORAGE_LIGHTS);
    inputs.view.bindUniform(UNIFORM_VIEW);
    passBlock.bindUniform(UNIFORM_PASS);
    gl::setDrawState(
        {.program = &program, .target = &noTarget, .viewport = {0, 0, cells.x, cells.y}, .depthClamp = true});
    if (points + spots > 0) gl::drawGenerated(device, proxyVertices, points + spots);
  });
}

void LightLists::bind() const {
  lights_.bindStorage(STORAGE_LIGHTS);
  lists_.bind(STORAGE_LIGHT_CELL_HEADS, STORAGE_LIGHT_CELL_LINKS, STORAGE_LIGHT_CELL_PAYLOADS);
}

}  // namespace sfumato::lights
