// Light linked lists (Lindbeck 2015, section 2.1): for every cell of 4x4 pixels, the point and spot lights
// that may reach something in it, with their front and back depth there, sorted by front depth. Directional
// lights stand outside the lists. The lists are conservative: every light that reaches any point seen in a
// cell is in it.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "gl/buffer.h"
#include "gl/device.h"
#include "gl/program.h"
#include "lights/light.h"
#include "lights/light_cells.h"
#include "lists/lists_gpu.h"

namespace sfumato::lights {

// Where the shadow of a light is found: faces of the deep shadow maps. One face or six; none: first is -1.
struct ShadowFaces {
  int first = -1;
  int count = 0;
};

struct LightListInputs {
  const std::vector<Light>& lights;
  const std::vector<ShadowFaces>& shadows;  // of each light, same order
  const gl::Buffer& view;                   // shared::ViewParams of the camera
  int width = 0;                            // of the image, pixels
  int height = 0;
  // Pixels whose cells get lists: x, y from the bottom, width, height, as in the view; none: the whole image.
  std::optional<glm::ivec4> window;
  lists::ListOptions lists{};
};

class LightLists {
 public:
  static constexpr int cellSide = lights::cellSide;  // pixels

  // Uploads the lights and builds the lists. Costs 8 bytes a cell and 12 a node, more while some strategies
  // build (lists/lists_gpu.h). Throws Memory when they do not fit budget or device.
  LightLists(gl::Device& device, const LightListInputs& inputs);
  // The same, but nothing where the nodes do not fit: the caller can try a smaller window.
  static std::optional<LightLists> tryBuild(gl::Device& device, const LightListInputs& inputs);

  int directionalLights() const { return directional_; }
  const lists::ListStatistics& statistics() const { return statistics_; }
  const lists::Lists& lists() const { return lists_; }
  // Scene indices of the lights by the numbers that the lists hold.
  const std::vector<int>& order() const { return order_; }
  // For shaders that include shaders/lights/light_lists.glsl.
  void bind() const;

 private:
  // The cells that have lists, among those of the image.
  struct Cells {
    glm::ivec2 ofImage;
    glm::ivec2 first;
    glm::ivec2 count;
    size_t number() const { return static_cast<size_t>(count.x) * static_cast<size_t>(count.y); }
  };
  static Cells cellsOf(const LightListInputs& inputs);
  LightLists(gl::Device& device, const LightListInputs& inputs, const Cells& cells);  // lists are still empty
  void store(gl::Device& device, const LightListInputs& inputs, const Cells& cells,
             const lists::Pass& pass) const;

  std::vector<int> order_;
  int directional_ = 0;
  gl::Buffer lights_;
  gl::Buffer passBlock_;
  lists::Lists lists_;
  lists::ListStatistics statistics_;
};

}  // namespace sfumato::lights
