// Ambient light in the CPU reference: answers known beforehand.
#include <gtest/gtest.h>

#include "pipelines/reference.h"
#include "tests/pipelines/ambient_scenes.h"

namespace sfumato::pipelines {
namespace {

TEST(Ambient, IsReflectedAsTheSurfaceIsColoured) {
  for (const tests::AmbientScene& of : tests::ambientScenes()) {
    SCOPED_TRACE(of.known.name);
    const image::Image image =
        renderReference(of.known.scene, of.known.scene.cameras[0], of.known.media, {.width = 8, .height = 6});
    for (size_t i = 0; i < image.values.size(); ++i)
      ASSERT_NEAR(image.values[i], of.radiance[static_cast<int>(i % 3)], 1e-6) << i;
  }
}

TEST(Ambient, AddsToLights) {
  tests::KnownScene known = tests::shinySpheres();
  const auto draw = [&] {
    return renderReference(known.scene, known.scene.cameras[0], {}, {.width = 24, .height = 16});
  };
  const image::Image lit = draw();
  known.scene.ambient = {0.5, 0.75, 1};
  const image::Image both = draw();
  known.scene.lights.clear();
  const image::Image ambient = draw();
  for (size_t i = 0; i < both.values.size(); ++i)
    ASSERT_NEAR(both.values[i], lit.values[i] + ambient.values[i], 1e-5f * both.values[i]);
}

}  // namespace
}  // namespace sfumato::pipelines
