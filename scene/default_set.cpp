#include "scene/default_set.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "scene/camera_view.h"

namespace sfumato::scene {

using glm::dvec3;
using glm::ivec3;

namespace {

// Lengths of the set are in radii of the smoke.
constexpr double groundGap = 0.01;        // below the lowest voxel
constexpr double backdropDistance = 1.5;  // from the centre to where the ground begins to rise
constexpr double backdropBend = 2.5;      // radius of the curve
constexpr double groundReach = 8;         // at least, to the sides and to the front
constexpr int bendPieces = 32;

Bounds orAMetre(const Bounds& bounds) {
  return bounds.empty() || bounds.radius() == 0 ? Bounds{dvec3(-0.5), dvec3(0.5)} : bounds;
}

// Sums of density along an axis, of each column that holds any.
std::vector<double> columns(const volumes::DensityGrid& grid, int axis) {
  const int across = (axis + 1) % 3;
  const int beyond = (axis + 2) % 3;
  const auto width = static_cast<size_t>(grid.size[across]);
  std::vector<double> sums(width * static_cast<size_t>(grid.size[beyond]));
  volumes::forEachRow(grid, [&](ivec3 voxel, std::span<const float> row) {
    for (const float value : row) {
      if (value != 0)
        sums[static_cast<size_t>(voxel[beyond]) * width + static_cast<size_t>(voxel[across])] += value;
      ++voxel.x;
    }
  });
  std::erase(sums, 0.0);
  return sums;
}

// The mean of the largest tenth, at least of one.
double meanOfLargest(std::vector<double> values) {
  const size_t count = values.size() / 10 + 1;
  std::partial_sort(values.begin(), values.begin() + static_cast<long>(count), values.end(), std::greater());
  double sum = 0;
  for (size_t i = 0; i < count; ++i) sum += values[i];
  return sum / static_cast<double>(count);
}

// The ground from front to back, up the curve and the wall behind it: points and normals in the plane x = 0.
struct ProfilePoint {
  dvec3 position;
  dvec3 normal;
};

std::vector<ProfilePoint> groundProfile(double front, double wallHeight) {
  std::vector<ProfilePoint> profile = {{{0, 0, front}, {0, 1, 0}}};
  for (int i = 0; i <= bendPieces; ++i) {
    const double angle = std::numbers::pi / 2 * i / bendPieces;
    const dvec3 inward(0, std::cos(angle), std::sin(angle));
    profile.push_back({dvec3(0, backdropBend, -backdropDistance) - backdropBend * inward, inward});
  }
  profile.push_back({{0, std::max(wallHeight, backdropBend), -backdropDistance - backdropBend}, {0, 0, 1}});
  return profile;
}

// The profile, drawn out to both sides.
Mesh groundMesh(const std::vector<ProfilePoint>& profile, double halfWidth) {
  Mesh mesh;
  mesh.name = "ground";
  for (const ProfilePoint& point : profile)
    for (const double x : {-halfWidth, halfWidth}) {
      Vertex vertex;
      vertex.position = point.position + dvec3(x, 0, 0);
      vertex.normal = point.normal;
      mesh.vertices.push_back(vertex);
    }
  for (uint32_t i = 0; i + 2 < mesh.vertices.size(); i += 2)
    mesh.indices.insert(mesh.indices.end(), {i, i + 1, i + 3, i, i + 3, i + 2});
  return mesh;
}

void addGround(Scene& scene, const Bounds& smoke, const Camera& camera, double aspect) {
  const double radius = smoke.radius();
  const dvec3 foot(smoke.centre().x, smoke.low.y - groundGap * radius, smoke.centre().z);
  const dvec3 eye = (dvec3(camera.worldFromView[3]) - foot) / radius;
  const double depth = glm::length(eye) + backdropDistance + backdropBend;  // of the wall, or a little more
  const double seenHeight = 2 * depth * std::tan(camera.yfov / 2);

  Material material;
  material.name = "ground";
  material.baseColour = {0.044f, 0.052f, 0.066f, 1.f};
  material.metallic = 0;
  material.specular = 0;
  Mesh mesh = groundMesh(groundProfile(std::max(groundReach, eye.z), eye.y + seenHeight),
                         std::max(groundReach, seenHeight * aspect));
  mesh.material = static_cast<int>(scene.materials.size());
  const auto index = static_cast<int>(scene.meshes.size());
  scene.materials.push_back(std::move(material));
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({index, glm::scale(glm::translate(glm::dmat4(1), foot), dvec3(radius))});
}

Light directionalLight(const char* name, const dvec3& towardsLight, const dvec3& irradiance) {
  Light light;
  light.name = name;
  light.type = LightType::Directional;
  light.direction = -glm::normalize(towardsLight);
  light.intensity = irradiance;
  return light;
}

}  // namespace

Camera framingCamera(const Bounds& bounds, double yfov, double aspect) {
  constexpr double room = 0.88;  // of the picture is the box's
  const Bounds box = orAMetre(bounds);
  const dvec3 centre = box.centre();
  const dvec3 back = glm::normalize(dvec3(0, 0.2, 1));
  const glm::dmat3 viewFromWorld = glm::transpose(glm::dmat3(lookAt(back, dvec3(0), yfov).worldFromView));
  const double slope = std::tan(yfov / 2) * room;
  double distance = 0;
  for (int i = 0; i < 8; ++i) {
    const dvec3 p = viewFromWorld * (corner(box, i) - centre);
    distance = std::max({distance, p.z + std::abs(p.x) / (slope * aspect), p.z + std::abs(p.y) / slope});
  }
  distance = std::max(distance, 1e-6);
  Camera camera = lookAt(centre + back * distance, centre, yfov);
  camera.nearDistance = distance * 1e-3;
  return camera;
}

void addDefaultSet(Scene& scene, const Bounds& smoke, double yfov, double aspect) {
  const Bounds box = orAMetre(smoke);
  const Camera camera = framingCamera(box, yfov, aspect);
  addGround(scene, box, camera, aspect);
  scene.lights.push_back(directionalLight("key", {-0.85, 0.75, 0.16}, {19, 15.8, 12}));
  scene.lights.push_back(directionalLight("fill", {0.75, 0.45, 0.8}, {1, 1.4, 2.1}));
  scene.cameras.push_back(camera);
}

void addDefaultLights(Scene& scene) {
  scene.lights.push_back(directionalLight("key", {-0.5, 1, 0.6}, {4.4, 3.9, 3.3}));
  scene.lights.push_back(directionalLight("fill", {0.8, 0.4, 0.5}, {0.5, 0.65, 0.85}));
}

double fittingScale(const volumes::Medium& medium) {
  double logarithms = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double> sums = columns(medium.grid, axis);
    if (sums.empty()) return 1;
    logarithms += std::log(meanOfLargest(sums) * glm::length(dvec3(medium.worldFromIndex[axis])));
  }
  return fittingOpticalDepth / std::exp(logarithms / 3);
}

}  // namespace sfumato::scene
