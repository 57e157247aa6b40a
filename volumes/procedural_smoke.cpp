#include "volumes/procedural_smoke.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "base/random.h"

namespace sfumato::volumes {
namespace {

using glm::ivec3;
using glm::vec3;

struct NoiseSample {
  float value = 0;
  vec3 gradient{0.f};
};

uint32_t hash(ivec3 cell, uint32_t seed) {
  uint32_t h = seed ^ (static_cast<uint32_t>(cell.x) * 0x8da6b343u) ^
               (static_cast<uint32_t>(cell.y) * 0xd8163841u) ^ (static_cast<uint32_t>(cell.z) * 0xcb1ab31fu);
  h = (h ^ (h >> 16)) * 0x7feb352du;
  h = (h ^ (h >> 15)) * 0x846ca68bu;
  return h ^ (h >> 16);
}

// A lattice direction of improved noise (Perlin 2002): towards the middles of a cube's edges, four of them
// twice.
vec3 latticeGradient(uint32_t h) {
  static constexpr float directions[16][3] = {
      {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
      {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1}, {1, 1, 0}, {-1, 1, 0}, {0, -1, 1}, {0, -1, -1}};
  const float* d = directions[h & 15];
  return {d[0], d[1], d[2]};
}

// Gradient noise with its exact gradient; about [-1, 1], features of size 1.
NoiseSample noise(vec3 p, uint32_t seed) {
  const vec3 floor = glm::floor(p);
  const ivec3 cell(floor);
  const vec3 f = p - floor;
  const vec3 fade = f * f * f * (f * (f * 6.f - 15.f) + 10.f);
  const vec3 slope = 30.f * f * f * (f * (f - 2.f) + 1.f);
  NoiseSample sample;
  for (int corner = 0; corner < 8; ++corner) {
    const ivec3 offset(corner & 1, (corner >> 1) & 1, corner >> 2);
    const vec3 gradient = latticeGradient(hash(cell + offset, seed));
    const float ramp = glm::dot(gradient, f - vec3(offset));
    vec3 weight, weightSlope;
    for (int axis = 0; axis < 3; ++axis) {
      weight[axis] = offset[axis] ? fade[axis] : 1.f - fade[axis];
      weightSlope[axis] = offset[axis] ? slope[axis] : -slope[axis];
    }
    const float product = weight.x * weight.y * weight.z;
    sample.value += product * ramp;
    sample.gradient += product * gradient + ramp * vec3(weightSlope.x * weight.y * weight.z,
                                                        weight.x * weightSlope.y * weight.z,
                                                        weight.x * weight.y * weightSlope.z);
  }
  return sample;
}

// The curl of a potential of three noises: a flow without sources.
vec3 curlNoise(vec3 p, uint32_t seed) {
  const vec3 a = noise(p, seed).gradient;
  const vec3 b = noise(p + vec3(31.4f, 15.9f, 26.5f), seed + 1).gradient;
  const vec3 c = noise(p - vec3(27.1f, 82.8f, 18.2f), seed + 2).gradient;
  return {c.y - b.z, a.z - c.x, b.x - a.y};
}

constexpr float halfWidth = 0.62f;  // metres from the axis that smoke reaches at most

struct Puff {
  vec3 centre;
  float radius;
};

class Plume {
 public:
  Plume(float height, uint64_t seed) : height_(height) {
    base::Random random(seed);
    noiseSeed_ = random.next();
    placePuffs(random);
  }

  float density(vec3 p) const {
    const float rise = p.y / height_;
    const float inBox = fadeOut(glm::length(vec3(p.x, 0, p.z)), halfWidth) * fadeOut(p.y, height_);
    if (inBox == 0 || bodyAt(p) < -farthestReach) return 0;
    const vec3 q = carriedBack(p, rise);
    float body = bodyAt(q);
    // Smooth where it leaves the ground, then rougher and thinner.
    const float developed = glm::smoothstep(-0.05f, 0.35f, rise);
    const float rough = glm::mix(0.02f, 0.16f, developed);  // metres
    if (body < -rough) return 0;
    body += rough * billows(glm::mix(p, q, 0.5f));
    if (body <= 0) return 0;
    const float edge = glm::smoothstep(0.f, glm::mix(0.015f, 0.06f, rise), body);
    const float hollow = glm::smoothstep(-0.35f, 0.35f, noise(q * 3.1f, noiseSeed_ + 40).value);
    return inBox * edge * glm::mix(1.f, 0.55f, rise) * glm::mix(1.f, 0.25f + 0.75f * hollow, developed);
  }

 private:
  // Falls from 1 to 0 over the last 10 cm before the end of the box.
  static float fadeOut(float x, float end) { return 1.f - glm::smoothstep(end - 0.1f, end, x); }

  static constexpr float farthestReach = 0.3f;  // metres that flow and billows carry smoke beyond a puff

  // Wider as it rises, and closed at the top.
  static float radiusAt(float rise) {
    return (0.07f + 0.36f * std::pow(rise, 0.8f)) * std::sqrt(1.f - glm::smoothstep(0.6f, 1.2f, rise));
  }

  void placePuffs(base::Random& random) {
    const float crown = std::max(0.6f * height_, height_ - 0.25f);
    for (float y = 0.f; y < crown;) {
      const float rise = y / crown, wide = radiusAt(rise);
      const auto angle = static_cast<float>(random.uniform(0, 6.283185307));
      const auto away = wide * static_cast<float>(random.uniform(0.1, 0.3 + 0.4 * std::sqrt(rise)));
      const auto radius = wide * static_cast<float>(random.uniform(0.7 - 0.3 * std::sqrt(rise), 0.75));
      const vec3 wander = 0.12f * rise * vec3(std::sin(2.1f * y + 1.f), 0, std::cos(1.7f * y));
      puffs_.push_back({wander + vec3(away * std::cos(angle), y, away * std::sin(angle)), radius});
      y += 0.2f * radius;
    }
  }

  // Noise folded at zero: round bulges between sharp creases; about [-1, 1].
  float billows(vec3 p) const {
    float sum = 0.f, amplitude = 0.6f, frequency = 4.f;
    for (uint32_t octave = 0; octave < 5; ++octave) {
      sum += amplitude * (0.5f - 2.2f * std::abs(noise(p * frequency, noiseSeed_ + 20 + octave).value));
      amplitude *= 0.6f;
      frequency *= 2.03f;
    }
    return sum;
  }

  // Where the air that is at p came from.
  vec3 carriedBack(vec3 p, float rise) const {
    const float turbulence = glm::smoothstep(-0.02f, 0.4f, rise);
    constexpr int steps = 3;
    for (int i = 0; i < steps; ++i) {
      const vec3 flow =
          0.055f * curlNoise(p * 2.4f, noiseSeed_) + 0.022f * curlNoise(p * 6.1f, noiseSeed_ + 3);
      p -= turbulence / steps * flow;
    }
    return p;
  }

  // Metres to the nearest puff's surface, positive inside.
  float bodyAt(vec3 p) const {
    float deepest = -1.f;
    for (const Puff& puff : puffs_)
      if (std::abs(p.y - puff.centre.y) < puff.radius + farthestReach)
        deepest = std::max(deepest, puff.radius - glm::length(p - puff.centre));
    return deepest;
  }

  float height_;
  uint32_t noiseSeed_ = 0;
  std::vector<Puff> puffs_;
};

// In units of its height.
class Flame {
 public:
  static constexpr float halfWidth = 0.34f;
  static constexpr float hottest = 2000.f;  // K

  explicit Flame(uint64_t seed) { noiseSeed_ = base::Random(seed).next(); }

  struct Gas {
    float density;
    float kelvin;
  };

  Gas at(vec3 p) const {
    const float rise = p.y;
    const float inBox = fadeOut(glm::length(vec3(p.x, 0, p.z)), halfWidth) * fadeOut(rise, 1.f) *
                        glm::smoothstep(0.f, 0.02f, rise);
    if (inBox == 0) return {0, 0};
    const vec3 q = carriedBack(p, rise);
    const float away = glm::length(vec3(q.x, 0, q.z));
    // Wide a little above its foot, and pointed.
    const float wide = 0.19f * (0.5f + 0.5f * glm::smoothstep(0.f, 0.22f, rise)) *
                       std::pow(std::max(1.f - rise / 0.9f, 0.f), 0.7f);
    const float tongues = 0.5f * noise(q * vec3(9, 3.5f, 9), noiseSeed_ + 20).value +
                          0.3f * noise(q * vec3(19, 8, 19), noiseSeed_ + 21).value;
    const float body = wide > 0 ? 1.f - away / wide + tongues : -1.f;
    const float heat = glm::smoothstep(0.f, 0.7f, body) * (1.f - 0.3f * rise);
    const float column = 1.f - away / (0.1f + 0.16f * rise) + 0.8f * tongues;
    const float smoke =
        glm::smoothstep(0.f, 0.7f, column) * glm::smoothstep(0.25f, 0.75f, rise) * (1.f - heat) +
        0.12f * heat;
    return {inBox * smoke, inBox * hottest * std::pow(heat, 0.45f)};
  }

 private:
  static float fadeOut(float x, float end) { return 1.f - glm::smoothstep(0.8f * end, end, x); }

  // Where the gas that is at p came from: it rises, and swirls the more the higher.
  vec3 carriedBack(vec3 p, float rise) const {
    const vec3 stretched(1, 0.55f, 1);
    for (int i = 0; i < 3; ++i)
      p -= glm::smoothstep(0.f, 0.5f, rise) * (0.02f * curlNoise(p * stretched * 4.3f, noiseSeed_) +
                                               0.006f * curlNoise(p * stretched * 11.f, noiseSeed_ + 3));
    return p;
  }

  uint32_t noiseSeed_ = 0;
};

// An empty grid that reaches from the ground to `height` and `halfWidth` to all sides, with its margin.
DensityGrid standingGrid(const char* name, int voxelsHigh, double height, double halfWidth) {
  const double voxel = height / voxelsHigh;
  const int reach = static_cast<int>(std::ceil(halfWidth / voxel)) + 1;
  DensityGrid grid;
  grid.name = name;
  grid.origin = {-reach, -1, -reach};
  grid.size = {2 * reach + 1, voxelsHigh + 2, 2 * reach + 1};
  grid.values.assign(grid.valueIndex(0, 0, grid.size.z), 0.f);
  for (int axis = 0; axis < 3; ++axis) grid.worldFromIndex[axis][axis] = voxel;
  return grid;
}

// Calls fill(value's index, position in metres) for all but the margin.
template <typename Fill>
void fillInside(const DensityGrid& grid, const Fill& fill) {
  const auto voxel = static_cast<float>(grid.worldFromIndex[0][0]);
  base::parallelFor(grid.size.z - 2, [&](long slice) {
    const int z = static_cast<int>(slice) + 1;
    for (int y = 1; y < grid.size.y - 1; ++y)
      for (int x = 1; x < grid.size.x - 1; ++x)
        fill(grid.valueIndex(x, y, z), voxel * vec3(grid.origin + ivec3(x, y, z)));
  });
}

void checkSize(int voxelsHigh, double height) {
  base::check(voxelsHigh >= 8 && voxelsHigh <= 512, "a plume or fire is 8 to 512 voxels high");
  base::check(height >= 1 && height <= 20, "a plume or fire is 1 to 20 m high");
}

}  // namespace

DensityGrid makePlume(int voxelsHigh, double height, uint64_t seed) {
  checkSize(voxelsHigh, height);
  DensityGrid grid = standingGrid("density", voxelsHigh, height, halfWidth);
  const Plume plume(static_cast<float>(height), seed);
  fillInside(grid, [&](size_t index, const vec3& p) { grid.values[index] = plume.density(p); });
  return grid;
}

FlameGrids makeFlame(int voxelsHigh, double height, uint64_t seed) {
  checkSize(voxelsHigh, height);
  FlameGrids grids{standingGrid("density", voxelsHigh, height, Flame::halfWidth * height),
                   standingGrid("temperature", voxelsHigh, height, Flame::halfWidth * height)};
  const Flame flame(seed);
  fillInside(grids.smoke, [&](size_t index, const vec3& p) {
    const Flame::Gas gas = flame.at(p / static_cast<float>(height));
    grids.smoke.values[index] = gas.density;
    grids.temperature.values[index] = gas.kelvin;
  });
  return grids;
}

}  // namespace sfumato::volumes
