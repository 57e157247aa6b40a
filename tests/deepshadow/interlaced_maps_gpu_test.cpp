// Interlaced shadow maps against rays from the light, in double precision, and against deep shadow maps.
#include "deepshadow/interlaced_maps_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "base/random.h"
#include "gl/commands.h"
#include "pipelines/geometry_gpu.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/known_scenes.h"
#include "volumes/volumes_gpu.h"

namespace sfumato::deepshadow {
namespace {

using glm::dvec3;
using lights::Light;
using lights::LightType;

constexpr int filterSides[] = {1, 2, 4};

// A parallelogram, and the part of light that it lets through.
struct Sheet {
  dvec3 corner;
  dvec3 u;
  dvec3 v;
  dvec3 passes{0};

  bool opaque() const { return passes == dvec3(0); }
  dvec3 normal() const { return glm::normalize(glm::cross(u, v)); }
  // Where a ray meets it, in units of the ray's direction.
  std::optional<double> met(const dvec3& start, const dvec3& direction) const {
    const dvec3 n = glm::cross(u, v);
    const double along = glm::dot(n, direction);
    if (along == 0) return {};
    const double t = glm::dot(n, corner - start) / along;
    const dvec3 at = start + t * direction - corner;
    const double a = glm::dot(glm::cross(at, v), n) / glm::dot(n, n);
    const double b = glm::dot(glm::cross(u, at), n) / glm::dot(n, n);
    if (a < 0 || a > 1 || b < 0 || b > 1) return {};
    return t;
  }
};

using Sheets = std::vector<Sheet>;

// How many translucent surfaces take their part.
enum class Layers { All, Nearest };

// The part of a light that gets to a point, but for what lies within `slack` metres of it.
dvec3 exactPassing(const Sheets& sheets, const Light& light, const dvec3& p, Layers layers = Layers::All,
                   double slack = 1e-6) {
  constexpr double farAway = 1e3;
  const dvec3 from = light.type == LightType::Directional ? p - farAway * light.direction : light.position;
  const double distance = glm::distance(from, p);
  dvec3 passing(1);
  double nearest = 2;
  for (const Sheet& sheet : sheets) {
    const auto t = sheet.met(from, p - from);
    if (!t || *t <= 0 || *t * distance > distance - slack) continue;
    if (sheet.opaque()) return dvec3(0);
    if (layers == Layers::All)
      passing *= sheet.passes;
    else if (*t < nearest)
      passing = sheet.passes;
    nearest = std::min(nearest, *t);
  }
  return passing;
}

// As the light sees it, nothing changes within `margin` metres of a point.
bool steady(const Sheets& sheets, const Light& light, const dvec3& p, double margin, double slack) {
  const dvec3 here = exactPassing(sheets, light, p, Layers::All, slack);
  const dvec3 forward =
      light.type == LightType::Directional ? light.direction : glm::normalize(p - light.position);
  const dvec3 side =
      glm::normalize(glm::cross(forward, std::abs(forward.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
  const dvec3 up = glm::cross(forward, side);
  for (int i = 0; i < 16; ++i) {
    const double angle = i * 3.14159265358979 / 8;
    const double reach = i % 2 == 0 ? margin : margin / 2;
    const dvec3 beside = p + reach * (std::cos(angle) * side + std::sin(angle) * up);
    if (exactPassing(sheets, light, beside, Layers::All, slack) != here) return false;
  }
  return true;
}

scene::Scene sceneOf(const Sheets& sheets, const Light& light) {
  scene::Scene scene;
  for (const Sheet& sheet : sheets)
    tests::add(scene, tests::quad(sheet.corner, sheet.u, sheet.v),
               sheet.opaque() ? tests::lambert({1, 1, 1}) : tests::pane(sheet.passes));
  scene.lights = {light};
  return scene;
}

struct Probe {
  glm::vec4 point;
  glm::vec4 normal;
  glm::vec4 light;
};

Probe inSmoke(const dvec3& p) {
  return {glm::vec4(glm::vec3(p), 0), glm::vec4(0), glm::vec4(0)};
}

Probe onSurface(const dvec3& p, const dvec3& normal) {
  return {glm::vec4(glm::vec3(p), 0), glm::vec4(glm::vec3(normal), 0), glm::vec4(0)};
}

// Of what is seen and what casts shadows.
const std::vector<dvec3> hull = {{-4, -1, -4}, {4, 5, 4},   {-4, 5, 4},  {4, -1, -4},
                                 {4, -1, 4},   {-4, 5, -4}, {-4, -1, 4}, {4, 5, -4}};

class InterlacedMapsGpu : public tests::GpuTest {
 protected:
  Casters castersOf(const pipelines::GeometryGpu& geometry) {
    return {.opaque = [&] { geometry.draw(pipelines::Layer::ShadowDepth, false); },
            .listed = [&] { geometry.draw(pipelines::Layer::ShadowLists, false); }};
  }

  void build(const scene::Scene& scene, int resolution, InterlacedKind kind = InterlacedKind::Transmittance) {
    const pipelines::GeometryGpu geometry(device(), scene);
    const Casters casters = castersOf(geometry);
    const std::vector<int> resolutions(scene.lights.size(), resolution);
    maps_.build(device(), {.lights = scene.lights,
                           .resolutions = resolutions,
                           .casters = casters,
                           .receivers = hull,
                           .castingPoints = hull,
                           .kind = kind});
  }

  // What the lookup that is bound answers, a light of `faces` at `position`.
  std::vector<dvec3> askBound(std::vector<Probe> probes, const dvec3& position, int faces, int side,
                              const gl::ShaderDefines& defines) {
    for (Probe& probe : probes) {
      probe.point.w = static_cast<float>(side);
      probe.light = {glm::vec3(position), static_cast<float>(faces)};
    }
    const gl::Buffer questions(device(), "probes", std::span<const Probe>(probes));
    const gl::Buffer answers(device(), "answers", probes.size() * sizeof(glm::vec4));
    questions.bindStorage(0);
    answers.bindStorage(1);
    gl::dispatchLinear(device().program({"deepshadow/lookups.comp"}, defines), probes.size());
    gl::storageBarrier();
    std::vector<dvec3> passing;
    for (const glm::vec4& answer : answers.readValues<glm::vec4>(probes.size())) passing.emplace_back(answer);
    return passing;
  }

  std::vector<dvec3> ask(const std::vector<Probe>& probes, const Light& light, int side) {
    maps_.bind();
    return askBound(probes, light.position, maps_.lights().front().faces, side,
                    {{"INTERLACED_SHADOWS", "1"}});
  }

  std::vector<dvec3> askDeep(const scene::Scene& scene, const std::vector<Probe>& probes, int resolution,
                             int side) {
    const pipelines::GeometryGpu geometry(device(), scene);
    const Casters casters = castersOf(geometry);
    const volumes::VolumesGpu noMedia(device(), {});
    const Maps maps(device(), {.lights = scene.lights,
                               .casters = casters,
                               .volumes = noMedia,
                               .receivers = hull,
                               .castingPoints = hull,
                               .plan = {{resolution}, 0}});
    maps.bind();
    return askBound(probes, scene.lights.front().position, maps.lights().front().faces, side, {});
  }

  InterlacedMaps maps_;
};

// Which way a light stands to the things about the origin; the point light is amidst them.
std::vector<Light> lightsAround() {
  return {tests::spotLight({1.3, 6, 2.1}, {0, 1, 0}, dvec3(7), 0.3, 0.62),
          tests::spotLight({-0.4, 4.4, 0.3}, {0.2, 0, 0.1}, dvec3(7), 0.4, 1.3),  // wide: six faces
          tests::pointLight({0.21, 2.3, -0.17}, dvec3(3)),
          tests::directionalLight({0.37, -1, -0.51}, dvec3(2)),
          tests::directionalLight({0, -1, 0}, dvec3(2)),
          tests::directionalLight({-1, -0.15, 0.02}, dvec3(2))};
}

// A coloured pane over a wall over a floor, none parallel, and a pane and a wall that stand; wherever from, a
// ray meets one pane at the most before something opaque.
Sheets paneWallAndFloor() {
  return {{{-1.5, 3.1, -1.4}, {2.9, 0.2, 0}, {0.1, 0.1, 3.1}, {0.8, 0.5, 0.1}},
          {{-1.3, 1.2, -0.9}, {2.4, 0, 0.1}, {0.1, 0.2, 2.4}},
          {{-4, 0, 4}, {8, 0, 0}, {0, 0, -8}},
          {{3.4, 0.1, -1.5}, {0.1, 2.5, 0}, {0, 0, 3}}};
}

// Metres around a point that the widest lookup asks about: taps two texels away, and the line beside them.
double askedAround(const Light& light, const dvec3& p, int resolution) {
  constexpr double texels = 3.2;
  if (light.type == LightType::Directional) return texels * 13.9 / resolution;  // the hull's diagonal
  const bool cube = light.type == LightType::Point || light.outerCone > widestCone;
  const double halfSide = cube ? resolution / 4 : resolution / 2 / std::tan(light.outerCone);
  return texels * glm::distance(p, light.position) / halfSide;
}

// Random points among the sheets, but where the shadow has an edge close by.
std::vector<dvec3> pointsAmong(const Sheets& sheets, const Light& light, int count, int resolution) {
  base::Random random(7);
  std::vector<dvec3> points;
  for (int tries = 0; static_cast<int>(points.size()) < count && tries < 100 * count; ++tries) {
    const dvec3 p(random.uniform(-3.2, 3.2), random.uniform(0.1, 4.2), random.uniform(-3.2, 3.2));
    if (light.type == LightType::Spot &&
        glm::dot(glm::normalize(p - light.position), light.direction) < std::cos(light.outerCone * 0.97))
      continue;
    if (light.type != LightType::Directional && glm::distance(p, light.position) < 0.3) continue;
    if (steady(sheets, light, p, askedAround(light, p, resolution), 1e-6)) points.push_back(p);
  }
  return points;
}

double worst(const dvec3& a, const dvec3& b) {
  const dvec3 d = glm::abs(a - b);
  return std::max({d.x, d.y, d.z});
}

// What a lookup is to answer there.
struct Asked {
  std::vector<Probe> probes;
  std::vector<dvec3> passing;

  void add(const Probe& probe, const dvec3& expected) {
    probes.push_back(probe);
    passing.push_back(expected);
  }
  // Those where it is dark, filtered and lit.
  std::array<int, 3> kinds() const {
    std::array<int, 3> counts{};
    for (const dvec3& p : passing) ++counts[p == dvec3(0) ? 0 : (p == dvec3(1) ? 2 : 1)];
    return counts;
  }
  double worstOf(const std::vector<dvec3>& answers) const {
    double most = 0;
    for (size_t i = 0; i < passing.size(); ++i) most = std::max(most, worst(answers[i], passing[i]));
    return most;
  }
};

Asked askedInSmoke(const Sheets& sheets, const Light& light, int resolution) {
  Asked asked;
  for (const dvec3& p : pointsAmong(sheets, light, 600, resolution))
    asked.add(inSmoke(p), exactPassing(sheets, light, p, Layers::Nearest));
  return asked;
}

// Random points of the sheets' lit sides, away from edges of shadows and of the sheets.
Asked askedOnSurfaces(const Sheets& sheets, const Light& light, int resolution) {
  base::Random random(8);
  Asked asked;
  for (size_t own = 0; own < sheets.size(); ++own) {
    Sheets others = sheets;
    others.erase(others.begin() + static_cast<int>(own));
    const Sheet& sheet = sheets[own];
    for (int i = 0; i < 300; ++i) {
      const dvec3 p =
          sheet.corner + random.uniform(0.05, 0.95) * sheet.u + random.uniform(0.05, 0.95) * sheet.v;
      const dvec3 fromLight =
          light.type == LightType::Directional ? light.direction : glm::normalize(p - light.position);
      const dvec3 normal = glm::dot(sheet.normal(), fromLight) < 0 ? sheet.normal() : -sheet.normal();
      if (light.type == LightType::Spot &&
          glm::dot(fromLight, light.direction) < std::cos(light.outerCone * 0.97))
        continue;
      if (glm::dot(normal, fromLight) < -0.1 &&
          steady(others, light, p, askedAround(light, p, resolution), 1e-6))
        asked.add(onSurface(p, normal), exactPassing(others, light, p, Layers::Nearest));
    }
  }
  return asked;
}

TEST_F(InterlacedMapsGpu, PointsGetTheLightThatOnePaneAndWallsLeave) {
  const Sheets sheets = paneWallAndFloor();
  int filteredInAll = 0;
  for (const Light& light : lightsAround()) {
    const scene::Scene scene = sceneOf(sheets, light);
    build(scene, 256);
    for (const bool surfaces : {false, true}) {
      const Asked asked = surfaces ? askedOnSurfaces(sheets, light, 256) : askedInSmoke(sheets, light, 256);
      ASSERT_GT(asked.probes.size(), 100u);
      const auto [dark, filtered, lit] = asked.kinds();
      EXPECT_GT(dark, 5);
      EXPECT_GT(lit, 10);
      filteredInAll += filtered;
      for (const int side : filterSides) {
        SCOPED_TRACE(fmt::format("light {} towards {:.2g} {:.2g} {:.2g}, {}, {} texels",
                                 static_cast<int>(light.type), light.direction.x, light.direction.y,
                                 light.direction.z, surfaces ? "surfaces" : "smoke", side));
        // Two colours of 10 bits; the deep map rounds tau to halves.
        EXPECT_LT(asked.worstOf(ask(asked.probes, light, side)), 1.0 / 1023);
        EXPECT_LT(asked.worstOf(askDeep(scene, asked.probes, 256, side)), 1.0 / 500);
      }
      fmt::print("light {}: {} dark, {} filtered, {} lit\n", static_cast<int>(light.type), dark, filtered,
                 lit);
    }
  }
  EXPECT_GT(filteredInAll, 1000);
}

}  // namespace
}  // namespace sfumato::deepshadow
