#include "gl/buffer.h"

#include <epoxy/gl.h>

#include <algorithm>

#include "base/error.h"
#include "base/size_text.h"

namespace sfumato::gl {

using base::ExitCode;
using base::fail;

void deleteBuffer(unsigned name) {
  glDeleteBuffers(1, &name);
}

namespace {

Object<deleteBuffer> createBuffer() {
  GLuint name = 0;
  glGenBuffers(1, &name);
  return Object<deleteBuffer>(name);
}

}  // namespace

Buffer::Buffer(Device& device, std::string label, size_t bytes, Whole whole)
    : ledger_(&device.memory()), label_(std::move(label)), bytes_(std::max<size_t>(bytes, 16)) {
  if (whole == Whole::Bound && bytes_ > static_cast<size_t>(device.limits().storageBlockBytes))
    fail(ExitCode::Memory, "{}: needs {}, this device allows {} in one buffer: lower the resolution", label_,
         base::sizeText(bytes_), base::sizeText(device.limits().storageBlockBytes));
  object_ = createBuffer();
  glBindBuffer(GL_COPY_WRITE_BUFFER, name());
  while (glGetError() != GL_NO_ERROR) {
  }
  glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(bytes_), nullptr, GL_DYNAMIC_COPY);
  if (glGetError() == GL_OUT_OF_MEMORY)
    fail(ExitCode::Memory, "{}: the device has no room for {}: lower the resolution", label_,
         base::sizeText(bytes_));
  ledger_->add(label_, bytes_);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(object_, other.object_);
  std::swap(ledger_, other.ledger_);
  std::swap(label_, other.label_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

Buffer::~Buffer() {
  if (object_.name() != 0) ledger_->remove(label_, bytes_);
}

void Buffer::write(std::span<const std::byte> bytes, size_t offset) {
  base::check(offset + bytes.size() <= bytes_, "a write stays inside its buffer");
  if (bytes.empty()) return;
  glBindBuffer(GL_COPY_WRITE_BUFFER, name());
  glBufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes.size()),
                  bytes.data());
}

void Buffer::clear() {
  glBindBuffer(GL_COPY_WRITE_BUFFER, name());
  glClearBufferData(GL_COPY_WRITE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void Buffer::copyFrom(const Buffer& source, size_t bytes, size_t offset) {
  glBindBuffer(GL_COPY_READ_BUFFER, source.name());
  glBindBuffer(GL_COPY_WRITE_BUFFER, name());
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset),
                      static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes));
}

void Buffer::read(std::span<std::byte> bytes, size_t offset) const {
  base::check(offset + bytes.size() <= bytes_, "a read stays inside its buffer");
  if (bytes.empty()) return;
  glBindBuffer(GL_COPY_READ_BUFFER, name());
  glGetBufferSubData(GL_COPY_READ_BUFFER, static_cast<GLintptr>(offset),
                     static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

const void* Buffer::map(size_t bytes) const {
  base::check(bytes <= bytes_, "a read stays inside its buffer");
  glBindBuffer(GL_COPY_READ_BUFFER, name());
  const void* mapped =
      glMapBufferRange(GL_COPY_READ_BUFFER, 0, static_cast<GLsizeiptr>(bytes), GL_MAP_READ_BIT);
  if (mapped == nullptr) fail(ExitCode::Memory, "{}: the driver cannot map it", label_);
  return mapped;
}

void Buffer::unmap() const {
  glBindBuffer(GL_COPY_READ_BUFFER, name());
  glUnmapBuffer(GL_COPY_READ_BUFFER);
}

void Buffer::bindStorage(unsigned binding) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, name());
}

void Buffer::bindStorageRange(unsigned binding, size_t offset, size_t bytes) const {
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, name(), static_cast<GLintptr>(offset),
                    static_cast<GLsizeiptr>(bytes));
}

void Buffer::bindUniform(unsigned binding) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, name());
}

void Buffer::bindAtomicCounter(unsigned binding) const {
  glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, binding, name());
}

MappedBuffer::MappedBuffer(const std::string& label, size_t bytes) : object_(createBuffer()) {
  constexpr GLbitfield access = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  const std::vector<std::byte> zeros(bytes);
  const auto size = static_cast<GLsizeiptr>(bytes);
  glBindBuffer(GL_COPY_READ_BUFFER, object_.name());
  glBufferStorage(GL_COPY_READ_BUFFER, size, zeros.data(), access);
  const void* mapped = glMapBufferRange(GL_COPY_READ_BUFFER, 0, size, access);
  if (mapped == nullptr) fail(ExitCode::Memory, "{}: the driver cannot map it", label);
  bytes_ = {static_cast<const std::byte*>(mapped), bytes};
}

void MappedBuffer::bindStorage(unsigned binding) const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, object_.name());
}

}  // namespace sfumato::gl
