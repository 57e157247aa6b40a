#include "volumes/volumes_gpu.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/volumes.h"

namespace sfumato::volumes {
namespace {

constexpr size_t maxMedia = 8;  // with five other textures in the resolve; every device has 16 a stage

// Voxel (i,j,k) of the texture stands at (i + 0.5) / size.
glm::dmat4 textureFromIndex(const DensityGrid& grid) {
  const glm::dvec3 size(grid.size);
  const glm::dvec3 shift = glm::dvec3(0.5) - glm::dvec3(grid.origin);
  return glm::scale(glm::dmat4(1.0), 1.0 / size) * glm::translate(glm::dmat4(1.0), shift);
}

double maxComponent(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

bool isColoured(const Medium& medium) {
  return medium.extinctionColour != glm::dvec3(maxComponent(medium.extinctionColour));
}

shared::VolumeData volumeData(const Medium& medium) {
  const glm::dvec3 size(medium.grid.size);
  shared::VolumeData data{};
  data.textureFromWorld = textureFromIndex(medium.grid) * glm::inverse(medium.worldFromIndex);
  data.boxMin = glm::vec4(glm::vec3(0.5 / size), 0.f);
  data.boxMax = glm::vec4(glm::vec3(1.0 - 0.5 / size), 0.f);
  const double densest = maxComponent(medium.extinctionColour);
  const glm::dvec3 colour = densest > 0 ? medium.extinctionColour / densest : glm::dvec3(1);
  data.extinction = glm::vec4(glm::vec3(colour), static_cast<float>(medium.scale * densest));
  data.albedo = glm::vec4(glm::vec3(medium.albedo), 0.f);
  data.scattering = glm::vec4(glm::vec3(medium.albedo * colour), 0.f);
  data.phase.x = static_cast<float>(medium.g);
  data.phase.y = static_cast<float>(voxelSize(medium.worldFromIndex));
  return data;
}

}  // namespace

VolumesGpu::VolumesGpu(gl::Device& device, std::span<const Medium> media) {
  if (media.size() > maxMedia)
    base::fail(base::ExitCode::Memory, "{} volumes: at most {} can be rendered at once: leave some out",
               media.size(), maxMedia);
  std::vector<shared::VolumeData> data;
  for (const Medium& medium : media) {
    const gl::TextureDescription description{
        .format = gl::Format::R32F, .size = medium.grid.size, .filter = gl::Filter::Linear};
    textures_.emplace_back(device, "density " + medium.grid.name, description,
                           std::as_bytes(std::span(medium.grid.values)));
    data.push_back(volumeData(medium));
    coloured_ = coloured_ || isColoured(medium);
  }
  data_ = gl::Buffer(device, "volumes", std::span<const shared::VolumeData>(data));
}

gl::ShaderDefines VolumesGpu::defines() const {
  gl::ShaderDefines defines = {{"VOLUME_COUNT", std::to_string(count())}};
  if (coloured_) defines.emplace_back("COLOURED_SMOKE", "1");
  return defines;
}

void VolumesGpu::bind() const {
  data_.bindStorage(STORAGE_VOLUMES);
  for (size_t i = 0; i < textures_.size(); ++i) textures_[i].bind(static_cast<unsigned>(TEXTURE_VOLUMES + i));
}

}  // namespace sfumato::volumes
