#include "gl/commands.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "base/error.h"

namespace sfumato::gl {

void deleteVertexArray(unsigned name) {
  glDeleteVertexArrays(1, &name);
}

namespace {

void enable(GLenum capability, bool on) {
  if (on)
    glEnable(capability);
  else
    glDisable(capability);
}

GLenum nameOf(Compare compare) {
  constexpr GLenum names[] = {GL_NEVER, GL_ALWAYS, GL_LESS, GL_LEQUAL, GL_EQUAL, GL_GREATER};
  return names[static_cast<int>(compare)];
}

GLenum nameOf(StencilChange change) {
  constexpr GLenum names[] = {GL_KEEP, GL_ZERO, GL_REPLACE, GL_DECR};
  return names[static_cast<int>(change)];
}

void setBlend(Blend blend) {
  enable(GL_BLEND, blend != Blend::None);
  glBlendEquation(blend == Blend::Minimum ? GL_MIN : GL_FUNC_ADD);
  if (blend == Blend::Multiply)
    glBlendFunc(GL_DST_COLOR, GL_ZERO);
  else
    glBlendFunc(GL_ONE, GL_ONE);
}

void setStencil(const std::optional<StencilTest>& stencil) {
  enable(GL_STENCIL_TEST, stencil.has_value());
  if (!stencil) return;
  glStencilFunc(nameOf(stencil->compare), stencil->reference, stencil->mask);
  glStencilOp(nameOf(stencil->failed), nameOf(stencil->failed), nameOf(stencil->passed));
  glStencilMask(0xff);
}

void setSampleMask(const std::optional<unsigned>& mask) {
  enable(GL_SAMPLE_MASK, mask.has_value());
  if (mask) glSampleMaski(0, *mask);
}

const void* byteOffset(size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

}  // namespace

void setDrawState(const DrawState& state) {
  glUseProgram(state.program->name());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, state.target->name());
  glViewport(state.viewport.x, state.viewport.y, state.viewport.z, state.viewport.w);
  enable(GL_DEPTH_TEST, state.depthTest);
  glDepthFunc(nameOf(state.depthCompare));
  glDepthMask(state.depthTest && state.depthWrite ? GL_TRUE : GL_FALSE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  enable(GL_DEPTH_CLAMP, state.depthClamp);
  glFrontFace(GL_CCW);
  setCull(state.cull);
  setBlend(state.blend);
  enable(GL_SCISSOR_TEST, state.scissor.has_value());
  if (state.scissor) glScissor(state.scissor->x, state.scissor->y, state.scissor->z, state.scissor->w);
  setStencil(state.stencil);
  setSampleMask(state.sampleMask);
  enable(GL_MULTISAMPLE, state.multisample);
}

void setCull(Cull cull) {
  enable(GL_CULL_FACE, cull != Cull::None);
  glCullFace(cull == Cull::Front ? GL_FRONT : GL_BACK);
}

VertexArray::VertexArray(Device& device, const Buffer& vertices, size_t vertexBytes,
                         std::span<const VertexAttribute> attributes, const Buffer& indices,
                         int instanceLocation, size_t maxInstances) {
  std::vector<uint32_t> numbers(maxInstances);
  std::iota(numbers.begin(), numbers.end(), 0u);
  instanceNumbers_ = Buffer(device, "instance numbers", std::span<const uint32_t>(numbers));
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  object_ = Object<deleteVertexArray>(name);
  glBindVertexArray(name);
  glBindBuffer(GL_ARRAY_BUFFER, vertices.name());
  for (const VertexAttribute& attribute : attributes) {
    const auto location = static_cast<GLuint>(attribute.location);
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, attribute.floats, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(vertexBytes),
                          byteOffset(attribute.offset));
  }
  const auto location = static_cast<GLuint>(instanceLocation);
  glBindBuffer(GL_ARRAY_BUFFER, instanceNumbers_.name());
  glEnableVertexAttribArray(location);
  glVertexAttribIPointer(location, 1, GL_UNSIGNED_INT, 0, nullptr);
  glVertexAttribDivisor(location, 1);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices.name());
  glBindVertexArray(0);
}

void drawIndexed(const VertexArray& vertices, const IndexedRange& range) {
  glBindVertexArray(vertices.name());
  glDrawElementsInstancedBaseVertexBaseInstance(
      GL_TRIANGLES, static_cast<GLsizei>(range.indices), GL_UNSIGNED_INT,
      byteOffset(range.firstIndex * sizeof(uint32_t)), static_cast<GLsizei>(range.instances),
      static_cast<GLint>(range.firstVertex), static_cast<GLuint>(range.firstInstance));
}

void drawGenerated(const Device& device, size_t vertices, size_t instances, Primitive primitive) {
  glBindVertexArray(device.emptyVertexArray());
  glDrawArraysInstanced(primitive == Primitive::Points ? GL_POINTS : GL_TRIANGLES, 0,
                        static_cast<GLsizei>(vertices), static_cast<GLsizei>(instances));
}

void dispatch(const Program& program, glm::uvec3 groups) {
  if (groups.x == 0 || groups.y == 0 || groups.z == 0) return;
  glUseProgram(program.name());
  glDispatchCompute(groups.x, groups.y, groups.z);
}

void dispatchLinear(const Program& program, size_t count) {
  constexpr unsigned maxGroups = 65535;  // of every GL 4.3 in each direction
  const unsigned groups = groupsFor(count, 64);
  dispatch(program, {std::min(groups, maxGroups), groupsFor(groups, maxGroups), 1});
}

void storageBarrier() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                  GL_TEXTURE_FETCH_BARRIER_BIT);
}

void imageBarrier() {
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

void barrierBefore(Reader reader) {
  constexpr GLbitfield bits[] = {GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT,
                                 GL_ELEMENT_ARRAY_BARRIER_BIT,
                                 GL_COMMAND_BARRIER_BIT,
                                 GL_UNIFORM_BARRIER_BIT,
                                 GL_TEXTURE_FETCH_BARRIER_BIT,
                                 GL_PIXEL_BUFFER_BARRIER_BIT,
                                 GL_BUFFER_UPDATE_BARRIER_BIT,
                                 GL_SHADER_STORAGE_BARRIER_BIT,
                                 GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT};
  glMemoryBarrier(bits[static_cast<int>(reader)]);
}

void drawIndirect(const Device& device, const Buffer& commands) {
  glBindVertexArray(device.emptyVertexArray());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.name());
  glDrawArraysIndirect(GL_TRIANGLES, nullptr);
}

void dispatchIndirect(const Program& program, const Buffer& groups) {
  glUseProgram(program.name());
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, groups.name());
  glDispatchComputeIndirect(0);
}

int64_t timestamp() {
  GLint64 now = 0;
  glGetInteger64v(GL_TIMESTAMP, &now);
  return now;
}

Fence::Fence() : sync_(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)) {}

Fence::~Fence() {
  glDeleteSync(static_cast<GLsync>(sync_));
}

bool Fence::wait(double seconds) const {
  const GLenum state = glClientWaitSync(static_cast<GLsync>(sync_), GL_SYNC_FLUSH_COMMANDS_BIT,
                                        static_cast<GLuint64>(seconds * 1e9));
  return state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED;
}

void flush() {
  glFlush();
}

}  // namespace sfumato::gl
