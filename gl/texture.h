// Textures (2D, 3D, multisample and arrays of these) and the framebuffers that draw into them.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gl/buffer.h"
#include "gl/device.h"
#include "gl/object.h"
#include "scene/sampling.h"

namespace sfumato::gl {

void deleteTexture(unsigned name);
void deleteFramebuffer(unsigned name);

enum class Format {
  R8,
  R16F,
  R32F,
  R32UI,
  R32I,
  RG32UI,
  RGBA8,
  SRGB8A8,
  RGB10A2,
  RGBA16F,
  RGBA32F,
  RGBA32UI,
  Depth32F,
  Depth32FStencil8
};
enum class BufferFormat { R32UI, RG32UI, RGB32UI, RGBA32UI, RGBA32F };
enum class Filter { Nearest, Linear };
using scene::Minify;
using scene::Wrap;

struct TextureDescription {
  Format format = Format::RGBA8;
  glm::ivec3 size{1, 1, 1};  // texels; z > 1 makes it 3D
  Filter filter = Filter::Nearest;
  std::optional<Minify> minify;  // as `filter`, without mipmaps, where none is given
  Wrap wrapS = Wrap::ClampToEdge;
  Wrap wrapT = Wrap::ClampToEdge;
  int samples = 0;     // a pixel; 0: not a multisample texture (1 is one, with its sample in the middle)
  bool array = false;  // of size.z layers, in place of 3D
};

class Texture {
 public:
  Texture() = default;
  // `texels`: rows of x, then y, then z, 4 bytes a channel-tuple for RGBA8 and R32F; empty: undefined
  // content. Throws Memory when a side is over the device's limit (the line says which) or there is no room.
  Texture(Device& device, std::string label, const TextureDescription& description,
          std::span<const std::byte> texels = {});
  Texture(Texture&& other) noexcept = default;
  Texture& operator=(Texture&& other) noexcept;
  ~Texture();

  unsigned name() const { return object_.name(); }
  glm::ivec3 size() const { return size_; }
  Format format() const { return format_; }
  bool isArray() const;
  size_t bytes() const { return bytes_; }
  void bind(unsigned unit) const;
  // For image loads, stores and atomics of shaders, in the texture's own format.
  void bindImage(unsigned unit) const;
  // Writes `count` layers of a 3D texture, from layer `first` on.
  void writeLayers(std::span<const std::byte> texels, int first, int count);
  // Takes all texels from the start of a buffer, in that order.
  void copyFrom(const Buffer& texels);
  // Reads back all texels, in the order in which the constructor takes them; not of multisample textures.
  void read(std::span<std::byte> texels) const;

 private:
  Object<deleteTexture> object_;
  MemoryLedger* ledger_ = nullptr;
  std::string label_;
  Format format_ = Format::RGBA8;
  size_t bytes_ = 0;
  unsigned target_ = 0;
  glm::ivec3 size_{0};
};

// A buffer seen as a row of texels: readable beyond the limit of one storage block. The buffer must outlive
// it.
class BufferTexture {
 public:
  BufferTexture() = default;
  // Throws Memory when the buffer holds more texels than the device allows.
  BufferTexture(const Device& device, const Buffer& buffer, BufferFormat format);
  void bind(unsigned unit) const;

 private:
  Object<deleteTexture> object_;
};

// An array of structs of vec4s, for shaders to read as texels of four words (RGBA32UI), a vec4 each: some
// drivers read storage blocks word by word and lane by lane.
class Records {
 public:
  Records() = default;
  template <typename T>
  Records(Device& device, std::string label, std::span<const T> values)
      : buffer_(device, std::move(label), values), rows_(device, buffer_, BufferFormat::RGBA32UI) {
    static_assert(sizeof(T) % sizeof(glm::vec4) == 0);
  }
  void bind(unsigned unit) const { rows_.bind(unit); }

 private:
  Buffer buffer_;
  BufferTexture rows_;
};

// What a draw writes to. Textures attached must outlive it.
class Framebuffer {
 public:
  // Nothing attached: only side effects of fragments count. `size`: its width and height.
  // `samples`: places in a pixel where coverage is told, 1: its centre. `layers`: for gl_Layer, 0: not
  // layered.
  explicit Framebuffer(glm::ivec2 size, int samples = 1, int layers = 0);
  // Colour attachments in order, and a depth buffer, with a stencil or without, or nullptr. `layer`: of
  // colours that are arrays.
  Framebuffer(std::span<const Texture* const> colours, const Texture* depth, int layer = 0);

  unsigned name() const { return object_.name(); }
  glm::ivec2 size() const { return size_; }
  // `area`: only there; x, y, width, height.
  void clearColour(int attachment, glm::vec4 value, const std::optional<glm::ivec4>& area = {}) const;
  void clearColour(int attachment, glm::uvec4 value, const std::optional<glm::ivec4>& area = {}) const;
  void clearDepth(float value, const std::optional<glm::ivec4>& area = {}) const;
  void clearStencil(int value, const std::optional<glm::ivec4>& area = {}) const;
  // Where the samples of a pixel stand in it, in [0, 1]^2 from its lower left corner.
  std::vector<glm::vec2> samplePositions() const;

 private:
  Object<deleteFramebuffer> object_;
  glm::ivec2 size_;
};

}  // namespace sfumato::gl
