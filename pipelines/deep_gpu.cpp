#include "pipelines/deep_gpu.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/size_text.h"
#include "gl/buffer.h"
#include "pipelines/deep_pixels.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/deep.h"

namespace sfumato::pipelines {
namespace {

constexpr size_t firstBatch = size_t{1} << 14;  // pixels

[[noreturn]] void failOverMemory(size_t bytes, size_t mostBytes) {
  base::fail(base::ExitCode::Memory,
             "deep image: its samples take {} and more, and {} are there for them: lower the resolution",
             base::sizeText(bytes), base::sizeText(mostBytes));
}

size_t bytesOf(const std::vector<image::DeepSample>& samples) {
  return samples.capacity() * sizeof(image::DeepSample);
}

size_t bytesOf(const image::DeepImage& image) {
  size_t bytes = image.pixels.size() * sizeof(image.pixels[0]);
  for (const auto& samples : image.pixels) bytes += bytesOf(samples);
  return bytes;
}

// Pixels first to first + count - 1 of a window, and the rays through them, pixel by pixel.
struct Batch {
  size_t first = 0;
  size_t count = 0;
  std::vector<uint32_t> rays;
  std::vector<size_t> raysBefore;  // a pixel each, and the end
};

Batch batchOf(const DeepRays& rays, size_t first, size_t count) {
  Batch batch{.first = first, .count = count};
  for (size_t pixel = first; pixel < first + count; ++pixel) {
    batch.raysBefore.push_back(batch.rays.size());
    rays.ofPixels.forEachRay(pixel, [&](size_t ray) { batch.rays.push_back(static_cast<uint32_t>(ray)); });
  }
  batch.raysBefore.push_back(batch.rays.size());
  return batch;
}

// Events by rays. What rounding put out of order or over each other is put right.
std::vector<RayEvents> sortedByRay(std::span<const shared::DeepEvent> events, size_t rays) {
  std::vector<RayEvents> sorted(rays);
  for (shared::DeepEvent event : events) {
    RayEvents& ray = sorted[event.ray];
    if (!ray.empty()) event.front = std::max(event.front, ray.back().back);
    event.back = std::max(event.back, event.front);
    ray.push_back(event);
  }
  return sorted;
}

class Recorder {
 public:
  Recorder(gl::Device& device, const DeepRays& rays, const DeepLimits& limits, image::DeepImage& image)
      : device_(device),
        rays_(rays),
        mostBytes_(limits.sampleBytes),
        image_(image),
        events_(device, "deep events", std::min(limits.eventBytes, mostEvents() * sizeof(shared::DeepEvent))),
        bytes_(bytesOf(image)) {}

  void record() {
    const size_t pixels = rays_.ofPixels.pixels;
    size_t count = firstBatch;
    for (size_t first = 0; first < pixels;) {
      count = std::min(count, pixels - first);
      const Batch batch = batchOf(rays_, first, count);
      const size_t demand = walk(batch);
      const bool fits = demand <= capacity();
      if (fits) {
        join(batch, demand);
        first += count;
      } else if (count == 1) {
        growTo(demand);
      }
      // The next pixels are taken to be like these; a quarter of the room is for those that are not.
      count = std::max<size_t>(
          1, fits && demand == 0 ? 2 * count : count * capacity() * 3 / (4 * std::max<size_t>(demand, 1)));
    }
  }

 private:
  size_t capacity() const { return events_.bytes() / sizeof(shared::DeepEvent); }
  size_t mostEvents() const {
    return static_cast<size_t>(device_.limits().storageBlockBytes) / sizeof(shared::DeepEvent);
  }

  void growTo(size_t events) {
    if (events > mostEvents())
      base::fail(base::ExitCode::Memory,
                 "deep image: one pixel's rays meet {} surfaces and steps of smoke, and this device holds {} "
                 "in a block: "
                 "use a longer --step",
                 events, mostEvents());
    events_ = gl::Buffer(device_, "deep events", events * sizeof(shared::DeepEvent));
  }

  // How many events the batch's rays made, which is more than there are when they found no room.
  size_t walk(const Batch& batch) {
    std::vector<uint32_t> words = {0};
    words.insert(words.end(), batch.rays.begin(), batch.rays.end());
    const gl::Buffer listed(device_, "deep rays", std::span<const uint32_t>(words));
    listed.bindStorage(STORAGE_DEEP_RAYS);
    events_.bindStorage(STORAGE_DEEP_EVENTS);
    rays_.walk(batch.rays.size());
    return listed.readValue<uint32_t>();
  }

  void join(const Batch& batch, size_t demand) {
    const auto events = sortedByRay(events_.readValues<shared::DeepEvent>(demand), batch.rays.size());
    std::atomic<size_t> bytes = bytes_;
    base::parallelFor(static_cast<long>(batch.count), [&](long i) {
      const auto pixel = static_cast<size_t>(i);
      const size_t first = batch.raysBefore[pixel];
      const glm::ivec2 place = rays_.window.placeOf(batch.first + pixel, image_.height);
      auto& samples = image_.pixel(place.x, place.y);
      samples = joinRays(std::span(events).subspan(first, batch.raysBefore[pixel + 1] - first));
      samples.shrink_to_fit();
      bytes += bytesOf(samples);
    });
    bytes_ = bytes;
    if (bytes_ > mostBytes_) failOverMemory(bytes_, mostBytes_);
  }

  gl::Device& device_;
  const DeepRays& rays_;
  const size_t mostBytes_;
  image::DeepImage& image_;
  gl::Buffer events_;
  size_t bytes_;  // of the image
};

image::Matrix asRows(const glm::dmat4& m) {
  const glm::mat4 narrow(m);  // glm's columns of a matrix for columns are the rows of one for rows
  image::Matrix rows;
  std::memcpy(rows.data(), &narrow, sizeof(rows));
  return rows;
}

image::DeepView deepView(const glm::dmat4& viewFromWorld, const glm::dvec2& halfExtent, bool orthographic) {
  glm::dmat4 cameraFromView(1);
  cameraFromView[2][2] = -1;
  // x and y over the depth, or as they are, from [-1, 1] up to [0, 1] down; z: the depth, or -1 over it.
  glm::dmat4 ndcFromCamera(0);
  ndcFromCamera[0][0] = 0.5 / halfExtent.x;
  ndcFromCamera[1][1] = -0.5 / halfExtent.y;
  const int w = orthographic ? 3 : 2;
  ndcFromCamera[w][0] = ndcFromCamera[w][1] = 0.5;
  ndcFromCamera[w][3] = 1;
  if (orthographic)
    ndcFromCamera[2][2] = 1;
  else
    ndcFromCamera[3][2] = -1;
  const glm::dmat4 cameraFromWorld = cameraFromView * viewFromWorld;
  return {asRows(cameraFromWorld), asRows(ndcFromCamera * cameraFromWorld)};
}

}  // namespace

DeepLimits withinMemory(DeepLimits limits) {
  const uint64_t there = base::freeMemory().value_or(UINT64_MAX) / 2;
  limits.sampleBytes = static_cast<size_t>(std::min<uint64_t>(limits.sampleBytes, there));
  return limits;
}

void recordDeep(gl::Device& device, const DeepRays& rays, const DeepLimits& limits, image::DeepImage& image) {
  Recorder(device, rays, limits, image).record();
}

image::DeepView deepView(const shared::ViewParams& view) {
  return deepView(view.viewFromWorld, glm::dvec2(view.halfExtent), view.halfExtent.z != 0.f);
}

std::vector<image::DeepImage> deepShadow(const deepshadow::Maps& maps, size_t light,
                                         const DeepLimits& limits) {
  const deepshadow::LightMap& map = maps.lights()[light];
  if (map.firstFace < 0)
    base::fail(
        base::ExitCode::Usage,
        "deep shadow map of light {}: it reaches nothing that is seen and has no map: choose another light",
        light);
  size_t texels = 0;
  for (const deepshadow::FaceProjection& face : maps.faces(light)) texels += face.texels();
  const size_t atMost =
      (maps.knotsAtMost(light) + texels) * sizeof(image::DeepSample) + texels * sizeof(std::vector<int>);
  if (atMost > limits.sampleBytes) failOverMemory(atMost, limits.sampleBytes);
  const deepshadow::ReadMap read = maps.read(light);

  constexpr std::array sides = {"+x", "-x", "+y", "-y", "+z", "-z"};
  std::vector<image::DeepImage> images;
  size_t firstTexel = 0;
  for (int i = 0; i < map.faces; ++i) {
    const deepshadow::FaceProjection& face = maps.faces(light)[static_cast<size_t>(i)];
    image::DeepImage image(face.side, face.side);
    if (map.faces > 1) image.name = sides[static_cast<size_t>(i)];
    image.view = deepView(glm::inverse(face.worldFromFace), face.halfExtent, face.orthographic);
    base::parallelFor(face.side, [&](long row) {
      for (int x = 0; x < face.side; ++x) {
        const auto& texel = read.texels[firstTexel + static_cast<size_t>(row * face.side + x)];
        const auto own = std::span(read.knots).subspan(texel.firstKnot, texel.knots);
        image.pixel(x, face.side - 1 - static_cast<int>(row)) = samplesOf(own, texel.opaqueDepth);
      }
    });
    images.push_back(std::move(image));
    firstTexel += face.texels();
  }
  return images;
}

}  // namespace sfumato::pipelines
