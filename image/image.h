// Float images in memory.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace sfumato::image {

// Rows from the top, pixels from the left, channels interleaved. Values are linear unless said otherwise.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<float> values;  // width * height * channels

  Image() = default;
  Image(int width, int height, int channels)
      : width(width),
        height(height),
        channels(channels),
        values(static_cast<size_t>(width) * static_cast<size_t>(height) * static_cast<size_t>(channels)) {}

  float* pixel(int x, int y) { return values.data() + index(x, y); }
  const float* pixel(int x, int y) const { return values.data() + index(x, y); }

 private:
  size_t index(int x, int y) const {
    return (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) *
           static_cast<size_t>(channels);
  }
};

// Channels that belong together, beside the picture itself.
struct Layer {
  std::string name;
  std::vector<std::string> channels;  // names of the image's, e.g. "X", "Y", "Z"
  Image image;
};

// Name and value pairs that a file keeps beside its pixels.
using Metadata = std::vector<std::pair<std::string, std::string>>;

}  // namespace sfumato::image
