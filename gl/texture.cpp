#include "gl/texture.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/size_text.h"

namespace sfumato::gl {

using base::ExitCode;
using base::fail;

void deleteTexture(unsigned name) {
  glDeleteTextures(1, &name);
}

void deleteFramebuffer(unsigned name) {
  glDeleteFramebuffers(1, &name);
}

namespace {

struct FormatTraits {
  GLenum internal, layout, type;
  size_t bytes;
};

FormatTraits traits(Format format) {
  switch (format) {
    case Format::R8:
      return {GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1};
    case Format::R16F:
      return {GL_R16F, GL_RED, GL_HALF_FLOAT, 2};
    case Format::R32F:
      return {GL_R32F, GL_RED, GL_FLOAT, 4};
    case Format::R32UI:
      return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
    case Format::R32I:
      return {GL_R32I, GL_RED_INTEGER, GL_INT, 4};
    case Format::RG32UI:
      return {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, 8};
    case Format::RGBA8:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
    case Format::SRGB8A8:
      return {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
    case Format::RGB10A2:
      return {GL_RGB10_A2, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, 4};
    case Format::RGBA16F:
      return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8};
    case Format::RGBA32F:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
    case Format::RGBA32UI:
      return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16};
    case Format::Depth32F:
      return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4};
    case Format::Depth32FStencil8:
      return {GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, 8};
  }
  return {};
}

GLint wrapping(Wrap wrap) {
  constexpr GLint values[] = {GL_REPEAT, GL_CLAMP_TO_EDGE, GL_MIRRORED_REPEAT};
  return values[static_cast<int>(wrap)];
}

GLenum targetOf(const TextureDescription& description) {
  if (description.array)
    return description.samples > 0 ? GL_TEXTURE_2D_MULTISAMPLE_ARRAY : GL_TEXTURE_2D_ARRAY;
  if (description.samples > 0) return GL_TEXTURE_2D_MULTISAMPLE;
  return description.size.z > 1 ? GL_TEXTURE_3D : GL_TEXTURE_2D;
}

GLint minification(Minify minify) {
  constexpr GLint values[] = {GL_NEAREST,
                              GL_LINEAR,
                              GL_NEAREST_MIPMAP_NEAREST,
                              GL_LINEAR_MIPMAP_NEAREST,
                              GL_NEAREST_MIPMAP_LINEAR,
                              GL_LINEAR_MIPMAP_LINEAR};
  return values[static_cast<int>(minify)];
}

void checkLayers(const std::string& label, int layers) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &limit);
  if (layers > limit)
    fail(ExitCode::Memory, "{}: {} layers, this device allows {}: use fewer", label, layers, limit);
}

void checkSize(const Device& device, const std::string& label, glm::ivec3 size) {
  const int limit = size.z > 1 ? device.limits().texture3dSize : device.limits().texture2dSize;
  const int largest = std::max({size.x, size.y, size.z});
  if (largest > limit)
    fail(ExitCode::Memory, "{}: {} x {} x {} texels, this device allows {} a side: use a smaller one", label,
         size.x, size.y, size.z, limit);
}

}  // namespace

Texture::Texture(Device& device, std::string label, const TextureDescription& description,
                 std::span<const std::byte> texels)
    : ledger_(&device.memory()),
      label_(std::move(label)),
      format_(description.format),
      target_(targetOf(description)),
      size_(description.size) {
  if (description.array) checkLayers(label_, size_.z);
  checkSize(device, label_, description.array ? glm::ivec3(size_.x, size_.y, 1) : size_);
  const FormatTraits format = traits(description.format);
  bytes_ = static_cast<size_t>(size_.x) * static_cast<size_t>(size_.y) * static_cast<size_t>(size_.z) *
           format.bytes * static_cast<size_t>(std::max(description.samples, 1));
  base::check(texels.empty() || texels.size() == bytes_, "a texture gets as many texels as it has");
  const GLint magnify = description.filter == Filter::Nearest ? GL_NEAREST : GL_LINEAR;
  const GLint minify = description.minify ? minification(*description.minify) : magnify;
  const bool mipmaps = minify != GL_NEAREST && minify != GL_LINEAR;
  const int levels = mipmaps ? 1 + static_cast<int>(std::log2(std::max(size_.x, size_.y))) : 1;

  GLuint name = 0;
  glGenTextures(1, &name);
  object_ = Object<deleteTexture>(name);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(target_, name);
  while (glGetError() != GL_NO_ERROR) {
  }
  const bool multisample = description.samples > 0;
  if (description.array && multisample)
    glTexStorage3DMultisample(target_, description.samples, format.internal, size_.x, size_.y, size_.z,
                              GL_TRUE);
  else if (multisample)
    glTexStorage2DMultisample(target_, description.samples, format.internal, size_.x, size_.y, GL_TRUE);
  else if (description.array || target_ == GL_TEXTURE_3D)
    glTexStorage3D(target_, levels, format.internal, size_.x, size_.y, size_.z);
  else
    glTexStorage2D(target_, levels, format.internal, size_.x, size_.y);
  if (glGetError() == GL_OUT_OF_MEMORY)
    fail(ExitCode::Memory, "{}: the device has no room for {}: use a smaller one", label_,
         base::sizeText(bytes_));
  if (!texels.empty()) {
    if (target_ == GL_TEXTURE_3D)
      glTexSubImage3D(target_, 0, 0, 0, 0, size_.x, size_.y, size_.z, format.layout, format.type,
                      texels.data());
    else
      glTexSubImage2D(target_, 0, 0, 0, size_.x, size_.y, format.layout, format.type, texels.data());
    if (mipmaps) glGenerateMipmap(target_);
  }
  if (!multisample) {
    glTexParameteri(target_, GL_TEXTURE_MAG_FILTER, magnify);
    glTexParameteri(target_, GL_TEXTURE_MIN_FILTER, minify);
    glTexParameteri(target_, GL_TEXTURE_WRAP_S, wrapping(description.wrapS));
    glTexParameteri(target_, GL_TEXTURE_WRAP_T, wrapping(description.wrapT));
    glTexParameteri(target_, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
  }
  if (mipmaps) bytes_ += bytes_ / 3;
  ledger_->add(label_, bytes_);
}

Texture& Texture::operator=(Texture&& other) noexcept {
  std::swap(object_, other.object_);
  std::swap(ledger_, other.ledger_);
  std::swap(label_, other.label_);
  std::swap(format_, other.format_);
  std::swap(bytes_, other.bytes_);
  std::swap(target_, other.target_);
  std::swap(size_, other.size_);
  return *this;
}

Texture::~Texture() {
  if (object_.name() != 0) ledger_->remove(label_, bytes_);
}

bool Texture::isArray() const {
  return target_ == GL_TEXTURE_2D_MULTISAMPLE_ARRAY || target_ == GL_TEXTURE_2D_ARRAY;
}

void Texture::bind(unsigned unit) const {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(target_, name());
}

void Texture::bindImage(unsigned unit) const {
  glBindImageTexture(unit, name(), 0, GL_TRUE, 0, GL_READ_WRITE, traits(format_).internal);
}

void Texture::writeLayers(std::span<const std::byte> texels, int first, int count) {
  const FormatTraits format = traits(format_);
  base::check(target_ == GL_TEXTURE_3D &&
                  texels.size() == bytes_ / static_cast<size_t>(size_.z) * static_cast<size_t>(count),
              "layers get as many texels as they have");
  bind(0);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage3D(target_, 0, 0, 0, first, size_.x, size_.y, count, format.layout, format.type,
                  texels.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void Texture::copyFrom(const Buffer& texels) {
  base::check(target_ == GL_TEXTURE_2D, "a buffer fills a 2D texture");
  const FormatTraits format = traits(format_);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(target_, name());
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, texels.name());
  glTexSubImage2D(target_, 0, 0, 0, size_.x, size_.y, format.layout, format.type, nullptr);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

void Texture::read(std::span<std::byte> texels) const {
  base::check(texels.size() == bytes_, "a texture is read whole");
  bind(0);
  glGetTexImage(target_, 0, traits(format_).layout, traits(format_).type, texels.data());
}

BufferTexture::BufferTexture(const Device& device, const Buffer& buffer, BufferFormat format) {
  constexpr GLenum internals[] = {GL_R32UI, GL_RG32UI, GL_RGB32UI, GL_RGBA32UI, GL_RGBA32F};
  const size_t texelBytes = 4 * std::min<size_t>(static_cast<size_t>(format) + 1, 4);
  const auto limit = static_cast<size_t>(device.limits().textureBufferTexels) * texelBytes;
  if (buffer.bytes() > limit)
    fail(ExitCode::Memory, "a buffer of {}, this device reads {} at once: lower --res or --shadow-res",
         base::sizeText(buffer.bytes()), base::sizeText(limit));
  GLuint name = 0;
  glGenTextures(1, &name);
  object_ = Object<deleteTexture>(name);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_BUFFER, name);
  glTexBuffer(GL_TEXTURE_BUFFER, internals[static_cast<int>(format)], buffer.name());
}

void BufferTexture::bind(unsigned unit) const {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_BUFFER, object_.name());
}

Framebuffer::Framebuffer(glm::ivec2 size, int samples, int layers) : size_(size) {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  object_ = Object<deleteFramebuffer>(name);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name);
  glFramebufferParameteri(GL_DRAW_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_WIDTH, size.x);
  glFramebufferParameteri(GL_DRAW_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_HEIGHT, size.y);
  glFramebufferParameteri(GL_DRAW_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_SAMPLES, samples > 1 ? samples : 0);
  glFramebufferParameteri(GL_DRAW_FRAMEBUFFER, GL_FRAMEBUFFER_DEFAULT_LAYERS, layers);
  glDrawBuffer(GL_NONE);
  base::check(glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
              "a framebuffer is complete");
}

Framebuffer::Framebuffer(std::span<const Texture* const> colours, const Texture* depth, int layer) {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  object_ = Object<deleteFramebuffer>(name);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name);
  std::vector<GLenum> buffers;
  for (const Texture* colour : colours) {
    buffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(buffers.size()));
    if (colour->isArray())
      glFramebufferTextureLayer(GL_DRAW_FRAMEBUFFER, buffers.back(), colour->name(), 0, layer);
    else
      glFramebufferTexture(GL_DRAW_FRAMEBUFFER, buffers.back(), colour->name(), 0);
    size_ = colour->size();
  }
  glDrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  if (depth != nullptr) {
    const GLenum place =
        depth->format() == Format::Depth32FStencil8 ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT;
    glFramebufferTexture(GL_DRAW_FRAMEBUFFER, place, depth->name(), 0);
    size_ = depth->size();
  }
  base::check(glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE,
              "a framebuffer is complete");
}

namespace {

// Clears obey the masks that the last draw left.
void openMasks(const Framebuffer& framebuffer) {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer.name());
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glStencilMask(0xff);
  glDisable(GL_SCISSOR_TEST);
}

}  // namespace

void Framebuffer::clearColour(int attachment, glm::vec4 value) const {
  openMasks(*this);
  glClearBufferfv(GL_COLOR, attachment, &value.x);
}

void Framebuffer::clearColour(int attachment, glm::uvec4 value) const {
  openMasks(*this);
  glClearBufferuiv(GL_COLOR, attachment, &value.x);
}

void Framebuffer::clearDepth(float value) const {
  openMasks(*this);
  glClearBufferfv(GL_DEPTH, 0, &value);
}

void Framebuffer::clearStencil(int value) const {
  openMasks(*this);
  glClearBufferiv(GL_STENCIL, 0, &value);
}

std::vector<glm::vec2> Framebuffer::samplePositions() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name());
  GLint samples = 0;
  glGetIntegerv(GL_SAMPLES, &samples);
  if (samples <= 1) return {glm::vec2(0.5f)};
  std::vector<glm::vec2> positions(static_cast<size_t>(samples));
  for (GLuint i = 0; i < positions.size(); ++i) glGetMultisamplefv(GL_SAMPLE_POSITION, i, &positions[i].x);
  return positions;
}

}  // namespace sfumato::gl
