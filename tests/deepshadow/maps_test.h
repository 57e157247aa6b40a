// Deep shadow maps that tests build and read back.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "deepshadow/maps_gpu.h"
#include "pipelines/scene_gpu.h"
#include "scene/light_faces.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/known_scenes.h"

namespace sfumato::tests {

// A light's map on the CPU.
struct LightFunction : deepshadow::ReadMap {
  std::vector<deepshadow::FaceProjection> faces;

  // Transmittance of a texel at a depth, by walking its knots in double precision.
  glm::dvec3 transmittance(size_t number, double depth) const {
    const Texel& texel = texels[number];
    if (depth > texel.opaqueDepth) return glm::dvec3(0);
    glm::dvec3 tau(0);
    for (size_t i = texel.firstKnot; i < texel.firstKnot + texel.knots; ++i) {
      const shared::ShadowKnot& knot = knots[i];
      if (knot.depth > depth) {
        if (i == texel.firstKnot) break;
        const shared::ShadowKnot& before = knots[i - 1];
        tau += (depth - before.depth) / (knot.depth - before.depth) *
               (glm::dvec3(knot.tauR, knot.tauG, knot.tauB) - tau);
        break;
      }
      tau = {knot.tauR, knot.tauG, knot.tauB};
    }
    return glm::exp(-tau);
  }
};

class MapsTest : public GpuTest {
 protected:
  // Of what is seen and what casts shadows.
  std::vector<glm::dvec3> hull = {{-4, -1, -4}, {4, 4, 4}, {-4, 4, 4}, {4, -1, -4}, {4, -1, 4}, {-4, 4, -4}};

  LightFunction build(const KnownScene& known, int resolution, double error, double stepVoxels = 0.25) {
    const pipelines::GeometryGpu geometry(device(), known.scene);
    const volumes::VolumesGpu media(device(), known.media);
    const deepshadow::Casters casters = pipelines::castersOf(geometry);
    const deepshadow::Maps maps(device(), {.lights = known.scene.lights,
                                           .casters = casters,
                                           .volumes = media,
                                           .receivers = hull,
                                           .castingPoints = hull,
                                           .plan = {{resolution}, error},
                                           .stepVoxels = stepVoxels});
    statistics_ = maps.lights().front();
    lists_ = maps.lists();
    EXPECT_EQ(maps.cutMarches(), 0u);
    return {maps.read(0), scene::facesOf(known.scene.lights.front(), resolution, hull, hull)};
  }

  deepshadow::LightMap statistics_;  // of the first light
  lists::ListStatistics lists_;
};

}  // namespace sfumato::tests
