#include "deepshadow/maps_gpu.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "base/error.h"
#include "gl/commands.h"
#include "gl/program.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/view.h"

namespace sfumato::deepshadow {

namespace {

// Parts of a buffer that are bound alone start at multiples of 256 bytes; texels do, as faces have whole
// workgroups of rows, which are multiples of 8 texels.
constexpr size_t knotAlignment = 16;

size_t alignedUp(size_t count, size_t alignment) {
  return (count + alignment - 1) / alignment * alignment;
}

size_t texelsOf(const FaceProjection& face) {
  return static_cast<size_t>(face.side) * static_cast<size_t>(face.side);
}

shared::ShadowFace faceData(const FaceProjection& face, size_t firstTexel) {
  shared::ShadowFace data{};
  data.faceFromWorld = glm::inverse(face.worldFromFace);
  const glm::dvec2 scale = static_cast<double>(face.side) / (2.0 * face.halfExtent);
  data.projection = glm::vec4(glm::vec2(scale), glm::vec2(face.side / 2.0));
  data.texels = {static_cast<int>(firstTexel), face.side, face.orthographic ? 0 : 1, 0};
  return data;
}

// Clip z is 0: nothing here uses a depth buffer, and the near and far planes are clamped.
shared::ViewParams faceView(const FaceProjection& face) {
  shared::ViewParams view{};
  view.viewFromWorld = glm::inverse(face.worldFromFace);
  view.worldFromView = face.worldFromFace;
  glm::mat4 clip(0.f);
  clip[0][0] = static_cast<float>(1.0 / face.halfExtent.x);
  clip[1][1] = static_cast<float>(1.0 / face.halfExtent.y);
  if (face.orthographic)
    clip[3][3] = 1.f;
  else
    clip[2][3] = -1.f;
  view.clipFromView = clip;
  view.halfExtent = glm::vec4(glm::vec2(face.halfExtent), face.orthographic ? 1.f : 0.f, 0.f);
  view.depthRange = {0.f, 3e38f, 0.f, 0.f};
  view.size = {face.side, face.side, 0, 0};
  return view;
}

// Everything that building the maps needs and that goes with it.
class Builder {
 public:
  Builder(gl::Device& device, const MapInputs& inputs, gl::Buffer& texels, gl::Buffer& knots)
      : device_(device),
        inputs_(inputs),
        texels_(texels),
        knots_(knots),
        opaque_(device.program({"scene/surface.vert", "deepshadow/opaque.frag"})),
        listed_(device.program({"scene/surface.vert", "deepshadow/listed.frag"})),
        runs_(device.program({"deepshadow/runs.comp"})),
        viewBlock_(device, "shadow view", sizeof(shared::ViewParams)),
        passBlock_(device, "shadow pass", sizeof(shared::ShadowPassParams)),
        counters_(device, "shadow counters", sizeof(shared::ShadowCounters)) {
    if (!inputs.volumes.empty())
      smoke_ = &device.program({"deepshadow/smoke.comp"}, inputs.volumes.defines());
    if (inputs.casters.once) once_ = &device.program({"deepshadow/once.comp"});
    counters_.clear();
  }

  // Builds one light's map into its texels.
  void build(const std::vector<FaceProjection>& faces, LightMap& map) {
    size_t firstTexel = map.firstTexel;
    for (const FaceProjection& face : faces) {
      drawOpaque(face);
      int rows = std::max(rowStep, static_cast<int>(windowTexels) / face.side / rowStep * rowStep);
      for (int row = 0; row < face.side;) {
        const Window window{face, firstTexel, row, std::min(rows, face.side - row)};
        if (buildWindow(window, map)) {
          row += window.rows;
        } else if (rows > rowStep) {
          rows = std::max(rowStep, rows / 2 / rowStep * rowStep);
        } else {
          base::fail(
              base::ExitCode::Memory,
              "deep shadow map: {} rows of {} texels are more than this device holds: lower --shadow-res",
              window.rows, face.side);
        }
      }
      firstTexel += texelsOf(face);
    }
  }

  size_t cutMarches() const { return counters_.readValue<shared::ShadowCounters>().boundHit; }

 private:
  // Rows of a face that are built at one time, so that the lists take the same memory at any resolution.
  struct Window {
    const FaceProjection& face;
    size_t firstTexelOfFace;
    int firstRow;
    int rows;
    size_t firstCell() const { return static_cast<size_t>(firstRow) * static_cast<size_t>(face.side); }
    size_t cells() const { return static_cast<size_t>(rows) * static_cast<size_t>(face.side); }
  };
  static constexpr size_t windowTexels = 1 << 20;
  static constexpr int rowStep = 8;  // windows start at whole workgroups

  // `numberOffset` and `firstRow`: see ViewParams::size.
  void useFace(const FaceProjection& face, int numberOffset, int firstRow) {
    shared::ViewParams view = faceView(face);
    view.size.z = numberOffset;
    view.size.w = firstRow;
    viewBlock_.writeValue(view);
    viewBlock_.bindUniform(UNIFORM_VIEW);
  }

  // Opaque depth of a face, kept for the passes that follow.
  void drawOpaque(const FaceProjection& face) {
    const gl::Profiler::Scope time(device_.profiler(), "opaque depth");
    if (depth_.size().x != face.side)
      depth_ = gl::Texture(device_, "shadow opaque depth",
                           {.format = gl::Format::R32F, .size = {face.side, face.side, 1}});
    const gl::Texture* colour = &depth_;
    const gl::Framebuffer target({&colour, 1}, nullptr);
    target.clearColour(0, glm::vec4(static_cast<float>(NOTHING_OPAQUE)));
    useFace(face, 0, 0);
    gl::setDrawState({.program = &opaque_,
                      .target = &target,
                      .viewport = {0, 0, face.side, face.side},
                      .depthClamp = true,
                      .blend = gl::Blend::Minimum});
    inputs_.casters.opaque();
  }

  // Lists of a window, then their runs. False when the window is too large for the device.
  bool buildWindow(const Window& window, LightMap& map) {
    std::optional<lists::ListStatistics> built;
    {
      const gl::Profiler::Scope time(device_.profiler(), "lists");
      prepareLists(window.cells());
      built = lists_->tryBuild(device_, window.cells(), [&] { insert(window); });
    }
    if (!built) return false;
    const gl::Profiler::Scope time(device_.profiler(), "runs");
    if (once_) keepFirstOfObjects(window);
    const std::optional<size_t> knots = writeRuns(window);
    if (!knots) return false;
    map.knots += *knots;
    map.lists += *built;
    return true;
  }

  void prepareLists(size_t cells) {
    if (cells <= listCells_) return;
    constexpr size_t nodesPerTexel = 2;  // a first guess; a pool that is too small grows
    lists_.reset();
    lists_.emplace(device_, "deep shadow lists", cells, sizeof(shared::ShadowNode), nodesPerTexel * cells);
    listCells_ = cells;
  }

  // Surfaces and smoke of a window into the lists.
  void insert(const Window& window) {
    const int side = window.face.side;
    useFace(window.face, -static_cast<int>(window.firstCell()), window.firstRow);
    usePass(window);
    depth_.bind(TEXTURE_OPAQUE_DEPTH);
    if (inputs_.casters.listed) {
      const gl::Framebuffer noTarget({side, side});
      gl::setDrawState({.program = &listed_,
                        .target = &noTarget,
                        .viewport = {0, 0, side, side},
                        .scissor = glm::ivec4(0, window.firstRow, side, window.rows),
                        .depthClamp = true});
      inputs_.casters.listed();
      gl::storageBarrier();
    }
    if (smoke_) {
      inputs_.volumes.bind();
      counters_.bindStorage(STORAGE_COUNTERS);
      gl::dispatch(*smoke_, groupsOver(side, window.rows));
    }
  }

  void keepFirstOfObjects(const Window& window) {
    usePass(window);
    lists_->bindForBuilding();
    counters_.bindStorage(STORAGE_COUNTERS);
    gl::dispatchLinear(*once_, window.cells());
    gl::storageBarrier();
  }

  // Lists to runs of knots, from firstKnot_ on; the pool of knots grows when it is full and the pass runs
  // again. Returns their number, or nothing when they are more than one block holds.
  std::optional<size_t> writeRuns(const Window& window) {
    const auto limit = static_cast<size_t>(device_.limits().storageBlockBytes);
    const size_t offset = firstKnot_ * sizeof(shared::ShadowKnot);
    size_t demand = 1;  // knots
    for (;;) {
      const size_t needed = demand * sizeof(shared::ShadowKnot);
      if (needed > limit) return std::nullopt;
      if (offset + needed > knots_.bytes()) growKnots(offset + needed, offset);
      const size_t room = std::min(limit, knots_.bytes() - offset);
      auto counters = counters_.readValue<shared::ShadowCounters>();
      counters.knots = 0;
      counters_.writeValue(counters);
      usePass(window);
      lists_->bindForBuilding();
      texels_.bindStorageRange(STORAGE_SHADOW_TEXELS,
                               (window.firstTexelOfFace + window.firstCell()) * sizeof(shared::ShadowTexel),
                               window.cells() * sizeof(shared::ShadowTexel));
      knots_.bindStorageRange(STORAGE_SHADOW_KNOTS, offset, room);
      counters_.bindStorage(STORAGE_COUNTERS);
      gl::dispatchLinear(runs_, window.cells());
      gl::storageBarrier();
      demand = counters_.readValue<shared::ShadowCounters>().knots;
      if (demand * sizeof(shared::ShadowKnot) <= room) {
        firstKnot_ = alignedUp(firstKnot_ + demand, knotAlignment);
        return demand;
      }
    }
  }

  // Room for `bytes` of knots, of which the first `used` are kept.
  void growKnots(size_t bytes, size_t used) {
    const size_t readable =
        static_cast<size_t>(device_.limits().textureBufferTexels) * sizeof(shared::ShadowKnot);
    if (bytes > readable)
      base::fail(base::ExitCode::Memory,
                 "deep shadow maps: more than the {} MiB that this device reads at once: lower --shadow-res",
                 readable >> 20);
    // Half as much again, so that many lights do not grow it one by one.
    gl::Buffer grown(device_, "deep shadow knots", std::min(bytes * 3 / 2, readable),
                     gl::Buffer::Whole::Never);
    grown.copyFrom(knots_, std::min(used, knots_.bytes()));
    knots_ = std::move(grown);
  }

  void usePass(const Window& window) {
    shared::ShadowPassParams params{};
    params.march = {static_cast<float>(inputs_.stepVoxels), static_cast<float>(inputs_.error), 0.f, 0.f};
    params.range = {static_cast<int>(firstKnot_), static_cast<int>(window.cells()), 0, 0};
    passBlock_.writeValue(params);
    passBlock_.bindUniform(UNIFORM_PASS);
  }

  static glm::uvec3 groupsOver(int width, int height) {
    return {gl::groupsFor(static_cast<size_t>(width), 8), gl::groupsFor(static_cast<size_t>(height), 8), 1};
  }

  gl::Device& device_;
  const MapInputs& inputs_;
  gl::Buffer& texels_;
  gl::Buffer& knots_;
  const gl::Program& opaque_;
  const gl::Program& listed_;
  const gl::Program& runs_;
  const gl::Program* smoke_ = nullptr;  // none without media
  const gl::Program* once_ = nullptr;   // none without objects that shadow once
  gl::Buffer viewBlock_;
  gl::Buffer passBlock_;
  gl::Buffer counters_;
  gl::Texture depth_;  // opaque depth of the face that is built
  std::optional<lists::LinkedLists> lists_;
  size_t listCells_ = 0;
  size_t firstKnot_ = 0;  // of the window that is built
};

}  // namespace

std::vector<FaceProjection> facesOf(const lights::Light& light, int resolution,
                                    std::span<const glm::dvec3> receivers,
                                    std::span<const glm::dvec3> castingPoints) {
  const int side = faceSide(resolution);
  if (light.type == lights::LightType::Directional)
    return {directionalFace(light.direction, side, receivers, castingPoints)};
  if (light.type == lights::LightType::Spot && light.outerCone <= widestCone)
    return {coneFace(light.position, light.direction, light.outerCone, side)};
  return cubeFaces(light.position, side);
}

Maps::Maps(gl::Device& device, const MapInputs& inputs) {
  std::vector<std::vector<FaceProjection>> faces;
  std::vector<shared::ShadowFace> data;
  size_t texels = 0;
  for (const lights::Light& light : inputs.lights) {
    LightMap& map = lightMaps_.emplace_back();
    faces.emplace_back();
    if (!light.castsShadow) continue;
    faces.back() = facesOf(light, inputs.resolution, inputs.receivers, inputs.castingPoints);
    map.firstFace = static_cast<int>(data.size());
    map.faces = static_cast<int>(faces.back().size());
    map.firstTexel = texels;
    for (const FaceProjection& face : faces.back()) {
      data.push_back(faceData(face, map.firstTexel + map.texels));
      map.texels += texelsOf(face);
    }
    texels += map.texels;
  }
  faces_ = gl::Buffer(device, "shadow faces", std::span<const shared::ShadowFace>(data));
  texels_ = gl::Buffer(device, "deep shadow texels", texels * sizeof(shared::ShadowTexel),
                       gl::Buffer::Whole::Never);
  knots_ = gl::Buffer(device, "deep shadow knots", texels * sizeof(shared::ShadowKnot) / 2,
                      gl::Buffer::Whole::Never);

  Builder builder(device, inputs, texels_, knots_);
  for (size_t i = 0; i < lightMaps_.size(); ++i)
    if (lightMaps_[i].firstFace >= 0) builder.build(faces[i], lightMaps_[i]);
  texelsView_ = gl::BufferTexture(device, texels_, gl::BufferFormat::RGB32UI);
  knotsView_ = gl::BufferTexture(device, knots_, gl::BufferFormat::RGBA32F);
  cutMarches_ = builder.cutMarches();
}

void Maps::bind() const {
  faces_.bindStorage(STORAGE_SHADOW_FACES);
  texelsView_.bind(TEXTURE_SHADOW_TEXELS);
  knotsView_.bind(TEXTURE_SHADOW_KNOTS);
}

}  // namespace sfumato::deepshadow
