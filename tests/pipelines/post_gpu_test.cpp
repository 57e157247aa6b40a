// Post-processing against pictures whose answer is known, and against double-precision oracles.
#include "pipelines/post_gpu.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "tests/gl/test_device.h"

namespace sfumato::pipelines {
namespace {

using image::Image;

constexpr float infinity = std::numeric_limits<float>::infinity();

Image constant(int width, int height, float value) {
  Image image(width, height, 3);
  std::fill(image.values.begin(), image.values.end(), value);
  return image;
}

Image noise(int width, int height, float largest = 4) {
  base::Random random(7);
  Image image(width, height, 3);
  for (float& value : image.values) value = largest * static_cast<float>(std::pow(random.uniform(), 3));
  return image;
}

Image withPixel(int width, int height, int x, int y, float value) {
  Image image(width, height, 3);
  std::fill_n(image.pixel(x, y), 3, value);
  return image;
}

double luminanceOf(const float* rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

// ---- oracles ---------------------------------------------------------------------------------------------

struct Plane {  // one channel in double precision
  int width, height;
  std::vector<double> values;

  Plane(int width, int height)
      : width(width), height(height), values(static_cast<size_t>(width) * static_cast<size_t>(height)) {}
  double& at(int x, int y) { return values[static_cast<size_t>(y * width + x)]; }
  double at(int x, int y) const {
    const bool inside = x >= 0 && y >= 0 && x < width && y < height;
    return inside ? values[static_cast<size_t>(y * width + x)] : 0;
  }
};

// Weight of a texel of the smaller image in a pixel of the larger one, along one side.
double tent(int pixel, int texel, int side) {
  return std::max(0.0, 1 - std::abs((pixel + 0.5) / side - (texel + 0.5)));
}

Plane shrink(const Plane& from, int side) {
  Plane to((from.width + side - 1) / side, (from.height + side - 1) / side);
  for (int v = 0; v < to.height; ++v)
    for (int u = 0; u < to.width; ++u) {
      double sum = 0;
      for (int y = (v - 1) * side; y < (v + 2) * side; ++y)
        for (int x = (u - 1) * side; x < (u + 2) * side; ++x)
          sum += from.at(x, y) * tent(x, u, side) * tent(y, v, side);
      to.at(u, v) = sum / (side * side);
    }
  return to;
}

void addEnlarged(Plane& to, const Plane& from, int side, double strength) {
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x)
      for (int v = y / side - 1; v <= y / side + 1; ++v)
        for (int u = x / side - 1; u <= x / side + 1; ++u)
          to.at(x, y) += strength * from.at(u, v) * tent(x, u, side) * tent(y, v, side);
}

// Two dimensions at once: 13 x 13 texels, sigma 2.5.
Plane blur(const Plane& from) {
  const auto weight = [](int u, int v) { return std::exp(-(u * u + v * v) / (2 * 2.5 * 2.5)); };
  double all = 0;
  for (int v = -6; v <= 6; ++v)
    for (int u = -6; u <= 6; ++u) all += weight(u, v);
  Plane to(from.width, from.height);
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x)
      for (int v = -6; v <= 6; ++v)
        for (int u = -6; u <= 6; ++u) to.at(x, y) += weight(u, v) / all * from.at(x + u, y + v);
  return to;
}

// Of one channel, times what of a pixel glows.
Plane glowing(const Image& image, int channel, const std::function<double(double luminance)>& part) {
  Plane plane(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      plane.at(x, y) = image.pixel(x, y)[channel] * part(luminanceOf(image.pixel(x, y)));
  return plane;
}

void expectChannel(const Image& image, int channel, const Plane& expected, double tolerance) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      ASSERT_NEAR(image.pixel(x, y)[channel], expected.at(x, y), tolerance * (1 + expected.at(x, y)))
          << x << ", " << y;
}

Plane channelOf(const Image& image, int channel) {
  return glowing(image, channel, [](double) { return 1; });
}

class Post : public tests::GpuTest {
 protected:
  Image bloomed(const Image& image, Bloom bloom, double white = 1, double average = 0, double strength = 1) {
    return postProcess(device(), {image, noAovs_, white, average},
                       {.bloom = bloom, .bloomStrength = strength});
  }

 private:
  AovImages noAovs_;
};

// ---- bloom -----------------------------------------------------------------------------------------------

double sumOf(const Image& image) {
  double sum = 0;
  for (size_t i = 0; i < image.values.size(); i += 3) sum += image.values[i];
  return sum;
}

TEST_F(Post, GlowHoldsTheLightThatGlows) {
  // 8 above the average glows; by contrast everything that is brighter than white.
  const Image image = withPixel(96, 80, 45, 37, 10);
  EXPECT_NEAR(sumOf(bloomed(image, Bloom::Mipmap, 1, 2, 0.5)), 10 + 0.5 * 8, 1e-4);
  EXPECT_NEAR(sumOf(bloomed(image, Bloom::Separable, 1, 2, 0.5)), 10 + 0.5 * 10, 1e-4);
  // A pixel of half the luminance of white glows with half its light.
  EXPECT_NEAR(sumOf(bloomed(image, Bloom::Separable, 20, 0, 1)), 10 + 0.5 * 10, 1e-4);
}

TEST_F(Post, GlowStandsAroundTheLightWhereverThatIs) {
  for (const Bloom bloom : {Bloom::Separable, Bloom::Mipmap})
    for (int x = 40; x < 57; ++x) {
      const int y = 112 - x;
      Image glow = bloomed(withPixel(97, 128, x, y, 10), bloom);
      glow.pixel(x, y)[0] -= 10;
      double sum = 0, sumX = 0, sumY = 0;
      for (int v = 0; v < glow.height; ++v)
        for (int u = 0; u < glow.width; ++u) {
          const double value = glow.pixel(u, v)[0];
          sum += value;
          sumX += value * u;
          sumY += value * v;
        }
      EXPECT_NEAR(sumX / sum, x, 1e-3);
      EXPECT_NEAR(sumY / sum, y, 1e-3);
    }
}

TEST_F(Post, GlowIsSymmetric) {
  // By contrast about the pixel, at this size; in all of them when the picture is mirrored.
  const Image separable = bloomed(withPixel(65, 65, 32, 32, 10), Bloom::Separable);
  for (int v = 0; v < 65; ++v)
    for (int u = 0; u < 65; ++u) {
      const float here = separable.pixel(u, v)[0];
      EXPECT_NEAR(here, separable.pixel(64 - u, v)[0], 1e-6 * here);
      EXPECT_NEAR(here, separable.pixel(v, u)[0], 1e-6 * here);
    }
  const Image left = bloomed(withPixel(64, 64, 20, 27, 10), Bloom::Mipmap);
  const Image right = bloomed(withPixel(64, 64, 43, 27, 10), Bloom::Mipmap);
  for (int v = 0; v < 64; ++v)
    for (int u = 0; u < 64; ++u)
      EXPECT_NEAR(left.pixel(u, v)[0], right.pixel(63 - u, v)[0], 1e-6 * left.pixel(u, v)[0])
          << u << " " << v;
}

TEST_F(Post, NothingGlowsThatIsNotBright) {
  const Image image = noise(61, 47, 3);
  EXPECT_EQ(bloomed(image, Bloom::Mipmap, 1, 4).values, image.values);
  EXPECT_NE(bloomed(image, Bloom::Mipmap, 1, 2).values, image.values);
  const Image black = constant(61, 47, 0);
  EXPECT_EQ(bloomed(black, Bloom::Separable).values, black.values);
  EXPECT_EQ(bloomed(black, Bloom::Mipmap).values, black.values);
}

TEST_F(Post, SeparableBloomIsATwoDimensionalConvolution) {
  struct Row {
    int width, height, side;
  };
  for (const Row& row : {Row{61, 47, 1}, Row{38, 300, 2}, Row{29, 461, 3}}) {
    const Image image = noise(row.width, row.height);
    const Image result = bloomed(image, Bloom::Separable, 3, 0, 0.7);
    for (int channel = 0; channel < 3; ++channel) {
      Plane expected = channelOf(image, channel);
      const Plane bright =
          glowing(image, channel, [](double luminance) { return std::min(luminance / 3, 1.); });
      addEnlarged(expected, blur(shrink(bright, row.side)), row.side, 0.7);
      expectChannel(result, channel, expected, 1e-5);
    }
  }
}

TEST_F(Post, MipmapBloomIsTheMeanOfItsLevels) {
  struct Row {
    int width, height, levels;
  };
  for (const Row& row : {Row{64, 64, 3}, Row{61, 47, 2}, Row{33, 15, 1}, Row{5, 131, 4}}) {
    const Image image = noise(row.width, row.height);
    const Image result = bloomed(image, Bloom::Mipmap, 1, 0.8, 0.6);
    for (int channel = 0; channel < 3; ++channel) {
      std::vector<Plane> levels = {glowing(
          image, channel, [](double luminance) { return std::max(luminance - 0.8, 0.) / luminance; })};
      for (int i = 0; i < row.levels; ++i) levels.push_back(shrink(levels.back(), 2));
      for (size_t i = levels.size() - 1; i > 1; --i) addEnlarged(levels[i - 1], levels[i], 2, 1);
      Plane expected = channelOf(image, channel);
      addEnlarged(expected, levels[1], 2, 0.6 / row.levels);
      expectChannel(result, channel, expected, 1e-5);
    }
  }
}

// ---- anti-aliasing ---------------------------------------------------------------------------------------

// Surfaces of an image, by what stands at each pixel.
struct Surface {
  glm::vec3 normal{0, 0, 1};
  float depth = 5;
};

AovImages surfaces(int width, int height, const std::function<Surface(int x, int y)>& at) {
  AovImages aovs = emptyImages({Aov::Depth, Aov::Normal}, width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Surface surface = at(x, y);
      *aovs.at(Aov::Depth).pixel(x, y) = surface.depth;
      std::copy_n(&surface.normal.x, 3, aovs.at(Aov::Normal).pixel(x, y));
    }
  return aovs;
}

class PostEdges : public Post {
 protected:
  Image smoothed(const Image& image, const AovImages& aovs, double white = 1) {
    return postProcess(device(), {image, aovs, white, 0}, {.antiAliasing = AntiAliasing::Edges});
  }
};

// Dark left of x = 20, bright from there on.
Image halves(int width, int height) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 20; x < width; ++x) std::fill_n(image.pixel(x, y), 3, 0.8f);
  return image;
}

TEST_F(PostEdges, AnEvenColourIsKeptAcrossAnyEdge) {
  const AovImages edges = surfaces(40, 30, [](int x, int y) {
    return Surface{x + y > 33 ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0), x > 17 ? 3.f : infinity};
  });
  const Image image = constant(40, 30, 0.7f);
  const Image result = smoothed(image, edges);
  for (const float value : result.values) EXPECT_NEAR(value, 0.7f, 1e-6f);
}

TEST_F(PostEdges, WhatIsNoEdgeOfASurfaceIsKept) {
  const Image image = noise(53, 41);
  // A plane that faces the camera, and floors and walls seen at a slant: 1 / depth is linear.
  for (const glm::vec2 slope :
       {glm::vec2(0), glm::vec2(0.004, 0), glm::vec2(0, 0.004), glm::vec2(-0.002, 0.003)})
    EXPECT_EQ(smoothed(image, surfaces(53, 41,
                                       [&](int x, int y) {
                                         const float near = 0.2f + slope.x * static_cast<float>(x) +
                                                            slope.y * static_cast<float>(y);
                                         return Surface{{0, 0, 1}, 1 / near};
                                       }))
                  .values,
              image.values);
  // The silhouette of a step that is no step: nothing at all.
  EXPECT_EQ(smoothed(image, surfaces(53, 41,
                                     [](int, int) {
                                       return Surface{glm::vec3(0), infinity};
                                     }))
                .values,
            image.values);
}

// What the pixels next to a vertical edge become that the smoothing is full at: of the nine pixels around,
// each side of the edge has weights 2 / 10 and 8 / 10 / 8 a pixel, dimmed as the screen dims it.
double smoothedStep(bool bright) {
  const double own = 2. / 10 + 5. / 10, others = 3. / 10;
  const double weightOfBright = (bright ? own : others) / (1 + 0.8), weightOfDark = bright ? others : own;
  return 0.8 * weightOfBright / (weightOfBright + weightOfDark);
}

void expectStepSmoothedAt20(const Image& result) {
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x) {
      const double expected = x < 19 ? 0 : x == 19 ? smoothedStep(false) : x == 20 ? smoothedStep(true) : 0.8;
      ASSERT_NEAR(result.pixel(x, y)[0], expected, 1e-6) << x << ", " << y;
    }
}

TEST_F(PostEdges, AStepOfNormalsIsSmoothedAlongItAndNowhereElse) {
  expectStepSmoothedAt20(smoothed(halves(40, 30), surfaces(40, 30, [](int x, int) {
                                    return Surface{x < 20 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1), 5};
                                  })));
}

TEST_F(PostEdges, AStepOfDepthIsSmoothedAlongItAndNowhereElse) {
  // Away from the border, where a pixel has all its neighbours.
  expectStepSmoothedAt20(smoothed(halves(40, 30), surfaces(40, 30, [](int x, int) {
                                    return Surface{{0, 0, 1}, x < 20 ? 5.f : 10.f};
                                  })));
}

TEST_F(PostEdges, ASilhouetteIsSmoothed) {
  expectStepSmoothedAt20(smoothed(halves(40, 30), surfaces(40, 30, [](int x, int) {
                                    return x < 20 ? Surface{glm::vec3(0), infinity} : Surface{};
                                  })));
}

TEST_F(PostEdges, WithoutTheEdgeTheStepStays) {
  const Image image = halves(40, 30);
  EXPECT_EQ(smoothed(image, surfaces(40, 30, [](int, int) { return Surface{}; })).values, image.values);
}

TEST_F(PostEdges, ASlightCreaseIsSmoothedALittle) {
  // Normals 8 degrees apart: three of eight neighbours, each 2 - 2 cos, less 0.02.
  const auto normal = [](double degrees) {
    return glm::vec3(std::sin(glm::radians(degrees)), 0, std::cos(glm::radians(degrees)));
  };
  const Image result = smoothed(halves(40, 30), surfaces(40, 30, [&](int x, int) {
                                  return Surface{normal(x < 20 ? 0 : 8), 5};
                                }));
  const double offset = 3 * (2 - 2 * std::cos(glm::radians(8.))) - 0.02;
  // Of ten taps three move towards the edge by the offset, and blend so much of what is behind it.
  const double dark = 1 - 0.3 * offset, bright = 0.3 * offset / (1 + 0.8);
  EXPECT_NEAR(result.pixel(19, 15)[0], 0.8 * bright / (bright + dark), 1e-5);
  EXPECT_EQ(result.pixel(18, 15)[0], 0.f);
}

// ---- both, and odd pictures
// --------------------------------------------------------------------------------

TEST_F(PostEdges, PicturesOfAnySizeAreProcessed) {
  for (const glm::ivec2 size : {glm::ivec2(1), glm::ivec2(2, 1), glm::ivec2(1, 37), glm::ivec2(4097, 3),
                                glm::ivec2(3, 4097), glm::ivec2(63, 65)})
    for (const Bloom bloom : {Bloom::Off, Bloom::Separable, Bloom::Mipmap}) {
      const Image image = noise(size.x, size.y);
      const AovImages aovs = surfaces(size.x, size.y, [](int x, int y) {
        return Surface{(x + y) % 5 == 0 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1),
                       1.f + static_cast<float>(x % 3)};
      });
      const Image result = postProcess(device(), {image, aovs, 1, 0.5}, {bloom, 0.2, AntiAliasing::Edges});
      ASSERT_EQ(result.width, size.x);
      ASSERT_EQ(result.height, size.y);
      for (const float value : result.values) ASSERT_TRUE(value >= 0 && value < 40) << value;
    }
}

TEST_F(Post, WhatIsNoNumberStaysWhereItIs) {
  Image image = constant(64, 64, 0.1f);
  image.pixel(10, 10)[0] = std::nanf("");
  image.pixel(50, 50)[1] = infinity;
  image.pixel(30, 5)[2] = -infinity;
  for (const Bloom bloom : {Bloom::Separable, Bloom::Mipmap}) {
    const Image result = bloomed(image, bloom, 1, 0.2, 0.1);
    EXPECT_LT(result.pixel(10, 10)[0], 1.f);
    EXPECT_GE(result.pixel(50, 50)[1], 65504.f);
    for (const float value : result.values) ASSERT_TRUE(value >= 0 && std::isfinite(value)) << value;
  }
}

TEST_F(Post, GivesItsMemoryBack) {
  const size_t before = device().memory().bytes();
  bloomed(noise(64, 64), Bloom::Mipmap);
  EXPECT_EQ(device().memory().bytes(), before);
  EXPECT_GE(device().memory().peakBytesByLabel().at("post-processed picture"), size_t{64 * 64 * 16});
  EXPECT_GE(device().memory().peakBytesByLabel().at("bloom"), size_t{32 * 32 * 16});
}

TEST_F(Post, SaysThatAPictureIsTooLarge) {
  const int width = device().limits().texture2dSize + 1;
  try {
    bloomed(Image(width, 1, 3), Bloom::Mipmap);
    FAIL() << "a texture of " << width << " texels was made";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.exitCode, base::ExitCode::Memory);
    EXPECT_NE(std::string(error.what()).find("post-processed picture"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace sfumato::pipelines
