// The three performance tests of Lindbeck 2015, section 3.2, at 1024x768: light lists alone (50 to 250 cone
// lights, no shadows), one deep shadow map (256 to 2048 texels a side, a spot on a flat surface), and both (5
// to 25 lights of 512 x 512 texels, here with smoke). The first and the last stand in the hall of
// demos/make_demo_scene, or in any other glTF file; its lights are left out. Each is drawn as Sfumato does,
// and as the thesis does: lists that stay linked, sorted under spin locks, opaque surfaces in those of the
// shadow maps, and lookups that walk them from the head; the smoke of a texel is then one node, as there, or
// several, which are nearer to the truth.
// Prints milliseconds, the medians of some frames drawn in turn, and their ratios, by the wall clock and, of
// frames, by the processor; passes are those of frames in between, as the profiler waits for each. Where
// there is smoke, how far pictures are from one whose smoke is of reference quality. With an .svg file, plots
// times.
//   thesis_bench SCENE.gltf [FRAMES [PLOT.svg [TEST]]]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <deque>

#include "base/error.h"
#include "base/file.h"
#include "base/random.h"
#include "image/image_file.h"
#include "image/metrics.h"
#include "pipelines/linked_lists_gpu.h"
#include "scene/camera_view.h"
#include "scene/gltf.h"
#include "scene/media.h"
#include "scene/visible_hull.h"

namespace sfumato {
namespace {

constexpr int width = 1024, height = 768;

struct Way {
  std::string name;
  int smokeNodes;  // of linked lists; 0: runs
};
const Way ours{"runs", 0};
const Way thesis{"linked, 1 node of smoke", 1};
const Way finer{"linked, 16 nodes of smoke", 16};

struct Times {
  double lightLists = 0, shadowMaps = 0, resolve = 0, frame = 0;  // ms, wall clock
  double processor = 0;                                           // ms of all threads, of the frame
};

struct Row {
  std::string test;
  std::string size;
  std::string way;
  Times times;
};

struct World {
  scene::Scene scene;
  std::vector<volumes::Medium> media;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// What a scene fills, as far as the camera sees it, or, where there are media, what these fill.
struct Room {
  glm::dvec3 low{1e30};
  glm::dvec3 high{-1e30};
};

Room roomOf(const World& world) {
  Room room;
  const auto add = [&](const std::vector<glm::dvec3>& points) {
    for (const glm::dvec3& p : points) {
      room.low = glm::min(room.low, p);
      room.high = glm::max(room.high, p);
    }
  };
  std::vector<glm::dmat4> boxes;
  for (const volumes::Medium& medium : world.media) boxes.push_back(volumes::worldFromUnit(medium));
  const scene::Scene none;
  const scene::Camera& camera = world.scene.cameras.at(0);
  add(scene::visiblePoints(boxes.empty() ? world.scene : none, boxes, camera, double(width) / height));
  return room;
}

// Cones in the upper half of a room, which look down and aside.
std::vector<lights::Light> coneLights(const Room& room, int count, bool shadows) {
  const auto& [low, high] = room;
  base::Random random(5);
  std::vector<lights::Light> lights;
  for (int i = 0; i < count; ++i) {
    lights::Light light;
    light.type = lights::LightType::Spot;
    const auto within = [&](double from, double to, int axis) {
      return low[axis] + random.uniform(from, to) * (high[axis] - low[axis]);
    };
    light.position = {within(0.15, 0.85, 0), within(0.5, 0.95, 1), within(0.05, 0.95, 2)};
    const glm::dvec3 target(within(0.2, 0.8, 0), within(0, 0.4, 1), within(0.2, 0.7, 2));
    light.direction = glm::normalize(target - light.position);
    light.outerCone = random.uniform(0.3, 0.5);
    light.innerCone = 0.7 * light.outerCone;
    light.range = 0.5 * glm::length(high - low);
    light.intensity = glm::dvec3(random.uniform(0.3, 1), random.uniform(0.3, 1), random.uniform(0.3, 1)) *
                      (light.range * light.range / std::sqrt(count));
    light.castsShadow = shadows;
    lights.push_back(light);
  }
  return lights;
}

// A spot over a floor.
World spotOnFloor() {
  World world;
  scene::Mesh floor;
  for (const auto& [x, z] : {std::pair(-4.f, 4.f), {4.f, 4.f}, {4.f, -4.f}, {-4.f, -4.f}}) {
    scene::Vertex vertex;
    vertex.position = {x, 0, z};
    vertex.normal = {0, 1, 0};
    floor.vertices.push_back(vertex);
  }
  floor.indices = {0, 1, 2, 0, 2, 3};
  world.scene.materials.emplace_back().metallic = 0;
  world.scene.meshes.push_back(floor);
  world.scene.instances.push_back({.mesh = 0});
  world.scene.cameras.push_back(scene::lookAt({0, 3, 6}, {0, 0, 0}, 0.8));
  lights::Light spot;
  spot.type = lights::LightType::Spot;
  spot.position = {1, 3, 0};
  spot.direction = {0, -1, 0};
  spot.intensity = glm::dvec3(20);
  spot.outerCone = 0.5;
  world.scene.lights = {spot};
  return world;
}

Times timesOf(gl::Device& device, double frame) {
  Times times{.frame = frame};
  for (const gl::PassTime& pass : device.profiler().times()) {
    if (pass.name == "light lists") times.lightLists = pass.wallMilliseconds;
    if (pass.name == "deep shadow maps") times.shadowMaps = pass.wallMilliseconds;
    if (pass.name == "resolve") times.resolve = pass.wallMilliseconds;
  }
  return times;
}

class Bench {
 public:
  // Pictures of the first way are written beside `plot`, where that is not empty.
  Bench(gl::Device& device, int frames, std::string plot)
      : device_(device), frames_(frames), plot_(std::move(plot)) {}

  void run(const std::string& test, const std::string& size, const World& world, int shadowResolution,
           const std::vector<Way>& ways) {
    std::deque<pipelines::LinkedListsPipeline> pipelines;  // of each way, as each keeps memory for its own
    for (size_t way = 0; way < ways.size(); ++way) pipelines.emplace_back(device_, world.scene, world.media);
    std::vector<std::vector<Times>> times(ways.size());
    std::vector<image::Image> images(ways.size());
    image::Image reference;
    if (!world.media.empty())
      reference = pipelines::LinkedListsPipeline(device_, world.scene, world.media)
                      .render(world.scene.cameras.at(0), width, height, finest(shadowResolution))
                      .radiance;
    for (int i = 0; i <= frames_; ++i) {
      for (size_t way = 0; way < ways.size(); ++way) {
        const auto draw = [&] {
          images[way] =
              pipelines[way]
                  .render(world.scene.cameras.at(0), width, height, qualityOf(ways[way], shadowResolution))
                  .radiance;
        };
        const std::clock_t processor = std::clock();
        const auto start = std::chrono::steady_clock::now();
        draw();
        const std::chrono::duration<double, std::milli> frame = std::chrono::steady_clock::now() - start;
        if (i == 0) continue;  // compiles
        const double processorTime = 1e3 * static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
        device_.profiler().reset();
        device_.profiler().enable();
        draw();
        device_.profiler().enable(false);
        times[way].push_back(timesOf(device_, frame.count()));
        times[way].back().processor = processorTime;
      }
    }
    if (!plot_.empty())
      image::writeImage(fmt::format("{}.{}.{}.png", plot_, test,
                                    std::string(size.begin(), std::find(size.begin(), size.end(), ' '))),
                        images[0], {});
    for (size_t way = 0; way < ways.size(); ++way) {
      const auto of = [&](double Times::*part) {
        std::vector<double> values;
        for (const Times& one : times[way]) values.push_back(one.*part);
        return median(values);
      };
      const Times medians{of(&Times::lightLists), of(&Times::shadowMaps), of(&Times::resolve),
                          of(&Times::frame), of(&Times::processor)};
      rows_.push_back({test, size, ways[way].name, medians});
      print(rows_.back(), rows_[rows_.size() - 1 - way].times);
      if (!world.media.empty())
        fmt::print("{:60} relative RMSE to smoke of reference quality {:.5f}\n", "",
                   image::compare(images[way], reference).relativeRmse);
      std::fflush(stdout);
    }
  }

  const std::vector<Row>& rows() const { return rows_; }

 private:
  static pipelines::Quality qualityOf(const Way& way, int shadowResolution) {
    pipelines::Quality quality = pipelines::qualityNamed("medium");
    quality.samples = 1;
    quality.shadowResolution = shadowResolution;
    quality.exactShadowResolution = true;
    quality.walkedSmokeNodes = way.smokeNodes;
    if (way.smokeNodes > 0) quality.lists.strategy = lists::Strategy::SpinLock;
    return quality;
  }

  // Of surfaces the same, so that pictures differ by their smoke.
  static pipelines::Quality finest(int shadowResolution) {
    const pipelines::Quality drawn = qualityOf(ours, shadowResolution);
    pipelines::Quality quality = pipelines::qualityNamed("reference");
    quality.samples = drawn.samples;
    quality.shadowResolution = drawn.shadowResolution;
    quality.exactShadowResolution = true;
    quality.surfaceShadows = drawn.surfaceShadows;
    return quality;
  }

  static void print(const Row& row, const Times& first) {
    const auto ratio = [](double a, double b) { return b > 0 ? a / b : 0; };
    fmt::print(
        "{:14} {:12} {:28} light lists {:8.1f}, shadow maps {:9.1f}, resolve {:9.1f}, frame {:9.1f} ms, of "
        "the "
        "processor {:9.1f} ms; times the first: {:.2f}, {:.2f}, {:.2f}, {:.2f}, {:.2f}\n",
        row.test, row.size, row.way, row.times.lightLists, row.times.shadowMaps, row.times.resolve,
        row.times.frame, row.times.processor, ratio(row.times.lightLists, first.lightLists),
        ratio(row.times.shadowMaps, first.shadowMaps), ratio(row.times.resolve, first.resolve),
        ratio(row.times.frame, first.frame), ratio(row.times.processor, first.processor));
  }

  gl::Device& device_;
  int frames_;
  std::string plot_;
  std::vector<Row> rows_;
};

// A panel for each test; of each size and way a bar for the light lists, the shadow maps and the frame.
std::string plot(const std::vector<Row>& rows) {
  constexpr double panelHeight = 260, top = 40, labels = 70, bar = 9, left = 70;
  constexpr const char* colours[3] = {"#cfd8dc", "#90a4ae", "#263238"};
  constexpr const char* names[3] = {"light lists", "deep shadow maps", "frame"};
  std::vector<std::string> tests;
  for (const Row& row : rows)
    if (std::find(tests.begin(), tests.end(), row.test) == tests.end()) tests.push_back(row.test);
  std::string body;
  double widest = 0;
  for (size_t t = 0; t < tests.size(); ++t) {
    const double base = top + static_cast<double>(t) * (panelHeight + labels + top) + panelHeight;
    double most = 0;
    for (const Row& row : rows)
      if (row.test == tests[t]) most = std::max(most, row.times.frame);
    body +=
        fmt::format("<text x='{}' y='{}' class='title'>{}</text>\n", left, base - panelHeight - 12, tests[t]);
    body += fmt::format("<text x='{}' y='{}' text-anchor='end'>{:.0f} ms</text>\n", left - 6,
                        base - panelHeight + 8, most);
    double x = left;
    std::string size;
    for (const Row& row : rows) {
      if (row.test != tests[t]) continue;
      if (row.size != size) {
        x += 24;
        size = row.size;
        body += fmt::format("<text x='{:.0f}' y='{:.0f}'>{}</text>\n", x, base + 16, size);
      }
      const double parts[3] = {row.times.lightLists, row.times.shadowMaps, row.times.frame};
      for (int i = 0; i < 3; ++i) {
        const double length = panelHeight * parts[i] / most;
        body += fmt::format(
            "<rect x='{:.1f}' y='{:.1f}' width='{}' height='{:.1f}' fill='{}'><title>{}, {}: {:.1f} "
            "ms</title></rect>\n",
            x, base - length, bar, length, colours[i], row.way, names[i], parts[i]);
        x += bar;
      }
      body += fmt::format("<text x='{:.0f}' y='{:.0f}' class='way'>{}</text>\n", x - 3 * bar, base + 30,
                          row.way == ours.name     ? "R"
                          : row.way == thesis.name ? "L1"
                                                   : "L16");
      x += 6;
    }
    body +=
        fmt::format("<line x1='{0}' x2='{1:.0f}' y1='{2:.0f}' y2='{2:.0f}' stroke='#888'/>\n", left, x, base);
    widest = std::max(widest, x);
  }
  const double bottom = static_cast<double>(tests.size()) * (panelHeight + labels + top) + top;
  std::string legend;
  for (int i = 0; i < 3; ++i)
    legend += fmt::format(
        "<rect x='{0}' y='{1}' width='12' height='12' fill='{2}'/><text x='{3}' y='{4}'>{5}</text>\n",
        left + 150 * i, bottom - 12, colours[i], left + 150 * i + 18, bottom - 1, names[i]);
  legend +=
      fmt::format("<text x='{}' y='{}'>R: runs; L1, L16: linked lists, 1 and 16 nodes of smoke</text>\n",
                  left, bottom + 20);
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0:.0f}' height='{1:.0f}' viewBox='0 0 {0:.0f} "
      "{1:.0f}'>\n"
      "<style>text{{font:12px "
      "sans-serif;fill:#222}}.title{{font-weight:bold}}.way{{font-size:10px}}</style>\n"
      "<rect width='100%' height='100%' fill='white'/>\n{2}{3}</svg>\n",
      std::max(widest + 30, 560.0), bottom + 36, body, legend);
}

int run(const std::string& path, int frames, const std::string& plotPath, const std::string& only) {
  gl::Device device({});
  fmt::print("{}\n", device.names().renderer);
  World hall{.scene = scene::readGltf(path)};
  hall.media = scene::readMedia(hall.scene);
  const Room room = roomOf(hall);
  if (hall.media.size() > 1) hall.media.erase(hall.media.begin() + 1, hall.media.end());
  World empty{.scene = hall.scene};
  Bench bench(device, frames, plotPath);
  const auto wanted = [&](const char* test) { return only.empty() || only == test; };
  for (int count = 50; wanted("lights") && count <= 250; count += 50) {
    empty.scene.lights = coneLights(room, count, false);
    bench.run("lights", fmt::format("{} lights", count), empty, 512, {ours, thesis});
  }
  const World floor = spotOnFloor();
  for (int side = 256; wanted("shadows") && side <= 2048; side *= 2)
    bench.run("shadows", fmt::format("{0} x {0}", side), floor, side, {ours, thesis});
  for (int count = 5; count <= 25; count += 5) {
    if (!wanted("both") && only != fmt::format("both{}", count)) continue;
    hall.scene.lights = coneLights(room, count, true);
    bench.run("both", fmt::format("{} lights", count), hall, 512, {ours, thesis, finer});
  }
  if (!plotPath.empty()) base::writeFile(plotPath, plot(bench.rows()));
  return 0;
}

}  // namespace
}  // namespace sfumato

int main(int argumentCount, char** arguments) {
  if (argumentCount < 2) {
    fmt::print(stderr, "usage: thesis_bench SCENE.gltf [FRAMES [PLOT.svg [lights|shadows|both|both25]]]\n");
    return 2;
  }
  const auto argument = [&](int i) { return i < argumentCount ? std::string(arguments[i]) : std::string(); };
  try {
    const int frames = argumentCount > 2 ? std::max(1, std::atoi(arguments[2])) : 3;
    return sfumato::run(argument(1), frames, argument(3), argument(4));
  } catch (const sfumato::base::Error& error) {
    fmt::print(stderr, "thesis_bench: error: {}\n", error.what());
    return static_cast<int>(error.exitCode);
  }
}
