#include "deepshadow/maps_gpu.h"

#include <algorithm>
#include <memory>

#include "base/error.h"
#include "gl/commands.h"
#include "gl/program.h"
#include "scene/light_faces.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/view.h"

namespace sfumato::deepshadow {

namespace {

// Parts of a buffer that are bound alone start at multiples of 256 bytes.
constexpr size_t knotAlignment = 256 / sizeof(shared::ShadowKnot);
constexpr size_t texelAlignment = 64;

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

// Rows that hold some cells of a face: what a scissor lets through.
glm::ivec4 rowsOf(const lists::Window& window, int side) {
  const auto width = static_cast<size_t>(side);
  const size_t first = window.firstCell / width;
  const size_t last = (window.firstCell + window.cells - 1) / width;
  return {0, static_cast<int>(first), side, static_cast<int>(last - first + 1)};
}

// Everything that building the maps needs and that goes with it.
class Builder {
 public:
  Builder(gl::Device& device, const MapInputs& inputs, gl::Buffer& texels, gl::Buffer& knots)
      : device_(device),
        inputs_(inputs),
        texels_(texels),
        knots_(knots),
        opaque_(device.program({"scene/surface.vert", "deepshadow/opaque.frag"}, inputs.casters.defines)),
        writer_(device.program({"deepshadow/knots.comp"}, writerDefines(inputs))),
        viewBlock_(device, "shadow view", sizeof(shared::ViewParams)),
        passBlock_(device, "shadow pass", sizeof(shared::ShadowPassParams)),
        counters_(device, "shadow counters", sizeof(shared::ShadowCounters)) {}

  // Builds one light's map into its texels. Faces are built in windows, so that the lists take the same
  // memory at any resolution.
  void build(const std::vector<FaceProjection>& faces, LightMap& map) {
    size_t firstTexel = map.firstTexel;
    for (const FaceProjection& face : faces) {
      drawOpaque(face);
      const auto writeWindow = [&](const lists::Window& window) {
        writeKnots({face, firstTexel, window}, map);
      };
      if (inputs_.casters.listed) {
        prepareLists(texelsOf(face));
        map.lists += lists_->buildWindows(
            device_, [&](const lists::Pass& pass) { store(face, pass); }, writeWindow, windowTexels);
      } else {
        for (size_t first = 0; first < texelsOf(face); first += windowTexels)
          writeWindow({first, std::min(windowTexels, texelsOf(face) - first)});
      }
      firstTexel += texelsOf(face);
    }
  }

  size_t cutMarches() const { return cutMarches_; }

 private:
  // Cells of a face whose lists are built.
  struct FaceWindow {
    const FaceProjection& face;
    size_t firstTexelOfFace;
    lists::Window cells;
  };

  static gl::ShaderDefines writerDefines(const MapInputs& inputs) {
    gl::ShaderDefines defines;
    if (!inputs.volumes.empty()) defines = inputs.volumes.defines();
    if (inputs.casters.listed) defines.emplace_back("SURFACES", "1");
    if (inputs.casters.once) defines.emplace_back("SHADOW_ONCE_OBJECTS", "1");
    if (inputs.casters.notSelf) defines.emplace_back("SHADOW_NOT_SELF_OBJECTS", "1");
    return defines;
  }

  void useFace(const FaceProjection& face) {
    viewBlock_.writeValue(faceView(face));
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
    useFace(face);
    gl::setDrawState({.program = &opaque_,
                      .target = &target,
                      .viewport = {0, 0, face.side, face.side},
                      .depthClamp = true,
                      .blend = gl::Blend::Minimum});
    inputs_.casters.opaque();
  }

  void prepareLists(size_t cells) {
    if (cells == listCells_) return;
    lists_.reset();
    lists_ = std::make_unique<lists::Lists>(device_, "deep shadow lists", cells, sizeof(shared::ShadowNode),
                                            inputs_.lists);
    listCells_ = cells;
  }

  // The surfaces of a face into the lists.
  void store(const FaceProjection& face, const lists::Pass& pass) {
    useFace(face);
    depth_.bind(TEXTURE_OPAQUE_DEPTH);
    const gl::Framebuffer noTarget({face.side, face.side});
    gl::setDrawState({.program = &device_.program({"scene/surface.vert", "deepshadow/listed.frag"},
                                                  gl::joined(inputs_.casters.defines, pass.defines)),
                      .target = &noTarget,
                      .viewport = {0, 0, face.side, face.side},
                      .scissor = rowsOf(pass.window, face.side),
                      .depthClamp = true});
    inputs_.casters.listed();
  }

  // The knots of a window, from firstKnot_ on. Texels that find no room in the pool are written again when it
  // has grown, or behind the block that is full.
  void writeKnots(const FaceWindow& window, LightMap& map) {
    const gl::Profiler::Scope time(device_.profiler(), "knots");
    size_t wanted = 1;
    for (bool all = true; wanted > 0; all = false) {
      const size_t room = reserveKnots(wanted);
      counters_.clear();
      useFace(window.face);
      useWindow(window, all);
      depth_.bind(TEXTURE_OPAQUE_DEPTH);
      if (inputs_.casters.listed) lists_->bind(TEXTURE_LIST_RUNS, TEXTURE_LIST_KEYS, TEXTURE_LIST_PAYLOADS);
      inputs_.volumes.bind();
      knots_.bindStorageRange(STORAGE_SHADOW_KNOTS, firstKnot_ * sizeof(shared::ShadowKnot),
                              room * sizeof(shared::ShadowKnot));
      counters_.bindStorage(STORAGE_COUNTERS);
      gl::dispatchLinear(writer_, window.cells.cells);
      gl::storageBarrier();
      const auto counted = counters_.readValue<shared::ShadowCounters>();
      const size_t written = counted.knots - counted.unplaced;
      if (written == 0 && counted.unplaced > 0 && room == mostKnots())
        base::fail(
            base::ExitCode::Memory,
            "deep shadow map: one texel has more knots than the {} that this device holds in one block: "
            "remove some surfaces",
            room);
      firstKnot_ = alignedUp(firstKnot_ + written, knotAlignment);
      map.knots += written;
      map.lists.hidden += counted.hidden;
      cutMarches_ += counted.boundHit;
      wanted = counted.unplaced;
    }
  }

  // Of one block.
  size_t mostKnots() const {
    return static_cast<size_t>(device_.limits().storageBlockBytes) / sizeof(shared::ShadowKnot);
  }

  // Makes room for `wanted` knots from firstKnot_ on, or for as many as a block holds. Returns how many there
  // may be.
  size_t reserveKnots(size_t wanted) {
    const size_t needed = firstKnot_ + std::min(wanted, mostKnots());
    if (needed > knots_.bytes() / sizeof(shared::ShadowKnot)) growKnots(needed);
    return std::min(knots_.bytes() / sizeof(shared::ShadowKnot) - firstKnot_, mostKnots());
  }

  void growKnots(size_t knots) {
    const auto readable = static_cast<size_t>(device_.limits().textureBufferTexels);
    if (knots > readable)
      base::fail(base::ExitCode::Memory,
                 "deep shadow maps: more than the {} MiB that this device reads at once: lower --shadow-res",
                 readable * sizeof(shared::ShadowKnot) >> 20);
    // Half as much again, so that many lights do not grow it one by one.
    gl::Buffer grown(device_, "deep shadow knots",
                     std::min(knots * 3 / 2, readable) * sizeof(shared::ShadowKnot),
                     gl::Buffer::Whole::Never);
    grown.copyFrom(knots_, std::min(firstKnot_ * sizeof(shared::ShadowKnot), knots_.bytes()));
    knots_ = std::move(grown);
  }

  // The window's texels and what is done with them; `all`, or those that found no room.
  void useWindow(const FaceWindow& window, bool all) {
    const size_t firstTexel = window.firstTexelOfFace + window.cells.firstCell;
    const size_t bound = firstTexel / texelAlignment * texelAlignment;
    shared::ShadowPassParams params{};
    params.march = {static_cast<float>(inputs_.stepVoxels), static_cast<float>(inputs_.error), 0.f, 0.f};
    params.cells = {static_cast<int>(window.cells.firstCell), static_cast<int>(window.cells.cells), 0,
                    static_cast<int>(firstTexel - bound)};
    params.knots = {static_cast<int>(firstKnot_), all ? 1 : 0, 0, 0};
    passBlock_.writeValue(params);
    passBlock_.bindUniform(UNIFORM_PASS);
    texels_.bindStorageRange(STORAGE_SHADOW_TEXELS, bound * sizeof(shared::ShadowTexel),
                             (firstTexel - bound + window.cells.cells) * sizeof(shared::ShadowTexel));
  }

  gl::Device& device_;
  const MapInputs& inputs_;
  gl::Buffer& texels_;
  gl::Buffer& knots_;
  const gl::Program& opaque_;
  const gl::Program& writer_;
  gl::Buffer viewBlock_;
  gl::Buffer passBlock_;
  gl::Buffer counters_;
  gl::Texture depth_;  // opaque depth of the face that is built
  std::unique_ptr<lists::Lists> lists_;
  size_t listCells_ = 0;
  size_t firstKnot_ = 0;  // of the window that is built
  size_t cutMarches_ = 0;
};

}  // namespace

Maps::Maps(gl::Device& device, const MapInputs& inputs) {
  std::vector<std::vector<FaceProjection>> faces;
  std::vector<shared::ShadowFace> data;
  size_t texels = 0;
  for (const lights::Light& light : inputs.lights) {
    LightMap& map = lightMaps_.emplace_back();
    faces.emplace_back();
    if (!light.castsShadow) continue;
    faces.back() = scene::facesOf(light, inputs.resolution, inputs.receivers, inputs.castingPoints);
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
  // A first guess; the pool grows.
  const size_t knots = inputs.volumes.empty() ? texels / 2 : texels * 5 / 4;
  knots_ =
      gl::Buffer(device, "deep shadow knots", knots * sizeof(shared::ShadowKnot), gl::Buffer::Whole::Never);

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
