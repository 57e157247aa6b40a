// What the ways of building lists cost beside each other, in one run: full-screen layers of hashed depth,
// nodes with a payload of 4 bytes. Prints milliseconds (the median of some runs) and the ratios that matter.
//   lists_bench [RUNS]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>

#include "base/error.h"
#include "gl/commands.h"
#include "lists/lists_gpu.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/view.h"

namespace sfumato {
namespace {

struct Size {
  int side;
  int layers;
  std::string name() const { return fmt::format("{0} x {0}, {1} layers", side, layers); }
  size_t cells() const { return static_cast<size_t>(side) * static_cast<size_t>(side); }
};

constexpr Size sizes[] = {{256, 32}, {512, 16}, {512, 8}, {1024, 8}};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double milliseconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

class Bench {
 public:
  Bench(gl::Device& device, const Size& size)
      : device_(device),
        size_(size),
        view_(device, "bench", sizeof(shared::ViewParams)),
        results_(device, "bench", size.cells() * sizeof(float)),
        target_(glm::ivec2(size.side)) {
    shared::ViewParams view{};
    view.size = {size.side, size.side, 0, 0};
    view_.writeValue(view);
  }

  void draw(const lists::Pass& pass) {
    const auto side = static_cast<size_t>(size_.side);
    const int firstRow = static_cast<int>(pass.window.firstCell / side);
    const int rows =
        static_cast<int>((pass.window.firstCell + pass.window.cells + side - 1) / side) - firstRow;
    view_.bindUniform(UNIFORM_VIEW);
    gl::setDrawState({.program = &device_.program({"bench/layers.vert", "bench/layers.frag"}, pass.defines),
                      .target = &target_,
                      .viewport = {0, 0, size_.side, size_.side},
                      .scissor = glm::ivec4(0, firstRow, size_.side, rows)});
    gl::drawGenerated(device_, 3, static_cast<size_t>(size_.layers));
  }

  lists::Lists lists(const lists::ListOptions& options) {
    return lists::Lists(device_, "bench", size_.cells(), sizeof(float), options);
  }

  lists::ListStatistics build(lists::Lists& lists) {
    return lists.build(device_, [&](const lists::Pass& pass) { draw(pass); });
  }

  lists::ListStatistics buildWindows(lists::Lists& lists) {
    return lists.buildWindows(
        device_, [&](const lists::Pass& pass) { draw(pass); }, [](const lists::Window&) {});
  }

  double lookUp(const gl::ShaderDefines& defines) {
    const gl::Program& program = device_.program({"bench/lookups.comp"}, defines);
    return milliseconds([&] {
      view_.bindUniform(UNIFORM_VIEW);
      results_.bindStorage(STORAGE_COUNTERS);
      gl::dispatchLinear(program, size_.cells());
      gl::storageBarrier();
      results_.readValue<float>();
    });
  }

  double sumOfResults() const {
    double sum = 0;
    for (const float value : results_.readValues<float>(size_.cells())) sum += value;
    return sum;
  }

  // Linked lists as spin-lock insertion leaves them, for the walk.
  struct Linked {
    gl::Buffer heads, links, payloads, counters, window;
    void bind() const {
      heads.bindStorage(STORAGE_LIST_HEADS);
      links.bindStorage(STORAGE_LIST_NODES);
      payloads.bindStorage(STORAGE_LIST_PAYLOADS);
      counters.bindStorage(STORAGE_LIST_COUNTERS);
      window.bindUniform(UNIFORM_LISTS);
    }
  };
  Linked link() {
    const size_t nodes = size_.cells() * static_cast<size_t>(size_.layers) + 1;
    Linked linked{{device_, "bench", size_.cells() * 8},
                  {device_, "bench", nodes * sizeof(shared::ListLink)},
                  {device_, "bench", nodes * sizeof(float)},
                  {device_, "bench", sizeof(shared::ListCounters) + LIST_TALLIES * 4},
                  {device_, "bench", sizeof(shared::ListWindow)}};
    linked.heads.clear();
    linked.counters.clear();
    linked.window.writeValue(
        shared::ListWindow{{0, static_cast<int>(size_.cells()), static_cast<int>(nodes), 0}});
    linked.bind();
    draw({{{"LIST_PASS", "LIST_PASS_SPINLOCK"}}, {0, size_.cells()}});
    gl::storageBarrier();
    return linked;
  }

 private:
  gl::Device& device_;
  Size size_;
  gl::Buffer view_;
  gl::Buffer results_;
  gl::Framebuffer target_;
};

// Milliseconds of the passes of one build, by name.
std::map<std::string, double> passes(gl::Device& device, Bench& bench, lists::Lists& lists) {
  device.profiler().reset();
  std::map<std::string, double> times;
  times["all"] = milliseconds([&] { bench.build(lists); });
  for (const gl::PassTime& pass : device.profiler().times()) times[pass.name] = pass.wallMilliseconds;
  return times;
}

void compareStrategies(gl::Device& device, const Size& size, int runs) {
  Bench bench(device, size);
  std::vector<lists::Lists> all;
  std::map<std::string, std::vector<double>> times[4];
  for (int i = 0; i < 4; ++i) {
    all.push_back(bench.lists({.strategy = static_cast<lists::Strategy>(i)}));
    bench.build(all.back());  // pools and programs
  }
  for (int run = 0; run < runs; ++run)
    for (int i = 0; i < 4; ++i)
      for (const auto& [name, time] : passes(device, bench, all[static_cast<size_t>(i)]))
        times[i][name].push_back(time);
  const double linked = median(times[0]["link"]);
  const double spinlock = median(times[0]["all"]);
  for (int i = 0; i < 4; ++i) {
    fmt::print("{:24} {:9}", size.name(), lists::strategies().nameOf(static_cast<lists::Strategy>(i)));
    const double time = median(times[i]["all"]);
    fmt::print(" {:7.1f} ms: {:.2f} of spinlock's linking, {:.2f} with its runs;", time, time / linked,
               time / spinlock);
    for (const auto& [name, values] : times[i])
      if (name != "all") fmt::print(" {} {:.1f}", name, median(values));
    fmt::print("\n");
  }
}

void compareLookups(gl::Device& device, const Size& size, int runs) {
  Bench bench(device, size);
  const Bench::Linked linked = bench.link();
  lists::Lists lists = bench.lists({});
  bench.build(lists);
  std::vector<double> walks, cursors;
  double sums[2] = {};
  for (int run = 0; run <= runs; ++run) {
    linked.bind();
    const double walk = bench.lookUp({{"WALK", "1"}});
    sums[0] = bench.sumOfResults();
    lists.bind(TEXTURE_LIST_RUNS, TEXTURE_LIST_KEYS, TEXTURE_LIST_PAYLOADS);
    const double cursor = bench.lookUp({});
    sums[1] = bench.sumOfResults();
    if (run == 0) continue;  // programs
    walks.push_back(walk);
    cursors.push_back(cursor);
  }
  base::check(std::abs(sums[0] - sums[1]) < 1e-4 * sums[0], "both lookups see the same");
  fmt::print("{:24} 64 lookups: walk {:.1f} ms, cursor {:.1f} ms: {:.1f} times faster\n", size.name(),
             median(walks), median(cursors), median(walks) / median(cursors));
}

void compareBudgets(gl::Device& device, const Size& size, int runs) {
  Bench bench(device, size);
  for (int i = 0; i < 4; ++i) {
    const auto strategy = static_cast<lists::Strategy>(i);
    lists::Lists unlimited = bench.lists({.strategy = strategy});
    const lists::ListStatistics demand = bench.build(unlimited);
    lists::Lists limited = bench.lists({.strategy = strategy, .budgetBytes = demand.bytes / 10});
    lists::ListStatistics windows = bench.buildWindows(limited);
    std::vector<double> free, tight;
    for (int run = 0; run < runs; ++run) {
      free.push_back(milliseconds([&] { bench.buildWindows(unlimited); }));
      tight.push_back(milliseconds([&] { windows = bench.buildWindows(limited); }));
    }
    fmt::print("{:24} {:9} 10 % of {:.1f} MiB: {} windows, {} nodes lost, {:.2f} times the time\n",
               size.name(), lists::strategies().nameOf(strategy), static_cast<double>(demand.bytes) / 0x1p20,
               windows.windows, demand.stored - windows.stored, median(tight) / median(free));
  }
}

int run(int runs) {
  gl::Device device({.shaderDir = std::string(SFUMATO_SOURCE_DIR) + "/tests/shaders"});
  device.profiler().enable();
  fmt::print("{}\n", device.names().renderer);
  for (const Size& size : sizes) compareStrategies(device, size, runs);
  for (const Size& size : sizes) compareLookups(device, size, runs);
  for (const Size& size : sizes) compareBudgets(device, size, runs);
  return 0;
}

}  // namespace
}  // namespace sfumato

int main(int argumentCount, char** arguments) {
  try {
    return sfumato::run(argumentCount > 1 ? std::max(1, std::atoi(arguments[1])) : 7);
  } catch (const sfumato::base::Error& error) {
    fmt::print(stderr, "lists_bench: error: {}\n", error.what());
    return static_cast<int>(error.exitCode);
  }
}
