#include "volumes/volumes_gpu.h"

#include <algorithm>

#include "base/error.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/volumes.h"

namespace sfumato::volumes {
namespace {

constexpr size_t maxMedia = 8;

std::vector<PlacedGrid> densitiesOf(std::span<const Medium> media) {
  if (media.size() > maxMedia)
    base::fail(base::ExitCode::Memory, "{} volumes: at most {} can be rendered at once: leave some out",
               media.size(), maxMedia);
  std::vector<PlacedGrid> grids;
  for (const Medium& medium : media) grids.push_back({medium.grid, medium.worldFromIndex});
  return grids;
}

double maxComponent(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

bool isColoured(const Medium& medium) {
  return medium.extinctionColour != glm::dvec3(maxComponent(medium.extinctionColour));
}

shared::VolumeData volumeData(const Medium& medium) {
  shared::VolumeData data{};
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

VolumesGpu::VolumesGpu(gl::Device& device, std::span<const Medium> media, const GridOptions& options)
    : count_(media.size()), grids_(device, densitiesOf(media), options) {
  std::vector<shared::VolumeData> data;
  for (const Medium& medium : media) {
    data.push_back(volumeData(medium));
    coloured_ = coloured_ || isColoured(medium);
  }
  data_ = gl::Buffer(device, "volumes", std::span<const shared::VolumeData>(data));
}

gl::ShaderDefines VolumesGpu::defines() const {
  gl::ShaderDefines defines = gl::joined({{"VOLUME_COUNT", std::to_string(count())}}, grids_.defines());
  if (coloured_) defines.emplace_back("COLOURED_SMOKE", "1");
  return defines;
}

void VolumesGpu::bind() const {
  if (empty()) return;
  grids_.bind();
  data_.bindStorage(STORAGE_VOLUMES);
}

}  // namespace sfumato::volumes
