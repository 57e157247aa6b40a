#include "scene/generated_scenes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "base/error.h"
#include "base/random.h"
#include "scene/camera_view.h"
#include "scene/surface.h"
#include "volumes/procedural_smoke.h"

namespace sfumato::scene {
namespace {

using glm::dvec3;
using glm::vec3;
using std::numbers::pi;

constexpr size_t fewestTriangles = 4000;

Material matte(const char* name, const vec3& colour) {
  Material material;
  material.name = name;
  material.baseColour = glm::vec4(colour, 1);
  material.metallic = 0;
  material.roughness = 0.8f;
  material.specular = 0.5f;
  material.doubleSided = true;
  return material;
}

Material glazed(const char* name, const vec3& colour) {
  Material material = matte(name, colour);
  material.roughness = 0.3f;
  return material;
}

Material glass(const vec3& colour) {
  Material material = glazed("glass", colour);
  material.transmission = 0.85f;
  return material;
}

// Lets a part of all light through, and reflects the rest.
Material veil(const vec3& colour, float alpha) {
  Material material = matte("veil", colour);
  material.alphaMode = AlphaMode::Blend;
  material.baseColour.a = alpha;
  return material;
}

int addMaterial(Scene& scene, const Material& material) {
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

// Around the upright axis through `foot`: a radius and a height for each v.
SurfacePoint turned(const dvec3& foot, const std::function<glm::dvec2(double v)>& profile) {
  return [=](double u, double v) {
    const glm::dvec2 p = profile(v);
    return foot + dvec3(p.x * std::cos(2 * pi * u), p.y, -p.x * std::sin(2 * pi * u));
  };
}

SurfacePoint parallelogram(const dvec3& corner, const dvec3& alongU, const dvec3& alongV) {
  return [=](double u, double v) { return corner + u * alongU + v * alongV; };
}

// What gets a share of the scene's triangles.
struct Part {
  int material = 0;
  double weight = 1;
  double aspect = 1;
  SurfacePoint point;
};

// Adds the parts as an instance each; together they have so many triangles, each at least two.
void addParts(Scene& scene, const std::vector<Part>& parts, size_t triangles) {
  double weights = 0, passed = 0;
  for (const Part& part : parts) weights += part.weight;
  size_t given = 0;
  const size_t shared = triangles - 2 * parts.size();
  for (const Part& part : parts) {
    passed += part.weight;
    const auto upTo = static_cast<size_t>(std::llround(static_cast<double>(shared) * (passed / weights)));
    Mesh mesh = tessellated(part.point, 2 + upTo - given, part.aspect);
    given = upTo;
    mesh.material = part.material;
    mesh.name = scene.materials[static_cast<size_t>(part.material)].name;
    scene.instances.push_back({static_cast<int>(scene.meshes.size())});
    scene.meshes.push_back(std::move(mesh));
  }
}

void checkCounts(const TriangleCounts& triangles) {
  base::check(triangles.opaque >= fewestTriangles, "a generated scene has 4,000 opaque triangles at least");
  base::check(triangles.translucent == 0 || triangles.translucent >= 100,
              "a generated scene has no translucent triangles, or 100 at least");
}

Light directional(const dvec3& towardsLight, const dvec3& irradiance) {
  Light light;
  light.name = "sun";
  light.type = LightType::Directional;
  light.direction = -glm::normalize(towardsLight);
  light.intensity = irradiance;
  return light;
}

Light point(const dvec3& position, const dvec3& intensity, double range) {
  Light light;
  light.name = "lamp";
  light.position = position;
  light.intensity = intensity;
  light.range = range;
  return light;
}

Light spot(const dvec3& position, const dvec3& target, const dvec3& intensity, double range,
           double outerCone) {
  Light light = point(position, intensity, range);
  light.name = "spot";
  light.type = LightType::Spot;
  light.direction = glm::normalize(target - position);
  light.innerCone = 0.75 * outerCone;
  light.outerCone = outerCone;
  return light;
}

// A pale colour of any hue.
dvec3 paleColour(base::Random& random) {
  dvec3 colour;
  for (int c = 0; c < 3; ++c) colour[c] = random.uniform(0.45, 1);
  return colour / std::max({colour.x, colour.y, colour.z});
}

// A fluted column with a base and a capital.
SurfacePoint column(const dvec3& foot, double height, double radius) {
  return [=](double u, double v) {
    const double end = std::min(v, 1 - v);  // of the height, from the nearer end
    const double spread = end < 0.06 ? 0.35 * (1 - end / 0.06) : 0;
    const double flutes = end < 0.1 ? 0 : 0.05 * std::abs(std::sin(10 * pi * u));
    const double r = radius * (1 + spread - flutes - 0.12 * v);
    return foot + dvec3(r * std::cos(2 * pi * u), height * v, -r * std::sin(2 * pi * u));
  };
}

// Of height 1 and a shape of its own; open at its mouth.
SurfacePoint vase(const dvec3& foot, int shape) {
  const double belly = 0.26 + 0.03 * (shape % 4), waist = 1.5 + 0.45 * (shape % 3);
  return turned(foot, [=](double v) {
    const double r =
        0.1 + belly * std::pow(std::sin(pi * std::pow(std::max(v, 0.0), 1 / waist) * 0.92), 2) + 0.08 * v * v;
    return glm::dvec2(std::min(r, 12 * v + 0.01), 0.02 + v);
  });
}

SurfacePoint halfVault(const dvec3& low, double width, double length) {
  return [=](double u, double v) {
    const double angle = pi * v;
    return low + dvec3(0.5 * width * (1 - std::cos(angle)), 0.5 * width * std::sin(angle), -length * u);
  };
}

// Lies around the axis between two points, radius in metres.
SurfacePoint archOver(const dvec3& left, const dvec3& right, double thickness) {
  return [=](double u, double v) {
    const dvec3 middle = 0.5 * (left + right), half = 0.5 * (right - left);
    const double angle = pi * u, around = 2 * pi * v;
    const dvec3 outwards = -std::cos(angle) * half + std::sin(angle) * glm::length(half) * dvec3(0, 1, 0);
    const dvec3 across = glm::cross(glm::normalize(half), dvec3(0, 1, 0));
    return middle + outwards +
           thickness * (std::cos(around) * glm::normalize(outwards) - std::sin(around) * across);
  };
}

// Six lamps without shadows about a place, a sun with them, and a little light from everywhere.
void addLampsAndSun(Scene& scene, const dvec3& centre, const dvec3& reach, double intensity,
                    const dvec3& towardsSun) {
  base::Random random(5);
  for (int i = 0; i < 6; ++i) {
    const double angle = 2 * pi * i / 6 + 0.3;
    const dvec3 position = centre + reach * dvec3(std::cos(angle), 0.5 * std::sin(2.3 * i), std::sin(angle));
    scene.lights.push_back(point(position, intensity * paleColour(random), 3 * glm::length(reach)));
    scene.lights.back().castsShadow = false;
  }
  scene.lights.push_back(directional(towardsSun, {2.6, 2.4, 2.1}));
  scene.ambient = {0.1, 0.12, 0.15};
}

// Moves the camera back or forth so that what fits a picture of 16 to 9 fits every other.
Camera cameraFor(const dvec3& from, const dvec3& at, double yfov, double aspect) {
  const double wide = 16.0 / 9;
  const double angle = aspect >= wide ? yfov : 2 * std::atan(std::tan(yfov / 2) * wide / aspect);
  Camera camera = lookAt(from, at, std::min(angle, 2.6));
  camera.nearDistance = 0.05;
  return camera;
}

}  // namespace

Scene withoutTranslucent(const Scene& scene) {
  Scene result = scene;
  std::erase_if(result.instances, [&](const Instance& instance) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    return scene.materials[static_cast<size_t>(mesh.material)].translucent();
  });
  return result;
}

GeneratedScene layersScene(double aspect, int voxelsHigh) {
  GeneratedScene made;
  Scene& scene = made.scene;
  const auto addPane = [&](const Material& material, const dvec3& corner, double width, double height) {
    addParts(scene,
             {{addMaterial(scene, material), 1, 1, parallelogram(corner, {width, 0, 0}, {0, height, 0})}}, 2);
  };
  addParts(scene,
           {{addMaterial(scene, matte("floor", {0.6f, 0.58f, 0.55f})), 1, 1,
             parallelogram({-5, 0, 3}, {10, 0, 0}, {0, 0, -5})}},
           2);
  addParts(scene,
           {{addMaterial(scene, matte("wall", {0.75f, 0.74f, 0.7f})), 1, 1,
             parallelogram({-5, 0, -2}, {10, 0, 0}, {0, 5, 0})}},
           2);
  // Something behind the panes to be seen in their colours.
  const vec3 balls[] = {{0.8f, 0.3f, 0.2f}, {0.3f, 0.6f, 0.3f}, {0.25f, 0.35f, 0.75f}, {0.8f, 0.7f, 0.3f}};
  for (int i = 0; i < 4; ++i)
    addParts(scene,
             {{addMaterial(scene, matte("ball", balls[i])), 1, 2,
               turned({1.2 * i - 1.8, 0.35, -1.2},
                      [](double v) {
                        const double angle = pi * (0.002 + 0.996 * v);
                        return glm::dvec2(0.35 * std::sin(angle), -0.35 * std::cos(angle));
                      })}},
             1600);

  const vec3 colours[] = {{0.95f, 0.35f, 0.3f}, {0.4f, 0.85f, 0.45f}, {0.4f, 0.5f, 0.95f},
                          {0.95f, 0.85f, 0.4f}, {0.85f, 0.45f, 0.9f}, {0.4f, 0.85f, 0.9f},
                          {0.95f, 0.65f, 0.4f}, {0.75f, 0.8f, 0.75f}};
  const int layers[] = {1, 2, 4, 8};
  for (int stack = 0; stack < 4; ++stack)
    for (int i = 0; i < layers[stack]; ++i) {
      const vec3& colour = colours[static_cast<size_t>(i + 2 * stack) % 8];
      const double step = 0.55 / layers[stack];
      const dvec3 corner(1.2 * stack - 2.35 + 0.3 * step * i, 0.12 + step * i, 1 - 0.2 * i);
      addPane(i % 2 == 0 ? glass(colour) : veil(colour, 0.4f), corner, 0.9, 1.25);
    }

  volumes::Medium smoke;
  smoke.grid = volumes::makePlume(voxelsHigh, 2.2, 3);
  smoke.worldFromIndex =
      glm::dmat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.35, 1) * smoke.grid.worldFromIndex;
  smoke.scale = 5;
  smoke.albedo = dvec3(0.9);
  smoke.g = 0.2;
  made.media.push_back(std::move(smoke));

  scene.lights.push_back(spot({-3, 3.6, 3.4}, {-0.4, 0.6, -0.6}, {95, 80, 60}, infinity, 0.5));
  scene.lights.push_back(point({2.3, 1.7, 2.2}, {4, 6, 12}, 7));
  scene.lights.push_back(directional({0.4, 1.2, 0.9}, {0.5, 0.7, 0.55}));
  scene.cameras.push_back(cameraFor({0, 1.25, 5.4}, {0, 0.98, 0}, 0.52, aspect));
  return made;
}

GeneratedScene hallScene(const TriangleCounts& triangles, int lights, double aspect) {
  checkCounts(triangles);
  constexpr int vases = 12;
  constexpr size_t glassVases = 20832;  // triangles of all twelve, in the thesis's first scene
  GeneratedScene made;
  Scene& scene = made.scene;
  const int stone = addMaterial(scene, matte("stone", {0.62f, 0.58f, 0.5f}));
  const int marble = addMaterial(scene, glazed("marble", {0.75f, 0.72f, 0.7f}));
  const int plaster = addMaterial(scene, matte("plaster", {0.7f, 0.66f, 0.6f}));
  std::vector<Part> opaque = {{marble, 3, 0.4, parallelogram({-4, 0, 5}, {8, 0, 0}, {0, 0, -27})},
                              {plaster, 4, 2, halfVault({-4, 4.2, 5}, 8, 27)},
                              {plaster, 1, 4, parallelogram({-4, 0, 5}, {0, 0, -27}, {0, 4.2, 0})},
                              {plaster, 1, 4, parallelogram({4, 0, -22}, {0, 0, 27}, {0, 4.2, 0})},
                              {plaster, 1, 1, parallelogram({-4, 0, -22}, {8, 0, 0}, {0, 8.3, 0})}};
  for (int i = 0; i < 14; ++i)
    opaque.push_back({stone, 2.2, 0.7, column({i % 2 == 0 ? -2.9 : 2.9, 0, 2 - 3.4 * (i / 2)}, 4.6, 0.34)});

  const int ofGlass =
      triangles.translucent == 0
          ? 0
          : std::clamp(static_cast<int>((triangles.translucent * vases + glassVases / 2) / glassVases), 1,
                       vases);
  const vec3 tints[] = {{0.95f, 0.5f, 0.4f}, {0.5f, 0.85f, 0.6f}, {0.45f, 0.6f, 0.95f}, {0.95f, 0.85f, 0.5f}};
  std::vector<Part> translucent;
  for (int i = 0; i < vases; ++i) {
    const dvec3 foot((i % 2 == 0 ? -1 : 1) * (0.75 + 0.12 * (i % 3)), 0, 1.6 - 1.15 * i);
    opaque.push_back({stone, 0.5, 1.5, turned(foot, [](double v) {
                        const double r = v < 0.05   ? 0.001 + 8 * v
                                         : v > 0.95 ? 0.001 + 8 * (1 - v)
                                                    : 0.4 - 0.05 * std::sin(pi * v);
                        return glm::dvec2(r, 0.85 * std::clamp((v - 0.05) / 0.9, 0.0, 1.0));
                      })});
    const SurfacePoint shape = vase(foot + dvec3(0, 0.85, 0), i);
    if (i < ofGlass)
      translucent.push_back({addMaterial(scene, glass(tints[i % 4])), 1, 2, shape});
    else
      opaque.push_back({addMaterial(scene, glazed("porcelain", tints[i % 4])), 3, 2, shape});
  }
  addParts(scene, opaque, triangles.opaque);
  if (!translucent.empty()) addParts(scene, translucent, triangles.translucent);

  base::Random random(7);
  for (int i = 0; i < lights; ++i) {
    // From the middle outwards to both ends: few lights are where the camera looks.
    const dvec3 target(random.uniform(-2.8, 2.8), 0.6,
                       -2 + (i % 2 == 0 ? -1 : 0.28) * 0.3 * i * random.uniform(0.8, 1));
    const dvec3 position = target + dvec3(random.uniform(-1.6, 1.6), 5.4, random.uniform(0.5, 3));
    scene.lights.push_back(spot(position, target, 60.0 * paleColour(random), 14, 0.62));
  }
  scene.cameras.push_back(cameraFor({0.35, 2.1, 4.6}, {0, 1.35, -4}, 0.85, aspect));
  return made;
}

GeneratedScene courtScene(const TriangleCounts& triangles, double aspect) {
  checkCounts(triangles);
  GeneratedScene made;
  Scene& scene = made.scene;
  const int stone = addMaterial(scene, matte("stone", {0.64f, 0.58f, 0.48f}));
  const int paving = addMaterial(scene, matte("paving", {0.5f, 0.47f, 0.42f}));
  const int wall = addMaterial(scene, matte("wall", {0.7f, 0.63f, 0.53f}));
  std::vector<Part> opaque = {{paving, 4, 0.4, parallelogram({-7, 0, 6}, {14, 0, 0}, {0, 0, -30})},
                              {wall, 3, 3, parallelogram({-7, 0, 6}, {0, 0, -30}, {0, 9, 0})},
                              {wall, 3, 3, parallelogram({7, 0, -24}, {0, 0, 30}, {0, 9, 0})},
                              {wall, 2, 1.5, parallelogram({-7, 0, -24}, {14, 0, 0}, {0, 9, 0})}};
  for (int storey = 0; storey < 2; ++storey) {
    const double foot = 4.4 * storey;
    for (const double x : {-3.8, 3.8}) {
      opaque.push_back(
          {stone, 1, 12, parallelogram({x < 0 ? -7 : 3.8, foot + 4.2, 6}, {3.2, 0, 0}, {0, 0, -30})});
      for (int i = 0; i < 10; ++i) {
        const dvec3 at(x, foot, 3 - 2.8 * i);
        opaque.push_back({stone, 2, 0.8, column(at, 2.9, 0.24)});
        if (i < 9)
          opaque.push_back({stone, 1, 4, archOver(at + dvec3(0, 2.9, 0), at + dvec3(0, 2.9, -2.8), 0.16)});
      }
    }
  }
  addParts(scene, opaque, triangles.opaque);
  std::vector<Part> translucent;
  const vec3 tints[] = {
      {0.9f, 0.35f, 0.3f}, {0.35f, 0.7f, 0.45f}, {0.35f, 0.45f, 0.9f}, {0.95f, 0.75f, 0.35f}};
  for (int i = 0; i < 12 && triangles.translucent > 0; ++i) {
    const dvec3 corner(-1.6 + 1.1 * (i % 3) + 0.2 * (i / 3), 1.1 + 0.25 * (i % 2),
                       -1.5 * (i / 3) - 0.5 * (i % 3));
    const SurfacePoint hung = [=](double u, double v) {  // a pane that the wind bends
      return corner + dvec3(1.3 * u, 2.1 * v, 0.14 * std::sin(5 * u + 3 * v + i));
    };
    translucent.push_back(
        {addMaterial(scene, i % 2 == 0 ? glass(tints[i % 4]) : veil(tints[i % 4], 0.5f)), 1, 0.6, hung});
  }
  if (!translucent.empty()) addParts(scene, translucent, triangles.translucent);
  addLampsAndSun(scene, {0, 2, -3}, {2.4, 1.5, 6}, 7, {0.35, 1, 0.3});
  scene.cameras.push_back(cameraFor({0.9, 2, 5.4}, {-0.2, 2.5, -4}, 0.95, aspect));
  return made;
}

GeneratedScene statueScene(const TriangleCounts& triangles, double aspect) {
  checkCounts(triangles);
  GeneratedScene made;
  Scene& scene = made.scene;
  // A (2, 3) torus knot, its tube scaled like a snake's skin.
  const auto centre = [](double u) {
    const double angle = 4 * pi * u, r = 1 + 0.42 * std::cos(1.5 * angle);
    return dvec3(r * std::cos(angle), 1.75 + 0.55 * std::sin(1.5 * angle), r * std::sin(angle));
  };
  const SurfacePoint knot = [=](double u, double v) {
    constexpr double step = 1e-3;
    const dvec3 along = glm::normalize(centre(u + step) - centre(u - step));
    const dvec3 across = glm::normalize(glm::cross(along, dvec3(0, 1, 0.01)));
    const double around = 2 * pi * v;
    const double r =
        0.24 + 0.03 * std::sin(2 * pi * 3 * u) + 0.012 * std::sin(240 * pi * u) * std::sin(9 * around);
    return centre(u) + r * (std::cos(around) * across + std::sin(around) * glm::cross(across, along));
  };
  const int jade = addMaterial(scene, glazed("jade", {0.35f, 0.6f, 0.45f}));
  const int stone = addMaterial(scene, matte("stone", {0.6f, 0.58f, 0.55f}));
  addParts(scene,
           {{jade, 180, 12, knot},
            {stone, 12, 2,
             turned({0, 0, 0},
                    [](double v) {
                      const double r = v < 0.15   ? 0.002 + 10 * v
                                       : v > 0.85 ? 0.002 + 10 * (1 - v)
                                                  : 1.5 - 0.15 * std::sin(pi * (v - 0.15) / 0.7);
                      return glm::dvec2(r, 0.9 * std::clamp((v - 0.15) / 0.7, 0.0, 1.0));
                    })},
            {stone, 9, 1, parallelogram({-9, 0, 9}, {18, 0, 0}, {0, 0, -18})}},
           triangles.opaque);
  if (triangles.translucent > 0)
    addParts(scene,
             {{addMaterial(scene, glass({0.7f, 0.85f, 0.9f})), 1, 2,
               turned({0, 0.9, 0}, [](double v) { return glm::dvec2(1.8, 2.2 * v); })}},
             triangles.translucent);
  addLampsAndSun(scene, {0, 2, 0}, {3, 1.5, 3}, 6, {-0.5, 1, 0.6});
  scene.cameras.push_back(cameraFor({1.4, 2.6, 4.6}, {0, 1.45, 0}, 0.8, aspect));
  return made;
}

GeneratedScene houseScene(const TriangleCounts& triangles, double aspect) {
  checkCounts(triangles);
  GeneratedScene made;
  Scene& scene = made.scene;
  const int grass = addMaterial(scene, matte("grass", {0.3f, 0.42f, 0.2f}));
  const int brick = addMaterial(scene, matte("brick", {0.6f, 0.35f, 0.26f}));
  const int tiles = addMaterial(scene, matte("tiles", {0.4f, 0.2f, 0.16f}));
  const int frames = addMaterial(scene, matte("frames", {0.8f, 0.78f, 0.72f}));
  const int leaves = addMaterial(scene, matte("leaves", {0.2f, 0.36f, 0.16f}));
  std::vector<Part> opaque = {
      {grass, 8, 1,
       [](double u, double v) {
         const double x = 24 * u - 12, z = 12 - 24 * v;
         return dvec3(x, -0.06 + 0.05 * std::sin(1.3 * x) * std::cos(0.9 * z), z);
       }},
      {brick, 3, 2, parallelogram({-3, 0, 0}, {6, 0, 0}, {0, 2.8, 0})},
      {brick, 2, 1.3, parallelogram({3, 0, 0}, {0, 0, -4}, {0, 2.8, 0})},
      {brick, 2, 1.3, parallelogram({-3, 0, -4}, {0, 0, 4}, {0, 2.8, 0})},
      {brick, 1, 2, parallelogram({3, 0, -4}, {-6, 0, 0}, {0, 2.8, 0})},
      {tiles, 4, 2.5, parallelogram({-3.3, 2.7, 0.4}, {6.6, 0, 0}, {0, 1.8, -2.4})},
      {tiles, 4, 2.5, parallelogram({3.3, 2.7, -4.4}, {-6.6, 0, 0}, {0, 1.8, 2.4})},
      {brick, 1, 0.5, turned({1.7, 2.8, -2.6}, [](double v) { return glm::dvec2(0.3, 2.1 * v); })}};
  for (int side = 0; side < 2; ++side) {  // gables: triangles that end in the ridge
    const double x = side == 0 ? -3 : 3;
    opaque.push_back({brick, 1, 1.5, [=](double u, double v) {
                        return dvec3(x, 2.8 + 1.65 * v, -2 + (side == 0 ? -1 : 1) * (2 - 4 * u) * (1 - v));
                      }});
  }
  for (int i = 0; i < 5; ++i)  // the posts of the porch
    opaque.push_back({frames, 0.4, 0.1,
                      turned({-2.6 + 1.3 * i, 0, 1.9}, [](double v) { return glm::dvec2(0.06, 2.2 * v); })});
  for (int i = 0; i < 6; ++i) {
    const dvec3 foot(i % 2 == 0 ? -4.6 - 0.7 * i : 4.4 + 0.6 * i, 0, 1.5 - 1.8 * i);
    opaque.push_back({frames, 0.4, 0.3, turned(foot, [](double v) { return glm::dvec2(0.12, 1.1 * v); })});
    opaque.push_back({leaves, 3, 2, [=](double u, double v) {
                        const double polar = pi * (0.01 + 0.98 * v), around = 2 * pi * u;
                        const double r = 1 + 0.15 * std::sin(7 * polar) * std::cos(6 * around);
                        return foot + dvec3(0.9 * r * std::sin(polar) * std::cos(around),
                                            2 - 1.2 * r * std::cos(polar),
                                            -0.9 * r * std::sin(polar) * std::sin(around));
                      }});
  }
  addParts(scene, opaque, triangles.opaque);
  if (triangles.translucent > 0) {
    const int pane = addMaterial(scene, glass({0.75f, 0.9f, 0.92f}));
    const int awning = addMaterial(scene, veil({0.85f, 0.75f, 0.4f}, 0.6f));
    std::vector<Part> translucent;
    for (int i = 0; i < 4; ++i)
      translucent.push_back(
          {pane, 1, 0.6, parallelogram({-2.6 + 1.3 * i, 0.1, 1.9}, {1.3, 0, 0}, {0, 2.1, 0})});
    translucent.push_back({pane, 1, 0.9, parallelogram({-2.6, 0.1, 0}, {0, 0, 1.9}, {0, 2.1, 0})});
    translucent.push_back({pane, 1, 0.9, parallelogram({2.6, 0.1, 1.9}, {0, 0, -1.9}, {0, 2.1, 0})});
    translucent.push_back({awning, 2, 2.5, parallelogram({-2.7, 2.2, 2}, {5.4, 0, 0}, {0, 0.3, -2})});
    addParts(scene, translucent, triangles.translucent);
  }
  addLampsAndSun(scene, {0, 1.6, 1.4}, {4, 0.8, 3}, 4, {-0.6, 1, 0.8});
  scene.cameras.push_back(cameraFor({3.4, 2.5, 8.6}, {0, 1.5, 0}, 0.75, aspect));
  return made;
}

}  // namespace sfumato::scene
