#include "lights/light_lists_gpu.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "gl/commands.h"
#include "gl/texture.h"
#include "lights/light_reach.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/lights.h"

namespace sfumato::lights {

namespace {

constexpr size_t manyLights = 256;    // from here on computing was the faster: docs/measured.md
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

}  // namespace

LightLists::Cells LightLists::cellsOf(int width, int height, const glm::ivec4& window) {
  const glm::ivec2 first = glm::ivec2(window) / cellSide;
  return {.ofImage = {cellsAlong(width), cellsAlong(height)},
          .first = first,
          .count = glm::ivec2(cellsAlong(window.x + window.z), cellsAlong(window.y + window.w)) - first};
}

LightLists::Cells LightLists::cellsOf(const LightListInputs& inputs) {
  return cellsOf(inputs.width, inputs.height,
                 inputs.window.value_or(glm::ivec4(0, 0, inputs.width, inputs.height)));
}

LightLists::LightLists(gl::Device& device, const LightListInputs& inputs, const Cells& cells)
    : order_(lightOrder(inputs.lights)),
      lists_(device, "light lists", cells.number(), 0, inputs.lists),
      linked_(inputs.linked) {
  if (order_.size() > LIGHT_MOST)
    base::fail(base::ExitCode::Input, "scene: {} lights, and at most {} can be drawn: remove some",
               order_.size(), LIGHT_MOST);
  std::vector<shared::LightData> data;
  for (const int number : order_) {
    const Light& light = inputs.lights[static_cast<size_t>(number)];
    data.push_back(lightData(light, inputs.shadows[static_cast<size_t>(number)], number));
    directional_ += light.type == LightType::Directional;
  }
  lights_ = gl::Records(device, "lights", std::span<const shared::LightData>(data));

  shared::LightPassParams params{};
  params.cells = {cells.ofImage.x, cells.ofImage.y, cellSide, directional_};
  params.window = {cells.first.x, cells.first.y, cells.count.x, cells.count.y};
  passBlock_ = gl::Buffer(device, "light list pass", sizeof params);
  passBlock_.writeValue(params);
}

LightLists::LightLists(gl::Device& device, const LightListInputs& inputs)
    : LightLists(device, inputs, cellsOf(inputs)) {
  statistics_ =
      lists_.build(device, [&](const lists::Pass& pass) { store(device, inputs, cellsOf(inputs), pass); });
}

std::optional<LightLists> LightLists::tryBuild(gl::Device& device, const LightListInputs& inputs) {
  const Cells cells = cellsOf(inputs);
  LightLists result(device, inputs, cells);
  if (inputs.linked) {
    // As many as there can be, up to some.
    const size_t pool = std::min(cells.number() * result.proxies(), size_t{1} << 22);
    result.statistics_.stored = result.lists_.buildLinked(
        device, pool, [&](const lists::Pass& pass) { result.store(device, inputs, cells, pass); });
    return result;
  }
  const auto statistics = result.lists_.tryBuild(
      device, cells.number(), [&](const lists::Pass& pass) { result.store(device, inputs, cells, pass); });
  if (!statistics) return std::nullopt;
  result.statistics_ = *statistics;
  return result;
}

void LightLists::store(gl::Device& device, const LightListInputs& inputs, const Cells& cells,
                       const lists::Pass& pass) const {
  if (proxies() == 0) return;
  gl::ShaderDefines defines = pass.defines;
  gl::BufferTexture receivers;
  if (inputs.receivers) {
    defines.emplace_back("RECEIVERS", "1");
    receivers = gl::BufferTexture(device, *inputs.receivers, gl::BufferFormat::RG32UI);
    receivers.bind(TEXTURE_RECEIVER_DEPTHS);
  }
  lights_.bind(TEXTURE_LIGHTS);
  inputs.view.bindUniform(UNIFORM_VIEW);
  passBlock_.bindUniform(UNIFORM_PASS);
  const bool many = proxies() >= manyLights;
  if (inputs.build.value_or(many ? LightListBuild::Compute : LightListBuild::Raster) ==
      LightListBuild::Raster)
    rasterise(device, cells, defines);
  else
    compute(device, cells, defines);
}

// Fragments are those of the whole image, so that a cell's list is the same whatever the window.
void LightLists::rasterise(gl::Device& device, const Cells& cells, const gl::ShaderDefines& defines) const {
  const gl::Framebuffer noTarget(cells.ofImage);
  gl::setDrawState(
      {.program = &device.program({"lights/light_lists.vert", "lights/light_lists.frag"}, defines),
       .target = &noTarget,
       .viewport = {0, 0, cells.ofImage.x, cells.ofImage.y},
       .scissor = glm::ivec4(cells.first, cells.count),
       .depthClamp = true});
  gl::drawGenerated(device, proxyVertices, proxies());
}

void LightLists::compute(gl::Device& device, const Cells& cells, const gl::ShaderDefines& defines) const {
  const auto tiles = [](int count) { return gl::groupsFor(static_cast<size_t>(count), LIGHT_TILE_SIDE); };
  gl::dispatch(device.program({"lights/light_lists.comp"}, defines),
               {tiles(cells.count.x), tiles(cells.count.y), gl::groupsFor(proxies(), LIGHTS_OF_A_GROUP)});
}

void LightLists::bind() const {
  lights_.bind(TEXTURE_LIGHTS);
  if (linked_)
    lists_.bindLinked(TEXTURE_LIGHT_CELL_RUNS, TEXTURE_LIGHT_CELL_KEYS, 0);
  else
    lists_.bind(TEXTURE_LIGHT_CELL_RUNS, TEXTURE_LIGHT_CELL_KEYS, 0);
}

}  // namespace sfumato::lights
