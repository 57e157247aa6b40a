// Surfaces that are there in part and shine: alpha scales all that they reflect, what is mirrored and what is
// left of that to be scattered alike.
#include "pipelines/pipeline_names.h"
#include "pipelines/reference.h"
#include "tests/pipelines/known_scenes.h"
#include "tests/pipelines/pipeline_test.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr int width = 32;
constexpr int height = 24;

// The floor of a wide image, seen and lit 12 degrees above it, from opposite sides.
KnownScene glossyVeil(float alpha) {
  KnownScene known;
  scene::Material material = tests::veil({0.8f, 0.7f, 0.6f}, alpha);
  material.specular = 1;
  material.roughness = 0.9f;
  tests::add(known.scene, tests::quad({-40, 0, 40}, {80, 0, 0}, {0, 0, -80}), material);
  known.scene.cameras = {tests::orthographicCamera({0, 0.2, 1}, {0, 0, 0}, 0.1)};
  known.scene.lights = {tests::directionalLight({0, -0.2, 1}, {10, 8, 6})};
  return known;
}

class GlossyVeils : public PipelineTest, public testing::WithParamInterface<std::string> {
 protected:
  // The largest error of a value, relative to the reference.
  double worst(const KnownScene& known, const Quality& quality) {
    const image::Image image = draw(GetParam(), known, quality, {width, height});
    const image::Image reference =
        renderReference(known.scene, known.scene.cameras[0], known.media, {.width = width, .height = height});
    double worst = 0;
    for (size_t i = 0; i < image.values.size(); ++i)
      worst = std::max(worst, std::abs(double(image.values[i]) / double(reference.values[i]) - 1));
    return worst;
  }
};

TEST_P(GlossyVeils, AreTheReferencesAtGrazingAngles) {
  for (const float alpha : {0.05f, 0.5f, 0.9f, 1.f})
    EXPECT_LT(worst(glossyVeil(alpha), coarse()), 2e-3) << alpha;
}

TEST_P(GlossyVeils, AreTheReferencesInAmbientLight) {
  for (const float alpha : {0.05f, 0.5f, 1.f}) {
    KnownScene known = glossyVeil(alpha);
    known.scene.materials[0].specularColour = glm::vec3(12, 8, 4);
    known.scene.lights.clear();
    known.scene.ambient = {1, 2, 3};
    EXPECT_LT(worst(known, coarse()), 2e-3) << alpha;
  }
}

INSTANTIATE_TEST_SUITE_P(Pipelines, GlossyVeils, testing::ValuesIn(pipelineNames()),
                         [](const auto& info) { return tests::testName(info.param); });

}  // namespace
}  // namespace sfumato::pipelines
