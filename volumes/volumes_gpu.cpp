#include "volumes/volumes_gpu.h"

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

shared::VolumeData volumeData(const Medium& medium) {
  shared::VolumeData data{};
  data.albedoScale = glm::vec4(glm::vec3(medium.albedo), static_cast<float>(medium.scale));
  data.phase.x = static_cast<float>(medium.g);
  data.phase.y = static_cast<float>(voxelSize(medium.worldFromIndex));
  return data;
}

}  // namespace

VolumesGpu::VolumesGpu(gl::Device& device, std::span<const Medium> media, const GridOptions& options)
    : count_(media.size()), grids_(device, densitiesOf(media), options) {
  std::vector<shared::VolumeData> data;
  for (const Medium& medium : media) data.push_back(volumeData(medium));
  data_ = gl::Buffer(device, "volumes", std::span<const shared::VolumeData>(data));
}

gl::ShaderDefines VolumesGpu::defines() const {
  return gl::joined({{"VOLUME_COUNT", std::to_string(count())}}, grids_.defines());
}

void VolumesGpu::bind() const {
  if (empty()) return;
  grids_.bind();
  data_.bindStorage(STORAGE_VOLUMES);
}

}  // namespace sfumato::volumes
