// Tiny scenes as plain values, to be drawn by any pipeline: the parts they are built of, and whole scenes, of
// which most have an answer in closed form (reference_test.cpp derives them).
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "volumes/grid.h"

namespace sfumato::tests {

// The camera to look through is scene.cameras[0].
struct KnownScene {
  std::string name;
  scene::Scene scene;
  std::vector<volumes::Medium> media;
};

// Materials without a specular lobe.
scene::Material lambert(const glm::vec3& colour);            // opaque, both sides
scene::Material pane(const glm::vec3& colour);               // transmission 1: t = colour, reflects nothing
scene::Material veil(const glm::vec3& colour, float alpha);  // BLEND
scene::Material cutOut(const glm::vec3& colour, float alpha, float cutoff);  // MASK
scene::Material glowing(const glm::vec3& radiance);                          // black, emits

// Adds a mesh under one material and stands it in the world; gives the index of the instance.
int add(scene::Scene& scene, scene::Mesh mesh, const scene::Material& material,
        const glm::dmat4& worldFromObject = glm::dmat4(1.0));

// A parallelogram of two triangles, seen from where u × v points to; uv0 runs along u and v.
scene::Mesh quad(const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v);
// The same in n × n quads, with shared vertices.
scene::Mesh tiledQuad(const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v, int n);
// A box whose faces are seen from outside.
scene::Mesh box(const glm::vec3& low, const glm::vec3& high);
// A unit sphere about the origin, smooth normals, seen from outside.
scene::Mesh sphere(int rings, int sectors);

// `direction` need not be of unit length.
scene::Light directionalLight(const glm::dvec3& direction, const glm::dvec3& irradiance);
scene::Light pointLight(const glm::dvec3& position, const glm::dvec3& intensity);
scene::Light spotLight(const glm::dvec3& position, const glm::dvec3& target, const glm::dvec3& intensity,
                       double innerCone, double outerCone);

// At `eye`, looking at `target`; `up` must not be parallel to that.
scene::Camera orthographicCamera(const glm::dvec3& eye, const glm::dvec3& target, double yMagnitude,
                                 const glm::dvec3& up = {0, 1, 0});
scene::Camera perspectiveCamera(const glm::dvec3& eye, const glm::dvec3& target, double yfov,
                                const glm::dvec3& up = {0, 1, 0});

// A block of density 1, `voxels` along each axis inside a margin of zero: along an axis its optical depth is
// that of the sharp box low…high, since the ramps of one voxel at both faces add what they take.
volumes::Medium block(const glm::dvec3& low, const glm::dvec3& high, const glm::ivec3& voxels, double sigmaT,
                      const glm::dvec3& albedo, double g);
// A ball of density that falls smoothly from 1 at its centre to 0 at its radius; n voxels across.
volumes::Medium ball(const glm::dvec3& centre, double radius, int n, double sigmaT, const glm::dvec3& albedo,
                     double g);

KnownScene planeUnderPointLight();  // Lambert plane y = 0, point light 2 m over the origin, seen from above
KnownScene planeUnderSpotLight();   // the same under a spot, 0.3 and 0.5 rad, straight down
KnownScene crossedPanes();          // a red and a blue pane over a white floor, overlapping in the middle
KnownScene paneBeforeSmoke();       // a pane, then a block of smoke lit from the side, then a glowing wall
KnownScene smokeBeforePane();       // the block, then the pane, then the wall
KnownScene smokeOverFloor();        // a slanting sun through a wide slab of smoke onto a floor
KnownScene glassBoxOverFloor();     // a closed box of glass between the sun and a floor
KnownScene veilsOverWall();         // two BLEND layers before an opaque wall, all lit from the front
KnownScene shinySpheres();          // a metal and a dielectric sphere on a floor under two lights
KnownScene smokeAndGlass();         // a bit of everything: spot, point and sun, panes, boxes, two media

std::vector<KnownScene> knownScenes();  // all of the above

std::vector<std::string> namesOf(const std::vector<KnownScene>& scenes);
// Throws std::out_of_range where there is none of that name.
KnownScene named(const std::vector<KnownScene>& scenes, const std::string& name);
// As GoogleTest takes it: letters, digits and underscores only.
std::string testName(std::string sceneName);

}  // namespace sfumato::tests
