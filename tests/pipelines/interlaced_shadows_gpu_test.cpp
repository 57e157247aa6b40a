// Frames under interlaced shadow maps against the same under deep ones: alike where no light goes through
// more than one translucent surface.
#include "base/error.h"
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

// All types of lights, in maps of a few sizes.
KnownScene manyLights() {
  KnownScene known = paneOverFloor(tests::directionalLight({0.3, -1, -0.4}, dvec3(1)), false);
  known.scene.lights.push_back(tests::spotLight({-0.5, 5, 1.5}, {0, 0, 0}, dvec3(20), 0.3, 0.5));
  known.scene.lights.push_back(tests::spotLight({-0.5, 3, 1.5}, {0, 0, 0}, dvec3(10), 0.9, 1.3));
  known.scene.lights.push_back(tests::pointLight({-0.2, 2.2, 0.6}, dvec3(5)));
  return known;
}

class InterlacedShadowMemoryGpu : public tests::GpuTest {
 protected:
  struct Drawn {
    image::Image radiance;
    ShadowFigures maps;
    size_t measured = 0;  // by the memory ledger, at the peak
  };

  // With as much memory for the maps; 0: no budget.
  Drawn draw(const std::string& pipeline, ShadowKind shadows, size_t memory, bool exact = false) {
    Quality quality = fine;
    quality.shadowResolution = resolution_;
    quality.exactShadowResolution = exact;
    quality.deferred.shadows = shadows;
    quality.shadowMemory = memory;
    device().memory().restartPeaks();
    const Frame frame = makePipeline(pipeline, device(), known_.scene, known_.media)
                            ->render(known_.scene.cameras[0], width, height, quality);
    Drawn drawn{frame.radiance, frame.statistics.shadowMaps, 0};
    const auto& peaks = device().memory().peakBytesByLabel();
    for (const char* label :
         {"interlaced shadow depths", "interlaced shadow colours", "interlaced shadow depth test"})
      if (peaks.contains(label)) drawn.measured += peaks.at(label);
    return drawn;
  }

  KnownScene known_ = manyLights();
  int resolution_ = 2048;
};

TEST_F(InterlacedShadowMemoryGpu, AllMapsKeepToOneBudget) {
  const image::Image deep = draw("peeling", ShadowKind::Deep, 0).radiance;
  for (const ShadowKind kind : {ShadowKind::Interlaced, ShadowKind::Opaque}) {
    SCOPED_TRACE(shadowKinds().nameOf(kind));
    const Drawn whole = draw("peeling", kind, 0);
    EXPECT_FALSE(whole.maps.lowered);
    EXPECT_EQ(whole.maps.bytes, whole.measured);
    const Drawn fitted = draw("peeling", kind, whole.measured / 4);
    EXPECT_TRUE(fitted.maps.lowered);
    EXPECT_EQ(fitted.maps.budgetBytes, whole.measured / 4);
    EXPECT_EQ(fitted.maps.bytes, fitted.measured);
    EXPECT_LE(fitted.measured, whole.measured / 4);
    EXPECT_GT(fitted.measured, whole.measured / 12);  // and not by giving up more than it must
    for (size_t i = 0; i < known_.scene.lights.size(); ++i) {
      EXPECT_LT(fitted.maps.resolutions[i], whole.maps.resolutions[i]) << i;
      EXPECT_GT(fitted.maps.resolutions[i], 0) << i;
    }
    if (kind == ShadowKind::Opaque) continue;
    // The same shadows with wider edges: about as where half the resolution is asked for. Without any, the
    // picture is another one.
    resolution_ /= 2;
    const PixelErrors half = compareFrames("half resolution", draw("peeling", kind, 0).radiance, deep);
    resolution_ *= 2;
    const PixelErrors found = compareFrames("a quarter of the memory", fitted.radiance, deep);
    EXPECT_LT(found.failingFraction, 1.5 * half.failingFraction);
    EXPECT_NEAR(found.meanRatio, 1, 0.005);
    EXPECT_GT(errors(draw("peeling", ShadowKind::None, 0).radiance, deep).failingFraction, 0.2);
  }
}

TEST_F(InterlacedShadowMemoryGpu, LightsThatTakeTurnsHaveItOneByOne) {
  const Drawn together = draw("peeling", ShadowKind::Interlaced, 0);
  const Drawn inTurns = draw("interlaced", ShadowKind::Interlaced, 0);
  EXPECT_EQ(inTurns.maps.bytes, inTurns.measured);
  EXPECT_LT(inTurns.measured, together.measured);
  const Drawn fitting = draw("interlaced", ShadowKind::Interlaced, inTurns.measured);
  EXPECT_FALSE(fitting.maps.lowered);
  EXPECT_EQ(fitting.maps.resolutions, together.maps.resolutions);
  EXPECT_EQ(fitting.radiance.values, inTurns.radiance.values);
  const Drawn fitted = draw("interlaced", ShadowKind::Interlaced, inTurns.measured - 1);
  EXPECT_TRUE(fitted.maps.lowered);
  EXPECT_EQ(fitted.maps.bytes, fitted.measured);
  EXPECT_LT(fitted.measured, inTurns.measured);
  EXPECT_TRUE(draw("peeling", ShadowKind::Interlaced, inTurns.measured).maps.lowered);
}

TEST_F(InterlacedShadowMemoryGpu, SaysWhatTheyTakeWhereNothingFits) {
  const auto expectTooLittle = [&](const std::string& pipeline, size_t memory, bool exact) {
    try {
      draw(pipeline, ShadowKind::Interlaced, memory, exact);
      ADD_FAILURE() << "no error";
    } catch (const base::Error& error) {
      EXPECT_EQ(error.exitCode, base::ExitCode::Memory);
      EXPECT_NE(std::string(error.what()).find("interlaced shadow maps: take "), std::string::npos)
          << error.what();
    }
  };
  const size_t measured = draw("interlaced", ShadowKind::Interlaced, 0, true).measured;
  expectTooLittle("interlaced", measured - 1, true);
  draw("interlaced", ShadowKind::Interlaced, measured, true);
  // The least maps: two faces of 32 x 32 texels, and two cubes of 16 x 16; of 12 bytes each.
  constexpr size_t least = 32 * (2 * 32 + 2 * 6 * 16) * 12;
  draw("peeling", ShadowKind::Interlaced, least);
  expectTooLittle("peeling", least - 1, false);
  expectTooLittle("interlaced", 32 * 6 * 16 * 12 - 1, false);
}

}  // namespace
}  // namespace sfumato::pipelines
