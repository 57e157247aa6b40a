// Rectangles of whole pixels in place of triangles (shaders/scene/covering.glsl) make fragments at the very
// pixels at which the driver makes them of the triangles, in all samples. (But for culled slivers so thin
// that rounding turns them over, which Mesa judges before rounding and after: one in 300 seeds.)
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/random.h"
#include "gl/buffer.h"
#include "gl/commands.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "pipelines/stencil_routed_gpu.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/view.h"
#include "tests/gl/test_device.h"

namespace sfumato::pipelines {
namespace {

using base::Random;
using Corners = std::vector<glm::vec4>;  // in clip space, three a triangle

constexpr int triangleCount = 250;  // so that sums of squares of their numbers are exact

glm::vec2 anywhere(Random& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

// As if seen in perspective, so far away.
glm::vec4 seenAt(glm::vec2 place, float w) {
  return {place * w, w - 1, w};
}

void add(Corners& corners, const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) {
  corners.insert(corners.end(), {a, b, c});
}

// A grid of n x n quads with shared corners, moved a little each.
Corners net(Random& random, double reach, int n) {
  std::vector<glm::vec4> points;
  const double step = 2 * reach / n;
  for (int i = 0; i < (n + 1) * (n + 1); ++i) {
    const glm::vec2 grid(i % (n + 1), i / (n + 1));
    points.push_back(
        seenAt(grid * static_cast<float>(step) - static_cast<float>(reach) + anywhere(random, 0.4 * step),
               static_cast<float>(random.uniform(1, 30))));
  }
  Corners corners;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const auto at = [&](int dx, int dy) {
        return points[static_cast<size_t>((y + dy) * (n + 1) + x + dx)];
      };
      add(corners, at(0, 0), at(1, 0), at(0, 1));
      add(corners, at(0, 1), at(1, 0), at(1, 1));
    }
  return corners;
}

Corners shared(Random& random) {
  return net(random, 0.95, 11);
}

Corners beyondTheImage(Random& random) {
  return net(random, 3, 11);
}

Corners tiny(Random& random) {
  Corners corners;
  for (int i = 0; i < triangleCount; ++i) {
    const glm::vec2 middle = anywhere(random, 1);
    const auto w = static_cast<float>(random.uniform(1, 30));
    add(corners, seenAt(middle + anywhere(random, 0.02), w), seenAt(middle + anywhere(random, 0.02), w),
        seenAt(middle + anywhere(random, 0.02), w));
  }
  return corners;
}

Corners slivers(Random& random) {
  Corners corners;
  for (int i = 0; i < triangleCount; ++i) {
    const glm::vec2 from = anywhere(random, 1.5);
    const glm::vec2 to = anywhere(random, 1.5);
    add(corners, seenAt(from, 1), seenAt(to, 5), seenAt(to + anywhere(random, 0.02), 5));
  }
  return corners;
}

// All around the eye, so that most cross planes of the view volume, and some are behind it.
Corners around(Random& random, double reach, double size) {
  const glm::mat4 clipFromView = glm::perspective(1.2f, 1.3f, 0.5f, 8.f);
  Corners corners;
  for (int i = 0; i < triangleCount; ++i) {
    const auto point = [&](double far) {
      return glm::vec3(random.uniform(-far, far), random.uniform(-far, far), random.uniform(-far, far));
    };
    const glm::vec3 middle = point(reach);
    const auto corner = [&] { return clipFromView * glm::vec4(middle + point(size), 1); };
    const glm::vec4 a = corner();
    const glm::vec4 b = corner();
    add(corners, a, b, corner());
  }
  return corners;
}

Corners throughTheNearPlane(Random& random) {
  return around(random, 1, 1);
}

Corners huge(Random& random) {
  return around(random, 10, 1000);
}

// Rectangles with sides through the centres of pixels, or between them, of an image of 64 x 64.
Corners throughCentres(Random& random) {
  Corners corners;
  const auto place = [&] { return static_cast<float>(static_cast<int>(random.uniform(-8, 136))) / 64 - 1; };
  for (int i = 0; i < triangleCount / 2; ++i) {
    const glm::vec2 low(place(), place());
    const glm::vec2 high(place(), place());
    const auto at = [&](float x, float y) { return seenAt({x, y}, 1); };
    add(corners, at(low.x, low.y), at(high.x, low.y), at(low.x, high.y));
    add(corners, at(low.x, high.y), at(high.x, low.y), at(high.x, high.y));
  }
  return corners;
}

Corners ofNoArea(Random& random) {
  Corners corners;
  for (int i = 0; i < triangleCount; ++i) {
    const glm::vec4 a = seenAt(anywhere(random, 1), 1);
    const glm::vec4 b = seenAt(anywhere(random, 1), 1);
    if (i % 2 == 0)
      add(corners, a, b, a);
    else
      add(corners, a, b, 0.5f * (a + b));
  }
  return corners;
}

struct Mesh {
  std::string name;
  Corners (*make)(Random&);
};

// What becomes of triangles: rectangles, and whether their fragments ask for the triangle.
struct Way {
  bool rectangles = false;
  bool asking = false;
  int samples = 0;
  std::optional<int> subpixelBits;  // none: what the shaders have
};

class CoveringGpu : public tests::GpuTest {
 protected:
  using Sums = std::vector<glm::vec4>;  // how many triangles, and which, in each sample of each pixel

  void SetUp() override {
    GpuTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    if (!routingOf(device()).covering) GTEST_SKIP() << "the driver routes fragments of triangles themselves";
  }

  Way triangles() { return {}; }
  Way covering() { return {.rectangles = true, .asking = true, .samples = device().limits().samples}; }

  Sums draw(const Corners& corners, glm::ivec2 size, const Way& way, gl::Cull cull = gl::Cull::None) {
    const gl::Texture image(
        device(), "sums",
        {.format = gl::Format::RGBA32F, .size = {size.x, size.y, 1}, .samples = way.samples});
    const gl::Framebuffer target(std::vector<const gl::Texture*>{&image}, nullptr);
    target.clearColour(0, glm::vec4(0.f));
    gl::Buffer view(device(), "view", sizeof(shared::ViewParams));
    view.writeValue(shared::ViewParams{.size = {size.x, size.y, 0, 0}});
    view.bindUniform(UNIFORM_VIEW);
    const gl::Buffer positions(device(), "corners", std::span<const glm::vec4>(corners));
    positions.bindStorage(STORAGE_COUNTERS);
    std::vector<std::string> shaders{"scene/clip_triangles.vert", "scene/primitive_sums.frag"};
    if (way.rectangles) shaders.emplace_back("scene/covering_only.geom");
    gl::ShaderDefines defines;
    if (way.subpixelBits) defines.emplace_back("SUBPIXEL_BITS", std::to_string(*way.subpixelBits));
    if (way.asking) defines.emplace_back("COVERING", "1");
    gl::setDrawState({.program = &device().program(shaders, defines),
                      .target = &target,
                      .viewport = {0, 0, size.x, size.y},
                      .cull = cull,
                      .blend = gl::Blend::Add});
    gl::drawGenerated(device(), corners.size(), 1);
    return way.samples > 0 ? samplesOf(image, way.samples) : pixelsOf(image);
  }

  static Sums pixelsOf(const gl::Texture& image) {
    Sums sums(static_cast<size_t>(image.size().x) * static_cast<size_t>(image.size().y));
    image.read(std::as_writable_bytes(std::span(sums)));
    return sums;
  }

  Sums samplesOf(const gl::Texture& image, int samples) {
    const auto count = static_cast<size_t>(image.size().x * image.size().y * samples);
    const gl::Buffer values(device(), "samples", count * sizeof(glm::vec4));
    values.bindStorage(STORAGE_COUNTERS);
    image.bind(TEXTURE_ROUTED_KEYS);
    gl::dispatch(device().program({"scene/read_samples.comp"}, {{"SAMPLES", std::to_string(samples)}}),
                 {gl::groupsFor(static_cast<size_t>(image.size().x), 8),
                  gl::groupsFor(static_cast<size_t>(image.size().y), 8), 1});
    gl::storageBarrier();
    return values.readValues<glm::vec4>(count);
  }

  // How many samples hold something else than the pixels that they are of.
  static size_t differing(const Sums& pixels, const Sums& samples) {
    const size_t perPixel = samples.size() / pixels.size();
    size_t count = 0;
    for (size_t i = 0; i < samples.size(); ++i) count += samples[i] != pixels[i / perPixel] ? 1 : 0;
    return count;
  }
};

class CoveredMeshes : public CoveringGpu, public testing::WithParamInterface<Mesh> {};

TEST_P(CoveredMeshes, HaveThePixelsOfTheirTriangles) {
  double fragments = 0;
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    const Corners corners = GetParam().make(random);
    for (const glm::ivec2 size : {glm::ivec2(64, 64), glm::ivec2(97, 51)})
      for (const gl::Cull cull : {gl::Cull::None, gl::Cull::Back, gl::Cull::Front}) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << size.x << " x " << size.y << ", cull "
                                        << static_cast<int>(cull));
        const Sums pixels = draw(corners, size, triangles(), cull);
        for (const glm::vec4& pixel : pixels) fragments += pixel.x;
        EXPECT_EQ(differing(pixels, draw(corners, size, covering(), cull)), 0u);
      }
  }
  EXPECT_GT(fragments, 0) << "there is something to compare";
}

INSTANTIATE_TEST_SUITE_P(Meshes, CoveredMeshes,
                         testing::Values(Mesh{"shared", shared}, Mesh{"beyondTheImage", beyondTheImage},
                                         Mesh{"tiny", tiny}, Mesh{"slivers", slivers},
                                         Mesh{"throughTheNearPlane", throughTheNearPlane}, Mesh{"huge", huge},
                                         Mesh{"throughCentres", throughCentres}, Mesh{"ofNoArea", ofNoArea}),
                         [](const auto& info) { return info.param.name; });

TEST_F(CoveringGpu, OtherWaysAreSeenToDiffer) {
  Random random(1);
  const Corners corners = shared(random);
  const Sums pixels = draw(corners, {64, 64}, triangles());
  Way plain = covering();  // samples beside the centre are in other triangles
  plain.rectangles = plain.asking = false;
  EXPECT_GT(differing(pixels, draw(corners, {64, 64}, plain)), 0u);
  Way unasked = covering();
  unasked.asking = false;
  EXPECT_GT(differing(pixels, draw(corners, {64, 64}, unasked)), 0u);
  Way coarser = covering();
  coarser.subpixelBits = 7;
  EXPECT_GT(differing(pixels, draw(corners, {64, 64}, coarser)), 0u);
}

}  // namespace
}  // namespace sfumato::pipelines
