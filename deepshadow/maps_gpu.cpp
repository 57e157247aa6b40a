#include "deepshadow/maps_gpu.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "gl/commands.h"
#include "gl/program.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/view.h"

namespace sfumato::deepshadow {

using scene::Layer;

namespace {

size_t texelsOf(const std::vector<FaceProjection>& faces) {
  size_t texels = 0;
  for (const FaceProjection& face : faces)
    texels += static_cast<size_t>(face.side) * static_cast<size_t>(face.side);
  return texels;
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
shared::ViewParams faceView(const FaceProjection& face, size_t firstTexelOfLight) {
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
  view.size = {face.side, face.side, static_cast<int>(firstTexelOfLight), 0};
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
        opaqueDepth_(device.program({"deepshadow/opaque_depth.comp"})),
        translucent_(device.program({"scene/surface.vert", "deepshadow/translucent.frag"})),
        resolve_(device.program({"deepshadow/resolve.comp"})),
        viewBlock_(device, "shadow view", sizeof(shared::ViewParams)),
        passBlock_(device, "shadow pass", sizeof(shared::ShadowPassParams)),
        counters_(device, "shadow counters", sizeof(shared::ShadowCounters)) {
    if (!inputs.volumes.empty())
      smoke_ = &device.program({"deepshadow/smoke.comp"}, inputs.volumes.defines());
    counters_.clear();
  }

  // Builds one light's map into its texels, from number `firstTexel` on.
  void build(const std::vector<FaceProjection>& faces, size_t firstTexel, LightMap& map) {
    shared::ShadowPassParams params{};
    params.march = {static_cast<float>(inputs_.stepMetres), static_cast<float>(inputs_.error), 0.f, 0.f};
    params.range = {static_cast<int>(firstTexel), static_cast<int>(map.texels), 0, 0};
    passBlock_.writeValue(params);
    if (!lists_ || listCells_ != map.texels) {
      lists_.reset();
      lists_.emplace(device_, "deep shadow lists", map.texels, sizeof(shared::ShadowNode),
                     std::max(expectedNodes_, map.texels));
      listCells_ = map.texels;
    }
    drawOpaque(faces);
    {
      const gl::Profiler::Scope time(device_.profiler(), "lists");
      map.lists = lists_->build(device_, [&] { insert(faces); });
    }
    expectedNodes_ = std::max(expectedNodes_, map.lists.capacity);
    {
      const gl::Profiler::Scope time(device_.profiler(), "resolve");
      map.knots = resolve(map.texels);
    }
  }

  size_t cutMarches() const { return counters_.readValue<shared::ShadowCounters>().boundHit; }

 private:
  void useFace(const FaceProjection& face, size_t firstTexelOfLight) {
    viewBlock_.writeValue(faceView(face, firstTexelOfLight));
    viewBlock_.bindUniform(UNIFORM_VIEW);
    passBlock_.bindUniform(UNIFORM_PASS);
  }

  // Opaque depth of every face, kept in a texture each and copied beside the texels.
  void drawOpaque(const std::vector<FaceProjection>& faces) {
    const gl::Profiler::Scope time(device_.profiler(), "opaque depth");
    depths_.resize(faces.size());
    size_t texel = 0;
    for (size_t i = 0; i < faces.size(); ++i) {
      const int side = faces[i].side;
      if (depths_[i].size().x != side)
        depths_[i] = gl::Texture(device_, "shadow opaque depth",
                                 {.format = gl::Format::R32F, .size = {side, side, 1}});
      const gl::Texture* colour = &depths_[i];
      const gl::Framebuffer target({&colour, 1}, nullptr);
      target.clearColour(0, glm::vec4(static_cast<float>(NOTHING_OPAQUE)));
      useFace(faces[i], texel);
      gl::setDrawState({.program = &opaque_,
                        .target = &target,
                        .viewport = {0, 0, side, side},
                        .depthClamp = true,
                        .blend = gl::Blend::Minimum});
      inputs_.geometry.draw(Layer::Opaque, false);
      depths_[i].bind(TEXTURE_OPAQUE_DEPTH);
      texels_.bindStorage(STORAGE_SHADOW_TEXELS);
      const unsigned groups = gl::groupsFor(static_cast<size_t>(side), 8);
      gl::dispatch(opaqueDepth_, {groups, groups, 1});
      texel += static_cast<size_t>(side) * static_cast<size_t>(side);
    }
  }

  // Surfaces and smoke of every face into the lists.
  void insert(const std::vector<FaceProjection>& faces) {
    counters_.bindStorage(STORAGE_COUNTERS);
    inputs_.volumes.bind();
    size_t texel = 0;
    for (size_t i = 0; i < faces.size(); ++i) {
      const int side = faces[i].side;
      useFace(faces[i], texel);
      depths_[i].bind(TEXTURE_OPAQUE_DEPTH);
      if (inputs_.geometry.has(Layer::Translucent)) {
        const gl::Framebuffer noTarget({side, side});
        gl::setDrawState({.program = &translucent_,
                          .target = &noTarget,
                          .viewport = {0, 0, side, side},
                          .depthClamp = true});
        inputs_.geometry.draw(Layer::Translucent, false);
        gl::storageBarrier();
      }
      if (smoke_) {
        const unsigned groups = gl::groupsFor(static_cast<size_t>(side), 8);
        gl::dispatch(*smoke_, {groups, groups, 1});
      }
      texel += static_cast<size_t>(side) * static_cast<size_t>(side);
    }
  }

  // Lists to knots; the pool of knots grows when it is full and the resolve runs again. Returns the light's
  // knots.
  size_t resolve(size_t texels) {
    const size_t before = knotsUsed_;
    for (;;) {
      auto counters = counters_.readValue<shared::ShadowCounters>();
      counters.knots = static_cast<uint32_t>(before);
      counters_.writeValue(counters);
      passBlock_.bindUniform(UNIFORM_PASS);
      lists_->bindForBuilding();
      texels_.bindStorage(STORAGE_SHADOW_TEXELS);
      knots_.bindStorage(STORAGE_SHADOW_KNOTS);
      counters_.bindStorage(STORAGE_COUNTERS);
      gl::dispatchLinear(resolve_, texels);
      gl::storageBarrier();
      knotsUsed_ = counters_.readValue<shared::ShadowCounters>().knots;
      if (knotsUsed_ * sizeof(shared::ShadowKnot) <= knots_.bytes()) return knotsUsed_ - before;
      // Half as much again where that is allowed, so that many lights do not grow it one by one.
      const size_t limit = static_cast<size_t>(device_.limits().storageBlockBytes);
      const size_t needed = knotsUsed_ * sizeof(shared::ShadowKnot);
      gl::Buffer grown(device_, "deep shadow knots", std::max(needed, std::min(needed + needed / 2, limit)));
      grown.copyFrom(knots_, before * sizeof(shared::ShadowKnot));
      knots_ = std::move(grown);
    }
  }

  gl::Device& device_;
  const MapInputs& inputs_;
  gl::Buffer& texels_;
  gl::Buffer& knots_;
  const gl::Program& opaque_;
  const gl::Program& opaqueDepth_;
  const gl::Program& translucent_;
  const gl::Program& resolve_;
  const gl::Program* smoke_ = nullptr;  // none without media
  gl::Buffer viewBlock_;
  gl::Buffer passBlock_;
  gl::Buffer counters_;
  std::vector<gl::Texture> depths_;  // one a face
  std::optional<lists::Lists> lists_;
  size_t listCells_ = 0;
  size_t expectedNodes_ = 0;
  size_t knotsUsed_ = 0;
};

}  // namespace

Maps::Maps(gl::Device& device, const MapInputs& inputs) {
  std::vector<std::vector<FaceProjection>> faces;
  std::vector<shared::ShadowFace> data;
  size_t texels = 0;
  for (const scene::Light& light : inputs.lights) {
    LightMap& map = lightMaps_.emplace_back();
    faces.emplace_back();
    if (!light.castsShadow) continue;
    faces.back() = shadowFaces(light, inputs.resolution, inputs.receivers, inputs.casters);
    map.firstFace = static_cast<int>(data.size());
    map.faces = static_cast<int>(faces.back().size());
    map.texels = texelsOf(faces.back());
    for (const FaceProjection& face : faces.back()) {
      data.push_back(faceData(face, texels));
      texels += static_cast<size_t>(face.side) * static_cast<size_t>(face.side);
    }
  }
  faces_ = gl::Buffer(device, "shadow faces", std::span<const shared::ShadowFace>(data));
  texels_ = gl::Buffer(device, "deep shadow texels", texels * sizeof(shared::ShadowTexel));
  knots_ = gl::Buffer(device, "deep shadow knots", texels * sizeof(shared::ShadowKnot));

  Builder builder(device, inputs, texels_, knots_);
  size_t firstTexel = 0;
  for (size_t i = 0; i < lightMaps_.size(); ++i) {
    if (lightMaps_[i].firstFace < 0) continue;
    builder.build(faces[i], firstTexel, lightMaps_[i]);
    firstTexel += lightMaps_[i].texels;
  }
  cutMarches_ = builder.cutMarches();
}

void Maps::bind() const {
  faces_.bindStorage(STORAGE_SHADOW_FACES);
  texels_.bindStorage(STORAGE_SHADOW_TEXELS);
  knots_.bindStorage(STORAGE_SHADOW_KNOTS);
}

}  // namespace sfumato::deepshadow
