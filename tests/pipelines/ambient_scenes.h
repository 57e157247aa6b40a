// Scenes under ambient light alone, whose answers are known: what a picture filled by them shows everywhere.
#pragma once

#include <vector>

#include "tests/pipelines/known_scenes.h"

namespace sfumato::tests {

struct AmbientScene {
  KnownScene known;
  glm::dvec3 radiance;
};

inline AmbientScene underAmbient(const std::string& name, const scene::Material& material,
                                 const glm::dvec3& ambient, const glm::dvec3& radiance) {
  AmbientScene made{{.name = name}, radiance};
  scene::Scene& scene = made.known.scene;
  add(scene, quad({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), material);
  scene.cameras.push_back(perspectiveCamera({1, 1, 3}, {0, 0, 0}, 0.6));
  scene.ambient = ambient;
  return made;
}

// Numbers that halves hold exactly, so that the GPU's answer is exact as well.
inline std::vector<AmbientScene> ambientScenes() {
  scene::Material glossy;  // white, and reflects 4 %
  glossy.metallic = 0;
  scene::Material gold;
  gold.baseColour = {1, 0.75f, 0.25f, 1};
  scene::Material unlit = lambert({0.5f, 0.25f, 1});
  unlit.unlit = true;
  std::vector<AmbientScene> scenes = {
      underAmbient("whitePlane", lambert({1, 1, 1}), {1, 1, 1}, {1, 1, 1}),
      underAmbient("colouredPlane", lambert({0.5f, 0.25f, 1}), {2, 4, 0.125}, {1, 1, 0.125}),
      underAmbient("whiteGlossyPlane", glossy, {1, 1, 1}, {1, 1, 1}),
      underAmbient("goldPlane", gold, {2, 1, 1}, {2, 0.75, 0.25}),
      underAmbient("veil", veil({1, 0.5f, 0.25f}, 0.5f), {1, 1, 1}, {0.5, 0.25, 0.125}),
      underAmbient("unlitPlane", unlit, {8, 8, 8}, {0.5, 0.25, 1}),
      underAmbient("pane", pane({0.5f, 0.5f, 0.5f}), {8, 8, 8}, {0, 0, 0}),
  };
  // Behind a veil that lets half through: 1/2 of its own, and 1/2 of the wall's.
  AmbientScene veiled =
      underAmbient("veilBeforeWall", veil({1, 0.5f, 0.25f}, 0.5f), {1, 1, 1}, {0.75, 0.5, 0.375});
  add(veiled.known.scene, quad({-8, -8, -1}, {16, 0, 0}, {0, 16, 0}), lambert({0.5f, 0.5f, 0.5f}));
  scenes.push_back(veiled);
  // Smoke takes of it, and scatters none.
  AmbientScene smoky =
      underAmbient("smokeBeforeWall", lambert({1, 1, 1}), {1, 1, 1}, glm::dvec3(std::exp(-2.0)));
  smoky.known.scene.cameras[0] = orthographicCamera({0, 0, 3}, {0, 0, 0}, 1);
  smoky.known.media.push_back(block({-4, -4, 1}, {4, 4, 2}, {4, 4, 16}, 2, {1, 1, 1}, 0));
  scenes.push_back(smoky);
  return scenes;
}

// Known scenes with lights, under ambient light as well.
inline std::vector<KnownScene> ambientAndLights() {
  std::vector<KnownScene> scenes;
  for (KnownScene known : {shinySpheres(), veilsOverWall(), smokeAndGlass(), glassBoxOverFloor()}) {
    known.scene.ambient = {0.5, 0.75, 1};
    scenes.push_back(known);
  }
  return scenes;
}

}  // namespace sfumato::tests
