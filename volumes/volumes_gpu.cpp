#include "volumes/volumes_gpu.h"

#include <algorithm>

#include "base/error.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/volumes.h"

namespace sfumato::volumes {
namespace {

constexpr size_t maxGrids = 8;

// The densities, then the fires.
std::vector<PlacedGrid> gridsOf(std::span<const Medium> media) {
  std::vector<PlacedGrid> grids;
  for (const Medium& medium : media) grids.push_back({medium.grid, medium.worldFromIndex});
  for (const Medium& medium : media)
    if (medium.fire) grids.push_back({medium.fire->grid, medium.fire->worldFromIndex});
  if (grids.size() > maxGrids)
    base::fail(base::ExitCode::Memory,
               "{} volumes and fires: at most {} can be rendered at once: leave some out", grids.size(),
               maxGrids);
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

// Appends the fire's ramp.
shared::VolumeData fireData(const Fire& fire, std::vector<glm::vec4>& ramps) {
  const auto steps = static_cast<float>(fire.ramp.size() - 1);
  const auto first = static_cast<float>(ramps.size());
  shared::VolumeData data{};
  data.ramp = {steps / static_cast<float>(fire.top), first, first + steps, 0.f};
  data.phase.y = static_cast<float>(voxelSize(fire.worldFromIndex));
  for (const glm::vec3& colour : fire.ramp) ramps.emplace_back(colour, 0.f);
  return data;
}

}  // namespace

VolumesGpu::VolumesGpu(gl::Device& device, std::span<const Medium> media, const GridOptions& options)
    : grids_(device, gridsOf(media), options) {
  std::vector<shared::VolumeData> data;
  for (const Medium& medium : media) {
    data.push_back(volumeData(medium));
    extents_.push_back({worldFromUnit(medium), voxelSize(medium.worldFromIndex)});
    coloured_ = coloured_ || isColoured(medium);
  }
  std::vector<glm::vec4> ramps;
  for (const Medium& medium : media)
    if (medium.fire) data.push_back(fireData(*medium.fire, ramps));
  if (burning()) ramps_ = gl::Buffer(device, "fire ramps", std::span<const glm::vec4>(ramps));
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
  if (burning()) ramps_.bindStorage(STORAGE_FIRE_RAMPS);
}

}  // namespace sfumato::volumes
