#include "deepshadow/maps_gpu.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "gl/commands.h"
#include "gl/program.h"
#include "lights/light_reach.h"
#include "scene/light_faces.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/view.h"

namespace sfumato::deepshadow {

namespace {

// Parts of a buffer that are bound alone start at multiples of 256 bytes.
constexpr size_t unitBytes = sizeof(shared::ShadowKnot);  // of the pool of knots
constexpr size_t unitAlignment = 256 / unitBytes;
constexpr size_t knotsInUnit = 4;  // at most
constexpr size_t texelAlignment = 64;
constexpr auto texelsLabel = "deep shadow texels";
constexpr auto poolLabel = "deep shadow knots";

size_t alignedUp(size_t count, size_t alignment) {
  return (count + alignment - 1) / alignment * alignment;
}

size_t squared(int side) {
  return static_cast<size_t>(side) * static_cast<size_t>(side);
}

// Those of surfaces.
size_t texelsOf(const FaceProjection& face) {
  return squared(face.surfaceSide());
}

size_t allTexelsOf(const FaceProjection& face) {
  return texelsOf(face) + squared(face.smokeSide);
}

// A face, and where its texels go.
struct PlacedFace {
  const FaceProjection& face;
  LightMap* map = nullptr;
  size_t firstTexel = 0;
};

// Those that stackedFaces() puts together; the first one's texels are the first cells of their lists.
using Stack = std::span<const PlacedFace>;

// The cells of a stack's face, by its number.
lists::Window cellsOf(Stack stack, size_t number) {
  const size_t texels = texelsOf(stack.front().face);
  return {number * texels, texels};
}

lists::Window intersection(const lists::Window& a, const lists::Window& b) {
  const size_t first = std::max(a.firstCell, b.firstCell);
  const size_t end = std::min(a.firstCell + a.cells, b.firstCell + b.cells);
  return {first, end > first ? end - first : 0};
}

// Where in the stack a face is drawn: x, y, width, height.
glm::ivec4 areaOf(Stack stack, size_t number) {
  const int side = stack.front().face.surfaceSide();
  return {0, static_cast<int>(number) * side, side, side};
}

// Rows that hold some cells: what a scissor lets through.
glm::ivec4 rowsOf(const lists::Window& window, int side) {
  const auto width = static_cast<size_t>(side);
  const size_t first = window.firstCell / width;
  const size_t last = (window.firstCell + window.cells - 1) / width;
  return {0, static_cast<int>(first), side, static_cast<int>(last - first + 1)};
}

// Everything that building the maps needs and that goes with it.
class Builder {
 public:
  // Writes `texels` and the pool of `knots`, which grows as long as it takes `mostUnits` at the most.
  Builder(gl::Device& device, const MapInputs& inputs, double error, gl::Buffer& texels, gl::Buffer& knots,
          size_t mostUnits)
      : device_(device),
        inputs_(inputs),
        error_(error),
        texels_(texels),
        knots_(knots),
        mostUnits_(mostUnits),
        opaque_(device.program({"scene/surface.vert", "deepshadow/opaque.frag"}, inputs.casters.defines)),
        surfaceWriter_(device.program({"deepshadow/surface_knots.comp"}, surfaceDefines(inputs.casters))),
        smokeWriter_(inputs.volumes.empty()
                         ? nullptr
                         : &device.program({"deepshadow/smoke_knots.comp"}, inputs.volumes.defines())),
        viewBlock_(device, "shadow view", sizeof(shared::ViewParams)),
        passBlock_(device, "shadow pass", sizeof(shared::ShadowPassParams)),
        counters_(device, "shadow counters", sizeof(shared::ShadowCounters)) {}

  // Builds the faces of a stack into their texels. Where it is larger, in windows, so that the lists take the
  // same memory at any resolution. False when the pool has no room for it.
  bool build(Stack stack) {
    bool fits = true;
    draw(stack, [&](const lists::Window& window) {
      forFaces(stack, window, [&](size_t number, const lists::Window& cells) {
        LightMap& map = *stack[number].map;
        if (inputs_.casters.listed)
          map.nodes += lists_->nodesOf({cells.firstCell - window.firstCell, cells.cells});
        fits = fits && writeKnots({stack, number, cells, window.firstCell}, map);
      });
    });
    for (size_t number = 0; number < stack.size(); ++number) {
      LightMap& map = *stack[number].map;
      forSmoke(stack[number].face, [&](const lists::Window& cells) {
        const size_t before = map.knotBytes;
        fits = fits && writeKnots({stack, number, cells, 0, true}, map);
        map.smokeKnots += (map.knotBytes - before) / unitBytes * knotsInUnit;
      });
    }
    return fits;
  }

  struct Units {
    size_t surfaces = 0;
    size_t smoke = 0;
  };

  // Units that the knots of a face take. Its texels are those of `texels` from the first on, and useless.
  Units count(const FaceProjection& face) {
    const size_t room = knots_.bytes() / unitBytes;
    const PlacedFace placed{face};
    const Stack stack(&placed, 1);
    Units units;
    draw(stack, [&](const lists::Window& window) {
      units.surfaces += write({stack, 0, window, window.firstCell}, SHADOW_ALL, room).units;
    });
    forSmoke(face, [&](const lists::Window& window) {
      units.smoke += write({stack, 0, window, 0, true}, SHADOW_ALL, room).units;
    });
    return units;
  }

  size_t cutMarches() const { return cutMarches_; }
  const lists::ListStatistics& lists() const { return listStatistics_; }

  // For comparisons: all faces, one after the other, into linked lists.
  void link(std::span<const std::vector<FaceProjection>> facesOfLights, lists::Lists& lists) {
    const auto forEachFace = [&](const auto& use) {
      for (const std::vector<FaceProjection>& ofLight : facesOfLights) {
        for (const FaceProjection& face : ofLight) {
          use(face);
          firstCell_ += texelsOf(face);
        }
      }
      firstCell_ = 0;
    };
    lists.buildLinked(device_, 0, [&](const lists::Pass& pass) {
      forEachFace([&](const FaceProjection& face) { linkSurfaces(face, pass); });
      gl::storageBarrier();
      if (!inputs_.volumes.empty()) forEachFace([&](const FaceProjection& face) { linkSmoke(face, pass); });
    });
    lists.bindLinked(TEXTURE_LIST_RUNS, TEXTURE_SHADOW_KNOTS, TEXTURE_LIST_PAYLOADS);
    forEachFace([&](const FaceProjection& face) {
      useFace(face);
      lists.heads().bindStorage(STORAGE_LIST_HEADS);
      texels_.bindStorage(STORAGE_SHADOW_TEXELS);
      gl::dispatchLinear(device_.program({"deepshadow/linked_texels.comp"}), texelsOf(face));
    });
    gl::storageBarrier();
  }

 private:
  // Texels of a face whose knots are written.
  struct FaceWindow {
    Stack stack;
    size_t number;        // of the face in it
    lists::Window cells;  // of the stack, or of the face's smoke
    size_t firstRun;      // cell of the stack that the first of the runs is of
    bool ofSmoke = false;

    const FaceProjection& face() const { return stack[number].face; }
    // Of the first cell.
    size_t firstTexel() const {
      const size_t ofFace = stack[number].firstTexel;
      return ofSmoke ? ofFace + texelsOf(face()) + cells.firstCell
                     : ofFace + cells.firstCell - cellsOf(stack, number).firstCell;
    }
  };

  static gl::ShaderDefines surfaceDefines(const Casters& casters) {
    gl::ShaderDefines defines;
    if (casters.listed) defines.emplace_back("SURFACES", "1");
    if (casters.once) defines.emplace_back("SHADOW_ONCE_OBJECTS", "1");
    if (casters.notSelf) defines.emplace_back("SHADOW_NOT_SELF_OBJECTS", "1");
    return defines;
  }

  // The opaque depth of a stack, then its lists window by window, for `consume`.
  void draw(Stack stack, const std::function<void(const lists::Window&)>& consume) {
    drawOpaque(stack);
    const size_t cells = stack.size() * texelsOf(stack.front().face);
    if (!inputs_.casters.listed) return forWindows(cells, consume);
    prepareLists(cells);
    listStatistics_ += lists_->buildWindows(
        device_, [&](const lists::Pass& pass) { store(stack, pass); }, consume, windowTexels);
  }

  // use(number, cells) for each face that has cells in a window of the stack, which are these.
  static void forFaces(Stack stack, const lists::Window& window,
                       const std::function<void(size_t, const lists::Window&)>& use) {
    for (size_t number = 0; number < stack.size(); ++number) {
      const lists::Window cells = intersection(cellsOf(stack, number), window);
      if (cells.cells > 0) use(number, cells);
    }
  }

  static void forWindows(size_t texels, const std::function<void(const lists::Window&)>& consume) {
    for (size_t first = 0; first < texels; first += windowTexels)
      consume({first, std::min(windowTexels, texels - first)});
  }

  // The texels of smoke of the face whose opaque depth was drawn last.
  static void forSmoke(const FaceProjection& face, const std::function<void(const lists::Window&)>& consume) {
    forWindows(squared(face.smokeSide), consume);
  }

  void useFace(const FaceProjection& face) { useFace(face, face.surfaceSide()); }

  void useFace(const FaceProjection& face, int side) {
    shared::ViewParams view = faceView(face, side);
    view.size.z = static_cast<int>(firstCell_);
    viewBlock_.writeValue(view);
    viewBlock_.bindUniform(UNIFORM_VIEW);
  }

  // Opaque depth of a stack, kept for the passes that follow.
  void drawOpaque(Stack stack) {
    const gl::Profiler::Scope time(device_.profiler(), "opaque depth");
    const int side = stack.front().face.surfaceSide();
    const int lines = side * static_cast<int>(stack.size());
    if (depth_.size().x != side || depth_.size().y < lines)
      depth_ =
          gl::Texture(device_, "shadow opaque depth", {.format = gl::Format::R32F, .size = {side, lines, 1}});
    const gl::Texture* colour = &depth_;
    const gl::Framebuffer target({&colour, 1}, nullptr);
    target.clearColour(0, glm::vec4(static_cast<float>(NOTHING_OPAQUE)));
    if (!inputs_.casters.opaque) return;
    for (size_t number = 0; number < stack.size(); ++number) {
      useFace(stack[number].face);
      gl::setDrawState({.program = &opaque_,
                        .target = &target,
                        .viewport = areaOf(stack, number),
                        .scissor = areaOf(stack, number),
                        .depthClamp = true,
                        .blend = gl::Blend::Minimum});
      inputs_.casters.opaque();
      gl::flush();  // it is drawn while the next one is prepared
    }
  }

  void prepareLists(size_t cells) {
    if (!lists_)
      lists_.emplace(device_, "deep shadow lists", cells, sizeof(shared::ShadowNode), inputs_.lists);
    lists_->setCells(cells);
  }

  // The surfaces of a stack into the lists.
  void store(Stack stack, const lists::Pass& pass) {
    depth_.bind(TEXTURE_OPAQUE_DEPTH);
    const int side = stack.front().face.surfaceSide();
    const gl::Framebuffer noTarget({side, side * static_cast<int>(stack.size())});
    forFaces(stack, pass.window, [&](size_t number, const lists::Window& cells) {
      useFace(stack[number].face);
      gl::setDrawState({.program = &device_.program({"scene/surface.vert", "deepshadow/listed.frag"},
                                                    gl::joined(inputs_.casters.defines, pass.defines)),
                        .target = &noTarget,
                        .viewport = areaOf(stack, number),
                        .scissor = rowsOf(cells, side),
                        .depthClamp = true});
      inputs_.casters.listed();
      gl::flush();
    });
  }

  // The surfaces of a face into linked lists.
  void linkSurfaces(const FaceProjection& face, const lists::Pass& pass) {
    useFace(face);
    const gl::Framebuffer noTarget({face.side, face.side});
    const auto draw = [&](const std::function<void()>& casters, const gl::ShaderDefines& more) {
      const gl::ShaderDefines defines = gl::joined(gl::joined(inputs_.casters.defines, pass.defines), more);
      gl::setDrawState(
          {.program = &device_.program({"scene/surface.vert", "deepshadow/linked_surface.frag"}, defines),
           .target = &noTarget,
           .viewport = {0, 0, face.side, face.side},
           .depthClamp = true});
      casters();
    };
    if (inputs_.casters.opaque) draw(inputs_.casters.opaque, {{"OPAQUE", "1"}});
    if (inputs_.casters.listed) draw(inputs_.casters.listed, {});
  }

  // The smoke of a face into linked lists.
  void linkSmoke(const FaceProjection& face, const lists::Pass& pass) {
    useFace(face);
    shared::ShadowPassParams params{};
    params.march.x = static_cast<float>(inputs_.stepVoxels);
    params.units.x = inputs_.linkedSmokeNodes;
    passBlock_.writeValue(params);
    passBlock_.bindUniform(UNIFORM_PASS);
    inputs_.volumes.bind();
    gl::dispatchLinear(device_.program({"deepshadow/linked_smoke.comp"},
                                       gl::joined(inputs_.volumes.defines(), pass.defines)),
                       texelsOf(face));
    gl::storageBarrier();
  }

  // The knots of a window, from firstUnit_ on. Texels that find no room in the pool are written again when it
  // has grown, or behind the block that is full. False when it cannot grow.
  bool writeKnots(const FaceWindow& window, LightMap& map) {
    size_t wanted = 1;
    for (int which = SHADOW_ALL; wanted > 0; which = SHADOW_UNPLACED) {
      const size_t room = reserveUnits(wanted);
      if (room == 0) return false;
      const shared::ShadowCounters counted = write(window, which, room);
      const size_t written = counted.units - counted.unplaced;
      if (written == 0 && counted.unplaced > 0 && room == unitsOfBlock())
        base::fail(base::ExitCode::Memory,
                   "deep shadow map: one texel has more knots than the {} that this device holds in one "
                   "block: remove some surfaces",
                   room);
      if (map.units == 0) map.firstUnit = firstUnit_;
      firstUnit_ = alignedUp(firstUnit_ + written, unitAlignment);
      map.units = firstUnit_ - map.firstUnit;
      map.knotBytes += written * unitBytes;
      map.hidden += counted.hidden;
      listStatistics_.hidden += counted.hidden;
      cutMarches_ += counted.boundHit;
      wanted = counted.unplaced;
    }
    return true;
  }

  // Writes the knots of a window's texels, `which` of them (SHADOW_*), into `room` units from firstUnit_ on.
  shared::ShadowCounters write(const FaceWindow& window, int which, size_t room) {
    const gl::Profiler::Scope time(device_.profiler(), window.ofSmoke ? "smoke" : "knots");
    counters_.clear();
    useFace(window.face(), window.ofSmoke ? window.face().smokeSide : window.face().surfaceSide());
    useWindow(window, which);
    depth_.bind(TEXTURE_OPAQUE_DEPTH);
    if (window.ofSmoke)
      inputs_.volumes.bind();
    else if (inputs_.casters.listed)
      lists_->bind(TEXTURE_LIST_RUNS, TEXTURE_LIST_KEYS, TEXTURE_LIST_PAYLOADS);
    knots_.bindStorageRange(STORAGE_SHADOW_KNOTS, firstUnit_ * unitBytes, room * unitBytes);
    counters_.bindStorage(STORAGE_COUNTERS);
    for (;;) {
      gl::dispatchLinear(window.ofSmoke ? *smokeWriter_ : surfaceWriter_, window.cells.cells);
      gl::storageBarrier();
      auto counted = counters_.readValue<shared::ShadowCounters>();
      if (counted.unfinished == 0) return counted;
      counted.unfinished = 0;
      counters_.writeValue(counted);
      useWindow(window, SHADOW_UNFINISHED);
    }
  }

  size_t unitsOfBlock() const { return static_cast<size_t>(device_.limits().storageBlockBytes) / unitBytes; }

  // Makes room for `wanted` units from firstUnit_ on, or for as many as a block holds. Returns how many there
  // may be, 0 when the pool may not grow to that.
  size_t reserveUnits(size_t wanted) {
    const size_t needed = firstUnit_ + std::min(wanted, unitsOfBlock());
    if (needed > knots_.bytes() / unitBytes && !growPool(needed)) return 0;
    return std::min(knots_.bytes() / unitBytes - firstUnit_, unitsOfBlock());
  }

  bool growPool(size_t units) {
    const size_t held = knots_.bytes() / unitBytes;  // while it is copied, both are there
    if (units + held > mostUnits_) return false;
    // Half as much again, so that many lights do not grow it one by one.
    gl::Buffer grown(device_, poolLabel, std::min(units * 3 / 2, mostUnits_ - held) * unitBytes,
                     gl::Buffer::Whole::Never);
    grown.copyFrom(knots_, std::min(firstUnit_ * unitBytes, knots_.bytes()));
    knots_ = std::move(grown);
    return true;
  }

  // The window's texels, and which of them are written.
  void useWindow(const FaceWindow& window, int which) {
    const size_t firstTexel = window.firstTexel();
    const size_t bound = firstTexel / texelAlignment * texelAlignment;
    shared::ShadowPassParams params{};
    params.march = {static_cast<float>(inputs_.stepVoxels), static_cast<float>(error_), 0.f, 0.f};
    params.cells = {static_cast<int>(window.cells.firstCell), static_cast<int>(window.cells.cells),
                    static_cast<int>(window.cells.firstCell - window.firstRun),
                    static_cast<int>(firstTexel - bound)};
    params.units = {static_cast<int>(firstUnit_), which, areaOf(window.stack, window.number).y, 0};
    passBlock_.writeValue(params);
    passBlock_.bindUniform(UNIFORM_PASS);
    texels_.bindStorageRange(STORAGE_SHADOW_TEXELS, bound * sizeof(shared::ShadowTexel),
                             (firstTexel - bound + window.cells.cells) * sizeof(shared::ShadowTexel));
  }

  gl::Device& device_;
  const MapInputs& inputs_;
  const double error_;
  gl::Buffer& texels_;
  gl::Buffer& knots_;
  const size_t mostUnits_;
  const gl::Program& opaque_;
  const gl::Program& surfaceWriter_;
  const gl::Program* smokeWriter_;  // where there are media
  gl::Buffer viewBlock_;
  gl::Buffer passBlock_;
  gl::Buffer counters_;
  gl::Texture depth_;  // opaque depth of the stack that is built
  std::optional<lists::Lists> lists_;
  size_t firstUnit_ = 0;  // of the window that is built
  size_t cutMarches_ = 0;
  lists::ListStatistics listStatistics_;
  size_t firstCell_ = 0;  // of the face, among the cells of linked lists
};

// What the knots of a texel usually take, or somewhat more: where the maps fit with that, nobody counts.
size_t usualUnits(const MapInputs& inputs) {
  return 2 + (inputs.casters.listed ? 4 : 0);
}

// The same of a texel of smoke. Smooth smoke has knots as 1 / sqrt(error).
size_t usualSmokeUnits(double error) {
  return 2 + static_cast<size_t>(error > 0 ? 0.75 / std::sqrt(error) : 256);
}

// Units of the knots of all `faces`: those of faces with an eighth of the side, times as many as there are.
size_t countUnits(gl::Device& device, const MapInputs& inputs, double error,
                  std::span<const std::vector<FaceProjection>> facesOfLights) {
  constexpr int reduction = 8;
  constexpr int leastSide = 16;
  const auto ratio = [](int all, int reduced) {
    return reduced > 0 ? static_cast<double>(squared(all)) / static_cast<double>(squared(reduced)) : 0;
  };
  size_t mostTexels = 0;
  for (const std::vector<FaceProjection>& faces : facesOfLights)
    for (const FaceProjection& face : faces) mostTexels = std::max(mostTexels, texelsOf(face));
  gl::Buffer texels(device, texelsLabel, mostTexels * sizeof(shared::ShadowTexel), gl::Buffer::Whole::Never);
  gl::Buffer noPool(device, poolLabel, unitAlignment * unitBytes);
  Builder builder(device, inputs, error, texels, noPool, 0);
  double units = 0;
  for (const std::vector<FaceProjection>& faces : facesOfLights) {
    for (const FaceProjection& face : faces) {
      FaceProjection reduced = face;
      reduced.side = std::min(face.side, faceSide(face.side / reduction));
      reduced.smokeSide = std::min(face.smokeSide, std::max(face.smokeSide / reduction, leastSide));
      const Builder::Units counted = builder.count(reduced);
      units += static_cast<double>(counted.surfaces) * ratio(face.surfaceSide(), reduced.surfaceSide()) +
               static_cast<double>(counted.smoke) * ratio(face.smokeSide, reduced.smokeSide);
    }
  }
  return static_cast<size_t>(units);
}

// The buffer that is there, where it has so many bytes and no more than `most`, or a new one.
void provide(gl::Device& device, gl::Buffer& buffer, const char* label, size_t bytes, size_t most) {
  if (buffer.bytes() >= bytes && buffer.bytes() <= most) return;
  buffer = gl::Buffer();  // the old one goes before the new one comes
  buffer = gl::Buffer(device, label, bytes, gl::Buffer::Whole::Never);
}

size_t smokeTexelsOf(const std::vector<LightMap>& maps) {
  size_t sum = 0;
  for (const LightMap& map : maps) sum += map.smokeTexels;
  return sum;
}

}  // namespace

Maps::Maps(gl::Device& device, const MapInputs& inputs, Maps former)
    : plan_(inputs.plan),
      texels_(std::move(former.texels_)),
      knots_(std::move(former.knots_)),
      linked_(std::move(former.linked_)) {
  const auto readable = static_cast<size_t>(device.limits().textureBufferTexels);
  budgetBytes_ = inputs.budget.bytes != 0 ? inputs.budget.bytes : readable * unitBytes;
  const auto excessOf = [&](size_t texels, size_t units) {
    const auto bytes = static_cast<double>(texels * sizeof(shared::ShadowTexel) + units * unitBytes);
    return std::max(bytes / static_cast<double>(budgetBytes_),
                    static_cast<double>(std::max(texels, units)) / static_cast<double>(readable));
  };
  if (inputs.linkedSmokeNodes > 0) {
    knots_ = gl::Buffer();
    buildLinked(device, inputs, arrange(inputs));
    return;
  }
  linked_.reset();
  for (bool counting = false;;) {
    const size_t texels = arrange(inputs);
    const size_t smokeTexels = smokeTexelsOf(lightMaps_);
    double excess = excessOf(texels, 0);
    const size_t usual =
        (texels - smokeTexels) * usualUnits(inputs) + smokeTexels * usualSmokeUnits(plan_.error);
    counting = counting || excessOf(texels, usual) > 1;
    size_t units = 0;
    if (excess <= 1 && counting) {
      units = countUnits(device, inputs, plan_.error, projections_);
      excess = excessOf(texels, units);
      predictedBytes_ = texels * sizeof(shared::ShadowTexel) + units * unitBytes;
    }
    if (excess <= 1) {
      if (tryBuild(device, inputs, texels, units)) break;
      if (!counting) {
        counting = true;
        continue;
      }
    }
    constexpr double margin = 1.05;  // for what was counted at fewer texels
    const auto next = coarser(plan_, inputs.plan, inputs.budget, margin * std::max(excess, 1.0));
    if (!next) failOverBudget("deep shadow maps", excess, budgetBytes_);
    plan_ = *next;
    lowered_ = true;
  }
  texelsView_ = gl::BufferTexture(device, texels_, gl::BufferFormat::RGB32UI);
  knotsView_ = gl::BufferTexture(device, knots_, gl::BufferFormat::RGBA32UI);
}

// The faces of all lights, and where their texels stand. Returns how many there are.
size_t Maps::arrange(const MapInputs& inputs) {
  lightMaps_.clear();
  projections_.clear();
  size_t texels = 0;
  int faces = 0;
  std::vector<glm::dmat4> boxes;
  for (const volumes::MediumExtent& medium : inputs.volumes.extents()) boxes.push_back(medium.worldFromUnit);
  for (size_t i = 0; i < inputs.lights.size(); ++i) {
    LightMap& map = lightMaps_.emplace_back();
    projections_.emplace_back();
    if (!inputs.lights[i].castsShadow || plan_.resolutions[i] == 0) continue;
    projections_.back() =
        scene::facesOf(inputs.lights[i], plan_.resolutions[i], inputs.receivers, inputs.castingPoints);
    map.resolution = plan_.resolutions[i];
    map.firstFace = faces;
    map.faces = static_cast<int>(projections_.back().size());
    map.firstTexel = texels;
    const int smokeSide = smokeSideOf(inputs, i);
    for (FaceProjection& face : projections_.back()) {
      face.casters = inputs.casters.any() || inputs.linkedSmokeNodes > 0;
      face.smokeSide = smokeSide;
      face.smoke = smokePart(face, boxes);
      map.texels += texelsOf(face);
      map.smokeTexels += squared(smokeSide);
    }
    faces += map.faces;
    texels += map.texels + map.smokeTexels;
  }
  return texels;
}

// The same for all faces of a light, so that lookups find one from the other. Where the plan is coarser than
// what was asked for, smoke is as much coarser.
int Maps::smokeSideOf(const MapInputs& inputs, size_t light) const {
  if (inputs.linkedSmokeNodes > 0) return 0;
  const double lowered =
      static_cast<double>(plan_.resolutions[light]) / static_cast<double>(inputs.plan.resolutions[light]);
  const double reach = lights::reach(inputs.lights[light]);
  int side = 0;
  for (const FaceProjection& face : projections_[light])
    for (const volumes::MediumExtent& medium : inputs.volumes.extents())
      side = std::max(
          side, smokeSide(face, medium.worldFromUnit, inputs.stepVoxels * medium.voxel / lowered, reach));
  return side;
}

void Maps::provideTexels(gl::Device& device, size_t texels) {
  const size_t bytes = texels * sizeof(shared::ShadowTexel);
  provide(device, texels_, texelsLabel, bytes, std::max(bytes, std::min(bytes + bytes / 4, budgetBytes_)));
}

// `units`: what the pool takes by count, 0 where nobody counted. False when it takes more than the budget.
bool Maps::tryBuild(gl::Device& device, const MapInputs& inputs, size_t texels, size_t units) {
  provideTexels(device, texels);
  const size_t mostUnits = std::min((budgetBytes_ - std::min(texels_.bytes(), budgetBytes_)) / unitBytes,
                                    static_cast<size_t>(device.limits().textureBufferTexels));
  const size_t smokeTexels = smokeTexelsOf(lightMaps_);
  const size_t guess = (texels - smokeTexels) / 4 + smokeTexels * 3 / 4;  // the pool grows
  const size_t firstUnits = units != 0 ? units + units / 10 + (1 << 12) : guess;
  provide(device, knots_, poolLabel, std::min(firstUnits, mostUnits) * unitBytes, mostUnits * unitBytes);
  Builder builder(device, inputs, plan_.error, texels_, knots_, mostUnits);
  std::vector<PlacedFace> placed;
  std::vector<const FaceProjection*> faces;
  for (size_t i = 0; i < lightMaps_.size(); ++i) {
    size_t firstTexel = lightMaps_[i].firstTexel;
    for (const FaceProjection& face : projections_[i]) {
      placed.push_back({face, &lightMaps_[i], firstTexel});
      faces.push_back(&face);
      firstTexel += allTexelsOf(face);
    }
  }
  for (size_t first = 0; first < faces.size();) {
    const size_t count = stackedFaces(std::span(faces).subspan(first));
    if (!builder.build(Stack(placed).subspan(first, count))) return false;
    first += count;
  }
  uploadFaces(device);
  lists_ = builder.lists();
  cutMarches_ = builder.cutMarches();
  return true;
}

void Maps::uploadFaces(gl::Device& device) {
  std::vector<shared::ShadowFace> faces;
  for (size_t i = 0; i < lightMaps_.size(); ++i) {
    size_t firstTexel = lightMaps_[i].firstTexel;
    for (const FaceProjection& face : projections_[i]) {
      faces.push_back(faceData(face, firstTexel));
      firstTexel += allTexelsOf(face);
    }
  }
  faces_ = gl::Records(device, "shadow faces", std::span<const shared::ShadowFace>(faces));
}

void Maps::buildLinked(gl::Device& device, const MapInputs& inputs, size_t texels) {
  provideTexels(device, texels);
  if (!linked_ || linked_->cells() != texels)
    linked_.emplace(device, "linked shadow lists", texels, sizeof(shared::ShadowNode),
                    lists::ListOptions{.strategy = lists::Strategy::SpinLock});
  Builder(device, inputs, plan_.error, texels_, knots_, 0).link(projections_, *linked_);
  uploadFaces(device);
  texelsView_ = gl::BufferTexture(device, texels_, gl::BufferFormat::RGB32UI);
}

size_t Maps::bytes() const {
  size_t sum = 0;
  for (const LightMap& map : lightMaps_)
    sum += (map.texels + map.smokeTexels) * sizeof(shared::ShadowTexel) + map.knotBytes;
  return sum;
}

size_t Maps::knotsAtMost(size_t light) const {
  const LightMap& map = lightMaps_[light];
  size_t texelsAround = 0;  // of surfaces, that a texel of smoke is looked up from
  for (const FaceProjection& face : projections_[light])
    if (face.smokeSide > 0) texelsAround = squared(2 * (face.side / face.smokeSide + 1));
  return knotsInUnit * (map.knotBytes / unitBytes) + texelsAround * map.smokeKnots;
}

ReadMap Maps::read(size_t light) const {
  const LightMap& map = lightMaps_[light];
  std::vector<shared::ShadowTexel> texels(map.texels + map.smokeTexels);
  std::vector<glm::uvec4> units(map.units);
  texels_.read(std::as_writable_bytes(std::span(texels)), map.firstTexel * sizeof(shared::ShadowTexel));
  knots_.read(std::as_writable_bytes(std::span(units)), map.firstUnit * unitBytes);
  ReadMap result;
  size_t first = 0;
  for (const FaceProjection& face : projections_[light]) {
    const auto own = std::span(texels).subspan(first, texelsOf(face));
    const auto smoke = std::span(texels).subspan(first + texelsOf(face), squared(face.smokeSide));
    appendJoined(face, decoded(own, units, map.firstUnit, Knotted::Surfaces),
                 decoded(smoke, units, map.firstUnit, Knotted::Smoke), result);
    first += allTexelsOf(face);
  }
  return result;
}

void Maps::bind() const {
  faces_.bind(TEXTURE_SHADOW_FACES);
  if (linked_) {
    linked_->bindLinked(TEXTURE_SHADOW_TEXELS, TEXTURE_SHADOW_KNOTS, TEXTURE_SHADOW_NODES);
    texelsView_.bind(TEXTURE_SHADOW_TEXELS);
    return;
  }
  texelsView_.bind(TEXTURE_SHADOW_TEXELS);
  knotsView_.bind(TEXTURE_SHADOW_KNOTS);
}

}  // namespace sfumato::deepshadow
