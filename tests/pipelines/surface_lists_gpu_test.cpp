// The camera's lists of translucent surfaces, node by node against ray-quad intersections on the CPU.
#include "pipelines/surface_lists_gpu.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "scene/camera_view.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/known_scenes.h"

namespace sfumato::pipelines {
namespace {

using glm::dvec3;

constexpr int width = 50;
constexpr int height = 40;

struct Quad {
  dvec3 corner, u, v;
};

// Of the ray through a pixel's centre with the quad: its depth, none when it misses. `nearEdge`: rounding may
// decide.
struct Hit {
  bool hit = false;
  bool nearEdge = false;
  double depth = 0;
};

Hit intersect(const Quad& quad, const dvec3& origin, const dvec3& perDepth) {
  const dvec3 n = glm::cross(quad.u, quad.v);
  const double depth = glm::dot(quad.corner - origin, n) / glm::dot(perDepth, n);
  const dvec3 p = origin + depth * perDepth - quad.corner;
  const double a = glm::dot(glm::cross(p, quad.v), n) / glm::dot(n, n);
  const double b = glm::dot(glm::cross(quad.u, p), n) / glm::dot(n, n);
  const auto inside = [&](double margin) {
    return std::min(a, b) > -margin && std::max(a, b) < 1 + margin && depth > 0.1 - margin;
  };
  return {inside(0), inside(0.02) && !inside(-0.02), depth};
}

class SurfaceListsGpu : public tests::GpuTest {
 protected:
  // Depths of each pixel's list, in list order; pixels row by row from the bottom.
  std::vector<std::vector<float>> build(const scene::Scene& scene, const scene::Camera& camera, int samples) {
    const GeometryGpu geometry(device(), scene);
    gl::Buffer view(device(), "view", sizeof(shared::ViewParams));
    view.writeValue(scene::cameraView(camera, width, height));
    const GBuffer gbuffer = drawGBuffer(device(), {geometry, view, width, height, samples});
    const SurfaceLists built = buildSurfaceLists(device(), {geometry, view, gbuffer, width, height});
    const auto keys = built.lists.readKeys();
    EXPECT_EQ(keys.size(), built.statistics.demand);
    std::vector<std::vector<float>> depths;
    for (const shared::ListRun& run : built.lists.readRuns()) {
      auto& list = depths.emplace_back();
      for (uint32_t i = 0; i < run.count; ++i) list.push_back(keys[run.first + i].depth);
    }
    return depths;
  }
};

TEST_F(SurfaceListsGpu, HoldEveryFragmentBeforeTheOpaqueDepthAndNoOther) {
  base::Random random(11);
  scene::Scene scene;
  std::vector<Quad> quads;
  const auto randomVector = [&](double size) {
    return dvec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
  };
  for (int i = 0; i < 60; ++i) {
    const Quad quad{glm::vec3(randomVector(2)), glm::vec3(randomVector(2)), glm::vec3(randomVector(2))};
    quads.push_back(quad);
    const auto material =
        i % 2 == 0 ? tests::pane({0.5f, 0.6f, 0.7f}) : tests::veil({0.5f, 0.6f, 0.7f}, 0.5f);
    tests::add(scene, tests::quad(quad.corner, quad.u, quad.v), material);
  }
  const Quad wall{{-0.5, -5, -0.3}, {6, 0, 0.4}, {0, 10, 0}};
  tests::add(scene, tests::quad(wall.corner, wall.u, wall.v), tests::lambert({1, 1, 1}));
  scene::Camera camera = tests::perspectiveCamera({0, 0.3, 5}, {0, 0, 0}, 0.7);
  camera.nearDistance = 0.1;
  const auto lists = build(scene, camera, 1);

  const shared::ViewParams view = scene::cameraView(camera, width, height);
  size_t compared = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::dvec2 plane = (glm::dvec2(x + 0.5, y + 0.5) / glm::dvec2(width, height) * 2.0 - 1.0) *
                               glm::dvec2(view.halfExtent);
      const dvec3 perDepth = glm::dmat3(camera.worldFromView) * dvec3(plane, -1.0);
      const dvec3 origin(camera.worldFromView[3]);
      const Hit opaque = intersect(wall, origin, perDepth);
      bool doubtful = opaque.nearEdge;
      std::vector<double> expected;
      for (const Quad& quad : quads) {
        const Hit hit = intersect(quad, origin, perDepth);
        doubtful |= hit.nearEdge || (opaque.hit && std::abs(hit.depth - opaque.depth) < 1e-3);
        if (hit.hit && (!opaque.hit || hit.depth < opaque.depth)) expected.push_back(hit.depth);
      }
      if (doubtful) continue;
      std::sort(expected.begin(), expected.end());
      const auto& found = lists[static_cast<size_t>(y * width + x)];
      ASSERT_EQ(found.size(), expected.size()) << x << ", " << y;
      for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-4 * expected[i]);
      compared += found.size();
    }
  }
  EXPECT_GT(compared, 2000u);
}

TEST_F(SurfaceListsGpu, HoldDeepListsOfEqualDepthsInFull) {
  // 300 layers, three each of one depth.
  scene::Scene scene;
  for (int i = 0; i < 300; ++i) {
    const auto z = static_cast<float>(-(i / 3));
    const float half = 0.6f * (5 - z);  // a little more than the camera sees there
    tests::add(scene, tests::quad({-half, -half, z}, {2 * half, 0, 0}, {0, 2 * half, 0}),
               tests::veil({1, 1, 1}, 0.01f));
  }
  const auto lists = build(scene, tests::perspectiveCamera({0, 0, 5}, {0, 0, 0}, 0.7), 1);
  for (const auto& list : lists) {
    ASSERT_EQ(list.size(), 300u);
    EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
  }
}

}  // namespace
}  // namespace sfumato::pipelines
