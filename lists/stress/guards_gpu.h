// Canaries: memory of a known content, beside that of the lists.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "gl/buffer.h"
#include "gl/device.h"

namespace sfumato::lists::stress {

class Guards {
 public:
  // Allocates one more, of 16 KiB, unless there are many.
  void add(gl::Device& device) {
    if (buffers_.size() < most)
      buffers_.emplace_back(device, "stress guard", std::span<const uint32_t>(words_));
  }
  // Of all of them, words that are not what they were.
  size_t changedWords() const {
    size_t changed = 0;
    for (const gl::Buffer& buffer : buffers_)
      for (const uint32_t word : buffer.readValues<uint32_t>(words_.size()))
        changed += word != pattern ? 1 : 0;
    return changed;
  }

 private:
  static constexpr size_t most = 256;
  static constexpr uint32_t pattern = 0xc0ffee11u;
  std::vector<uint32_t> words_ = std::vector<uint32_t>(4096, pattern);
  std::deque<gl::Buffer> buffers_;
};

}  // namespace sfumato::lists::stress
