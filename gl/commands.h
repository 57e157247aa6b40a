// Draws, dispatches and barriers. A draw states all the GL state that it needs; nothing is inherited.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "gl/buffer.h"
#include "gl/object.h"
#include "gl/program.h"
#include "gl/texture.h"

namespace sfumato::gl {

void deleteVertexArray(unsigned name);

enum class Cull { None, Back, Front };
// What becomes of what is there and what is drawn: the latter, the smaller, their sum, their product.
enum class Blend { None, Minimum, Add, Multiply };
enum class Compare { Never, Always, Less, LessEqual, Equal, Greater };
enum class StencilChange { Keep, Zero, Replace, Decrement };

// A fragment passes where (reference & mask) compares so to (what is there & mask).
struct StencilTest {
  Compare compare = Compare::Always;
  int reference = 0;
  unsigned mask = 0xff;
  StencilChange passed = StencilChange::Keep;
  StencilChange failed = StencilChange::Keep;  // this test, or the depth test after it
};

struct DrawState {
  const Program* program = nullptr;
  const Framebuffer* target = nullptr;
  glm::ivec4 viewport{0};             // x, y, width, height
  std::optional<glm::ivec4> scissor;  // fragments outside x, y, width, height are not made
  bool depthTest = false;
  Compare depthCompare = Compare::Less;
  bool depthWrite = true;  // where it is tested
  bool depthClamp = false;
  Cull cull = Cull::None;
  Blend blend = Blend::None;
  std::optional<StencilTest> stencil;
  std::optional<unsigned> sampleMask;  // samples of a pixel that may be written to; none: all
  // Off: a fragment covers all samples of the pixels whose centres it covers; the sample mask has no say.
  bool multisample = true;
};

// Makes the state current for the draws that follow.
void setDrawState(const DrawState& state);
// Changes only the culling of the current state.
void setCull(Cull cull);

// Which floats of an interleaved vertex feed an attribute.
struct VertexAttribute {
  int location = 0;
  int floats = 0;
  size_t offset = 0;  // bytes in the vertex
};

// Interleaved float vertices, 32-bit indices, and attribute `instanceLocation`: a uint that counts instances
// from a draw's first one, so that a shader knows which instance it draws.
class VertexArray {
 public:
  VertexArray() = default;
  VertexArray(Device& device, const Buffer& vertices, size_t vertexBytes,
              std::span<const VertexAttribute> attributes, const Buffer& indices, int instanceLocation,
              size_t maxInstances);
  unsigned name() const { return object_.name(); }

 private:
  Object<deleteVertexArray> object_;
  Buffer instanceNumbers_;
};

struct IndexedRange {
  size_t firstIndex = 0;
  size_t indices = 0;
  size_t firstVertex = 0;
  size_t firstInstance = 0;
  size_t instances = 1;
};

void drawIndexed(const VertexArray& vertices, const IndexedRange& range);
enum class Primitive { Triangles, Points };
// Primitives whose vertices the shader makes from gl_VertexID and gl_InstanceID.
void drawGenerated(const Device& device, size_t vertices, size_t instances,
                   Primitive primitive = Primitive::Triangles);

// Runs a compute program on a grid of workgroups; zero in any direction does nothing.
void dispatch(const Program& program, glm::uvec3 groups);
// The same with at least `count` invocations of a program of 64 in a row a workgroup, in two dimensions where
// one is too short; shaders/shared/linear_id.glsl gives each its number.
void dispatchLinear(const Program& program, size_t count);

// What shaders wrote to storage buffers becomes visible to later shaders (as blocks and as buffer textures),
// copies and reads.
void storageBarrier();

// What shaders wrote to images becomes visible to later image accesses and to Texture::read().
void imageBarrier();

// What reads a buffer, or a texture, that shaders have written to.
enum class Reader {
  VertexFetch,
  IndexFetch,
  IndirectCommand,
  Uniform,
  TextureFetch,
  PixelUnpack,
  Update,
  Storage,
  Mapped
};
// What shaders wrote becomes visible to this kind of reader. Update: copies, reads, writes and mappings of
// buffers.
void barrierBefore(Reader reader);

// Triangles with vertices made by the shader; `commands` holds the counts: vertices, instances, 0, 0.
void drawIndirect(const Device& device, const Buffer& commands);
// Workgroups in x, y and z as the first three words of `groups` say.
void dispatchIndirect(const Program& program, const Buffer& groups);

// The GPU's clock, in nanoseconds.
int64_t timestamp();

// A point in the stream of commands, to be waited for.
class Fence {
 public:
  Fence();
  ~Fence();
  Fence(const Fence&) = delete;
  Fence& operator=(const Fence&) = delete;
  // Whether all commands before it were done within so many seconds.
  bool wait(double seconds) const;

 private:
  void* sync_ = nullptr;
};

// Starts what was asked for so far, without waiting for it.
void flush();

// Workgroups of `groupSize` that cover `count`.
inline unsigned groupsFor(size_t count, unsigned groupSize) {
  return static_cast<unsigned>((count + groupSize - 1) / groupSize);
}

}  // namespace sfumato::gl
