// Ambient occlusion: what must not be occluded at all, what must be and by how much, and what the blur may
// not do. In white scenes under an ambient light of 1 the picture is the accessibility itself.
#include "pipelines/ambient_occlusion_gpu.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <span>

#include "base/random.h"
#include "pipelines/gbuffer_gpu.h"
#include "pipelines/linked_lists_gpu.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/frame_errors.h"
#include "tests/pipelines/known_scenes.h"

namespace sfumato::pipelines {
namespace {

using scene::Camera;
using scene::Scene;
using tests::add;
using tests::quad;

constexpr int width = 160;
constexpr int height = 120;
const scene::Material white = tests::lambert(glm::vec3(1));

const OcclusionSize sizes[] = {OcclusionSize::Full, OcclusionSize::Half, OcclusionSize::Quarter};

Scene whiteScene(const Camera& camera) {
  Scene scene;
  scene.ambient = glm::dvec3(1);
  scene.cameras.push_back(camera);
  return scene;
}

// The floor y = 0 and the wall z = 0 behind it.
Scene cornerScene(const Camera& camera) {
  Scene scene = whiteScene(camera);
  add(scene, quad({-9, 0, 0}, {0, 0, 9}, {18, 0, 0}), white);
  add(scene, quad({-9, 0, 0}, {18, 0, 0}, {0, 9, 0}), white);
  return scene;
}

class AmbientOcclusionGpu : public tests::GpuTest {
 protected:
  image::Image draw(const Scene& scene, const AmbientOcclusionOptions& options, int samples = 1,
                    glm::ivec2 size = {width, height}, const FrameOptions& frame = {}) {
    LinkedListsPipeline pipeline(device(), scene, {});
    Quality quality = fine;
    quality.samples = samples;
    quality.ambientOcclusion = options;
    return pipeline.render(scene.cameras[0], size.x, size.y, quality, frame).radiance;
  }

  // One for each pixel, rows from the bottom.
  std::vector<float> occlusions(const Scene& scene, double radius, bool gaussian) {
    const SceneGpu uploaded(device(), scene, {});
    const FrameView view = viewOf(scene, scene.cameras[0], width, height);
    shared::ViewParams params = view.params;
    params.tile = params.window = {0, 0, width, height};
    gl::Buffer block(device(), "view", sizeof params);
    block.writeValue(params);
    const GBuffer gbuffer = drawGBuffer(
        device(), {.geometry = uploaded.geometry(), .view = block, .width = width, .height = height});
    const AmbientOcclusion drawn = drawAmbientOcclusion(device(), {gbuffer.depth,
                                                                   gbuffer.surface0,
                                                                   block,
                                                                   width,
                                                                   height,
                                                                   {OcclusionSize::Full, radius},
                                                                   gaussian ? 1e6 : 0.02,
                                                                   gaussian ? 1e6 : 0.3});
    std::vector<glm::uvec4> texels(width * height);
    drawn.occlusion.read(std::as_writable_bytes(std::span(texels)));
    std::vector<float> result;
    for (const glm::uvec4& texel : texels) result.push_back(std::bit_cast<float>(texel.x));
    return result;
  }
};

TEST_F(AmbientOcclusionGpu, TakesNothingFromAPlane) {
  for (const bool orthographic : {false, true})
    for (const glm::dvec3 eye : {glm::dvec3(0, 3, 0.01), {1, 2, 3}, {3, 0.5, 1}, {4, 0.1, 0}}) {
      Scene scene = whiteScene(orthographic ? tests::orthographicCamera(10.0 * eye, {0, 0, 0}, 0.8)
                                            : tests::perspectiveCamera(eye, {0, 0, 0}, 0.7));
      add(scene, quad({-500, 0, -500}, {0, 0, 1000}, {1000, 0, 0}), white);
      for (const OcclusionSize size : sizes)
        for (const double radius : {0.02, 1.0, 50.0}) {
          const image::Image image = draw(scene, {size, radius});
          for (const float value : image.values)
            ASSERT_TRUE(value == 1.f || value == 0.f)  // 0: above the horizon
                << value << " at radius " << radius << ", eye " << eye.x << " " << eye.y << " " << eye.z;
          EXPECT_EQ(*image.pixel(width / 2, height - 1), 1.f);
        }
    }
}

TEST_F(AmbientOcclusionGpu, TakesNothingFromABall) {
  // It is convex, and so are its facets.
  Scene scene = whiteScene(tests::perspectiveCamera({0, 1, 4}, {0, 0, 0}, 0.6));
  add(scene, tests::sphere(12, 24), white);
  for (const OcclusionSize size : sizes)
    for (const float value : draw(scene, {size, 0.7}).values)
      ASSERT_TRUE(value == 1.f || value == 0.f) << value;
}

TEST_F(AmbientOcclusionGpu, OfWhatIsFartherThanTheRadiusIsNothing) {
  // A card a metre before a wall: no halo around it. With a larger radius there is one.
  Scene scene = whiteScene(tests::perspectiveCamera({0, 0, 5}, {0, 0, 0}, 0.6));
  add(scene, quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), white);
  add(scene, quad({-0.5, -0.5, 1}, {1, 0, 0}, {0, 1, 0}), white);
  for (const int samples : {1, 4})
    for (const OcclusionSize size : sizes)
      for (const float value : draw(scene, {size, 0.9}, samples).values) ASSERT_EQ(value, 1.f);
  const image::Image close = draw(scene, {OcclusionSize::Full, 2});
  EXPECT_LT(*std::ranges::min_element(close.values), 0.97f);
}

// Of a point of the corner's floor or wall, by its definition: the mean over points of the ball, on the side
// that the surface faces, of what hides them from the camera, in double precision and with the surfaces as
// formulas.
double accessibilityInCorner(const Camera& camera, const glm::dvec3& p, const glm::dvec3& normal,
                             double radius) {
  const glm::dvec3 forward = -glm::dvec3(camera.worldFromView[2]);
  const glm::dvec3 eye(camera.worldFromView[3]);
  base::Random random(1);
  constexpr int count = 10000;
  const auto weightAt = [](double d) { return std::max(1 - std::pow(d, 4), 0.0) / (1 + d * d); };
  double occlusion = 0;
  double most = 0;
  for (int i = 0; i < count;) {
    glm::dvec3 offset(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (glm::length(offset) > 1) continue;
    ++i;
    const double length = random.uniform();
    offset *= length / glm::length(offset);
    most += weightAt(length);
    if (glm::dot(offset, normal) < 0) offset = -offset;
    const glm::dvec3 q = p + radius * offset;
    // The ray of the camera through q meets the floor or the wall first.
    const glm::dvec3 direction = camera.orthographic ? forward : q - eye;
    const glm::dvec3 start = camera.orthographic ? q - 100.0 * forward : eye;
    double t = scene::infinity;
    if (direction.y < 0) t = std::min(t, -start.y / direction.y);
    if (direction.z < 0) t = std::min(t, -start.z / direction.z);
    const glm::dvec3 seen = start + t * direction;
    if (!(glm::dot(seen, forward) < glm::dot(q, forward)) || glm::dot(seen - p, normal) <= 1e-9) continue;
    occlusion += weightAt(glm::length(seen - p) / radius);
  }
  return 1 - occlusion / most;
}

TEST_F(AmbientOcclusionGpu, OfACornerIsThatOfItsDefinition) {
  for (const bool orthographic : {false, true}) {
    const glm::dvec3 eye(0, 4, 5);
    const Scene scene = cornerScene(orthographic ? tests::orthographicCamera(eye, {0, 0, 0}, 2)
                                                 : tests::perspectiveCamera(eye, {0, 0, 0}, 0.6));
    const Camera& camera = scene.cameras[0];
    const double radius = 1;
    for (const OcclusionSize size : sizes) {
      const image::Image image = draw(scene, {size, radius});
      double worst = 0;
      double darkest = 1;
      for (int y = 0; y < height; ++y) {
        // The mean of a row, which has the same distance to the edge everywhere, has little of the noise
        // left.
        double mean = 0;
        for (int x = width / 4; x < width * 3 / 4; ++x) mean += *image.pixel(x, y) / (width / 2.0);
        const double up = 1 - (y + 0.5) / height * 2;
        const glm::dvec3 view = orthographic ? glm::dvec3(0, 0, -1) : glm::dvec3(0, up * std::tan(0.3), -1);
        const glm::dvec3 direction = glm::dmat3(camera.worldFromView) * view;
        const glm::dvec3 start = eye + (orthographic ? up * 2 : 0.0) * glm::dvec3(camera.worldFromView[1]);
        const double toFloor = -start.y / direction.y;
        const double toWall = -start.z / direction.z;
        const bool onFloor = toFloor < toWall;
        const glm::dvec3 p = start + std::min(toFloor, toWall) * direction;
        const double edge = onFloor ? p.z : p.y;
        if (edge < 0.1) continue;  // the blur spans the edge itself
        const double known =
            accessibilityInCorner(camera, p, onFloor ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1), radius);
        worst = std::max(worst, std::abs(mean - known));
        darkest = std::min(darkest, mean);
        if (edge > 2.5) {
          EXPECT_NEAR(mean, 1, 1e-12) << y;
        }
      }
      fmt::print("{}, {}: off by {:.4f} at most, darkest {:.3f}\n",
                 orthographic ? "orthographic" : "perspective", occlusionSizes().nameOf(size), worst,
                 darkest);
      EXPECT_LT(worst, 0.06);
      EXPECT_LT(darkest, 0.8);
    }
  }
}

TEST_F(AmbientOcclusionGpu, DarkensWhereABallTouchesTheFloor) {
  Scene scene = whiteScene(tests::perspectiveCamera({0, 2, 6}, {0, 0.5, 0}, 0.7));
  add(scene, quad({-9, 0, -9}, {0, 0, 18}, {18, 0, 0}), white);
  add(scene, tests::sphere(24, 48), white, glm::translate(glm::dmat4(1), {0, 1, 0}));
  for (const OcclusionSize size : sizes) {
    const image::Image image = draw(scene, {size, 0.8});
    const auto on = [&](double x, double z) {  // of the floor
      const glm::dvec4 p = glm::inverse(scene.cameras[0].worldFromView) * glm::dvec4(x, 0, z, 1);
      const glm::dvec2 plane = glm::dvec2(p) / -p.z / std::tan(0.35);
      return *image.pixel(static_cast<int>((plane.x * height / width * 0.5 + 0.5) * width),
                          static_cast<int>((0.5 - plane.y * 0.5) * height));
    };
    EXPECT_LT(on(0, 0.35), 0.75f);
    EXPECT_GT(on(0, 1.3), on(0, 0.35) + 0.1f);
    EXPECT_EQ(on(2.75, 0), 1.f);
    EXPECT_EQ(on(-2.75, 0), 1.f);
  }
}

// A card with a groove, occluded by its own sides, that ends at x = 0; far behind it a wall.
Scene grooveBeforeWall() {
  Scene scene = whiteScene(tests::orthographicCamera({0, 0, 5}, {0, 0, 0}, 1));
  add(scene, quad({-3, -2, 0}, {2.5, 0, 0}, {0, 4, 0}), white);
  add(scene, quad({-0.5, -2, 0}, {0.25, 0, -0.25}, {0, 4, 0}), white);
  add(scene, quad({-0.25, -2, -0.25}, {0.25, 0, 0.25}, {0, 4, 0}), white);
  add(scene, quad({-9, -9, -9}, {18, 0, 0}, {0, 18, 0}), white);
  return scene;
}

TEST_F(AmbientOcclusionGpu, IsNotBlurredAcrossDepths) {
  const Scene scene = grooveBeforeWall();
  const auto atWall = [&](bool gaussian) {  // most of the occlusion beside the groove
    const std::vector<float> found = occlusions(scene, 0.4, gaussian);
    double most = 0;
    for (int y = 0; y < height; ++y)
      for (int x = width / 2; x < width; ++x)
        most = std::max<double>(most, found[static_cast<size_t>(y * width + x)]);
    return most;
  };
  EXPECT_EQ(atWall(false), 0);
  EXPECT_GT(atWall(true), 0.02);
  for (const OcclusionSize size : sizes) {
    const image::Image image = draw(scene, {size, 0.4}, 4);
    for (int y = 0; y < height; ++y) {
      for (int x = width / 2; x < width; ++x)
        ASSERT_NEAR(*image.pixel(x, y), 1, 1e-5) << occlusionSizes().nameOf(size);
      ASSERT_LT(*image.pixel(width / 2 - 15, y), 0.9f);  // the groove itself
    }
  }
}

TEST_F(AmbientOcclusionGpu, IsSmooth) {
  // Along the corner nothing changes but the random directions.
  const Scene scene = cornerScene(tests::perspectiveCamera({0, 4, 5}, {0, 0, 0}, 0.6));
  for (const OcclusionSize size : sizes) {
    const image::Image image = draw(scene, {size, 1});
    for (int y = 0; y < height; y += 6) {
      double least = 1;
      double most = 0;
      for (int x = width / 4; x < width * 3 / 4; ++x) {
        least = std::min<double>(least, *image.pixel(x, y));
        most = std::max<double>(most, *image.pixel(x, y));
      }
      EXPECT_LT(most - least, 0.12) << occlusionSizes().nameOf(size) << " " << y;
    }
  }
}

TEST_F(AmbientOcclusionGpu, TakesAmbientLightOnly) {
  tests::KnownScene known = tests::shinySpheres();
  const auto drawn = [&](const AmbientOcclusionOptions& options) { return draw(known.scene, options); };
  const image::Image lit = drawn({});
  EXPECT_EQ(drawn({OcclusionSize::Full, 1}).values, lit.values);
  known.scene.ambient = glm::dvec3(0.5);
  const image::Image open = drawn({});
  const image::Image occluded = drawn({OcclusionSize::Full, 1});
  size_t darker = 0;
  for (size_t i = 0; i < lit.values.size(); ++i) {
    ASSERT_LE(occluded.values[i], open.values[i] * 1.00001f);
    ASSERT_GE(occluded.values[i], lit.values[i] * 0.99999f);
    if (occluded.values[i] < open.values[i] - 0.02f) ++darker;
  }
  EXPECT_GT(darker, lit.values.size() / 50);
}

TEST_F(AmbientOcclusionGpu, LeavesTranslucentSurfacesAlone) {
  Scene scene = whiteScene(tests::perspectiveCamera({0, 4, 5}, {0, 0, 0}, 0.6));
  add(scene, quad({-9, 0, 0}, {0, 0, 9}, {18, 0, 0}), tests::veil(glm::vec3(1), 0.5f));
  add(scene, quad({-9, 0, 0}, {18, 0, 0}, {0, 9, 0}), white);
  const image::Image image = draw(scene, {OcclusionSize::Full, 1});
  EXPECT_EQ(*image.pixel(width / 2, height - 2), 0.5f);
  for (const float value : image.values) ASSERT_GE(value, 0.5f);
}

TEST_F(AmbientOcclusionGpu, WorksAtAnySize) {
  const Scene scene = cornerScene(tests::perspectiveCamera({0, 4, 5}, {0, 0, 0}, 0.6));
  for (const OcclusionSize size : sizes)
    for (const glm::ivec2 pixels : {glm::ivec2(1, 1), {4097, 3}, {3, 517}, {65, 37}, {2, 2}}) {
      for (const float value : draw(scene, {size, 1}, 1, pixels).values)
        ASSERT_TRUE(value == 0.f || (value > 0.3f && value <= 1.f)) << value;
    }
}

TEST_F(AmbientOcclusionGpu, IsTheSameEveryTimeAndInTiles) {
  const Scene scene = cornerScene(tests::perspectiveCamera({2, 4, 5}, {0, 0, 0}, 0.6));
  const auto drawn = [&](const FrameOptions& options) {
    return draw(scene, {OcclusionSize::Half, 1}, 4, {width, height}, options);
  };
  const image::Image first = drawn({});
  EXPECT_EQ(drawn({}).values, first.values);
  EXPECT_EQ(drawn({.windowPixels = 900}).values, first.values);
  // A tile's rasteriser rounds otherwise, see TilesAreSeenNowhere.
  EXPECT_LE(image::pixelsBeyond(drawn({.tilePixels = 900}), first, 1e-3), 4u);
}

TEST(AmbientOcclusion, HasARadiusOfTheScenesSize) {
  Scene scene;
  EXPECT_EQ(usualOcclusionRadius(scene), 1);
  add(scene, tests::box({0, 0, 0}, {2, 3, 6}), white);
  EXPECT_NEAR(usualOcclusionRadius(scene), 0.7, 1e-6);
  add(scene, quad({-500, 0, -500}, {0, 0, 1000}, {1000, 0, 0}), white);
  add(scene, tests::box({0, 0, 0}, {1, 2, 2}), white);
  EXPECT_NEAR(usualOcclusionRadius(scene), 0.7, 1e-6);
}

}  // namespace
}  // namespace sfumato::pipelines
