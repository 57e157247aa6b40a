#include "pipelines/post_gpu.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/error.h"
#include "gl/commands.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/post.h"

namespace sfumato::pipelines {

using gl::Profiler;
using gl::Texture;

namespace {

constexpr float brightest = 65504.f;    // as .exr files have it: what is infinite must not flood the picture
constexpr int rowsOfSmallImage = 180;   // of separable bloom: a quarter of 720
constexpr int rowsOfSmallestImage = 8;  // of mipmap bloom, at least

enum class Bright { All, ByContrast, ByThreshold };  // as in bloom_shrink.comp

Texture emptyTexture(gl::Device& device, const std::string& label, glm::ivec2 size) {
  return {device, label, {.format = gl::Format::RGBA32F, .size = {size, 1}}};
}

// A texture of what texelOf(x, y) says.
template <typename TexelOf>
Texture upload(gl::Device& device, const std::string& label, glm::ivec2 size, const TexelOf& texelOf) {
  std::vector<glm::vec4> texels;
  texels.reserve(static_cast<size_t>(size.x) * static_cast<size_t>(size.y));
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) texels.push_back(texelOf(x, y));
  return {
      device, label, {.format = gl::Format::RGBA32F, .size = {size, 1}}, std::as_bytes(std::span(texels))};
}

float usable(float radiance) {
  return std::isnan(radiance) ? 0.f : std::clamp(radiance, 0.f, brightest);
}

glm::vec4 surfaceAt(const AovImages& aovs, int x, int y) {
  const float* normal = aovs.at(Aov::Normal).pixel(x, y);
  const float depth = aovs.at(Aov::Depth).pixel(x, y)[0];
  return {normal[0], normal[1], normal[2], 1.f / std::max(depth, 1e-6f)};
}

glm::ivec2 shrunk(glm::ivec2 size, int side) {
  return (size + side - 1) / side;
}

// Textures from textures, by the shaders of one frame.
class PostPasses {
 public:
  PostPasses(gl::Device& device, const PostInputs& inputs)
      : device_(device),
        inputs_(inputs),
        block_(device, "post-processing pass", sizeof(shared::PostParams)) {}

  Texture shrink(const Texture& from, int side, Bright bright) {
    Texture to = emptyTexture(device_, "bloom", shrunk(from.size(), side));
    run("bloom_shrink", from, to, {.step = {side, 0, 0, 0}},
        {{"BRIGHT", std::to_string(static_cast<int>(bright))}});
    return to;
  }

  Texture blur(const Texture& from, glm::ivec2 direction) {
    Texture to = emptyTexture(device_, "bloom", from.size());
    run("bloom_blur", from, to, {.step = {0, direction, 0}});
    return to;
  }

  void addEnlarged(const Texture& from, int side, double strength, const Texture& to) {
    run("bloom_enlarge", from, to,
        {.step = {side, 0, 0, 0}, .light = {0.f, 0.f, static_cast<float>(strength), 0.f}});
  }

  Texture blurEdges(const Texture& from, const Texture& surfaces) {
    Texture to = emptyTexture(device_, "post-processed picture", from.size());
    surfaces.bind(TEXTURE_PICTURE_SURFACES);
    run("edges", from, to, {});
    return to;
  }

 private:
  void run(const std::string& pass, const Texture& from, const Texture& to, shared::PostParams params,
           const gl::ShaderDefines& defines = {}) {
    params.sizes = {from.size().x, from.size().y, to.size().x, to.size().y};
    params.light.x = static_cast<float>(inputs_.white);
    params.light.y = static_cast<float>(inputs_.average);
    block_.writeValue(params);
    block_.bindUniform(UNIFORM_PASS);
    from.bind(TEXTURE_PICTURE);
    to.bindImage(IMAGE_PICTURE);
    gl::dispatch(device_.program({"pipelines/post/" + pass + ".comp"}, defines),
                 {gl::groupsFor(static_cast<size_t>(to.size().x), 8),
                  gl::groupsFor(static_cast<size_t>(to.size().y), 8), 1});
    gl::barrierBefore(gl::Reader::TextureFetch);
    gl::imageBarrier();
  }

  gl::Device& device_;
  const PostInputs& inputs_;
  gl::Buffer block_;
};

void addSeparableBloom(PostPasses& passes, double strength, const Texture& picture) {
  const int side = std::max((picture.size().y + rowsOfSmallImage / 2) / rowsOfSmallImage, 1);
  Texture glow = passes.shrink(picture, side, Bright::ByContrast);
  glow = passes.blur(glow, {1, 0});
  glow = passes.blur(glow, {0, 1});
  passes.addEnlarged(glow, side, strength, picture);
}

void addMipmapBloom(PostPasses& passes, double strength, const Texture& picture) {
  std::vector<Texture> levels;
  levels.push_back(passes.shrink(picture, 2, Bright::ByThreshold));
  while ((rowsOfSmallestImage << (levels.size() + 1)) <= picture.size().y)
    levels.push_back(passes.shrink(levels.back(), 2, Bright::All));
  for (size_t i = levels.size() - 1; i > 0; --i) passes.addEnlarged(levels[i], 2, 1, levels[i - 1]);
  passes.addEnlarged(levels[0], 2, strength / static_cast<double>(levels.size()), picture);
}

void addBloom(gl::Device& device, PostPasses& passes, const PostOptions& options, const Texture& picture) {
  if (options.bloom == Bloom::Off) return;
  const Profiler::Scope time(device.profiler(), "bloom");
  const auto add = options.bloom == Bloom::Separable ? addSeparableBloom : addMipmapBloom;
  add(passes, options.bloomStrength, picture);
}

image::Image download(const Texture& picture) {
  image::Image image(picture.size().x, picture.size().y, 3);
  std::vector<glm::vec4> texels(image.values.size() / 3);
  picture.read(std::as_writable_bytes(std::span(texels)));
  for (size_t i = 0; i < texels.size(); ++i) std::copy_n(&texels[i].x, 3, &image.values[3 * i]);
  return image;
}

}  // namespace

image::Image postProcess(gl::Device& device, const PostInputs& inputs, const PostOptions& options) {
  const image::Image& radiance = inputs.radiance;
  const glm::ivec2 size(radiance.width, radiance.height);
  PostPasses passes(device, inputs);
  Texture picture = upload(device, "post-processed picture", size, [&](int x, int y) {
    const float* rgb = radiance.pixel(x, y);
    return glm::vec4(usable(rgb[0]), usable(rgb[1]), usable(rgb[2]), 1.f);
  });
  addBloom(device, passes, options, picture);
  if (options.antiAliasing == AntiAliasing::Edges) {
    const Profiler::Scope time(device.profiler(), "edges");
    const Texture surfaces =
        upload(device, "edges", size, [&](int x, int y) { return surfaceAt(inputs.aovs, x, y); });
    picture = passes.blurEdges(picture, surfaces);
  }
  return download(picture);
}

}  // namespace sfumato::pipelines
