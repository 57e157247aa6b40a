// Light linked lists (Lindbeck 2015, section 2.1): for every cell of 4x4 pixels, the point and spot lights
// that may reach something in it, with their front and back depth there, sorted by front depth. Directional
// lights stand outside the lists. The lists are conservative: every light that reaches any point seen in a
// cell is in it. A node is 8 bytes: its key is the front depth, its id the light and, in 16 bits, the back
// depth rounded up (shaders/shared/lights.h).
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

// Two ways to the same lists, bit for bit.
enum class LightListBuild {
  Raster,   // proxy geometry of each light is rasterised (Lindbeck 2015, 2.1.1)
  Compute,  // each tile of cells goes through the lights
};

struct LightListInputs {
  const std::vector<Light>& lights;
  const std::vector<ShadowFaces>& shadows;  // of each light, same order
  const gl::Buffer& view;                   // shared::ViewParams of the camera
  int width = 0;                            // of the image, pixels
  int height = 0;
  // Pixels whose cells get lists: x, y from the bottom, width, height, as in the view; none: the whole image.
  std::optional<glm::ivec4> window;
  // Two floats for each cell that has a list: the least and the greatest depth at which something that is
  // seen there can be lit; the first is greater where nothing can. None: everything can.
  const gl::Buffer* receivers = nullptr;
  lists::ListOptions lists{};
  bool linked = false;                  // for comparisons: see Lists::buildLinked
  std::optional<LightListBuild> build;  // none: what was found the faster one for so many lights
};

class LightLists {
 public:
  // The cells that have lists, among those of the image.
  struct Cells {
    glm::ivec2 ofImage;
    glm::ivec2 first;
    glm::ivec2 count;
    size_t number() const { return static_cast<size_t>(count.x) * static_cast<size_t>(count.y); }
  };
  static Cells cellsOf(int width, int height, const glm::ivec4& window);

  static constexpr int cellSide = lights::cellSide;  // pixels

  // Uploads the lights and builds the lists. Costs 8 bytes a cell and 8 a node, more while some strategies
  // build (lists/lists_gpu.h). Throws Memory when they do not fit budget or device, Input when there are more
  // lights than a node can number (65,536).
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
  static Cells cellsOf(const LightListInputs& inputs);
  LightLists(gl::Device& device, const LightListInputs& inputs, const Cells& cells);  // lists are still empty
  void store(gl::Device& device, const LightListInputs& inputs, const Cells& cells,
             const lists::Pass& pass) const;
  void rasterise(gl::Device& device, const Cells& cells, const gl::ShaderDefines& defines) const;
  void compute(gl::Device& device, const Cells& cells, const gl::ShaderDefines& defines) const;
  size_t proxies() const { return order_.size() - static_cast<size_t>(directional_); }

  std::vector<int> order_;
  int directional_ = 0;
  gl::Records lights_;
  gl::Buffer passBlock_;
  lists::Lists lists_;
  bool linked_ = false;
  lists::ListStatistics statistics_;
};

}  // namespace sfumato::lights
