#include "deepshadow/interlaced_maps_gpu.h"

#include <algorithm>
#include <array>

#include "gl/commands.h"
#include "gl/program.h"
#include "scene/light_faces.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/view.h"

namespace sfumato::deepshadow {

using glm::ivec2;

namespace {

gl::ShaderDefines definesOf(const InterlacedInputs& inputs) {
  gl::ShaderDefines defines = inputs.casters.defines;
  if (inputs.kind != InterlacedKind::Opaque) defines.emplace_back("TRANSLUCENT", "1");
  if (inputs.kind == InterlacedKind::Thesis) defines.emplace_back("THESIS_FILTER", "1");
  return defines;
}

gl::Format filterFormat(InterlacedKind kind) {
  return kind == InterlacedKind::Thesis ? gl::Format::RGBA8 : gl::Format::RGB10A2;
}

glm::vec3 colourOf(const lights::Light& light) {
  const double brightest = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
  return brightest > 0 ? light.intensity / brightest : glm::dvec3(0);
}

int mostLines(const gl::Device& device) {
  return std::min(device.limits().texture2dSize, device.limits().framebufferSize);
}

size_t texelBytes(InterlacedKind kind) {
  return kind == InterlacedKind::Opaque ? 8 : 12;
}

bool hasMap(const InterlacedInputs& inputs, size_t light) {
  return inputs.lights[light].castsShadow && inputs.resolutions[light] > 0;
}

// Where faces stand in the textures: those of a light one above the other, lights above each other as long as
// the textures may be that high, then beside.
class Stacks {
 public:
  explicit Stacks(const gl::Device& device) : mostLines_(mostLines(device)) {}

  // The corner of the first of a light's faces.
  ivec2 place(int faces, int side) {
    if (next_.y + faces * side > mostLines_) next_ = {size_.x, 0};
    const ivec2 corner = next_;
    next_.y += faces * side;
    size_ = glm::max(size_, ivec2(corner.x + side, next_.y));
    return corner;
  }
  const ivec2& size() const { return size_; }

 private:
  int mostLines_;
  ivec2 next_{0};
  ivec2 size_{0};
};

// Of the textures that hold what stands at once.
ivec2 sizeOf(const gl::Device& device, const InterlacedInputs& inputs, const std::vector<int>& resolutions,
             InterlacedStand stand) {
  Stacks stacks(device);
  ivec2 largest(0);
  for (size_t i = 0; i < inputs.lights.size(); ++i) {
    if (!hasMap(inputs, i)) continue;
    if (stand == InterlacedStand::InTurns) stacks = Stacks(device);
    const int faces = scene::faceCount(inputs.lights[i]);
    stacks.place(faces, faceSide(resolutions[i]) / (faces == 1 ? 1 : 2));
    largest = glm::max(largest, stacks.size());
  }
  return largest;
}

}  // namespace

gl::ShaderDefines lookupDefines(InterlacedKind kind) {
  gl::ShaderDefines defines = {{"INTERLACED_SHADOWS", "1"}};
  if (kind == InterlacedKind::Opaque) defines.emplace_back("PLAIN_SHADOWS", "1");
  return defines;
}

InterlacedPlan planOf(const gl::Device& device, const InterlacedInputs& inputs, const MapBudget& budget,
                      InterlacedStand stand) {
  const int lines = mostLines(device);
  const auto bytesOf = [&](const ivec2& size) {
    return static_cast<size_t>(size.x) * static_cast<size_t>(size.y) * texelBytes(inputs.kind);
  };
  const size_t budgetBytes = budget.bytes != 0 ? budget.bytes : bytesOf(ivec2(lines));
  const MapPlan asked{{inputs.resolutions.begin(), inputs.resolutions.end()}, 0};
  MapPlan plan = asked;
  for (size_t i = 0; i < inputs.lights.size(); ++i) {
    const int faces = scene::faceCount(inputs.lights[i]);
    plan.resolutions[i] = std::min(plan.resolutions[i], faces == 1 ? lines : lines / faces * 2);
  }
  for (;;) {
    const ivec2 size = sizeOf(device, inputs, plan.resolutions, stand);
    const double excess = std::max(static_cast<double>(bytesOf(size)) / static_cast<double>(budgetBytes),
                                   static_cast<double>(size.x) / lines);
    if (excess <= 1) return {plan.resolutions, plan.resolutions != asked.resolutions, budgetBytes};
    const auto next =
        coarser(plan, asked, {.lowerResolution = budget.lowerResolution, .loosenError = false}, excess);
    if (!next) failOverBudget("interlaced shadow maps", excess, budgetBytes);
    plan = *next;
  }
}

void InterlacedMaps::build(gl::Device& device, const InterlacedInputs& inputs) {
  const ivec2 size = arrange(device, inputs);
  std::vector<shared::ShadowFace> data;
  for (const Face& face : faces_) {
    const int side = face.projection.side;
    data.push_back(faceData(face.projection, static_cast<size_t>(face.corner.y) * static_cast<size_t>(side)));
    data.back().texels.w = face.corner.x;
  }
  faceData_ = gl::Records(device, "interlaced shadow faces", std::span<const shared::ShadowFace>(data));
  if (faces_.empty()) return;
  reserve(device, size, inputs.kind);
  draw(device, inputs);
}

// Returns the size of what holds all faces.
ivec2 InterlacedMaps::arrange(const gl::Device& device, const InterlacedInputs& inputs) {
  lights_.clear();
  faces_.clear();
  lightColours_.clear();
  Stacks stacks(device);
  for (size_t i = 0; i < inputs.lights.size(); ++i) {
    const lights::Light& light = inputs.lights[i];
    LightMap& map = lights_.emplace_back();
    if (!hasMap(inputs, i)) continue;
    map.resolution = inputs.resolutions[i];
    map.firstFace = static_cast<int>(faces_.size());
    const auto faces = scene::facesOf(light, map.resolution, inputs.receivers, inputs.castingPoints);
    map.faces = static_cast<int>(faces.size());
    ivec2 corner = stacks.place(map.faces, faces.front().side);
    for (const FaceProjection& face : faces) {
      faces_.push_back({face, corner});
      lightColours_.push_back(colourOf(light));
      corner.y += face.side;
    }
  }
  return stacks.size();
}

void InterlacedMaps::reserve(gl::Device& device, const ivec2& size, InterlacedKind kind) {
  const auto provide = [&](gl::Texture& texture, const char* label, gl::Format format) {
    const glm::ivec3 held = texture.size();
    if (held.x >= size.x && held.y >= size.y && texture.format() == format) return;
    const ivec2 sides = glm::max(size, ivec2(held));
    texture = gl::Texture();  // before the new one
    texture = gl::Texture(device, label, {.format = format, .size = {sides, 1}});
  };
  provide(depths_, "interlaced shadow depths", gl::Format::R32F);
  provide(depthTest_, "interlaced shadow depth test", gl::Format::Depth32F);
  if (kind == InterlacedKind::Opaque)
    filters_ = gl::Texture();
  else
    provide(filters_, "interlaced shadow colours", filterFormat(kind));
}

void InterlacedMaps::draw(gl::Device& device, const InterlacedInputs& inputs) const {
  const gl::Profiler::Scope time(device.profiler(), "interlaced shadow maps");
  const std::array<const gl::Texture*, 2> colours = {&depths_, &filters_};
  const bool filtered = inputs.kind != InterlacedKind::Opaque;
  const gl::Framebuffer target({colours.data(), filtered ? size_t{2} : size_t{1}}, &depthTest_);
  target.clearColour(0, glm::vec4(NOTHING_OPAQUE));
  target.clearDepth(0);
  const gl::Program& program =
      device.program({"scene/surface.vert", "deepshadow/interlaced.frag"}, definesOf(inputs));
  gl::Buffer viewBlock(device, "shadow view", sizeof(shared::ViewParams));
  gl::Buffer passBlock(device, "shadow pass", sizeof(shared::InterlacedPassParams));
  for (size_t i = 0; i < faces_.size(); ++i) {
    const Face& face = faces_[i];
    viewBlock.writeValue(faceView(face.projection, face.projection.side));
    viewBlock.bindUniform(UNIFORM_VIEW);
    passBlock.writeValue(shared::InterlacedPassParams{glm::vec4(lightColours_[i], 0)});
    passBlock.bindUniform(UNIFORM_PASS);
    const glm::ivec4 rectangle(face.corner, face.projection.side, face.projection.side);
    gl::setDrawState({.program = &program,
                      .target = &target,
                      .viewport = rectangle,
                      .scissor = rectangle,
                      .depthTest = true,
                      .depthCompare = gl::Compare::Greater,  // of what falls with the distance
                      .depthClamp = true});
    if (inputs.casters.opaque) inputs.casters.opaque();
    if (inputs.casters.listed) inputs.casters.listed();
  }
}

size_t InterlacedMaps::bytes() const {
  return depths_.bytes() + filters_.bytes() + depthTest_.bytes();
}

void InterlacedMaps::bind() const {
  faceData_.bind(TEXTURE_SHADOW_FACES);
  if (depths_.bytes() > 0) depths_.bind(TEXTURE_SHADOW_TEXELS);
  if (filters_.bytes() > 0) filters_.bind(TEXTURE_SHADOW_KNOTS);
}

InterlacedMaps::ReadFace InterlacedMaps::read(size_t face) const {
  const auto [projection, corner] = faces_[face];
  const auto width = static_cast<size_t>(depths_.size().x);
  const auto texels = width * static_cast<size_t>(depths_.size().y);
  std::vector<float> depths(texels);
  depths_.read(std::as_writable_bytes(std::span(depths)));
  std::vector<uint32_t> colours(filters_.bytes() > 0 ? texels : 0);
  if (!colours.empty()) filters_.read(std::as_writable_bytes(std::span(colours)));
  const bool bytes = filters_.format() == gl::Format::RGBA8;
  const auto unpacked = [&](uint32_t word) {
    const uint32_t bits = bytes ? 8 : 10;
    glm::vec4 colour;
    for (uint32_t c = 0; c < 4; ++c) {
      const uint32_t most = (1u << (c == 3 && !bytes ? 2 : bits)) - 1;
      colour[static_cast<int>(c)] = static_cast<float>(word >> (c * bits) & most) / static_cast<float>(most);
    }
    return colour;
  };
  ReadFace result{projection, {}, {}};
  for (int y = 0; y < projection.side; ++y) {
    for (int x = 0; x < projection.side; ++x) {
      const size_t at = static_cast<size_t>(corner.y + y) * width + static_cast<size_t>(corner.x + x);
      result.depths.push_back(depths[at]);
      if (!colours.empty()) result.letThrough.push_back(unpacked(colours[at]));
    }
  }
  return result;
}

}  // namespace sfumato::deepshadow
