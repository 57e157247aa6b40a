#include "tests/pipelines/known_scenes.h"

#include <cctype>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sfumato::tests {

using scene::AlphaMode;
using scene::Camera;
using scene::Light;
using scene::LightType;
using scene::Material;
using scene::Mesh;
using scene::Scene;
using scene::Vertex;
using volumes::Medium;

namespace {

Vertex vertex(const glm::vec3& position, const glm::vec3& normal) {
  Vertex v;
  v.position = position;
  v.normal = normal;
  return v;
}

Camera cameraAt(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up) {
  const glm::dvec3 back = glm::normalize(eye - target);
  const glm::dvec3 right = glm::normalize(glm::cross(up, back));
  Camera camera;
  camera.worldFromView = glm::dmat4(glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0),
                                    glm::dvec4(back, 0), glm::dvec4(eye, 1));
  return camera;
}

// The margin is the outermost layer of voxels; density(p) is asked for the others, p in (0, 1) per axis.
template <typename Density>
Medium voxelise(const glm::dvec3& low, const glm::dvec3& high, const glm::ivec3& voxels, Density density) {
  Medium medium;
  volumes::DensityGrid& grid = medium.grid;
  grid.size = voxels + 2;
  grid.values.assign(static_cast<size_t>(grid.size.x) * grid.size.y * grid.size.z, 0.f);
  for (int z = 0; z < voxels.z; ++z)
    for (int y = 0; y < voxels.y; ++y)
      for (int x = 0; x < voxels.x; ++x)
        grid.values[grid.valueIndex(x + 1, y + 1, z + 1)] =
            static_cast<float>(density((glm::dvec3(x, y, z) + 0.5) / glm::dvec3(voxels)));
  const glm::dvec3 step = (high - low) / glm::dvec3(voxels);
  const glm::dvec3 first = low - 0.5 * step;  // the margin's centre
  medium.worldFromIndex =
      glm::dmat4(step.x, 0, 0, 0, 0, step.y, 0, 0, 0, 0, step.z, 0, first.x, first.y, first.z, 1);
  grid.worldFromIndex = medium.worldFromIndex;
  return medium;
}

Medium withOptics(Medium medium, double sigmaT, const glm::dvec3& albedo, double g) {
  medium.scale = sigmaT;
  medium.albedo = albedo;
  medium.g = g;
  return medium;
}

KnownScene paneAndSmoke(double paneZ) {
  KnownScene known;
  Scene& scene = known.scene;
  add(scene, quad({-4, -4, -2}, {8, 0, 0}, {0, 8, 0}), glowing({0.5f, 1, 2}));
  add(scene, quad({-4, -4, paneZ}, {8, 0, 0}, {0, 8, 0}), pane({0.75f, 0.5f, 0.25f}));
  known.media.push_back(block({-4, -4, -0.5}, {4, 4, 0.5}, {4, 4, 16}, 1.5, {0.9, 0.6, 0.3}, 0.4));
  scene.lights.push_back(directionalLight({3, 0, -4}, {4, 5, 6}));
  scene.lights.back().castsShadow = false;
  scene.cameras.push_back(orthographicCamera({0, 0, 2}, {0, 0, 0}, 1));
  return known;
}

}  // namespace

Material lambert(const glm::vec3& colour) {
  Material material;
  material.baseColour = glm::vec4(colour, 1);
  material.metallic = 0;
  material.specular = 0;
  material.doubleSided = true;
  return material;
}

Material pane(const glm::vec3& colour) {
  Material material = lambert(colour);
  material.transmission = 1;
  return material;
}

Material veil(const glm::vec3& colour, float alpha) {
  Material material = lambert(colour);
  material.alphaMode = AlphaMode::Blend;
  material.baseColour.a = alpha;
  return material;
}

Material cutOut(const glm::vec3& colour, float alpha, float cutoff) {
  Material material = lambert(colour);
  material.alphaMode = AlphaMode::Mask;
  material.baseColour.a = alpha;
  material.alphaCutoff = cutoff;
  return material;
}

Material glowing(const glm::vec3& radiance) {
  Material material = lambert(glm::vec3(0));
  material.emissive = radiance;
  return material;
}

int add(Scene& scene, Mesh mesh, const Material& material, const glm::dmat4& worldFromObject) {
  mesh.material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(material);
  scene.instances.push_back({static_cast<int>(scene.meshes.size()), worldFromObject});
  scene.meshes.push_back(std::move(mesh));
  return static_cast<int>(scene.instances.size()) - 1;
}

Mesh tiledQuad(const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v, int n) {
  Mesh mesh;
  const glm::vec3 normal = glm::normalize(glm::cross(u, v));
  for (int row = 0; row <= n; ++row)
    for (int column = 0; column <= n; ++column) {
      const glm::vec2 uv(static_cast<float>(column) / n, static_cast<float>(row) / n);
      Vertex added = vertex(corner + uv.x * u + uv.y * v, normal);
      added.tangent = glm::vec4(glm::normalize(u), 1);
      added.uv0 = added.uv1 = uv;
      mesh.vertices.push_back(added);
    }
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) {
      const auto first = static_cast<uint32_t>(row * (n + 1) + column);
      const uint32_t above = first + static_cast<uint32_t>(n) + 1;
      mesh.indices.insert(mesh.indices.end(), {first, first + 1, above + 1, first, above + 1, above});
    }
  return mesh;
}

Mesh quad(const glm::vec3& corner, const glm::vec3& u, const glm::vec3& v) {
  return tiledQuad(corner, u, v, 1);
}

Mesh box(const glm::vec3& low, const glm::vec3& high) {
  const glm::vec3 x(high.x - low.x, 0, 0);
  const glm::vec3 y(0, high.y - low.y, 0);
  const glm::vec3 z(0, 0, high.z - low.z);
  Mesh mesh;
  for (const Mesh& face : {quad(low, y, x), quad(low, z, y), quad(low, x, z), quad(low + z, x, y),
                           quad(low + x, y, z), quad(low + y, z, x)}) {
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), face.vertices.begin(), face.vertices.end());
    for (const uint32_t index : face.indices) mesh.indices.push_back(first + index);
  }
  return mesh;
}

Mesh sphere(int rings, int sectors) {
  Mesh mesh;
  for (int ring = 0; ring <= rings; ++ring)
    for (int sector = 0; sector <= sectors; ++sector) {
      const double polar = std::numbers::pi * ring / rings;
      const double azimuth = 2 * std::numbers::pi * (sector % sectors) / sectors;
      const double radius = ring % rings == 0 ? 0 : std::sin(polar);
      const glm::vec3 p(radius * std::cos(azimuth), std::cos(polar), -radius * std::sin(azimuth));
      mesh.vertices.push_back(vertex(p, p));
    }
  for (int ring = 0; ring < rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      const auto upper = static_cast<uint32_t>(ring * (sectors + 1) + sector);
      const uint32_t lower = upper + static_cast<uint32_t>(sectors) + 1;
      if (ring > 0) mesh.indices.insert(mesh.indices.end(), {upper, lower + 1, upper + 1});
      if (ring + 1 < rings) mesh.indices.insert(mesh.indices.end(), {upper, lower, lower + 1});
    }
  return mesh;
}

Light directionalLight(const glm::dvec3& direction, const glm::dvec3& irradiance) {
  Light light;
  light.type = LightType::Directional;
  light.direction = glm::normalize(direction);
  light.intensity = irradiance;
  return light;
}

Light pointLight(const glm::dvec3& position, const glm::dvec3& intensity) {
  Light light;
  light.type = LightType::Point;
  light.position = position;
  light.intensity = intensity;
  return light;
}

Light spotLight(const glm::dvec3& position, const glm::dvec3& target, const glm::dvec3& intensity,
                double innerCone, double outerCone) {
  Light light = pointLight(position, intensity);
  light.type = LightType::Spot;
  light.direction = glm::normalize(target - position);
  light.innerCone = innerCone;
  light.outerCone = outerCone;
  return light;
}

Camera orthographicCamera(const glm::dvec3& eye, const glm::dvec3& target, double yMagnitude,
                          const glm::dvec3& up) {
  Camera camera = cameraAt(eye, target, up);
  camera.orthographic = true;
  camera.yMagnitude = yMagnitude;
  return camera;
}

Camera perspectiveCamera(const glm::dvec3& eye, const glm::dvec3& target, double yfov, const glm::dvec3& up) {
  Camera camera = cameraAt(eye, target, up);
  camera.yfov = yfov;
  return camera;
}

Medium block(const glm::dvec3& low, const glm::dvec3& high, const glm::ivec3& voxels, double sigmaT,
             const glm::dvec3& albedo, double g) {
  return withOptics(voxelise(low, high, voxels, [](const glm::dvec3&) { return 1.0; }), sigmaT, albedo, g);
}

Medium ball(const glm::dvec3& centre, double radius, int n, double sigmaT, const glm::dvec3& albedo,
            double g) {
  const auto density = [](const glm::dvec3& p) {
    const double fromCentre = 2 * glm::distance(p, glm::dvec3(0.5));
    return fromCentre < 1 ? std::pow(1 - fromCentre * fromCentre, 2) : 0.0;
  };
  return withOptics(voxelise(centre - radius, centre + radius, glm::ivec3(n), density), sigmaT, albedo, g);
}

KnownScene planeUnderPointLight() {
  KnownScene known{"plane under point light", {}, {}};
  add(known.scene, quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), lambert({0.75f, 0.5f, 0.25f}));
  known.scene.lights.push_back(pointLight({0, 2, 0}, {10, 20, 30}));
  known.scene.cameras.push_back(perspectiveCamera({0, 3, 0}, {0, 0, 0}, 1.2, {0, 0, -1}));
  return known;
}

KnownScene planeUnderSpotLight() {
  KnownScene known = planeUnderPointLight();
  known.name = "plane under spot light";
  known.scene.lights = {spotLight({0, 2, 0}, {0, 0, 0}, {10, 20, 30}, 0.3, 0.5)};
  return known;
}

KnownScene crossedPanes() {
  KnownScene known{"crossed panes", {}, {}};
  Scene& scene = known.scene;
  add(scene, quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), lambert({1, 1, 1}));
  add(scene, quad({-2, 1, 0.6f}, {4, 0, 0}, {0, 0, -1.2f}), pane({0.75f, 0.25f, 0.25f}));
  add(scene, quad({-0.6f, 1.5f, 2}, {1.2f, 0, 0}, {0, 0, -4}), pane({0.25f, 0.5f, 1}));
  scene.lights.push_back(directionalLight({0, -1, 0}, {3, 3, 3}));
  scene.cameras.push_back(orthographicCamera({0, 4, 0}, {0, 0, 0}, 2, {0, 0, -1}));
  return known;
}

KnownScene paneBeforeSmoke() {
  KnownScene known = paneAndSmoke(1);
  known.name = "pane before smoke";
  return known;
}

KnownScene smokeBeforePane() {
  KnownScene known = paneAndSmoke(-1);
  known.name = "smoke before pane";
  return known;
}

KnownScene smokeOverFloor() {
  KnownScene known{"smoke over floor", {}, {}};
  Scene& scene = known.scene;
  add(scene, quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), lambert({0.75f, 0.5f, 0.25f}));
  known.media.push_back(block({-16, 2, -16}, {16, 3, 16}, {8, 16, 8}, 0.8, {0.9, 0.9, 0.9}, 0));
  scene.lights.push_back(directionalLight({3, -4, 0}, {4, 5, 6}));
  scene.cameras.push_back(orthographicCamera({0, 1, 0}, {0, 0, 0}, 1, {0, 0, -1}));
  return known;
}

KnownScene glassBoxOverFloor() {
  KnownScene known{"glass box over floor", {}, {}};
  Scene& scene = known.scene;
  add(scene, quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), lambert({1, 1, 1}));
  Material glass = pane({0.5f, 0.75f, 0.875f});
  glass.doubleSided = false;
  add(scene, box({-1, 2, -1}, {1, 3, 1}), glass);
  scene.lights.push_back(directionalLight({0, -1, 0}, {3, 3, 3}));
  scene.cameras.push_back(orthographicCamera({0, 1, 0}, {0, 0, 0}, 2, {0, 0, -1}));
  return known;
}

KnownScene veilsOverWall() {
  KnownScene known{"veils over wall", {}, {}};
  Scene& scene = known.scene;
  add(scene, quad({-4, -4, -1}, {8, 0, 0}, {0, 8, 0}), lambert({0.5f, 0.5f, 0.5f}));
  add(scene, quad({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), veil({0.75f, 0.25f, 0.25f}, 0.25f));
  add(scene, quad({-4, -4, 1}, {8, 0, 0}, {0, 8, 0}), veil({0.25f, 0.25f, 1}, 0.5f));
  scene.lights.push_back(directionalLight({0, 0, -1}, {3, 3, 3}));
  scene.cameras.push_back(orthographicCamera({0, 0, 4}, {0, 0, 0}, 1));
  return known;
}

KnownScene shinySpheres() {
  KnownScene known{"shiny spheres", {}, {}};
  Scene& scene = known.scene;
  add(scene, quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), lambert({0.5f, 0.5f, 0.5f}));
  Material gold = lambert({1, 0.75f, 0.3f});
  gold.metallic = 1;
  gold.roughness = 0.35f;
  gold.specular = 1;
  Material lacquer = lambert({0.1f, 0.2f, 0.6f});
  lacquer.roughness = 0.2f;
  lacquer.specular = 1;
  const glm::dmat4 left(0.8, 0, 0, 0, 0, 0.8, 0, 0, 0, 0, 0.8, 0, -1, 0.8, 0, 1);
  const glm::dmat4 right(0.7, 0, 0, 0, 0, 0.9, 0, 0, 0, 0, 0.7, 0, 1, 0.9, 0, 1);
  add(scene, sphere(24, 48), gold, left);
  add(scene, sphere(24, 48), lacquer, right);
  scene.lights.push_back(pointLight({2, 3, 2}, {20, 18, 15}));
  scene.lights.push_back(directionalLight({1, -1, -1}, {1, 1.25, 1.5}));
  scene.cameras.push_back(perspectiveCamera({0, 1.5, 5}, {0, 0.75, 0}, 0.7));
  return known;
}

KnownScene smokeAndGlass() {
  KnownScene known{"smoke and glass", {}, {}};
  Scene& scene = known.scene;
  add(scene, quad({-6, 0, 6}, {12, 0, 0}, {0, 0, -12}), lambert({0.55f, 0.55f, 0.5f}));
  add(scene, quad({-6, 0, -3}, {12, 0, 0}, {0, 6, 0}), lambert({0.45f, 0.5f, 0.55f}));
  add(scene, box({-1.8f, 0, -0.5f}, {-1, 0.8f, 0.5f}), lambert({0.7f, 0.35f, 0.2f}));
  add(scene, box({1, 0, -1.5f}, {1.8f, 1.2f, -0.5f}), lambert({0.25f, 0.45f, 0.7f}));
  add(scene, quad({-1.2f, 1, 1.2f}, {0.8f, 0, 0.5f}, {0, 1.2f, 0}), pane({0.95f, 0.25f, 0.15f}));
  add(scene, quad({0.4f, 0.2f, 1.5f}, {1, 0, -0.4f}, {0, 1.1f, 0}), veil({0.2f, 0.8f, 0.3f}, 0.5f));
  known.media.push_back(ball({0, 1.2, 0}, 1.1, 32, 4, {0.9, 0.9, 0.9}, 0.3));
  known.media.push_back(ball({0.7, 1.5, 0.4}, 0.8, 24, 3, {0.9, 0.7, 0.5}, -0.2));
  scene.lights.push_back(spotLight({-3.5, 4.5, 3}, {0, 1, 0}, {160, 156, 148}, 0.3, 0.45));
  scene.lights.push_back(pointLight({1.9, 0.9, 1.6}, {12, 7, 3}));
  scene.lights.back().range = 6;
  scene.lights.push_back(directionalLight({-0.3, -1, -0.6}, {0.3, 0.35, 0.45}));
  scene.cameras.push_back(perspectiveCamera({0, 1.8, 6.5}, {0, 1.2, 0}, 0.6));
  return known;
}

std::vector<KnownScene> knownScenes() {
  return {planeUnderPointLight(), planeUnderSpotLight(), crossedPanes(),      paneBeforeSmoke(),
          smokeBeforePane(),      smokeOverFloor(),      glassBoxOverFloor(), veilsOverWall(),
          shinySpheres(),         smokeAndGlass()};
}

std::vector<std::string> namesOf(const std::vector<KnownScene>& scenes) {
  std::vector<std::string> names;
  for (const KnownScene& scene : scenes) names.push_back(scene.name);
  return names;
}

KnownScene named(const std::vector<KnownScene>& scenes, const std::string& name) {
  for (const KnownScene& scene : scenes)
    if (scene.name == name) return scene;
  throw std::out_of_range(name);
}

std::string testName(std::string sceneName) {
  for (char& c : sceneName)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return sceneName;
}

}  // namespace sfumato::tests
