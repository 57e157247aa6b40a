// What both ways of building light lists cost beside each other, in one run: lights of all types in a room of
// 12 x 6 x 12 m, 640x480. Prints milliseconds (the median of some runs).
//   light_lists_bench [RUNS]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include "base/error.h"
#include "base/random.h"
#include "lights/light_lists_gpu.h"
#include "scene/camera_view.h"

namespace sfumato {
namespace {

using lights::Light;
using lights::LightListBuild;
using lights::LightType;

constexpr int width = 640, height = 480;

std::vector<Light> lightsInRoom(int count, double range) {
  base::Random random(1);
  std::vector<Light> lights;
  for (int i = 0; i < count; ++i) {
    Light light;
    light.type = i % 2 == 0 ? LightType::Point : LightType::Spot;
    light.position = {random.uniform(-6, 6), random.uniform(0, 6), random.uniform(-6, 6)};
    light.direction =
        glm::normalize(glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    light.outerCone = random.uniform(0.2, std::numbers::pi / 3);
    light.range = range;
    light.castsShadow = false;
    lights.push_back(light);
  }
  return lights;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

int run(int runs) {
  gl::Device device({});
  device.profiler().enable();
  fmt::print("{}\n", device.names().renderer);
  gl::Buffer view(device, "view", sizeof(shared::ViewParams));
  view.writeValue(scene::cameraView(scene::lookAt({0, 3, 9}, {0, 2, 0}, 0.9), width, height));
  for (const double range : {0.5, 2.0}) {
    for (const int count : {1, 16, 256, 4096}) {
      const std::vector<Light> lights = lightsInRoom(count, range);
      const std::vector<lights::ShadowFaces> shadows(lights.size());
      std::vector<double> times[2];
      std::string passes[2];
      size_t nodes = 0;
      for (int i = 0; i <= runs; ++i) {
        for (const LightListBuild build : {LightListBuild::Raster, LightListBuild::Compute}) {
          device.profiler().reset();
          const auto start = std::chrono::steady_clock::now();
          const lights::LightLists lists(device, {.lights = lights,
                                                  .shadows = shadows,
                                                  .view = view,
                                                  .width = width,
                                                  .height = height,
                                                  .build = build});
          nodes = lists.lists().readRuns().empty() ? 0 : lists.statistics().stored;  // waits for the GPU
          const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
          std::string& text = passes[static_cast<size_t>(build)];
          text.clear();
          for (const gl::PassTime& pass : device.profiler().times())
            text += fmt::format(" {} {:.2f}", pass.name, pass.wallMilliseconds);
          if (i > 0) times[static_cast<size_t>(build)].push_back(time.count());  // the first run compiles
        }
      }
      fmt::print(
          "{:5} lights of range {:3.1f} m, {:8} nodes: raster {:8.2f} ms ({}), compute {:8.2f} ms ({})\n",
          count, range, nodes, median(times[0]), passes[0], median(times[1]), passes[1]);
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace
}  // namespace sfumato

int main(int argumentCount, char** arguments) {
  try {
    return sfumato::run(argumentCount > 1 ? std::max(1, std::atoi(arguments[1])) : 5);
  } catch (const sfumato::base::Error& error) {
    fmt::print(stderr, "light_lists_bench: error: {}\n", error.what());
    return static_cast<int>(error.exitCode);
  }
}
