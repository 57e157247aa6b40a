#include "image/image_file.h"

#include "base/error.h"

#ifdef SFUMATO_OPENIMAGEIO

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <functional>

#include "base/file.h"
#include "image/metrics.h"

namespace sfumato::image {

namespace fs = std::filesystem;
using base::ExitCode;
using base::fail;

namespace {

constexpr float largestHalf = 65504.f;
constexpr int maxPictureSide = 16384;
constexpr uint64_t maxImageValues = uint64_t{1} << 31;
// More than any real picture packs into a byte; a header that claims more is lying about its size.
constexpr uint64_t maxPixelsPerByte = 65536;

// OpenImageIO's messages may have several lines.
std::string oneLine(std::string message) {
  while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back()))) message.pop_back();
  std::replace_if(
      message.begin(), message.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return message.empty() ? "unknown reason" : message;
}

// Alpha stays as stored: no multiplication into the colour on reading.
OIIO::ImageSpec readAsStored() {
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  return hints;
}

enum class Ending { Exr, Png };

Ending endingOf(const fs::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".exr") return Ending::Exr;
  if (ending == ".png") return Ending::Png;
  fail(ExitCode::Usage, "{}: unknown image ending \"{}\": use .exr or .png", path.string(), ending);
}

constexpr int stripeRows = 64;  // that are converted at a time; zip packs 16 together

// Metadata of every file.
void describe(OIIO::ImageSpec& spec, const Metadata& metadata) {
  for (const auto& [name, value] : metadata) spec.attribute(name, value);
  spec.attribute("DateTime", "");  // else OpenImageIO writes the time of day: the same run, other bytes
}

// Writes rows first to first + count - 1 of a part; false where that failed.
using WriteRows = std::function<bool(OIIO::ImageOutput& output, size_t part, int first, int count)>;

// Writes all parts to a file `name`; `path` is what errors call it.
void writeParts(const fs::path& path, const std::string& name, std::span<const OIIO::ImageSpec> parts,
                const WriteRows& writeRows) {
  const auto output = OIIO::ImageOutput::create(path.string());
  if (!output) fail(ExitCode::Input, "{}: cannot be written: {}", path.string(), oneLine(OIIO::geterror()));
  bool written = parts.size() == 1 ? output->open(name, parts[0])
                                   : output->open(name, static_cast<int>(parts.size()), parts.data());
  for (size_t part = 0; part < parts.size() && written; ++part) {
    if (part > 0) written = output->open(name, parts[part], OIIO::ImageOutput::AppendSubimage);
    for (int y = 0; y < parts[part].height && written; y += stripeRows)
      written = writeRows(*output, part, y, std::min(stripeRows, parts[part].height - y));
  }
  if (!output->close() || !written)
    fail(ExitCode::Input, "{}: cannot be written: {}", path.string(), oneLine(output->geterror()));
}

// The pixels of rows first to first + count - 1, in the file's order of channels.
using Rows = std::function<const void*(int first, int count)>;

void write(const fs::path& path, OIIO::ImageSpec spec, const Metadata& metadata, OIIO::TypeDesc type,
           const Rows& rows) {
  describe(spec, metadata);
  // Into memory first: OpenImageIO does not say when a disk is full.
  OIIO::Filesystem::IOVecOutput memory;
  OIIO::Filesystem::IOProxy* target = &memory;
  spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &target);
  writeParts(path, path.string(), {&spec, 1}, [&](OIIO::ImageOutput& output, size_t, int first, int count) {
    return output.write_scanlines(first, first + count, 0, type, rows(first, count));
  });
  base::writeFile(path, {reinterpret_cast<const char*>(memory.buffer().data()), memory.buffer().size()});
}

// The channels of all images side by side, as `convert` makes them.
void interleaveRows(std::span<const Image* const> images, int first, int count, std::vector<float>& pixels,
                    const std::function<float(float value, bool isFirstImage)>& convert) {
  pixels.clear();
  for (int y = first; y < first + count; ++y)
    for (int x = 0; x < images[0]->width; ++x)
      for (const Image* image : images)
        for (int c = 0; c < image->channels; ++c)
          pixels.push_back(convert(image->pixel(x, y)[c], image == images[0]));
}

void writeExr(const fs::path& path, const Image& image, std::span<const Layer> layers,
              const Metadata& metadata, bool fullFloat) {
  const OIIO::TypeDesc type = fullFloat ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::HALF;
  OIIO::ImageSpec spec(image.width, image.height, image.channels, type);
  spec.attribute("compression", "zip");
  spec.channelformats.assign(static_cast<size_t>(image.channels), type);
  std::vector<const Image*> images = {&image};
  for (const Layer& layer : layers) {
    base::check(layer.image.width == image.width && layer.image.height == image.height &&
                    layer.image.channels == static_cast<int>(layer.channels.size()),
                "layers have the image's size, and a name for each channel");
    images.push_back(&layer.image);
    for (const std::string& channel : layer.channels) {
      spec.channelnames.push_back(layer.name + "." + channel);
      spec.channelformats.push_back(OIIO::TypeDesc::FLOAT);
    }
  }
  spec.nchannels = static_cast<int>(spec.channelnames.size());
  if (layers.empty()) spec.channelformats.clear();
  const auto convert = [&](float value, bool isHalf) {
    return isHalf && !fullFloat ? std::clamp(value, -largestHalf, largestHalf) : value;  // a NaN stays NaN
  };
  std::vector<float> pixels;
  write(path, spec, metadata, OIIO::TypeDesc::FLOAT, [&](int first, int count) {
    interleaveRows(images, first, count, pixels, convert);
    return pixels.data();
  });
}

OIIO::ImageSpec pngSpec(int width, int height, int channels) {
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  return spec;
}

void writePng(const fs::path& path, const Image& image, const Metadata& metadata,
              const ToneMapping& toneMapping) {
  Image stripe(image.width, stripeRows, image.channels);
  std::vector<uint8_t> bytes(stripe.values.size());
  write(path, pngSpec(image.width, image.height, image.channels), metadata, OIIO::TypeDesc::UINT8,
        [&](int first, int count) {
          std::copy(image.pixel(0, first), image.pixel(0, first + count), stripe.pixel(0, 0));
          const Image screen = toneMap(stripe, toneMapping);
          std::transform(screen.values.begin(), screen.values.end(), bytes.begin(), [](float value) {
            return value > 0.f ? static_cast<uint8_t>(std::lround(std::min(value, 1.f) * 255.f)) : uint8_t{0};
          });
          return bytes.data();
        });
}

// Whether some sample takes more of one colour than of another.
bool isColoured(const DeepImage& image) {
  return std::ranges::any_of(image.pixels, [](const std::vector<DeepSample>& samples) {
    return std::ranges::any_of(samples, [](const DeepSample& sample) {
      return sample.takes != std::array{sample.alpha, sample.alpha, sample.alpha};
    });
  });
}

// The channels of a deep file, in this order; the last three where it is coloured.
enum DeepChannel { R, G, B, A, Z, ZBack, RA, GA, BA };

OIIO::ImageSpec deepSpec(const DeepImage& image, bool coloured) {
  OIIO::ImageSpec spec(image.width, image.height, coloured ? 9 : 6, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"R", "G", "B", "A", "Z", "ZBack"};
  if (coloured) spec.channelnames.insert(spec.channelnames.end(), {"RA", "GA", "BA"});
  spec.channelformats.assign(spec.channelnames.size(), OIIO::TypeDesc::HALF);
  spec.channelformats[Z] = spec.channelformats[ZBack] = OIIO::TypeDesc::FLOAT;
  spec.alpha_channel = A;
  spec.z_channel = Z;
  spec.deep = true;
  spec.attribute("compression", "zips");
  spec.attribute("worldtocamera", OIIO::TypeDesc::TypeMatrix, image.view.worldToCamera.data());
  spec.attribute("worldtoNDC", OIIO::TypeDesc::TypeMatrix, image.view.worldToNdc.data());
  if (!image.name.empty()) spec.attribute("oiio:subimagename", image.name);
  return spec;
}

// A pixel whose values become halves: what one sample's rounding changes of the light behind it is made up
// for by the next one, so that the flattened pixel is as exact as a half.
class DeepPixelWriter {
 public:
  DeepPixelWriter(OIIO::DeepData& data, int64_t pixel) : data_(data), pixel_(pixel) {}

  void write(const DeepSample& sample) {
    for (size_t c = 0; c < 3; ++c) store(R + static_cast<int>(c), dimmed(sample.colour[c] * colour_.exact));
    store(Z, sample.z);
    store(ZBack, sample.zBack);
    take(A, colour_, sample.alpha);
    if (data_.channels() > RA)
      for (size_t c = 0; c < 3; ++c) take(RA + static_cast<int>(c), channels_[c], sample.takes[c]);
    ++sample_;
  }

 private:
  // Light that is left of what comes from behind: as the samples have it, and as the file has it.
  struct Left {
    double exact = 1;
    double written = 1;
  };

  float dimmed(double radiance) const {
    const double value = colour_.written > 0 ? radiance / colour_.written : 0.0;
    return static_cast<float>(std::clamp(value, -double{largestHalf}, double{largestHalf}));
  }

  void take(int channel, Left& left, float alpha) {
    constexpr float mostBelowOne = 0.99951171875f;  // in halves
    left.exact *= 1.0 - alpha;
    float written = left.written > 0 ? static_cast<float>(1.0 - left.exact / left.written) : 0.f;
    if (left.exact > 0) written = std::clamp(written, 0.f, mostBelowOne);
    left.written *= 1.0 - store(channel, written);
  }

  // What it is as the channel's type.
  double store(int channel, float value) {
    data_.set_deep_value(pixel_, channel, sample_, value);
    return data_.deep_value(pixel_, channel, sample_);
  }

  OIIO::DeepData& data_;
  const int64_t pixel_;
  int sample_ = 0;
  Left colour_;
  std::array<Left, 3> channels_;
};

OIIO::DeepData deepRows(const DeepImage& image, const OIIO::ImageSpec& spec, int first, int count) {
  const size_t pixels = static_cast<size_t>(count) * static_cast<size_t>(image.width);
  const std::vector<DeepSample>* from = &image.pixel(0, first);
  OIIO::DeepData data;
  data.init(static_cast<int64_t>(pixels), spec.nchannels, spec.channelformats, spec.channelnames);
  std::vector<unsigned> counts(pixels);
  for (size_t i = 0; i < pixels; ++i) counts[i] = static_cast<unsigned>(from[i].size());
  data.set_all_samples(counts);
  for (size_t i = 0; i < pixels; ++i) {
    DeepPixelWriter writer(data, static_cast<int64_t>(i));
    for (const DeepSample& sample : from[i]) writer.write(sample);
  }
  return data;
}

// Throws Input unless the last row of the last part can be read: OpenImageIO does not say when a disk was
// full.
void checkDeepEnd(const fs::path& path, const std::string& name) {
  const auto input = OIIO::ImageInput::open(name);
  int parts = 0;
  while (input && input->seek_subimage(parts, 0)) ++parts;
  OIIO::DeepData row;
  const int last = input ? input->spec().height - 1 : 0;
  if (!input ||
      !input->read_native_deep_scanlines(parts - 1, 0, last, last + 1, 0, 0, input->spec().nchannels, row))
    fail(ExitCode::Input, "{}: cannot be written whole: is the disk full?", path.string());
}

// Red, green and blue; grey where there are fewer.
OIIO::ImageBuf colourOf(const Image& image) {
  OIIO::ImageBuf buffer(OIIO::ImageSpec(image.width, image.height, 3, OIIO::TypeDesc::FLOAT));
  auto* to = static_cast<float*>(buffer.localpixels());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) *to++ = image.pixel(x, y)[image.channels < 3 ? 0 : c];
  return buffer;
}

std::vector<uint8_t> expandToRgba(const std::vector<uint8_t>& stored, int channels) {
  const size_t pixels = stored.size() / static_cast<size_t>(channels);
  std::vector<uint8_t> rgba(pixels * 4);
  const bool grey = channels < 3;
  const bool alpha = channels == 2 || channels == 4;
  for (size_t i = 0; i < pixels; ++i) {
    const uint8_t* from = &stored[i * static_cast<size_t>(channels)];
    uint8_t* to = &rgba[i * 4];
    for (int c = 0; c < 3; ++c) to[c] = from[grey ? 0 : c];
    to[3] = alpha ? from[channels - 1] : 255;
  }
  return rgba;
}

// The format by its first bytes; nullptr for what is neither PNG nor JPEG.
const char* pictureFormat(std::span<const std::byte> bytes) {
  const auto startsWith = [&](const char* magic, size_t size) {
    return bytes.size() >= size && std::memcmp(bytes.data(), magic, size) == 0;
  };
  if (startsWith("\x89PNG\r\n\x1a\n", 8)) return "png";
  if (startsWith("\xff\xd8\xff", 3)) return "jpeg";
  return nullptr;
}

// Whether a PNG's chunks follow each other up to the last one. A cut file stops here, without the lines that
// libpng would print.
bool pngIsWhole(std::span<const std::byte> bytes) {
  constexpr size_t signature = 8, frame = 12;  // a chunk's length, type and checksum
  for (size_t at = signature; bytes.size() - at >= frame;) {
    size_t length = 0;
    for (size_t i = 0; i < 4; ++i) length = length << 8 | std::to_integer<size_t>(bytes[at + i]);
    if (length > bytes.size() - at - frame) return false;
    if (std::memcmp(&bytes[at + 4], "IEND", 4) == 0) return true;
    at += frame + length;
  }
  return false;
}

// Throws Input unless the file is an image of sane size.
std::unique_ptr<OIIO::ImageInput> openImage(const fs::path& path) {
  std::error_code error;
  const uint64_t fileBytes = fs::file_size(path, error);
  if (error) fail(ExitCode::Input, "{}: cannot be read: {}", path.string(), error.message());
  if (fileBytes == 0) fail(ExitCode::Input, "{}: is empty: write it again", path.string());

  const OIIO::ImageSpec hints = readAsStored();
  auto input = OIIO::ImageInput::open(path.string(), &hints);
  if (!input) fail(ExitCode::Input, "{}: cannot be read: {}", path.string(), oneLine(OIIO::geterror()));
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1)
    fail(ExitCode::Input, "{}: is not a two-dimensional image", path.string());
  const uint64_t pixels = static_cast<uint64_t>(spec.width) * static_cast<uint64_t>(spec.height);
  if (pixels > maxImageValues / static_cast<uint64_t>(spec.nchannels) ||
      pixels / maxPixelsPerByte > fileBytes)
    fail(ExitCode::Input, "{}: {} x {} x {} values are too many for this file: it is damaged or too large",
         path.string(), spec.width, spec.height, spec.nchannels);
  return input;
}

// Channels begin to end - 1.
Image readChannels(OIIO::ImageInput& input, const fs::path& path, int begin, int end) {
  Image image(input.spec().width, input.spec().height, end - begin);
  if (!input.read_image(0, 0, begin, end, OIIO::TypeDesc::FLOAT, image.values.data()))
    fail(ExitCode::Input, "{}: is damaged: {}: write it again", path.string(), oneLine(input.geterror()));
  return image;
}

// R, G and B of a deep image, its samples put over each other.
Image readFlattened(OIIO::ImageInput& input, const fs::path& path) {
  OIIO::ImageBuf deep(input.spec());
  if (!deep.deepdata() || !input.read_native_deep_image(0, 0, *deep.deepdata()))
    fail(ExitCode::Input, "{}: is damaged: {}: write it again", path.string(), oneLine(input.geterror()));
  const OIIO::ImageBuf flat = OIIO::ImageBufAlgo::flatten(deep);
  Image image(input.spec().width, input.spec().height, 3);
  const auto& names = input.spec().channelnames;
  const bool hasColour = names.size() >= 3 && names[0] == "R" && names[1] == "G" && names[2] == "B";
  const OIIO::ROI colour(0, image.width, 0, image.height, 0, 1, 0, 3);
  if (!hasColour || flat.has_error() || !flat.get_pixels(colour, OIIO::TypeDesc::FLOAT, image.values.data()))
    fail(ExitCode::Input, "{}: is a deep image that cannot be flattened: {}", path.string(),
         hasColour ? oneLine(flat.geterror()) : "it has no R, G and B");
  return image;
}

}  // namespace

bool readsAndWritesImages() {
  return true;
}

Image readImage(const fs::path& path) {
  const auto input = openImage(path);
  if (input->spec().deep) return readFlattened(*input, path);
  const std::vector<std::string>& names = input->spec().channelnames;
  const int channels = input->spec().nchannels;
  // OpenImageIO puts R, G, B and A first.
  const bool hasLayers = channels > 3 && names[0] == "R" && names[1] == "G" && names[2] == "B";
  const int wanted = !hasLayers ? channels : names[3] == "A" ? 4 : 3;
  return readChannels(*input, path, 0, wanted);
}

Layer readLayer(const fs::path& path, const std::string& name) {
  const auto input = openImage(path);
  if (input->spec().deep) fail(ExitCode::Input, "{}: is a deep image: it has no layers", path.string());
  const std::vector<std::string>& names = input->spec().channelnames;
  const auto isOfLayer = [&](const std::string& channel) { return channel.starts_with(name + "."); };
  const auto first = std::find_if(names.begin(), names.end(), isOfLayer);
  const auto end = std::find_if_not(first, names.end(), isOfLayer);  // OpenImageIO keeps them together
  if (first == end) fail(ExitCode::Input, "{}: has no layer \"{}\"", path.string(), name);
  Layer layer{.name = name};
  for (auto channel = first; channel != end; ++channel)
    layer.channels.push_back(channel->substr(name.size() + 1));
  layer.image = readChannels(*input, path, static_cast<int>(first - names.begin()),
                             static_cast<int>(end - names.begin()));
  return layer;
}

void writeImage(const fs::path& path, const Image& image, const Metadata& metadata, bool fullFloat,
                const ToneMapping& toneMapping) {
  base::check(image.channels == 3 || image.channels == 4, "an image to write has 3 or 4 channels");
  if (endingOf(path) == Ending::Exr)
    writeExr(path, image, {}, metadata, fullFloat);
  else
    writePng(path, image, metadata, toneMapping);
}

void writeLayers(const fs::path& path, const Image& image, std::span<const Layer> layers,
                 const Metadata& metadata) {
  base::check(holdsLayers(path), "layers are written to .exr files");
  writeExr(path, image, layers, metadata, false);
}

void writeDeep(const fs::path& path, std::span<const DeepImage> parts, const Metadata& metadata) {
  checkDeepName(path);
  std::vector<OIIO::ImageSpec> specs;
  const bool coloured = std::ranges::any_of(parts, isColoured);
  for (const DeepImage& part : parts) describe(specs.emplace_back(deepSpec(part, coloured)), metadata);
  base::PendingFile pending(path);  // as OpenImageIO writes no deep images into memory
  writeParts(path, pending.temporary().string(), specs,
             [&](OIIO::ImageOutput& output, size_t part, int first, int count) {
               return output.write_deep_scanlines(first, first + count, 0,
                                                  deepRows(parts[part], specs[part], first, count));
             });
  checkDeepEnd(path, pending.temporary().string());
  pending.rename();
}

bool holdsLayers(const fs::path& path) {
  return endingOf(path) == Ending::Exr;
}

void checkImageName(const fs::path& path) {
  endingOf(path);
}

void checkDeepName(const fs::path& path) {
  if (endingOf(path) != Ending::Exr)
    fail(ExitCode::Usage, "{}: is not the name of a deep image: use .exr", path.string());
  std::error_code ignored;
  if (fs::is_other(path, ignored))  // its bytes are not written in their order
    fail(ExitCode::Input, "{}: is a device or a pipe: give a file", path.string());
}

Picture decodePicture(std::span<const std::byte> bytes, const std::string& name) {
  const char* format = pictureFormat(bytes);
  if (!format) fail(ExitCode::Input, "{}: is not a PNG or JPEG picture: convert it", name);
  if (std::strcmp(format, "png") == 0 && !pngIsWhole(bytes))
    fail(ExitCode::Input, "{}: is a PNG picture that is cut off: write it again", name);
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  OIIO::Filesystem::IOProxy* source = &memory;
  OIIO::ImageSpec hints = readAsStored();
  hints.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &source);
  const auto input = OIIO::ImageInput::create(format);
  if (!input) fail(ExitCode::Input, "{}: cannot be decoded: {}", name, oneLine(OIIO::geterror()));
  OIIO::ImageSpec spec;
  if (!input->open(format, spec, hints))
    fail(ExitCode::Input, "{}: is a damaged picture: {}: write it again", name, oneLine(input->geterror()));
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels < 1 || spec.nchannels > 4)
    fail(ExitCode::Input, "{}: is a picture without pixels or with more than 4 channels: convert it", name);
  const uint64_t pixels = static_cast<uint64_t>(spec.width) * static_cast<uint64_t>(spec.height);
  if (spec.width > maxPictureSide || spec.height > maxPictureSide || pixels / maxPixelsPerByte > bytes.size())
    fail(ExitCode::Input, "{}: {} x {} pixels are too many: at most {} on a side, and no more than it holds",
         name, spec.width, spec.height, maxPictureSide);

  std::vector<uint8_t> stored(pixels * static_cast<uint64_t>(spec.nchannels));
  const bool read = input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, stored.data());
  if (!read || input->has_error())  // a cut JPEG is read in grey, and only noted
    fail(ExitCode::Input, "{}: is a damaged picture: {}: write it again", name, oneLine(input->geterror()));
  return {spec.width, spec.height, expandToRgba(stored, spec.nchannels)};
}

void checkPictureName(const fs::path& path) {
  if (endingOf(path) != Ending::Png)
    fail(ExitCode::Usage, "{}: is not the name of a picture: use .png", path.string());
}

void writePicture(const fs::path& path, const Picture& picture, const Metadata& metadata) {
  checkPictureName(path);
  write(path, pngSpec(picture.width, picture.height, 4), metadata, OIIO::TypeDesc::UINT8,
        [&](int first, int) { return &picture.rgba[static_cast<size_t>(first) * picture.width * 4]; });
}

size_t perceptualFailures(const Image& image, const Image& reference) {
  checkComparable(image, reference);
  OIIO::ImageBufAlgo::CompareResults results;
  return static_cast<size_t>(OIIO::ImageBufAlgo::compare_Yee(colourOf(image), colourOf(reference), results));
}

}  // namespace sfumato::image

#else

namespace sfumato::image {
namespace {

[[noreturn]] void failWithoutOpenImageIO(const std::string& name) {
  base::fail(base::ExitCode::Input,
             "{}: this build reads and writes no images: build with OpenImageIO (SFUMATO_OPENIMAGEIO=ON)",
             name);
}

}  // namespace

bool readsAndWritesImages() {
  return false;
}

Image readImage(const std::filesystem::path& path) {
  failWithoutOpenImageIO(path.string());
}

void writeImage(const std::filesystem::path& path, const Image&, const Metadata&, bool, const ToneMapping&) {
  failWithoutOpenImageIO(path.string());
}

void writeLayers(const std::filesystem::path& path, const Image&, std::span<const Layer>, const Metadata&) {
  failWithoutOpenImageIO(path.string());
}

void writeDeep(const std::filesystem::path& path, std::span<const DeepImage>, const Metadata&) {
  failWithoutOpenImageIO(path.string());
}

bool holdsLayers(const std::filesystem::path& path) {
  failWithoutOpenImageIO(path.string());
}

Layer readLayer(const std::filesystem::path& path, const std::string&) {
  failWithoutOpenImageIO(path.string());
}

void checkImageName(const std::filesystem::path& path) {
  failWithoutOpenImageIO(path.string());
}

void checkDeepName(const std::filesystem::path& path) {
  failWithoutOpenImageIO(path.string());
}

Picture decodePicture(std::span<const std::byte>, const std::string& name) {
  failWithoutOpenImageIO(name);
}

void checkPictureName(const std::filesystem::path& path) {
  failWithoutOpenImageIO(path.string());
}

void writePicture(const std::filesystem::path& path, const Picture&, const Metadata&) {
  failWithoutOpenImageIO(path.string());
}

size_t perceptualFailures(const Image&, const Image&) {
  failWithoutOpenImageIO("perceptual comparison");
}

}  // namespace sfumato::image

#endif
