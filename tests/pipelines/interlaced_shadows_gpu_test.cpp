// Frames under interlaced shadow maps against the same under deep ones: alike where no light goes through
// more than one translucent surface.
#include "pipelines/pipeline_gpu.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/frame_errors.h"
#include "tests/pipelines/known_scenes.h"

namespace sfumato::pipelines {
namespace {

using glm::dvec3;
using tests::KnownScene;

constexpr int width = 80;
constexpr int height = 60;

// A pane over a floor, and beside it a wall and a ball; or, black, in smoke, which then is all that is seen.
KnownScene paneOverFloor(const scene::Light& light, bool smoke) {
  KnownScene known{"pane over floor", {}, {}};
  scene::Scene& scene = known.scene;
  tests::add(scene, tests::quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), tests::lambert({0.8f, 0.8f, 0.8f}));
  tests::add(scene, tests::quad({-1.2f, 1, 0.9f}, {1.9f, 0.1f, 0.2f}, {0.2f, 0.1f, -1.8f}),
             tests::pane({0.9f, 0.5f, 0.2f}));
  tests::add(scene, tests::quad({1.2f, 0, 0.5f}, {0.3f, 0, -1}, {0, 0.8f, 0}),
             tests::lambert({0.4f, 0.6f, 0.9f}));
  tests::add(scene, tests::sphere(24, 48), tests::lambert({0.9f, 0.9f, 0.9f}),
             glm::dmat4(0.3, 0, 0, 0, 0, 0.3, 0, 0, 0, 0, 0.3, 0, -0.3, 0.31, 0.1, 1));
  if (smoke) {
    for (scene::Material& material : scene.materials)
      if (material.transmission == 0) material.baseColour = {0, 0, 0, 1};
    // So thin that its own shadow, which interlaced maps have not, takes 1 % at the most.
    known.media = {tests::block({-2, 0, -2}, {2, 1.9, 2}, {8, 32, 8}, 0.003, dvec3(1), 0)};
  }
  scene.lights = {light};
  scene.cameras = {tests::perspectiveCamera({0.5, 2.5, 4}, {0, 0.4, 0}, 0.7)};
  return known;
}

class InterlacedShadowsGpu : public tests::GpuTest {
 protected:
  image::Image draw(const KnownScene& known, ShadowKind shadows, Storage storage = Storage::Exact) {
    Quality quality = fine;
    quality.shadowResolution = 512;
    quality.stepVoxels = 2;
    quality.deferred.shadows = shadows;
    quality.deferred.storage = storage;
    return makePipeline("peeling", device(), known.scene, known.media)
        ->render(known.scene.cameras[0], width, height, quality)
        .radiance;
  }
};

TEST_F(InterlacedShadowsGpu, OneTranslucentLayerIsAsUnderDeepMaps) {
  const std::pair<const char*, scene::Light> lights[] = {
      {"sun", tests::directionalLight({0.3, -1, -0.4}, dvec3(3))},
      {"spot", tests::spotLight({-0.5, 5, 1.5}, {0, 0, 0}, dvec3(60), 0.3, 0.5)},
      {"wide spot", tests::spotLight({-0.5, 3, 1.5}, {0, 0, 0}, dvec3(30), 0.9, 1.3)},
      {"point", tests::pointLight({-0.2, 2.2, 0.6}, dvec3(15))}};
  for (const auto& [name, light] : lights) {
    for (const bool smoke : {false, true}) {
      if (smoke && light.type == scene::LightType::Spot) continue;
      const KnownScene known = paneOverFloor(light, smoke);
      const image::Image deep = draw(known, ShadowKind::Deep);
      const PixelErrors found =
          compareFrames(fmt::format("{}, smoke {}", name, smoke), draw(known, ShadowKind::Interlaced), deep);
      // Along edges of shadows: a pane's has half the lines.
      EXPECT_LT(found.failingFraction, 0.015);
      EXPECT_NEAR(found.meanRatio, 1, smoke ? 0.01 : 0.001);
      if (light.type != scene::LightType::Directional) continue;
      // What is not filtered at all, or wholly blocked, is seen.
      EXPECT_GT(errors(draw(known, ShadowKind::Opaque), deep).failingFraction, 0.03);
      EXPECT_GT(errors(draw(known, ShadowKind::None), deep).failingFraction, 0.03);
    }
  }
}

}  // namespace
}  // namespace sfumato::pipelines
