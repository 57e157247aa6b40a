// Clears of a part of a framebuffer.
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gl/texture.h"
#include "tests/gl/test_device.h"

namespace sfumato::gl {
namespace {

constexpr glm::ivec2 size(7, 5);
constexpr glm::ivec4 area(2, 1, 3, 2);

bool inside(int x, int y) {
  return x >= area.x && x < area.x + area.z && y >= area.y && y < area.y + area.w;
}

class FramebufferGpu : public tests::GpuTest {
 protected:
  Texture texture(Format format) { return {device(), "target", {.format = format, .size = {size, 1}}}; }

  template <typename Texel>
  static void expectOnlyInside(const Texture& texture, const Texel& before, const Texel& after) {
    std::vector<Texel> texels(static_cast<size_t>(size.x) * static_cast<size_t>(size.y));
    texture.read(std::as_writable_bytes(std::span(texels)));
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        EXPECT_EQ(texels[static_cast<size_t>(y * size.x + x)], inside(x, y) ? after : before)
            << x << " " << y;
  }
};

TEST_F(FramebufferGpu, ClearsAPartOfItsColoursAndDepth) {
  const Texture floats = texture(Format::R32F);
  const Texture words = texture(Format::RGBA32UI);
  const Texture depth = texture(Format::Depth32F);
  const Framebuffer target(std::vector<const Texture*>{&floats, &words}, &depth);
  target.clearColour(0, glm::vec4(1));
  target.clearColour(1, glm::uvec4(1, 2, 3, 4));
  target.clearDepth(1);
  target.clearColour(0, glm::vec4(2), area);
  target.clearColour(1, glm::uvec4(0xffffffffu, 6, 7, 8), area);
  target.clearDepth(0.25f, area);
  expectOnlyInside(floats, 1.f, 2.f);
  expectOnlyInside(words, glm::uvec4(1, 2, 3, 4), glm::uvec4(0xffffffffu, 6, 7, 8));
  expectOnlyInside(depth, 1.f, 0.25f);
  target.clearColour(0, glm::vec4(3));  // the part was that one's only
  expectOnlyInside(floats, 3.f, 3.f);
}

}  // namespace
}  // namespace sfumato::gl
