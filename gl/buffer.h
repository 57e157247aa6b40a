// GPU buffers: shader storage, uniform blocks, vertices and indices are all this.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gl/device.h"
#include "gl/object.h"

namespace sfumato::gl {

void deleteBuffer(unsigned name);

class Buffer {
 public:
  Buffer() = default;
  // `bytes` of undefined content (at least 16 are taken, so that an empty one can be bound). `label` names it
  // in the memory ledger and in errors. Throws Memory when the driver has no room or `bytes` is over the
  // limit of one storage block; `Whole::Never` bound as one block (only in ranges, or as a BufferTexture)
  // lifts that limit.
  enum class Whole { Bound, Never };
  Buffer(Device& device, std::string label, size_t bytes, Whole whole = Whole::Bound);
  template <typename T>
  Buffer(Device& device, std::string label, std::span<const T> values)
      : Buffer(device, std::move(label), values.size_bytes()) {
    write(std::as_bytes(values));
  }
  Buffer(Buffer&& other) noexcept { *this = std::move(other); }
  Buffer& operator=(Buffer&& other) noexcept;
  ~Buffer();

  size_t bytes() const { return bytes_; }
  unsigned name() const { return object_.name(); }

  void write(std::span<const std::byte> bytes, size_t offset = 0);
  template <typename T>
  void writeValue(const T& value) {
    write(std::as_bytes(std::span(&value, 1)));
  }
  void clear();                                                          // to zeros
  void copyFrom(const Buffer& source, size_t bytes, size_t offset = 0);  // bytes at `offset` of both

  // Reads back; the caller has put a barrier after shader writes (gl/commands.h).
  void read(std::span<std::byte> bytes, size_t offset = 0) const;
  template <typename T>
  std::vector<T> readValues(size_t count) const {
    std::vector<T> values(count);
    read(std::as_writable_bytes(std::span(values)));
    return values;
  }
  template <typename T>
  T readValue() const {
    return readValues<T>(1).front();
  }

  // The same through a mapping, without a copy: use(span of the first `count` values).
  template <typename T, typename Use>
  void withValues(size_t count, const Use& use) const {
    if (count == 0) return use(std::span<const T>());
    use(std::span(static_cast<const T*>(map(count * sizeof(T))), count));
    unmap();
  }

  void bindStorage(unsigned binding) const;
  // `offset` is a multiple of 256.
  void bindStorageRange(unsigned binding, size_t offset, size_t bytes) const;
  void bindUniform(unsigned binding) const;
  void bindAtomicCounter(unsigned binding) const;

 private:
  const void* map(size_t bytes) const;
  void unmap() const;

  Object<deleteBuffer> object_;
  MemoryLedger* ledger_ = nullptr;
  std::string label_;
  size_t bytes_ = 0;
};

// A buffer that the CPU sees all the time: needs GL_ARB_buffer_storage. What shaders wrote is there after
// barrierBefore(Reader::Mapped) and a fence.
class MappedBuffer {
 public:
  // `bytes` of zeros. Throws Memory when the driver cannot map it.
  MappedBuffer(const std::string& label, size_t bytes);
  std::span<const std::byte> bytes() const { return bytes_; }
  void bindStorage(unsigned binding) const;

 private:
  Object<deleteBuffer> object_;
  std::span<const std::byte> bytes_;
};

}  // namespace sfumato::gl
