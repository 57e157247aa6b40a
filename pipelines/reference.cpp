#include "pipelines/reference.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "pipelines/reference_bvh.h"
#include "pipelines/reference_shading.h"
#include "volumes/reference_march.h"

namespace sfumato::pipelines {

namespace {

using scene::Camera;
using scene::Instance;
using scene::Light;
using scene::Material;
using scene::Mesh;
using scene::Scene;
using scene::Vertex;
using volumes::Medium;

constexpr double startOffset = 1e-6;  // of the scene's extent: how far off its surface a shadow ray starts
constexpr double grazing = 0.05;      // the least cosine that the way through a shell is counted at
constexpr double negligible = 1e-9;   // transmittance that is not followed any further

bool isNegligible(const glm::dvec3& transmittance) {
  return std::max({transmittance.x, transmittance.y, transmittance.z}) < negligible;
}

// The instances' triangles in world space, and what their corners say.
class Geometry {
 public:
  explicit Geometry(const Scene& scene) : scene_(scene), bvh_(collectTriangles()) {}

  const Bvh& bvh() const { return bvh_; }

  const Material& material(const Hit& hit) const {
    return scene_.materials[static_cast<size_t>(mesh(hit).material)];
  }

  uint32_t object(const Hit& hit) const { return sources_[hit.triangle].instance; }

  // Whether a camera ray sees the face that it hit: front faces, counter-clockwise in the world, and both of
  // doubleSided materials.
  bool isSeen(const Hit& hit, const glm::dvec3& direction) const {
    return material(hit).doubleSided || glm::dot(windingNormal(hit), direction) < 0;
  }

  SurfacePoint pointAt(const Ray& ray, const Hit& hit) const {
    const auto interpolate = [&](auto attribute) {  // exact where the corners agree
      const auto first = attribute(vertex(hit, 0));
      return first + hit.weights[1] * (attribute(vertex(hit, 1)) - first) +
             hit.weights[2] * (attribute(vertex(hit, 2)) - first);
    };
    const glm::dmat3 worldFromObject(instance(hit).worldFromObject);
    const glm::dvec3 winding = windingNormal(hit);

    SurfacePoint point;
    point.position = ray.at(hit.t);
    point.geometricNormal = glm::normalize(glm::dot(winding, ray.direction) > 0 ? -winding : winding);
    const glm::dvec3 normal = glm::transpose(glm::inverse(worldFromObject)) *
                              interpolate([](const Vertex& v) { return glm::dvec3(v.normal); });
    const double length = glm::length(normal);
    point.normal = length > 0 && std::isfinite(length) ? normal / length : point.geometricNormal;
    const glm::dvec3 tangent = interpolate([](const Vertex& v) { return glm::dvec3(v.tangent); });
    point.tangent = glm::dvec4(worldFromObject * tangent, vertex(hit, 0).tangent.w);
    point.uv = {interpolate([](const Vertex& v) { return glm::dvec2(v.uv0); }),
                interpolate([](const Vertex& v) { return glm::dvec2(v.uv1); })};
    point.colour = interpolate([](const Vertex& v) { return glm::dvec4(v.colour); });
    return point;
  }

 private:
  struct Source {
    uint32_t instance;
    uint32_t firstIndex;  // in the mesh's indices
  };

  std::vector<Triangle> collectTriangles() {
    std::vector<Triangle> triangles;
    for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
      const Instance& instance = scene_.instances[i];
      const Mesh& mesh = scene_.meshes[static_cast<size_t>(instance.mesh)];
      for (uint32_t first = 0; first + 2 < mesh.indices.size(); first += 3) {
        const auto corner = [&](uint32_t k) {
          const glm::dvec3 p(mesh.vertices[mesh.indices[first + k]].position);
          return glm::dvec3(instance.worldFromObject * glm::dvec4(p, 1));
        };
        triangles.push_back({corner(0), corner(1), corner(2)});
        sources_.push_back({i, first});
      }
    }
    return triangles;
  }

  const Instance& instance(const Hit& hit) const { return scene_.instances[sources_[hit.triangle].instance]; }
  const Mesh& mesh(const Hit& hit) const { return scene_.meshes[static_cast<size_t>(instance(hit).mesh)]; }
  const Vertex& vertex(const Hit& hit, int corner) const {
    const Mesh& m = mesh(hit);
    return m.vertices[m.indices[sources_[hit.triangle].firstIndex + static_cast<uint32_t>(corner)]];
  }

  // Towards where the corners are seen counter-clockwise; not of unit length.
  glm::dvec3 windingNormal(const Hit& hit) const {
    const Triangle& p = bvh_.triangle(hit.triangle);
    return glm::cross(p[1] - p[0], p[2] - p[0]);
  }

  const Scene& scene_;
  std::vector<Source> sources_;  // filled before bvh_ is made
  Bvh bvh_;
};

// Of a ray of the camera, or of all rays of a pixel; pipelines/aovs.h says what each means.
struct Seen {
  glm::dvec3 radiance{0};
  glm::dvec3 transmittance{1};
  double distance = scene::infinity;  // along the ray; of a pixel the depth
  glm::dvec3 normal{0};
  glm::dvec3 albedo{0};
  int fragments = 0;
};

// Follows light backwards from the camera.
class Tracer {
 public:
  Tracer(const Scene& scene, std::span<const Medium> media, const ReferenceOptions& options)
      : scene_(scene), media_(media), options_(options), geometry_(scene), bounds_(geometry_.bvh().bounds()) {
    surfaceOffset_ = bounds_.empty() ? 0 : startOffset * glm::distance(bounds_.low, bounds_.high);
    for (const Medium& medium : media_) addBox(medium);
  }

  // What arrives along the ray from what is between tMin and tMax.
  Seen look(const Ray& ray, double tMin, double tMax) const {
    Seen seen;
    double t = tMin;
    for (const Hit& hit : visibleHits(ray, tMin, tMax)) {
      march(ray, t, hit.t, seen.radiance, seen.transmittance);
      t = hit.t;
      const SurfacePoint point = geometry_.pointAt(ray, hit);
      const Coverage coverage = coverageAt(scene_, geometry_.material(hit), point);
      if (!isNegligible(seen.transmittance))
        seen.radiance += seen.transmittance * leaving(ray, hit, point, coverage);
      if (isOpaque(hit, coverage)) {
        seen.distance = hit.t;
        seen.normal = reflectorAt(scene_, geometry_.material(hit), point, coverage).normal;
        seen.albedo = coverage.baseColour;
        return seen;
      }
      if (coverage.alpha > 0) ++seen.fragments;
      seen.transmittance *= coverage.passing();
    }
    march(ray, t, tMax, seen.radiance, seen.transmittance);
    return seen;
  }

 private:
  // Whether a surface ends what is seen, whatever else may let nothing through.
  bool isOpaque(const Hit& hit, const Coverage& coverage) const {
    return !geometry_.material(hit).translucent() && coverage.alpha > 0;
  }

  void addBox(const Medium& medium) {
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      const glm::dvec3 pIndex = glm::dvec3(medium.grid.origin) + side * glm::dvec3(medium.grid.size - 1);
      bounds_.add(glm::dvec3(medium.worldFromIndex * glm::dvec4(pIndex, 1)));
    }
  }

  // The surfaces that the camera sees, from near to far, none behind the first opaque one.
  std::vector<Hit> visibleHits(const Ray& ray, double tMin, double tMax) const {
    std::vector<Hit> hits;
    const auto visit = [&](const Hit& hit) {
      if (!geometry_.isSeen(hit, ray.direction)) return tMax;
      hits.push_back(hit);
      const Coverage coverage = coverageAt(scene_, geometry_.material(hit), geometry_.pointAt(ray, hit));
      if (isOpaque(hit, coverage)) tMax = std::min(tMax, hit.t);
      return tMax;
    };
    geometry_.bvh().forEachHit(ray, tMin, tMax, std::ref(visit));
    std::ranges::sort(hits, {}, [](const Hit& hit) { return std::pair(hit.t, hit.triangle); });
    return hits;
  }

  // Radiance that a surface sends towards the viewer: reflected and its own.
  glm::dvec3 leaving(const Ray& ray, const Hit& hit, const SurfacePoint& point,
                     const Coverage& coverage) const {
    const Reflector reflector = reflectorAt(scene_, geometry_.material(hit), point, coverage);
    glm::dvec3 radiance = reflector.emitted + scene_.ambient * ambientAlbedo(reflector);
    for (const Light& light : scene_.lights) {
      const Illumination arriving = illuminate(light, point.position);
      if (glm::dot(point.geometricNormal, arriving.toLight) <= 0) continue;
      const double cosine = std::max(glm::dot(reflector.normal, arriving.toLight), 0.0);
      const glm::dvec3 reflected =
          brdf(reflector, -ray.direction, arriving.toLight) * cosine * arriving.irradiance;
      if (reflected == glm::dvec3(0)) continue;
      const glm::dvec3 start = point.position + surfaceOffset_ * point.geometricNormal;
      radiance += reflected * shadowTransmittance(light, start, illuminate(light, start), &hit);
    }
    return radiance;
  }

  // The part of a light that gets to a point through all surfaces and media. `receiver` is the surface that
  // the point is on, or null.
  glm::dvec3 shadowTransmittance(const Light& light, const glm::dvec3& pWorld, const Illumination& arriving,
                                 const Hit* receiver) const {
    if (!light.castsShadow) return glm::dvec3(1);
    const Ray ray{pWorld, arriving.toLight};
    const double distance = std::isfinite(arriving.distance) ? arriving.distance : distanceOutOf(pWorld);
    const std::optional<uint32_t> spared = receiver && !geometry_.material(*receiver).shadowSelf
                                               ? std::optional(geometry_.object(*receiver))
                                               : std::nullopt;
    struct First {
      double t;
      glm::dvec3 passing;
    };
    std::map<uint32_t, First> firsts;  // of the objects that shadow once, the surface nearest to the light
    glm::dvec3 transmittance(1);
    const auto visit = [&](const Hit& hit) {
      const uint32_t object = geometry_.object(hit);
      if (object == spared) return distance;
      const SurfacePoint point = geometry_.pointAt(ray, hit);
      const Coverage coverage = coverageAt(scene_, geometry_.material(hit), point);
      if (coverage.alpha == 0) return distance;
      const glm::dvec3 passing = passingLight(hit, point, coverage, ray.direction);
      if (!geometry_.material(hit).shadowOnce) {
        transmittance *= passing;
      } else {
        const auto [first, isNew] = firsts.try_emplace(object, hit.t, passing);
        if (!isNew && hit.t > first->second.t) first->second = {hit.t, passing};
      }
      return isNegligible(transmittance) ? -scene::infinity : distance;
    };
    geometry_.bvh().forEachHit(ray, 0, distance, std::ref(visit));
    for (const auto& [object, first] : firsts) transmittance *= first.passing;
    if (isNegligible(transmittance)) return glm::dvec3(0);
    return transmittance *
           glm::exp(-volumes::opticalDepth(media_, pWorld, ray.at(distance), options_.shadowStepVoxels));
  }

  // What a surface lets through of light that comes along a direction, or against it.
  glm::dvec3 passingLight(const Hit& hit, const SurfacePoint& point, const Coverage& coverage,
                          const glm::dvec3& direction) const {
    const Material& material = geometry_.material(hit);
    if (material.shadowRim == 0) return coverage.passing();
    const glm::dvec3 normal = reflectorAt(scene_, material, point, coverage).normal;
    const double cosine = std::max(std::abs(glm::dot(normal, direction)), grazing);
    return glm::pow(coverage.passing(), glm::dvec3(1 + material.shadowRim * (1 / cosine - 1)));
  }

  // A distance from the point in any direction beyond which there is nothing.
  double distanceOutOf(const glm::dvec3& pWorld) const {
    if (bounds_.empty()) return 0;
    const glm::dvec3 centre = (bounds_.low + bounds_.high) / 2.0;
    return glm::distance(pWorld, centre) + glm::distance(bounds_.low, bounds_.high);
  }

  // What the media scatter and the fires emit between tMin and tMax, and what the media there let through.
  // The ray is cut where it enters or leaves a medium's box, so that steps never straddle a border.
  void march(const Ray& ray, double tMin, double tMax, glm::dvec3& radiance,
             glm::dvec3& transmittance) const {
    std::vector<Stay> stays;
    std::vector<double> cuts;
    const auto addStay = [&](Stay stay) {
      if (stay.enter == stay.leave) return;
      stays.push_back(stay);
      cuts.insert(cuts.end(), {stay.enter, stay.leave});
    };
    for (const Medium& medium : media_) {
      Stay stay{&medium, nullptr, tMin, tMax};
      if (volumes::clipToMedium(medium, ray.origin, ray.direction, stay.enter, stay.leave)) addStay(stay);
      if (!medium.fire) continue;
      stay = {nullptr, &*medium.fire, tMin, tMax};
      if (volumes::clipToFire(*medium.fire, ray.origin, ray.direction, stay.enter, stay.leave)) addStay(stay);
    }
    std::ranges::sort(cuts);
    for (size_t i = 1; i < cuts.size(); ++i) {
      Inside inside;
      for (const Stay& stay : stays)
        if (stay.enter <= cuts[i - 1] && cuts[i] <= stay.leave) {
          if (stay.medium) inside.media.push_back(stay.medium);
          if (stay.fire) inside.fires.push_back(stay.fire);
        }
      if (!inside.empty() && cuts[i] > cuts[i - 1])
        marchInside(inside, ray, cuts[i - 1], cuts[i], radiance, transmittance);
    }
  }

  // Where a ray is in the box of a medium, or of a fire.
  struct Stay {
    const Medium* medium;
    const volumes::Fire* fire;
    double enter;
    double leave;
  };

  struct Inside {
    std::vector<const Medium*> media;
    std::vector<const volumes::Fire*> fires;

    bool empty() const { return media.empty() && fires.empty(); }
    double voxel() const {
      double least = scene::infinity;
      for (const Medium* medium : media) least = std::min(least, volumes::voxelSize(medium->worldFromIndex));
      for (const volumes::Fire* fire : fires)
        least = std::min(least, volumes::voxelSize(fire->worldFromIndex));
      return least;
    }
  };

  void marchInside(const Inside& inside, const Ray& ray, double tMin, double tMax, glm::dvec3& radiance,
                   glm::dvec3& transmittance) const {
    const double steps = std::ceil((tMax - tMin) / (options_.stepVoxels * inside.voxel()));
    const double longest = (tMax - tMin) / steps;
    const double shortest = longest / 256;
    std::vector<glm::dvec3> extinctions;  // of each medium
    double t = tMin;
    while (t < tMax && !isNegligible(transmittance)) {
      // Close to a lamp its irradiance changes within a voxel.
      const double length =
          std::min(std::clamp(0.1 * distanceToLamp(ray.at(t + 0.5 * shortest)), shortest, longest), tMax - t);
      const glm::dvec3 p = ray.at(t + 0.5 * length);
      t += length;
      extinctions.clear();
      glm::dvec3 extinction(0);
      for (const Medium* medium : inside.media) {
        extinctions.push_back(volumes::extinctionAt(*medium, p));
        extinction += extinctions.back();
      }
      glm::dvec3 source(0);
      for (const volumes::Fire* fire : inside.fires) source += volumes::emissionAt(*fire, p);
      if (extinction != glm::dvec3(0)) source += scattered(inside.media, extinctions, p, ray.direction);
      radiance += transmittance * seenLength(extinction, length) * source;
      transmittance *= glm::exp(-extinction * length);
    }
  }

  // Integral of exp(-extinction s) over the length, per channel.
  static glm::dvec3 seenLength(const glm::dvec3& extinction, double length) {
    glm::dvec3 seen(length);
    for (int channel = 0; channel < 3; ++channel)
      if (extinction[channel] > 0)
        seen[channel] = -std::expm1(-extinction[channel] * length) / extinction[channel];
    return seen;
  }

  // To the nearest light that stands somewhere.
  double distanceToLamp(const glm::dvec3& pWorld) const {
    double nearest = scene::infinity;
    for (const Light& light : scene_.lights)
      if (light.type != lights::LightType::Directional)
        nearest = std::min(nearest, glm::distance(light.position, pWorld));
    return nearest;
  }

  // Light scattered at a point of the media to where the ray comes from, per metre.
  glm::dvec3 scattered(std::span<const Medium* const> media, std::span<const glm::dvec3> extinctions,
                       const glm::dvec3& pWorld, const glm::dvec3& direction) const {
    glm::dvec3 sum(0);
    for (const Light& light : scene_.lights) {
      const Illumination arriving = illuminate(light, pWorld);
      if (arriving.irradiance == glm::dvec3(0)) continue;
      const glm::dvec3 passing = shadowTransmittance(light, pWorld, arriving, nullptr);
      const double cosine = glm::dot(arriving.toLight, direction);  // both the other way: travelling light
      glm::dvec3 turned(0);
      for (size_t i = 0; i < media.size(); ++i)
        turned += extinctions[i] * media[i]->albedo *
                  volumes::turnedLight(*media[i], cosine, passing, options_.scatteringOctaves);
      sum += turned * arriving.irradiance;
    }
    return sum;
  }

  const Scene& scene_;
  const std::span<const Medium> media_;
  const ReferenceOptions options_;
  const Geometry geometry_;
  Box bounds_;                // of surfaces and media
  double surfaceOffset_ = 0;  // metres
};

// What the camera sees through a point of the picture: x to the right and y up, -1 to 1 across it.
Seen trace(const Tracer& tracer, const Camera& camera, double x, double y, double aspect) {
  const auto world = [&](const glm::dvec4& view) { return glm::dvec3(camera.worldFromView * view); };
  if (camera.orthographic) {
    const glm::dvec4 origin(x * camera.yMagnitude * aspect, y * camera.yMagnitude, 0, 1);
    return tracer.look({world(origin), world({0, 0, -1, 0})}, camera.nearDistance, camera.farDistance);
  }
  const double slope = std::tan(camera.yfov / 2);
  const glm::dvec3 view(x * slope * aspect, y * slope, -1);
  const double tPerDepth = glm::length(view);
  const Ray ray{world({0, 0, 0, 1}), world(glm::dvec4(view / tPerDepth, 0))};
  Seen seen = tracer.look(ray, camera.nearDistance * tPerDepth, camera.farDistance * tPerDepth);
  seen.distance /= tPerDepth;
  return seen;
}

// Adds a sample of `weight` to its pixel: the mean of colours, the nearest surface, the most fragments.
void addSample(Seen& pixel, const Seen& sample, double weight) {
  pixel.radiance += weight * sample.radiance;
  pixel.transmittance += weight * sample.transmittance;
  pixel.albedo += weight * sample.albedo;
  pixel.fragments = std::max(pixel.fragments, sample.fragments);
  if (sample.distance >= pixel.distance) return;
  pixel.distance = sample.distance;
  pixel.normal = sample.normal;
}

bool holds(const Medium& medium, const glm::dvec3& pWorld) {
  const glm::dvec3 p(glm::inverse(volumes::worldFromUnit(medium)) * glm::dvec4(pWorld, 1));
  return glm::all(glm::greaterThanEqual(p, glm::dvec3(0))) && glm::all(glm::lessThanEqual(p, glm::dvec3(1)));
}

// Where the lights stand that smoke shows as peaks, in the picture's coordinates of trace().
std::vector<glm::dvec2> lampsInSmoke(const Scene& scene, std::span<const Medium> media, const Camera& camera,
                                     double aspect) {
  std::vector<glm::dvec2> seen;
  const glm::dmat4 viewFromWorld = glm::inverse(camera.worldFromView);
  for (const Light& light : scene.lights) {
    const glm::dvec3 p(viewFromWorld * glm::dvec4(light.position, 1));
    if (light.type == lights::LightType::Directional || p.z >= 0) continue;
    if (std::ranges::none_of(media, [&](const Medium& m) { return holds(m, light.position); })) continue;
    const double halfHeight = camera.orthographic ? camera.yMagnitude : -p.z * std::tan(camera.yfov / 2);
    seen.push_back(glm::dvec2(p.x / aspect, p.y) / halfHeight);
  }
  return seen;
}

// Looks through the middle of a part of the picture, or where a lamp is near it through quarters of it,
// `levels` times over: the light of a lamp in smoke grows as 1 / distance from where it is seen.
void addPart(const std::function<Seen(const glm::dvec2&)>& look, std::span<const glm::dvec2> lamps,
             const glm::dvec2& middle, const glm::dvec2& size, double weight, int levels, Seen& pixel) {
  const bool lampIsNear = std::ranges::any_of(lamps, [&](const glm::dvec2& lamp) {
    return glm::all(glm::lessThan(glm::abs(lamp - middle), 1.5 * size));
  });
  if (levels == 0 || !lampIsNear) return addSample(pixel, look(middle), weight);
  for (const glm::dvec2 corner : {glm::dvec2(-1, -1), {1, -1}, {-1, 1}, {1, 1}})
    addPart(look, lamps, middle + 0.25 * corner * size, size / 2.0, weight / 4, levels - 1, pixel);
}

glm::vec3 valueOf(Aov aov, const Seen& pixel) {
  switch (aov) {
    case Aov::Depth:
      return glm::vec3(pixel.distance);
    case Aov::Normal:
      return pixel.normal;
    case Aov::Albedo:
      return pixel.albedo;
    case Aov::Transmittance:
      return pixel.transmittance;
    default:
      return glm::vec3(pixel.fragments);
  }
}

void store(const glm::vec3& value, image::Image& image, int x, int y) {
  std::copy_n(&value.x, image.channels, image.pixel(x, y));
}

}  // namespace

image::Image renderReference(const Scene& scene, const Camera& camera, std::span<const Medium> media,
                             const ReferenceOptions& options) {
  return traceReference(scene, camera, media, options).radiance;
}

ReferenceFrame traceReference(const Scene& scene, const Camera& camera, std::span<const Medium> media,
                              const ReferenceOptions& options) {
  base::check(options.stepVoxels > 0 && options.shadowStepVoxels > 0 && options.samples > 0,
              "the reference's steps and samples are positive");
  base::check(std::ranges::none_of(options.aovs, isOfLists), "the reference has no lists");
  const Tracer tracer(scene, media, options);
  const double aspect = static_cast<double>(options.width) / options.height;
  const auto lamps = lampsInSmoke(scene, media, camera, aspect);
  constexpr int lampLevels = 6;
  const glm::dvec2 size = 2.0 / (double(options.samples) * glm::dvec2(options.width, options.height));
  const double weight = 1.0 / (options.samples * options.samples);
  const auto lookThrough = [&](const glm::dvec2& p) { return trace(tracer, camera, p.x, p.y, aspect); };
  const auto look = [&](int px, int py) {
    Seen pixel{.transmittance = glm::dvec3(0)};
    for (int row = py * options.samples; row < (py + 1) * options.samples; ++row)
      for (int column = px * options.samples; column < (px + 1) * options.samples; ++column) {
        const glm::dvec2 middle((column + 0.5) * size.x - 1, 1 - (row + 0.5) * size.y);
        addPart(lookThrough, lamps, middle, size, weight, lampLevels, pixel);
      }
    return pixel;
  };

  ReferenceFrame frame{image::Image(options.width, options.height, 3),
                       emptyImages(options.aovs, options.width, options.height)};
  std::optional<base::Progress> progress;
  if (options.showProgress) progress.emplace("reference", options.height);
  base::parallelFor(options.height, [&](long row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < options.width; ++x) {
      const Seen pixel = look(x, y);
      store(pixel.radiance, frame.radiance, x, y);
      for (auto& [aov, image] : frame.aovs) store(valueOf(aov, pixel), image, x, y);
    }
    if (progress) progress->advance();
  });
  return frame;
}

}  // namespace sfumato::pipelines
