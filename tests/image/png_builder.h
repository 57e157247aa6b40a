// A PNG encoder of its own, so that what is decoded is known: any colour type, stored (uncompressed) blocks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace sfumato::test {

class PngBuilder {
 public:
  // `colourType` 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA. `rows` is width * channels samples a
  // row, of `bitDepth` 8 or 16 (big-endian), without filter bytes.
  PngBuilder(uint32_t width, uint32_t height, int bitDepth, int colourType, std::span<const uint8_t> rows,
             std::span<const uint8_t> palette = {}) {
    for (const int b : {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a})
      bytes_.push_back(static_cast<std::byte>(b));
    std::vector<uint8_t> header;
    big(header, width);
    big(header, height);
    header.insert(header.end(), {static_cast<uint8_t>(bitDepth), static_cast<uint8_t>(colourType), 0, 0, 0});
    chunk("IHDR", header);
    if (!palette.empty()) chunk("PLTE", palette);
    chunk("IDAT", deflateStored(rows, height));
    chunk("IEND", {});
  }

  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  static void big(std::vector<uint8_t>& to, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) to.push_back(static_cast<uint8_t>(value >> shift));
  }

  static std::vector<uint8_t> deflateStored(std::span<const uint8_t> rows, uint32_t height) {
    std::vector<uint8_t> raw;
    const size_t stride = height == 0 ? 0 : rows.size() / height;
    for (uint32_t y = 0; y < height; ++y) {
      raw.push_back(0);  // no filter
      raw.insert(raw.end(), rows.begin() + static_cast<long>(y * stride),
                 rows.begin() + static_cast<long>((y + 1) * stride));
    }
    std::vector<uint8_t> out = {0x78, 0x01};
    for (size_t at = 0; at == 0 || at < raw.size();) {
      const size_t size = std::min<size_t>(raw.size() - at, 65535);
      out.push_back(at + size == raw.size());
      for (size_t half : {size, ~size})
        for (int shift : {0, 8}) out.push_back(static_cast<uint8_t>(half >> shift));
      out.insert(out.end(), raw.begin() + static_cast<long>(at), raw.begin() + static_cast<long>(at + size));
      at += size;
      if (size == 0) break;
    }
    uint32_t a = 1, b = 0;
    for (uint8_t value : raw) {
      a = (a + value) % 65521;
      b = (b + a) % 65521;
    }
    big(out, b << 16 | a);
    return out;
  }

  void chunk(std::string_view type, std::span<const uint8_t> data) {
    std::vector<uint8_t> body(type.begin(), type.end());
    body.insert(body.end(), data.begin(), data.end());
    uint32_t crc = 0xffffffffu;
    for (uint8_t value : body) {
      crc ^= value;
      for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320u : 0);
    }
    std::vector<uint8_t> all;
    big(all, static_cast<uint32_t>(data.size()));
    all.insert(all.end(), body.begin(), body.end());
    big(all, ~crc);
    for (uint8_t value : all) bytes_.push_back(std::byte{value});
  }

  std::vector<std::byte> bytes_;
};

}  // namespace sfumato::test
