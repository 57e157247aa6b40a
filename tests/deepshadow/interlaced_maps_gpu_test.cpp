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
#include "pipelines/scene_gpu.h"
#include "scene/visible_hull.h"
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

using Probes = std::vector<Probe>;

Probe inSmoke(const dvec3& p) {
  return {glm::vec4(glm::vec3(p), 0), glm::vec4(0), glm::vec4(0)};
}

Probe onSurface(const dvec3& p, const dvec3& normal) {
  return {glm::vec4(glm::vec3(p), 0), glm::vec4(glm::vec3(normal), 0), glm::vec4(0)};
}

// Of what is seen.
const std::vector<dvec3> hull = {{-4, -1, -4}, {4, 5, 4},   {-4, 5, 4},  {4, -1, -4},
                                 {4, -1, 4},   {-4, 5, -4}, {-4, -1, 4}, {4, 5, -4}};

class InterlacedMapsGpu : public tests::GpuTest {
 protected:
  void build(const scene::Scene& scene, int resolution, InterlacedKind kind = InterlacedKind::Transmittance) {
    const pipelines::GeometryGpu geometry(device(), scene);
    const Casters casters = pipelines::castersOf(geometry);
    const std::vector<int> resolutions(scene.lights.size(), resolution);
    const std::vector<dvec3> castingPoints = scene::boundingPoints(scene, {});
    kind_ = kind;
    maps_.build(device(), {.lights = scene.lights,
                           .resolutions = resolutions,
                           .casters = casters,
                           .receivers = hull,
                           .castingPoints = castingPoints,
                           .kind = kind});
  }

  // What the lookup that is bound answers, of a light at `position` with so many faces from the first on.
  std::vector<dvec3> askBound(Probes probes, const dvec3& position, int firstFace, int faces, int side,
                              const gl::ShaderDefines& defines) {
    for (Probe& probe : probes) {
      probe.point.w = static_cast<float>(side);
      probe.normal.w = static_cast<float>(firstFace);
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

  std::vector<dvec3> ask(const Probes& probes, const Light& light, int side, size_t number = 0) {
    maps_.bind();
    return askAsBound(probes, light, side, number);
  }

  std::vector<dvec3> askAsBound(const Probes& probes, const Light& light, int side, size_t number = 0) {
    const InterlacedMaps::LightMap& map = maps_.lights()[number];
    return askBound(probes, light.position, map.firstFace, map.faces, side, lookupDefines(kind_));
  }

  std::vector<dvec3> askDeep(const scene::Scene& scene, const Probes& probes, int resolution, int side) {
    const pipelines::GeometryGpu geometry(device(), scene);
    const Casters casters = pipelines::castersOf(geometry);
    const volumes::VolumesGpu noMedia(device(), {});
    const std::vector<dvec3> castingPoints = scene::boundingPoints(scene, {});
    const Maps maps(device(), {.lights = scene.lights,
                               .casters = casters,
                               .volumes = noMedia,
                               .receivers = hull,
                               .castingPoints = castingPoints,
                               .plan = {{resolution}, 0}});
    maps.bind();
    return askBound(probes, scene.lights.front().position, 0, maps.lights().front().faces, side, {});
  }

  InterlacedMaps maps_;
  InterlacedKind kind_{};
};

dvec3 randomDirection(base::Random& random) {
  return glm::normalize(dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
}

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
  Probes probes;
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
    }
  }
  EXPECT_GT(filteredInAll, 1000);
}

// Every texel of every face, against the ray through its centre.
TEST_F(InterlacedMapsGpu, OddLinesHoldTheFirstSurfaceAndEvenOnesTheFirstOpaqueOne) {
  const Sheets sheets = paneWallAndFloor();
  for (const Light& light : lightsAround()) {
    build(sceneOf(sheets, light), 64);
    size_t compared[3] = {};  // nothing, opaque, translucent
    for (int number = 0; number < maps_.lights().front().faces; ++number) {
      const InterlacedMaps::ReadFace face = maps_.read(static_cast<size_t>(number));
      const FaceProjection& projection = face.projection;
      const int side = projection.side;
      // The first surface that a ray meets: its depth and number.
      const auto first = [&](const glm::dvec2& texel, bool opaqueOnly) {
        const glm::dvec2 plane = (texel / static_cast<double>(side) * 2.0 - 1.0) * projection.halfExtent;
        const dvec3 start = projection.orthographic ? dvec3(plane, 0) : dvec3(0);
        const dvec3 rate = projection.orthographic ? dvec3(0, 0, -1) : dvec3(plane, -1);
        std::pair<double, int> nearest = {NOTHING_OPAQUE, -1};
        for (size_t i = 0; i < sheets.size(); ++i) {
          const auto t = sheets[i].met(dvec3(projection.worldFromFace * glm::dvec4(start, 1)),
                                       glm::dmat3(projection.worldFromFace) * rate);
          if (t && *t > 0 && *t < nearest.first && (sheets[i].opaque() || !opaqueOnly))
            nearest = {*t, static_cast<int>(i)};
        }
        return nearest;
      };
      for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
          const glm::dvec2 centre(x + 0.5, y + 0.5);
          const auto [depth, sheet] = first(centre, y % 2 == 0);
          // Of a texel whose centre an edge goes through nobody knows.
          bool edge = false;
          for (const glm::dvec2& off : {glm::dvec2(0.02, 0), {-0.02, 0}, {0, 0.02}, {0, -0.02}})
            edge = edge || first(centre + off, y % 2 == 0).second != sheet;
          if (edge) continue;
          const size_t at = static_cast<size_t>(y * side + x);
          const bool translucent = sheet >= 0 && !sheets[static_cast<size_t>(sheet)].opaque();
          ASSERT_NEAR(face.depths[at] / depth, translucent ? -1 : 1, 2e-5) << number << ' ' << x << ' ' << y;
          if (translucent) {
            ASSERT_LT(worst(dvec3(face.letThrough[at]), sheets[static_cast<size_t>(sheet)].passes),
                      1 / 1023.0);  // not all drivers round to the nearest
          }
          ++compared[sheet < 0 ? 0 : (translucent ? 2 : 1)];
        }
      }
    }
    EXPECT_GT(compared[1], 300u);
    EXPECT_GT(compared[0] + compared[2], 100u);
  }
}

// A texel of one face and the next one of another: all around a lamp in a lantern of twelve panes, with a
// wall behind each.
TEST_F(InterlacedMapsGpu, NothingIsLostAcrossTheFacesOfAPointLight) {
  Sheets sheets;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      for (const double away : {1.0, 2.5}) {
        dvec3 corner(-away);
        corner[axis] = sign * away;
        dvec3 u(0);
        dvec3 v(0);
        u[(axis + 1) % 3] = v[(axis + 2) % 3] = 2 * away;
        sheets.push_back(
            {corner, u, v, away == 1 ? dvec3(0.6, 0.2 + 0.1 * axis, 0.5 + 0.2 * sign) : dvec3(0)});
      }
    }
  }
  const Light light = tests::pointLight({0, 0, 0}, dvec3(1));
  build(sceneOf(sheets, light), 128);
  base::Random random(3);
  Asked inside;
  Asked between;
  Asked behind;
  for (int i = 0; i < 3000; ++i) {
    dvec3 d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const dvec3 size = glm::abs(d);
    d /= std::max({size.x, size.y, size.z});  // on the cube's faces
    const int axis = std::abs(d.x) == 1 ? 0 : (std::abs(d.y) == 1 ? 1 : 2);
    // Half of them on edges of the cube, where faces meet.
    if (i % 2 == 0) d[(axis + 1) % 3] = (i % 4 == 0 ? 1 : -1) * (1 - 1e-3 * random.uniform());
    const bool corner = std::abs(d[(axis + 1) % 3]) > 0.9 || std::abs(d[(axis + 2) % 3]) > 0.9;
    inside.add(inSmoke(0.8 * d), dvec3(1));
    behind.add(inSmoke(2.8 * d), dvec3(0));
    between.add(inSmoke(1.8 * d), corner ? dvec3(-1) : exactPassing(sheets, light, 1.8 * d));
  }
  for (const int side : filterSides) {
    EXPECT_LT(inside.worstOf(ask(inside.probes, light, side)), 1e-6) << side;
    EXPECT_EQ(behind.worstOf(ask(behind.probes, light, side)), 0) << side;
    const auto passing = ask(between.probes, light, side);
    for (size_t i = 0; i < passing.size(); ++i) {
      if (between.passing[i].x >= 0) {
        ASSERT_LT(worst(passing[i], between.passing[i]), 1 / 1023.0) << side;
      } else {  // filtered by one pane or the other: none lets more than 0.7 through
        ASSERT_LT(std::max({passing[i].x, passing[i].y, passing[i].z}), 0.701) << side;
      }
    }
  }
}

// Eq. 3.1 and 3.2 by hand, of a veil C = (0.8, 0.3, 0.1), alpha = 0.25.
TEST_F(InterlacedMapsGpu, TheThesisFiltersByTheMinimumOfLightAndColour) {
  struct Case {
    dvec3 intensity;
    InterlacedKind kind;
    dvec3 passing;
  };
  const Case cases[] = {
      {{40, 20, 10}, InterlacedKind::Thesis, {0.75 * 0.8, 0.75 * 0.3 / 0.5, 0.75 * 0.1 / 0.25}},
      {{3, 0.6, 0.15}, InterlacedKind::Thesis, {0.75 * 0.8, 0.75, 0.75}},
      {{0, 0, 9}, InterlacedKind::Thesis, {0, 0, 0.75 * 0.1}},
      {{40, 20, 10}, InterlacedKind::Transmittance, dvec3(0.75)},
      {{40, 20, 10}, InterlacedKind::Opaque, dvec3(0)},
  };
  for (const Case& known : cases) {
    const Light light = tests::spotLight({0, 4, 0}, {0, 0, 0}, known.intensity, 0.3, 0.5);
    scene::Scene scene;
    tests::add(scene, tests::quad({-2, 2, -2}, {4, 0, 0}, {0, 0, 4}), tests::veil({0.8f, 0.3f, 0.1f}, 0.25f));
    tests::add(scene, tests::quad({-2, 1, -2}, {4, 0, 0}, {0, 0, 4}), tests::lambert({1, 1, 1}));
    scene.lights = {light};
    build(scene, 64, known.kind);
    for (const int side : filterSides) {
      const auto passing = ask({inSmoke({0.1, 3, 0.2}), inSmoke({0.1, 1.5, 0.2}), inSmoke({0.1, 0.5, 0.2}),
                                onSurface({0.1, 1, 0.2}, {0, 1, 0})},
                               light, side);
      EXPECT_EQ(passing[0], dvec3(1));
      for (int c = 0; c < 3; ++c) {
        if (known.intensity[c] == 0) continue;  // of nothing anything may be left
        EXPECT_NEAR(passing[1][c], known.passing[c], 2.0 / 255) << c;
        EXPECT_NEAR(passing[3][c], known.passing[c], 2.0 / 255) << c;
      }
      EXPECT_EQ(passing[2], dvec3(0));
    }
  }
}

// The method's known fault.
TEST_F(InterlacedMapsGpu, OfTwoLayersOnlyTheNearestFilters) {
  const Sheets sheets = {{{-3, 3, -3}, {6, 0, 0}, {0, 0, 6}, {0.8, 0.5, 0.1}},
                         {{-3, 2, -3}, {6, 0, 0}, {0, 0, 6}, {0.5, 0.9, 0.9}}};
  for (const Light& light :
       {tests::spotLight({0, 5, 0}, {0, 0, 0}, dvec3(1), 0.2, 0.4), tests::pointLight({0, 5, 0}, dvec3(1)),
        tests::directionalLight({0, -1, 0}, dvec3(1))}) {
    const scene::Scene scene = sceneOf(sheets, light);
    build(scene, 64);
    const Probes below = {inSmoke({0.2, 1, 0.1}), onSurface({0.2, 1, 0.1}, {0, 1, 0})};
    for (const int side : filterSides) {
      for (const dvec3& passing : ask(below, light, side))
        EXPECT_LT(worst(passing, {0.8, 0.5, 0.1}), 1 / 1023.0);
      for (const dvec3& passing : askDeep(scene, below, 64, side))
        EXPECT_LT(worst(passing, {0.4, 0.45, 0.09}), 1 / 500.0);
    }
  }
}

// Lights from all sides onto a plane, with a pane above it or without.
TEST_F(InterlacedMapsGpu, APlaneIsNotShadowedByItselfWhateverTheAngle) {
  base::Random random(17);
  for (const LightType type : {LightType::Spot, LightType::Point, LightType::Directional}) {
    for (const double degrees : {2.0, 10.0, 45.0, 89.0}) {
      const double e = degrees * 3.14159265358979 / 180;
      const dvec3 to(std::cos(e) * 0.8, std::sin(e), std::cos(e) * 0.6);
      const Light light = type == LightType::Directional ? tests::directionalLight(-to, dvec3(1))
                          : type == LightType::Point
                              ? tests::pointLight(5.0 * to, dvec3(1))
                              : tests::spotLight(5.0 * to, {0, 0, 0}, dvec3(1), 0.3, 0.5);
      const Sheet plane = {{-4, 0, 4}, {8, 0, 0}, {0, 0, -8}};
      const Sheet pane = {{-40, 0.5, 40}, {80, 0, 0}, {0, 0, -80}, {0.9, 0.5, 0.2}};
      Probes probes;
      while (probes.size() < 500) {
        const dvec3 p =
            plane.corner + random.uniform(0.2, 0.8) * plane.u + random.uniform(0.2, 0.8) * plane.v;
        const bool outside = type == LightType::Spot &&
                             glm::dot(glm::normalize(p - light.position), light.direction) < std::cos(0.48);
        if (!outside) probes.push_back(onSurface(p, {0, 1, 0}));
      }
      for (const int resolution : {32, 128, 512}) {
        for (const bool filtered : {false, true}) {
          // Below the pane; and one within a texel or two is taken for a part of the plane.
          if (filtered && type != LightType::Directional && light.position.y < 0.6) continue;
          if (filtered && resolution == 32) continue;
          const Sheets sheets = filtered ? Sheets{plane, pane} : Sheets{plane};
          const scene::Scene scene = sceneOf(sheets, light);
          build(scene, resolution);
          for (const int side : filterSides) {
            Asked asked{probes, {}};
            for (const Probe& probe : probes)
              asked.passing.push_back(
                  exactPassing({sheets.begin() + 1, sheets.end()}, light, dvec3(probe.point)));
            const double most = asked.worstOf(ask(probes, light, side));
            EXPECT_LT(most, filtered ? 1 / 1023.0 : 1e-5)
                << "light " << static_cast<int>(type) << " at " << degrees << " degrees, " << resolution
                << " texels, filter " << side << ", pane " << filtered;
          }
        }
      }
    }
  }
}

// Without translucent surfaces the lines are a plain shadow map, bit for bit, and lookups those of deep ones,
// which tests/pipelines/shadow_filter_gpu_test.cpp sends through everything that is difficult.
TEST_F(InterlacedMapsGpu, WithoutTranslucentSurfacesItIsAPlainShadowMap) {
  Sheets sheets = paneWallAndFloor();
  sheets.erase(sheets.begin());
  sheets.push_back({{-4, -0.2, -2}, {8, 0, 0}, {0, 4, 0.4}});  // goes through the floor
  for (const Light& light : lightsAround()) {
    const scene::Scene scene = sceneOf(sheets, light);
    Probes probes = askedInSmoke(sheets, light, 1 << 20).probes;  // edges too
    const Probes onThem = askedOnSurfaces(sheets, light, 1 << 20).probes;
    probes.insert(probes.end(), onThem.begin(), onThem.end());
    for (const int side : filterSides) {
      build(scene, 64, InterlacedKind::Opaque);
      const auto plain = ask(probes, light, side);
      build(scene, 64);
      EXPECT_EQ(plain, ask(probes, light, side)) << side;
      const auto deep = askDeep(scene, probes, 64, side);
      size_t different = 0;
      for (size_t i = 0; i < probes.size(); ++i) different += worst(plain[i], deep[i]) > 1e-5 ? 1 : 0;
      EXPECT_EQ(different, 0u) << "of " << probes.size() << ", light " << static_cast<int>(light.type)
                               << ", filter " << side;
    }
  }
}

// At the border of a pane's shadow, over a floor, a wall that stands on it and a ball: between what the pane
// lets through and all light, whatever lines and columns it begins with.
TEST_F(InterlacedMapsGpu, NothingIsDarkAtTheBorderOfAPanesShadow) {
  const dvec3 passes(0.7, 0.4, 0.2);
  base::Random random(23);
  for (const LightType type : {LightType::Spot, LightType::Point, LightType::Directional}) {
    for (const double degrees : {15.0, 40.0, 80.0}) {
      const double e = degrees * 3.14159265358979 / 180;
      const dvec3 to(-std::cos(e) * 0.8, std::sin(e), std::cos(e) * 0.6);
      const Light light = type == LightType::Directional ? tests::directionalLight(-to, dvec3(1))
                          : type == LightType::Point
                              ? tests::pointLight(6.0 * to, dvec3(1))
                              : tests::spotLight(6.0 * to, {0, 0, 0}, dvec3(1), 0.5, 0.6);
      // Across the light, its borders slanting.
      const dvec3 u = glm::normalize(glm::cross(to, dvec3(0.3, 1, 0.2)));
      const dvec3 v = glm::cross(to, u);
      const dvec3 middle = 3.2 * to;
      scene::Scene scene = sceneOf({{{-4, 0, 4}, {8, 0, 0}, {0, 0, -8}},
                                    {{1.5, 0, 4}, {0, 0, -8}, {0, 3, 0}},
                                    {middle - 0.6 * u - 0.5 * v, 1.0 * u, 1.1 * v, passes}},
                                   light);
      tests::add(scene, tests::sphere(48, 96), tests::lambert({1, 1, 1}), glm::dmat4(glm::dmat3(0.7)));
      Probes probes;
      while (probes.size() < 1500) {
        const dvec3 d = randomDirection(random);
        if (glm::dot(d, to) > 0.2 && d.y > 0.05) probes.push_back(onSurface(0.699 * d, d));
        const dvec3 p(random.uniform(-2, 1.4), 0, random.uniform(-2, 2));
        const dvec3 ray = type == LightType::Directional ? -to : glm::normalize(p - light.position);
        const bool besideTheBall = glm::length(glm::cross(p, ray)) > 1;
        if (besideTheBall) probes.push_back(onSurface(p, {0, 1, 0}));
      }
      for (const int resolution : {type == LightType::Point ? 128 : 64, 256}) {
        build(scene, resolution);
        for (const int side : filterSides) {
          int border = 0;
          double dark = 0;
          for (const dvec3& passing : ask(probes, light, side)) {
            const dvec3 lack = glm::max(passes - passing, passing - 1.0);
            dark = std::max({dark, lack.x, lack.y, lack.z});
            border += passing.x > 0.72 && passing.x < 0.98 ? 1 : 0;
          }
          // Of a coarse map one more line is asked than of a deep one, which the ball curves away from.
          EXPECT_LT(dark, resolution < 256 ? 3e-3 : 1 / 1023.0)
              << "light " << static_cast<int>(type) << " at " << degrees << " degrees, " << resolution
              << " texels, filter " << side;
          EXPECT_GT(border, side == 1 ? -1 : 3);
        }
      }
    }
  }
}

// A wall without a thickness on the floor, and a pane that stands before half of it.
TEST_F(InterlacedMapsGpu, BehindAThinWallItIsDarkBehindAPaneOrNot) {
  const Sheets sheets = {{{-4, 0, 4}, {8, 0, 0}, {0, 0, -8}},
                         {{0, 0, -2.5}, {0, 0, 5}, {0, 2, 0}},
                         {{1.2, 0.1, 0.3}, {0.3, 2.8, 0}, {0, 0.1, 3}, {0.3, 0.9, 0.6}}};
  int allDark = 0;
  int allFiltered = 0;
  for (const LightType type : {LightType::Spot, LightType::Point, LightType::Directional}) {
    for (const double degrees : {10.0, 30.0, 60.0, 75.0}) {
      const double e = degrees * 3.14159265358979 / 180;
      const dvec3 to(std::cos(e) * 0.96, std::sin(e), std::cos(e) * 0.28);
      const Light light = type == LightType::Directional ? tests::directionalLight(-to, dvec3(1))
                          : type == LightType::Point
                              ? tests::pointLight(7.0 * to, dvec3(1))
                              : tests::spotLight(7.0 * to, {0, 0, 0}, dvec3(1), 0.5, 0.6);
      const int resolution = type == LightType::Point ? 512 : 256;
      const Asked asked = askedOnSurfaces(sheets, light, resolution);
      build(sceneOf(sheets, light), resolution);
      const auto [dark, filtered, lit] = asked.kinds();
      for (const int side : filterSides)
        EXPECT_LT(asked.worstOf(ask(asked.probes, light, side)), 1 / 1023.0)
            << "light " << static_cast<int>(type) << " at " << degrees << " degrees, filter " << side << ": "
            << dark << " dark, " << filtered << " filtered, " << lit << " lit";
      allDark += dark;
      allFiltered += filtered;
    }
  }
  EXPECT_GT(allDark, 500);
  EXPECT_GT(allFiltered, 500);
}

// A pane under the edge of a wall: what is lit beside the wall's shadow went through the pane, though lines
// beside it show the wall.
TEST_F(InterlacedMapsGpu, APaneFiltersUpToTheShadowOfAWallBeforeIt) {
  const dvec3 passes(0.8, 0.4, 0.1);
  const Light light = tests::directionalLight({0, -1, 0}, dvec3(1));
  for (const bool acrossLines : {false, true}) {
    const dvec3 u = acrossLines ? dvec3(3.013, 0, 0) : dvec3(6, 0, 0);
    const dvec3 v = acrossLines ? dvec3(0, 0, 6) : dvec3(0, 0, 3.013);
    build(sceneOf({{{-3, 3, -3}, u, v}, {{-3, 2, -3}, {6, 0, 0}, {0, 0, 6}, passes}}, light), 64);
    Probes probes;
    for (int i = 0; i < 400; ++i) {
      const double across = 0.004 * (i - 200);
      probes.push_back(inSmoke({acrossLines ? across : 0.3, 1, acrossLines ? 0.3 : across}));
    }
    for (const int side : {2, 4}) {
      int border = 0;
      for (const dvec3& passing : ask(probes, light, side)) {
        const dvec3 whole = passes * (passing.x / passes.x);
        EXPECT_LT(worst(passing, whole), 1 / 500.0) << acrossLines << ' ' << side;
        border += passing.x > 0.05 && passing.x < 0.75 ? 1 : 0;
      }
      EXPECT_GT(border, 10);
    }
  }
}

// Around the point that asks a bowl is nearer to the light than the plane there.
TEST_F(InterlacedMapsGpu, ABallOfGlassWithALampInItDoesNotFilterItsOwnLight) {
  base::Random random(29);
  const Light light = tests::pointLight({0.2, 0.1, -0.2}, dvec3(1));
  scene::Scene scene;
  tests::add(scene, tests::sphere(64, 128), tests::pane({0.6f, 0.3f, 0.2f}));
  scene.lights = {light};
  Probes probes;
  for (int i = 0; i < 500; ++i) {
    const dvec3 d = randomDirection(random);
    probes.push_back(onSurface(d, -d));
  }
  build(scene, 128);
  for (const int side : filterSides)
    for (const dvec3& passing : ask(probes, light, side)) ASSERT_LT(worst(passing, dvec3(1)), 1e-5) << side;
}

// What is seen of a step when something moves across the edge of a shadow.
struct Step {
  bool monotone = true;
  double width = 0;   // from the first place that is neither before nor behind, to the last, texels
  double middle = 0;  // where half of it is done, texels from the edge
};

Step stepOf(const std::vector<double>& values, double perTexel, double edge) {
  Step step;
  double sum = 0;
  int between = 0;  // more than what 10 bits are off
  for (size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && values[i] < values[i - 1] - 1e-6) step.monotone = false;
    if (values[i] > 2e-3 && values[i] < 1 - 2e-3) ++between;
    sum += 1 - values[i];
  }
  step.width = between / perTexel;
  step.middle = sum / perTexel - edge;
  return step;
}

TEST_F(InterlacedMapsGpu, EdgesAreSmoothAndAsWideAsTheFilter) {
  constexpr int resolution = 64;
  constexpr int perTexel = 16;
  const Light light = tests::directionalLight({0, -1, 0}, dvec3(1));
  for (const bool translucent : {false, true}) {
    for (const int axis : {0, 2}) {  // across the lines of the map, across its columns
      for (double shift = 0; shift < 2; shift += 0.25) {
        // All that is on one side of a place close to the middle.
        build(sceneOf({{{-20, 3, -20}, {40, 0, 0}, {0, 0, 40}}}, light), resolution);
        const double texel = 2 * maps_.read(0).projection.halfExtent.x / resolution;
        const double edge = shift * texel;
        dvec3 corner(-20, 3, -20);
        dvec3 u(0);
        dvec3 v(0);
        u[axis] = 20 + edge;
        v[2 - axis] = 40;
        build(sceneOf({{corner, u, v, translucent ? dvec3(0.5, 0.25, 0.75) : dvec3(0)}}, light), resolution);
        constexpr double from = -8;
        Probes probes;
        for (int i = 0; i < 18 * perTexel; ++i) {
          dvec3 p(0.013, 1, 0.017);
          p[axis] = (from + (i + 0.5) / perTexel) * texel;
          probes.push_back(onSurface(p, {0, 1, 0}));
        }
        for (const int side : filterSides) {
          std::vector<double> values;
          for (const dvec3& passing : ask(probes, light, side))
            values.push_back(translucent ? (passing.y - 0.25) / 0.75 : passing.y);
          const Step step = stepOf(values, perTexel, shift - from);
          SCOPED_TRACE(fmt::format("translucent {}, axis {}, edge {}, side {}: width {}, middle {}",
                                   translucent, axis, shift, side, step.width, step.middle));
          EXPECT_TRUE(step.monotone);
          // A B-spline blurs a step over as many texels as it has taps but one; where lines were left out,
          // over one more. The soft one begins and ends with f^3 / 6, or half of that, below 2e-3.
          const bool halved = translucent && axis == 0;
          const double soft = halved ? 4 - 2 * std::cbrt(24e-3) : 3 - 2 * std::cbrt(12e-3);
          EXPECT_NEAR(step.width, side == 1 ? 0 : (side == 2 ? (halved ? 2 : 1) : soft), 0.13);
          EXPECT_LT(std::abs(step.middle), halved ? (side == 1 ? 1.54 : 1.04) : 0.54);
        }
      }
    }
  }
}

// What they would be seen to fail at.
TEST_F(InterlacedMapsGpu, LinesThatAreMistakenForEachOtherAndPlainMapsFailTheComparison) {
  const Sheets sheets = paneWallAndFloor();
  const Light light = lightsAround().front();
  const scene::Scene scene = sceneOf(sheets, light);
  const Asked asked = askedInSmoke(sheets, light, 256);
  build(scene, 256, InterlacedKind::Opaque);
  EXPECT_GT(asked.worstOf(ask(asked.probes, light, 1)), 0.5);
  build(scene, 256);
  shared::ShadowFace face = faceData(maps_.read(0).projection, 0);
  face.texels.x += face.texels.y;  // one line up: odd ones are taken for even ones
  const gl::Records broken(device(), "broken faces", std::span<const shared::ShadowFace>(&face, 1));
  maps_.bind();
  broken.bind(TEXTURE_SHADOW_FACES);
  EXPECT_GT(asked.worstOf(askAsBound(asked.probes, light, 4)), 0.1);
}

TEST_F(InterlacedMapsGpu, LightsStandBesideEachOtherInOneMapAsAlone) {
  const Sheets sheets = paneWallAndFloor();
  scene::Scene scene = sceneOf(sheets, lightsAround().front());
  scene.lights = lightsAround();
  scene.lights.insert(scene.lights.begin() + 1, tests::pointLight({1, 1, 1}, dvec3(1)));
  scene.lights[1].castsShadow = false;
  build(scene, 64);
  EXPECT_EQ(maps_.lights()[1].firstFace, -1);
  EXPECT_EQ(maps_.lights()[1].faces, 0);
  const Probes probes = askedInSmoke(sheets, scene.lights[3], 1 << 20).probes;
  std::vector<std::vector<dvec3>> together(scene.lights.size());
  for (size_t i = 0; i < scene.lights.size(); ++i)
    if (i != 1) together[i] = ask(probes, scene.lights[i], 2, i);
  const InterlacedMaps all = std::move(maps_);  // keeps its own
  maps_ = InterlacedMaps();
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    if (i == 1) continue;
    build(sceneOf(sheets, scene.lights[i]), 64);
    EXPECT_EQ(together[i], ask(probes, scene.lights[i], 2)) << i;
  }
  EXPECT_GT(all.bytes(), maps_.bytes());
}

TEST_F(InterlacedMapsGpu, TexturesAreUsedAgainForTheNextLight) {
  const Sheets sheets = paneWallAndFloor();
  const std::vector<Light> lights = lightsAround();
  build(sceneOf(sheets, lights[2]), 128);  // six faces
  const Probes probes = askedInSmoke(sheets, lights[2], 1 << 20).probes;
  const auto before = ask(probes, lights[2], 2);
  const size_t bytes = maps_.bytes();
  EXPECT_EQ(bytes, size_t{64 * 64 * 6 * 12});
  for (const size_t next : {size_t{0}, size_t{3}, size_t{2}}) {
    build(sceneOf(sheets, lights[next]), 64);
    EXPECT_EQ(maps_.bytes(), bytes);
  }
  build(sceneOf(sheets, lights[2]), 128);
  EXPECT_EQ(before, ask(probes, lights[2], 2));
  build(sceneOf(sheets, lights[2]), 128, InterlacedKind::Opaque);
  EXPECT_EQ(maps_.bytes(), bytes * 2 / 3);
}

TEST_F(InterlacedMapsGpu, AwkwardResolutionsWork) {
  const Sheets sheets = {{{-3, 3, -3}, {6, 0, 0}, {0, 0, 6}, {0.8, 0.5, 0.1}}};
  for (const Light& light :
       {tests::spotLight({0, 5, 0}, {0, 0, 0}, dvec3(1), 0.2, 0.4), tests::pointLight({0, 5, 0}, dvec3(1)),
        tests::directionalLight({0, -1, 0}, dvec3(1))}) {
    for (const int resolution : {1, 33, 47, 101}) {
      build(sceneOf(sheets, light), resolution);
      for (const int side : filterSides)
        EXPECT_LT(worst(ask({inSmoke({0.2, 1, 0.1})}, light, side).front(), {0.8, 0.5, 0.1}), 1 / 1023.0);
    }
    build(sceneOf(sheets, light), 0);
    EXPECT_EQ(maps_.lights().front().firstFace, -1);
    maps_.bind();
  }
}

}  // namespace
}  // namespace sfumato::deepshadow
