// The reference's answers to what objects say of their shadows and to the thesis's volumes, in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pipelines/reference.h"
#include "tests/pipelines/thesis_scenes.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr double pi = std::numbers::pi;
constexpr int width = 48;
constexpr int height = 36;
constexpr double rounding = 2e-7;  // relative: the picture's floats

image::Image render(const KnownScene& known) {
  return renderReference(known.scene, known.scene.cameras[0], known.media,
                         {.width = width, .height = height, .shadowStepVoxels = 0.05});
}

glm::dvec3 at(const image::Image& image, int x, int y) {
  const float* p = image.pixel(x, y);
  return {p[0], p[1], p[2]};
}

void expectNear(const glm::dvec3& value, const glm::dvec3& expected, double relative) {
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(value[c], expected[c], relative * std::abs(expected[c])) << "channel " << c;
}

// World x and z under a pixel's centre of an orthographic camera that looks down on (x, 0, 0), -z up.
glm::dvec2 under(int px, int py, double yMagnitude, double x = 0) {
  return {x + ((px + 0.5) / width * 2 - 1) * yMagnitude * width / height,
          ((py + 0.5) / height * 2 - 1) * yMagnitude};
}

template <typename Expected>
void expectOnFloor(const KnownScene& known, double relative, const Expected& expected) {
  const image::Image image = render(known);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      SCOPED_TRACE(testing::Message() << known.name << ", pixel " << x << ", " << y);
      const glm::dvec2 p = under(x, y, 1.5);
      expectNear(at(image, x, y), expected(p.x, p.y) * 3.0 / pi, relative);
    }
}

TEST(ThesisFlags, PanesOfOneObjectShadowOnceOfTwoTwice) {
  const glm::dvec3 t(0.5, 0.25, 0.75);
  const auto expected = [&](double x, double z) {
    const bool inside = std::abs(std::abs(x) - 1) < 0.5 && std::abs(z) < 0.5;
    return inside ? (x < 0 ? t : t * t) : glm::dvec3(1);
  };
  expectOnFloor(tests::panesOfOneObjectAndOfTwo(), rounding, expected);
}

TEST(ThesisFlags, WithoutTheFlagEveryPaneCounts) {
  KnownScene known = tests::panesOfOneObjectAndOfTwo();
  for (scene::Material& material : known.scene.materials) material.shadowOnce = false;
  const glm::dvec3 t(0.5, 0.25, 0.75);
  expectOnFloor(known, rounding, [&](double x, double z) {
    return std::abs(std::abs(x) - 1) < 0.5 && std::abs(z) < 0.5 ? t * t : glm::dvec3(1);
  });
}

TEST(ThesisFlags, TheSurfaceThatLightMeetsFirstCounts) {
  expectOnFloor(tests::redPaneOverBluePane(), rounding, [](double x, double z) {
    if (std::abs(z) < 1 && std::abs(x - 0.5) < 1) return glm::dvec3(0.9f, 0.2f, 0.1f);
    if (std::abs(z) < 1 && std::abs(x) < 1) return glm::dvec3(0.2f, 0.3f, 0.9f);
    return glm::dvec3(1);
  });
}

// Between the two panes light has met one of them, above both none: seen as what a white veil there reflects.
TEST(ThesisFlags, APointBetweenTheSurfacesHasTheFirstOneOnly) {
  KnownScene known = tests::panesOfOneObjectAndOfTwo();
  known.scene.instances.erase(known.scene.instances.begin());  // the floor
  tests::add(known.scene, tests::quad({-4, 1.5, 4}, {8, 0, 0}, {0, 0, -8}), tests::lambert({1, 1, 1}));
  known.scene.cameras[0] = tests::orthographicCamera({0, 1.75, 0}, {0, 0, 0}, 1.5, {0, 0, -1});
  const glm::dvec3 t(0.5, 0.25, 0.75);
  expectOnFloor(known, rounding, [&](double x, double z) {
    return std::abs(std::abs(x) - 1) < 0.5 && std::abs(z) < 0.5 ? t : glm::dvec3(1);
  });
}

TEST(ThesisFlags, TheRimOfAGlassBallIsDarkerByTheWayThroughItsShell) {
  const glm::dvec3 t(0.9f, 0.8f, 0.6f);
  for (const float rim : {0.f, 1.f, 2.5f}) {
    const image::Image image = render(tests::glassBall(rim));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double fromAxis = glm::length(under(x, y, 1.5));
        if (std::abs(fromAxis - 1) < 0.1) continue;  // facets: the rim itself is ragged
        const double cosine = std::sqrt(std::max(1 - fromAxis * fromAxis, 0.0));
        const glm::dvec3 shade =
            fromAxis < 1 ? glm::pow(t, glm::dvec3(2 * (1 + rim * (1 / cosine - 1)))) : glm::dvec3(1);
        SCOPED_TRACE(testing::Message() << "rim " << rim << ", " << fromAxis << " from the axis");
        // Facets of 1.9 degrees stand off the ball by 3e-4 of its radius, which moves 1 / cosine by 3e-4 /
        // cosine^3.
        const double moved = 2 * rim * std::abs(std::log(0.6)) * 3e-4 / (cosine * cosine * cosine);
        expectNear(at(image, x, y), shade * 3.0 / pi, rounding + (fromAxis < 1 ? moved : 0));
      }
  }
}

TEST(ThesisFlags, AtGrazingAnglesTheWayThroughAShellEnds) {
  KnownScene known = tests::glassBall(1);
  known.scene.instances.pop_back();
  scene::Material glass = tests::pane({0.9f, 0.9f, 0.9f});
  glass.shadowRim = 1;
  scene::Mesh level = tests::quad({-4, 1, 4}, {8, 0, 0}, {0, 0, -8});
  for (scene::Vertex& vertex : level.vertices) vertex.normal = {1, 0, 0};
  tests::add(known.scene, level, glass);
  expectOnFloor(known, 1e-6, [](double, double) { return glm::dvec3(std::pow(double(0.9f), 20)); });
}

// The light comes at 45 degrees: the wall of 1 m shadows the foot's top, and the floor up to x = 1.
TEST(ThesisFlags, AnLShapeThatDoesNotShadowItselfShadowsTheFloor) {
  for (const bool shadowSelf : {true, false}) {
    const image::Image image = render(tests::lShape(shadowSelf));
    const double lit = 3 * std::sqrt(0.5) / pi;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const glm::dvec2 p = under(x, y, 1.2, 0.25);
        SCOPED_TRACE(testing::Message() << shadowSelf << " at " << p.x << ", " << p.y);
        glm::dvec3 expected(lit);
        if (std::abs(p.y) < 1) {
          if (p.x > -0.2 && p.x < 0) expected = lit * glm::dvec3(0.75, 0.5, 0.25);
          if (p.x > 0 && p.x < 0.5) expected = shadowSelf ? glm::dvec3(0) : lit * glm::dvec3(0.75, 0.5, 0.25);
          if (p.x > 0.5 && p.x < 1) expected = glm::dvec3(0);
        }
        expectNear(at(image, x, y), expected, rounding);
      }
  }
}

// Figure 3.2 b: three steps of 0.4, 0.8 and 1.2 m of smoke over the floor, lit from above.
TEST(ThesisVolumes, AStaircaseOfSmokeThrowsThreeShadows) {
  KnownScene known = tests::staircase();
  known.scene.cameras[0] = tests::orthographicCamera({0, 0.25, 0}, {0, 0, 0}, 1.5, {0, 0, -1});
  const image::Image image = render(known);
  int compared = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec2 p = under(x, y, 1.5);
      const double fromEdge = std::abs(std::remainder(p.x + 0.9, 0.6));
      if (std::abs(p.y) > 0.45 || std::abs(p.x) > 0.85 || fromEdge < 0.06) continue;
      const double depth = 0.4 * (std::floor((p.x + 0.9) / 0.6) + 1);
      expectNear(at(image, x, y), glm::dvec3(0.8f) * 3.0 / pi * std::exp(-1.2 * depth), 2e-3);
      ++compared;
    }
  EXPECT_GT(compared, 100);
}

// Figure 3.2 a: the depth of a cube on its edge falls linearly from its diagonal to nothing.
TEST(ThesisVolumes, ACubeOnItsEdgeThrowsAGradient) {
  KnownScene known = tests::rotatedCube();
  known.scene.cameras[0] = tests::orthographicCamera({0, 0.2, 0}, {0, 0, 0}, 1.5, {0, 0, -1});
  const image::Image image = render(known);
  const double half = 0.6 * std::sqrt(2.0);
  for (int x = 0; x < width; ++x) {
    const double px = under(x, height / 2, 1.5).x;
    const double depth = 2 * std::max(half - std::abs(px), 0.0);
    if (std::abs(std::abs(px) - half) < 0.1 || std::abs(px) < 0.1) continue;  // the voxels' ramps
    expectNear(at(image, x, height / 2), glm::dvec3(0.8f) * 3.0 / pi * std::exp(-1.5 * depth), 5e-3);
  }
}

}  // namespace
}  // namespace sfumato::pipelines
