#include "volumes/grids_gpu.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/grids.h"
#include "volumes/brick_map.h"

namespace sfumato::volumes {
namespace {

constexpr size_t valuesAtOnce = size_t{1} << 22;
constexpr size_t mostMapBricks = size_t{1} << 24;  // 64 MiB of map
constexpr int mostBricksAnAxis = 1 << BRICK_AXIS_BITS;

size_t product(const glm::ivec3& v) {
  return static_cast<size_t>(v.x) * static_cast<size_t>(v.y) * static_cast<size_t>(v.z);
}

// The maps of all grids lie in one texture, one above the other, each with a margin of a brick around.
glm::ivec3 mapTextureSize(std::span<const PlacedGrid> grids, int side) {
  glm::ivec3 size(0);
  for (const PlacedGrid& placed : grids) {
    const glm::ivec3 own = brickCount(placed.grid, side) + 2;
    size = {std::max(size.x, own.x), std::max(size.y, own.y), size.z + own.z};
  }
  return size;
}

int chooseBrickSide(std::span<const PlacedGrid> grids, int textureSide) {
  for (int side = DensityGrid::brickSide;; side *= 2) {
    const glm::ivec3 size = mapTextureSize(grids, side);
    if (product(size) <= mostMapBricks && std::max({size.x, size.y, size.z}) <= textureSide) return side;
  }
}

size_t valueBytes(const DensityGrid& grid) {
  return grid.half ? sizeof(uint16_t) : sizeof(float);
}

gl::Texture makeTexture(gl::Device& device, const std::string& label, const DensityGrid& grid,
                        const glm::ivec3& size) {
  return {device, label + grid.name,
          gl::TextureDescription{.format = grid.half ? gl::Format::R16F : gl::Format::R32F,
                                 .size = size,
                                 .filter = gl::Filter::Linear}};
}

// As many layers of the texture as there are values for.
void writeValues(gl::Texture& texture, const DensityGrid& grid, std::span<const float> values, int firstLayer,
                 int layers) {
  if (!grid.half) {
    texture.writeLayers(std::as_bytes(values), firstLayer, layers);
    return;
  }
  std::vector<uint16_t> halves(values.size());
  std::transform(values.begin(), values.end(), halves.begin(), glm::packHalf1x16);
  texture.writeLayers(std::as_bytes(std::span(halves)), firstLayer, layers);
}

gl::Texture uploadDense(gl::Device& device, const DensityGrid& grid) {
  gl::Texture texture = makeTexture(device, "density ", grid, grid.size);
  const size_t layer = grid.valueIndex(0, 0, 1);
  const int layersAtOnce = static_cast<int>(std::max(valuesAtOnce / layer, size_t{1}));
  for (int z = 0; z < grid.size.z; z += layersAtOnce) {
    const int layers = std::min(layersAtOnce, grid.size.z - z);
    const auto values = std::span(grid.values).subspan(static_cast<size_t>(z) * layer);
    writeValues(texture, grid, values.first(static_cast<size_t>(layers) * layer), z, layers);
  }
  return texture;
}

// Where the filled bricks of a grid lie in its texture: in a box of bricks, x first.
struct BrickBox {
  glm::ivec3 size{1};

  BrickBox(size_t bricks, int mostAnAxis) {
    const auto count = static_cast<double>(std::max(bricks, size_t{1}));
    size.x = std::min(static_cast<int>(std::ceil(std::cbrt(count))), mostAnAxis);
    size.y = std::min(static_cast<int>(std::ceil(std::sqrt(count / size.x))), mostAnAxis);
    size.z = static_cast<int>(std::ceil(count / size.x / size.y));
  }

  glm::ivec3 place(size_t brick) const {
    const auto x = static_cast<size_t>(size.x), y = static_cast<size_t>(size.y);
    return {brick % x, brick / x % y, brick / (x * y)};
  }
};

// A grid on its way to the device.
struct Upload {
  const DensityGrid& grid;
  BrickMap map;
  BrickBox box;
  glm::ivec3 first;  // of its bricks, in the texture of all maps

  Upload(const DensityGrid& grid, int brickSide, int textureSide, int mapLayer)
      : grid(grid),
        map(mapBricks(grid, brickSide)),
        box(map.filled, std::min(mostBricksAnAxis, textureSide / (brickSide + 1))),
        first(1, 1, mapLayer + 1) {}

  size_t denseBytes() const { return product(grid.size) * valueBytes(grid); }
  size_t brickBytes() const { return product(box.size * (map.side + 1)) * valueBytes(grid); }

  // Calls visit(brick, number) for the filled bricks, in order.
  template <typename Visit>
  void forFilledBricks(const Visit& visit) const {
    size_t number = 0;
    for (int z = 0; z < map.count.z; ++z)
      for (int y = 0; y < map.count.y; ++y)
        for (int x = 0; x < map.count.x; ++x)
          if (map.distance[map.place({x, y, z})] == 0) visit(glm::ivec3(x, y, z), number++);
  }
};

// One layer of bricks at a time is put together on the CPU.
gl::Texture uploadBricks(gl::Device& device, const Upload& upload) {
  const DensityGrid& grid = upload.grid;
  const int side = upload.map.side, stored = side + 1;
  gl::Texture texture = makeTexture(device, "bricks of density ", grid, upload.box.size * stored);
  std::vector<glm::ivec3> bricks;
  upload.forFilledBricks([&](const glm::ivec3& brick, size_t) { bricks.push_back(brick); });

  const glm::ivec3 layer(texture.size().x, texture.size().y, stored);
  const size_t bricksInLayer = product({upload.box.size.x, upload.box.size.y, 1});
  std::vector<float> values(product(layer));
  for (size_t first = 0; first < bricks.size(); first += bricksInLayer) {
    const size_t count = std::min(bricksInLayer, bricks.size() - first);
    base::parallelFor(static_cast<long>(count), [&](long i) {
      const glm::ivec3 from = bricks[first + static_cast<size_t>(i)] * side;
      const glm::ivec3 to = upload.box.place(static_cast<size_t>(i)) * stored;
      for (int z = 0; z < stored; ++z)
        for (int y = 0; y < stored; ++y)
          for (int x = 0; x < stored; ++x) {
            const glm::ivec3 voxel = glm::min(from + glm::ivec3(x, y, z), grid.size - 1);
            values[placeIn(layer, {to.x + x, to.y + y, z})] = grid.value(voxel);
          }
    });
    writeValues(texture, grid, values, static_cast<int>(first / bricksInLayer) * stored, stored);
  }
  return texture;
}

// What the map says of a brick: see shaders/shared/grids.h.
void writeMap(const Upload& upload, const glm::ivec3& size, std::vector<uint32_t>& entries) {
  const auto entryAt = [&](const glm::ivec3& brick) -> uint32_t& {
    return entries[placeIn(size, upload.first + brick)];
  };
  for (int z = 0; z < upload.map.count.z; ++z)
    for (int y = 0; y < upload.map.count.y; ++y)
      for (int x = 0; x < upload.map.count.x; ++x)
        entryAt({x, y, z}) = upload.map.distance[upload.map.place({x, y, z})];
  upload.forFilledBricks([&](const glm::ivec3& brick, size_t number) {
    const glm::uvec3 place(upload.box.place(number));
    entryAt(brick) = BRICK_FILLED | place.x | place.y << BRICK_AXIS_BITS | place.z << (2 * BRICK_AXIS_BITS);
  });
}

// Bit g is set for each grid that is put into bricks.
unsigned chooseBricks(std::span<const Upload> uploads, const GridOptions& options, int textureSide) {
  unsigned inBricks = 0;
  size_t bytes = 0;
  const auto decide = [&](bool sparing) {
    inBricks = 0, bytes = 0;
    for (size_t g = 0; g < uploads.size(); ++g) {
      const Upload& upload = uploads[g];
      const glm::ivec3& size = upload.grid.size;
      const bool fits = upload.grid.dense() && std::max({size.x, size.y, size.z}) <= textureSide;
      const bool bricks = !fits || (sparing && upload.brickBytes() < upload.denseBytes());
      if (bricks) inBricks |= 1u << g;
      bytes += bricks ? upload.brickBytes() : upload.denseBytes();
    }
  };
  decide(false);
  if (bytes > options.budgetBytes) decide(true);
  if (bytes > options.budgetBytes)
    base::fail(
        base::ExitCode::Memory,
        "volumes: take {:.1f} MiB, the budget is {:.1f} MiB: raise --volume-memory, or resample them to "
        "larger voxels",
        static_cast<double>(bytes) / 0x1p20, static_cast<double>(options.budgetBytes) / 0x1p20);
  for (size_t g = 0; g < uploads.size(); ++g) {
    const glm::ivec3 size = uploads[g].box.size * (uploads[g].map.side + 1);
    if ((inBricks >> g & 1u) != 0 && size.z > textureSide)
      base::fail(base::ExitCode::Memory,
                 "volume \"{}\": its bricks take {:.1f} MiB in {} x {} x {} texels, this device allows {} a "
                 "side: resample it to larger voxels",
                 uploads[g].grid.name, static_cast<double>(uploads[g].brickBytes()) / 0x1p20, size.x, size.y,
                 size.z, textureSide);
  }
  return inBricks;
}

shared::GridData gridData(const Upload& upload, const glm::dmat4& worldFromIndex, bool inBricks) {
  const glm::dvec3 size(upload.grid.size), first(upload.first);
  const double side = upload.map.side;
  // Voxel (i,j,k) of a dense texture stands at (i + 0.5) / size.
  const glm::dvec3 scale = inBricks ? glm::dvec3(1 / side) : 1.0 / size;
  const glm::dvec3 start = inBricks ? first : 0.5 / size;
  const glm::dmat4 gridFromIndex = glm::translate(glm::dmat4(1.0), start) *
                                   glm::scale(glm::dmat4(1.0), scale) *
                                   glm::translate(glm::dmat4(1.0), -glm::dvec3(upload.grid.origin));
  shared::GridData data{};
  data.gridFromWorld = gridFromIndex * glm::inverse(worldFromIndex);
  data.boxMin = glm::vec4(glm::vec3(start), 0.f);
  data.boxMax = glm::vec4(glm::vec3(start + (size - 1.0) * scale), 0.f);
  data.bricksScale = glm::vec4(glm::vec3(inBricks ? glm::dvec3(1) : size / side), 0.f);
  data.bricksFirst = glm::vec4(glm::vec3(inBricks ? glm::dvec3(0) : first - 0.5 / side), 0.f);
  return data;
}

}  // namespace

GridsGpu::GridsGpu(gl::Device& device, std::span<const PlacedGrid> grids, const GridOptions& options) {
  if (grids.empty()) return;
  const int textureSide = std::min(options.textureSide, device.limits().texture3dSize);
  brickSide_ = chooseBrickSide(grids, textureSide);
  std::vector<Upload> uploads;
  int mapLayer = 0;
  for (const PlacedGrid& placed : grids) {
    uploads.emplace_back(placed.grid, brickSide_, textureSide, mapLayer);
    mapLayer += uploads.back().map.count.z + 2;
  }
  inBricks_ = chooseBricks(uploads, options, textureSide);

  const glm::ivec3 mapSize = mapTextureSize(grids, brickSide_);
  std::vector<uint32_t> map(product(mapSize), 1u);
  std::vector<shared::GridData> data;
  for (size_t g = 0; g < grids.size(); ++g) {
    const bool inBricks = (inBricks_ >> g & 1u) != 0;
    textures_.push_back(inBricks ? uploadBricks(device, uploads[g]) : uploadDense(device, grids[g].grid));
    writeMap(uploads[g], mapSize, map);
    data.push_back(gridData(uploads[g], grids[g].worldFromIndex, inBricks));
  }
  map_ = gl::Texture(device, "brick map", {.format = gl::Format::R32UI, .size = mapSize},
                     std::as_bytes(std::span(map)));
  data_ = gl::Buffer(device, "grids", std::span<const shared::GridData>(data));
}

gl::ShaderDefines GridsGpu::defines() const {
  return {{"GRID_COUNT", std::to_string(count())},
          {"GRID_BRICKS", std::to_string(inBricks_)},
          {"GRID_BRICK_SIDE", std::to_string(brickSide_)}};
}

void GridsGpu::bind() const {
  data_.bindUniform(UNIFORM_GRIDS);
  map_.bind(TEXTURE_BRICK_MAP);
  for (size_t g = 0; g < textures_.size(); ++g) textures_[g].bind(static_cast<unsigned>(TEXTURE_GRIDS + g));
}

}  // namespace sfumato::volumes
