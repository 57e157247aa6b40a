// Image files through OpenImageIO. This room's image_file.cpp is the one file that includes it; built without
// it, every function here throws Input and says so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "image/deep_image.h"
#include "image/image.h"
#include "image/tone_map.h"

namespace sfumato::image {

// Whether this build has it.
bool readsAndWritesImages();

// Reads any image that OpenImageIO knows as float, linear where the file says how it is encoded to be linear
// (EXR), else as stored; of one with layers only R, G, B and A; of a deep one R, G and B, flattened. Throws
// Input: missing, damaged, empty or larger than 2^31 values.
Image readImage(const std::filesystem::path& path);

// Writes channels R, G, B (and A for four channels) of a linear image; the ending chooses: `.exr` (half
// unless `fullFloat`, zip) holds it as it is, but what half cannot hold becomes +-65504; `.png` is
// tone-mapped by toneMap() to 8-bit sRGB. Metadata become attributes; nothing tells the time of day, so that
// the same image makes the same bytes. Beside, then renamed: a failure (Input) leaves no file. Other endings
// are a Usage error.
void writeImage(const std::filesystem::path& path, const Image& image, const Metadata& metadata,
                bool fullFloat = false, const ToneMapping& toneMapping = {});

// Writes an `.exr` as writeImage() does, with layers beside the image: channels named "layer.channel", as
// floats.
void writeLayers(const std::filesystem::path& path, const Image& image, std::span<const Layer> layers,
                 const Metadata& metadata);

// Writes deep images of one file, an `.exr` part each, scanlines of R, G, B, A (halves), Z and ZBack
// (floats), and where a sample takes more of one colour than of another RA, GA and BA (halves). R, G, B and A
// are an ordinary deep image without the latter: flattened they are what the samples are, within the rounding
// of halves. The rest as writeImage(); while it writes, the file is in memory. Other endings are a Usage
// error.
void writeDeep(const std::filesystem::path& path, std::span<const DeepImage> parts, const Metadata& metadata);

// Whether writeLayers() can write the file: it ends in .exr. Throws as checkImageName().
bool holdsLayers(const std::filesystem::path& path);

// Reads one layer, its channels in the order of R, G, B or X, Y, Z. Throws Input as readImage(), and when
// there is no such layer.
Layer readLayer(const std::filesystem::path& path, const std::string& name);

// Throws Usage unless writeImage knows the ending of `path`.
void checkImageName(const std::filesystem::path& path);

// Throws Usage unless writeDeep knows the ending of `path`, Input where it is a device or a pipe.
void checkDeepName(const std::filesystem::path& path);

// A picture as 8-bit RGBA, rows from the top, as stored (sRGB stays sRGB).
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<uint8_t> rgba;
};

// Throws Usage unless writePicture knows the ending of `path`.
void checkPictureName(const std::filesystem::path& path);

// Writes a picture as an 8-bit `.png`, as it is. Throws as writeImage().
void writePicture(const std::filesystem::path& path, const Picture& picture, const Metadata& metadata);

// Decodes a PNG or JPEG from memory; `name` stands in the error line. Throws Input when it is neither,
// damaged, or wider or higher than 16384.
Picture decodePicture(std::span<const std::byte> bytes, const std::string& name);

// Pixels in which a viewer would see a difference, after Yee (2004), "A perceptual metric for production
// testing", as OpenImageIO has it: 100 cd/m^2 for a value of 1, across 45 degrees. Of the first three
// channels, or of the first one as grey. Throws as checkComparable().
size_t perceptualFailures(const Image& image, const Image& reference);

}  // namespace sfumato::image
