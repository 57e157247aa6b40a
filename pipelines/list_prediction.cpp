#include "pipelines/list_prediction.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "lights/light_cells.h"
#include "lights/light_reach.h"
#include "lists/list_bytes.h"
#include "pipelines/projected_area.h"
#include "pipelines/shadow_resolution.h"
#include "pipelines/tiles.h"
#include "scene/camera_view.h"
#include "scene/light_faces.h"
#include "scene/visible_hull.h"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/surface.h"

namespace sfumato::pipelines {

using deepshadow::FaceProjection;
using glm::dvec3;
using lights::LightType;

namespace {

// Triangles that are looked at, in all views together, and in each at most and at least.
constexpr size_t mostTriangles = size_t{1} << 18;
constexpr size_t mostOfView = size_t{1} << 15;
constexpr size_t leastOfView = 256;
// Scenes of more triangles are bounded by the boxes of their instances where only their extent matters, and
// those of more instances by one box.
constexpr size_t mostForHull = size_t{1} << 16;
constexpr size_t mostBoxes = size_t{1} << 12;
// Pairs of a light and a part that is seen; beyond, one box stands for all parts.
constexpr size_t mostLitParts = size_t{1} << 16;

// Equal parts of a row of `all` things: from each one is drawn, and stands for the rest of it.
struct Strata {
  size_t all;
  size_t parts;

  size_t begin(size_t part) const { return part * all / parts; }
  size_t size(size_t part) const { return begin(part + 1) - begin(part); }
  size_t drawn(size_t part) const {
    return begin(part) + base::hash(static_cast<uint32_t>(part)) % size(part);
  }
};

bool isListed(const scene::Material& material) {
  return material.translucent() &&
         (material.alphaMode != scene::AlphaMode::Blend || material.baseColour.a > 0);
}

bool isListedInShadows(const scene::Material& material) {
  return isListed(material) || (!material.translucent() && !material.shadowSelf);
}

class Predictor {
 public:
  Predictor(const scene::Scene& scene, const Quality& quality) : scene_(scene), quality_(quality) {
    for (const scene::Instance& instance : scene.instances) {
      const scene::Material& material = materialOf(instance);
      if (meshOf(instance).indices.empty()) continue;
      if (isListed(material)) translucent_.push_back(&instance);
      if (isListedInShadows(material)) casters_.push_back(&instance);
    }
  }

  PredictedLists surfaces(const scene::Camera& camera, int width, int height, size_t triangles) const {
    const shared::ViewParams view = scene::cameraView(camera, width, height);
    const FragmentCount count({.viewFromWorld = glm::inverse(camera.worldFromView),
                               .halfExtent = glm::dvec2(view.halfExtent),
                               .orthographic = camera.orthographic,
                               .size = {width, height},
                               .nearDistance = camera.nearDistance,
                               .farDistance = camera.farDistance,
                               .samples = quality_.samples});
    const double nodes = fragments(translucent_, count, triangles, true);
    size_t largest = 0;
    for (const Tile& tile : tilesOf(width, height)) largest = std::max(largest, tile.pixels());
    return lists(static_cast<size_t>(width) * static_cast<size_t>(height), nodes, largest,
                 sizeof(shared::PackedSurface));
  }

  // Of each light, whose faces are given.
  std::vector<PredictedLists> shadows(const std::vector<std::vector<FaceProjection>>& facesOfLights,
                                      size_t triangles) const {
    std::vector<const FaceProjection*> faces;
    std::vector<size_t> lightOf;
    std::vector<PredictedLists> alone;
    for (size_t light = 0; light < facesOfLights.size(); ++light) {
      for (const FaceProjection& face : facesOfLights[light]) {
        const FragmentCount count({.viewFromWorld = glm::inverse(face.worldFromFace),
                                   .halfExtent = face.halfExtent,
                                   .orthographic = face.orthographic,
                                   .size = glm::dvec2(face.side)});
        faces.push_back(&face);
        lightOf.push_back(light);
        alone.push_back({face.texels(), whole(fragments(casters_, count, triangles, false)), 0});
      }
    }
    std::vector<PredictedLists> sums(facesOfLights.size());
    for (size_t first = 0; first < faces.size();) {
      const size_t count = deepshadow::stackedFaces(std::span(faces).subspan(first));
      PredictedLists stack;
      for (size_t i = first; i < first + count; ++i) stack += alone[i];
      const size_t bytes = lists(stack.cells, static_cast<double>(stack.nodes),
                                 std::min(stack.cells, deepshadow::windowTexels), sizeof(shared::ShadowNode))
                               .bytes;
      for (size_t i = first; i < first + count; ++i) {
        alone[i].bytes = bytes;
        sums[lightOf[i]] += alone[i];
      }
      first += count;
    }
    return sums;
  }

  PredictedLists lights(const scene::Camera& camera, int width, int height) const {
    const shared::ViewParams view = scene::cameraView(camera, width, height);
    double nodes = 0;
    for (const int number : lights::lightOrder(scene_.lights)) {
      const scene::Light& light = scene_.lights[static_cast<size_t>(number)];
      if (light.type != LightType::Directional) nodes += lights::cellsReached(light, view);
    }
    const auto cells =
        static_cast<size_t>(lights::cellsAlong(width)) * static_cast<size_t>(lights::cellsAlong(height));
    const size_t tiles = tilesOf(width, height).size();
    return lists(cells, nodes, (cells - 1) / tiles + 1, 0);
  }

  bool hasCasters() const { return !casters_.empty(); }

 private:
  const scene::Mesh& meshOf(const scene::Instance& instance) const {
    return scene_.meshes[static_cast<size_t>(instance.mesh)];
  }
  const scene::Material& materialOf(const scene::Instance& instance) const {
    return scene_.materials[static_cast<size_t>(meshOf(instance).material)];
  }

  static size_t whole(double value) { return static_cast<size_t>(std::min(std::round(value), 1e18)); }

  // Lists of `cells`, of which `together` are built at one time, their nodes anywhere among them.
  PredictedLists lists(size_t cells, double nodes, size_t together, size_t payloadBytes) const {
    const double share = static_cast<double>(together) / static_cast<double>(cells);
    return {cells, whole(nodes),
            lists::bytesOfLists(quality_.lists.strategy, together, whole(nodes * share), payloadBytes)};
  }

  // Of all instances, from so many triangles at most.
  double fragments(const std::vector<const scene::Instance*>& instances, const FragmentCount& count,
                   size_t triangles, bool cull) const {
    const Strata drawn{instances.size(), std::min(instances.size(), triangles)};
    double sum = 0;
    for (size_t part = 0; part < drawn.parts; ++part)
      sum += static_cast<double>(drawn.size(part)) *
             fragments(*instances[drawn.drawn(part)], count, triangles / drawn.parts, cull);
    return sum;
  }

  double fragments(const scene::Instance& instance, const FragmentCount& count, size_t triangles,
                   bool cull) const {
    const scene::Mesh& mesh = meshOf(instance);
    const bool culled = cull && !materialOf(instance).doubleSided;
    const Strata drawn{mesh.indices.size() / 3, std::min(mesh.indices.size() / 3, triangles)};
    double sum = 0;
    for (size_t part = 0; part < drawn.parts; ++part) {
      const size_t first = 3 * drawn.drawn(part);
      std::array<dvec3, 3> corners;
      for (size_t i = 0; i < 3; ++i)
        corners[i] = dvec3(instance.worldFromObject *
                           glm::dvec4(dvec3(mesh.vertices[mesh.indices[first + i]].position), 1.0));
      sum += static_cast<double>(drawn.size(part)) * count.of(corners, culled);
    }
    return sum;
  }

  const scene::Scene& scene_;
  const Quality& quality_;
  std::vector<const scene::Instance*> translucent_;
  std::vector<const scene::Instance*> casters_;
};

// As pipelines/linked_lists_gpu has it, but not of every triangle of large scenes.
scene::Seen seenOf(const scene::Scene& scene, const std::vector<glm::dmat4>& mediaBoxes,
                   const scene::Camera& camera, double aspect) {
  scene::Seen seen;
  seen.add(scene::visibleParts(mediaBoxes, camera, aspect));
  size_t triangles = 0;
  for (const scene::Instance& instance : scene.instances)
    triangles += scene.meshes[static_cast<size_t>(instance.mesh)].indices.size() / 3;
  if (triangles <= mostForHull) {
    seen.add(scene::visibleParts(scene, camera, aspect));
    return seen;
  }
  std::vector<glm::dmat4> boxes = scene::boundingBoxes(scene);
  if (boxes.size() > mostBoxes)
    boxes = {scene::worldFromUnit(scene::boundsOf(scene::boundingPoints(scene, {})))};
  seen.add(scene::visibleParts(boxes, camera, aspect));
  return seen;
}

}  // namespace

PredictedLists& PredictedLists::operator+=(const PredictedLists& other) {
  cells += other.cells;
  nodes += other.nodes;
  bytes = std::max(bytes, other.bytes);
  return *this;
}

PredictedLists ListPrediction::allShadows() const {
  PredictedLists sum;
  for (const PredictedLists& map : shadows) sum += map;
  return sum;
}

ListPrediction predictLists(const scene::Scene& scene, std::span<const volumes::Medium> media,
                            const scene::Camera& camera, int width, int height, const Quality& quality) {
  const Predictor predictor(scene, quality);
  std::vector<glm::dmat4> boxes;
  for (const volumes::Medium& medium : media) boxes.push_back(volumes::worldFromUnit(medium));
  scene::Seen seen = seenOf(scene, boxes, camera, static_cast<double>(width) / height);
  if (seen.parts.size() * scene.lights.size() > mostLitParts) seen.parts = {scene::boundsOf(seen.points)};
  const std::vector<dvec3> casting = scene::boundingPoints(scene, boxes);
  const std::vector<int> resolutions =
      shadowResolutions(scene.lights, seen.parts, camera, width, height, quality);
  std::vector<std::vector<FaceProjection>> faces;
  size_t views = 1;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    faces.emplace_back();
    if (resolutions[i] == 0 || !scene.lights[i].castsShadow || !predictor.hasCasters()) continue;
    faces.back() = scene::facesOf(scene.lights[i], resolutions[i], seen.points, casting);
    views += faces.back().size();
  }
  const size_t triangles = std::clamp(mostTriangles / views, leastOfView, mostOfView);
  return {.surfaces = predictor.surfaces(camera, width, height, triangles),
          .lights = predictor.lights(camera, width, height),
          .shadows = predictor.shadows(faces, triangles)};
}

}  // namespace sfumato::pipelines
