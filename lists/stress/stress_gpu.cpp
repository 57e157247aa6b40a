#include "lists/stress/stress_gpu.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/parallel.h"
#include "gl/buffer.h"
#include "gl/commands.h"
#include "lists/stress/guards_gpu.h"
#include "lists/stress/lookups_gpu.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/stress.h"

namespace sfumato::lists::stress {
namespace {

using gl::Profiler;

class Measurement : public Observer {
 public:
  Measurement(gl::Device& device, const Load& load, const ListOptions& options)
      : device_(device),
        load_(load),
        lists_(device, "stress", load.cells(), load.payloadWords * sizeof(uint32_t), observed(options)),
        params_(device, "stress params", sizeof(shared::StressParams)),
        verification_(load) {
    if (options.budgetBytes != 0 && options.onOverflow == OnOverflow::Window) indexNodes();
  }

  Measured run() {
    Measured measured;
    device_.profiler().enable();
    device_.profiler().reset();
    {
      const Profiler::Scope time(device_.profiler(), "stress lists");
      measured.statistics = lists_.buildWindows(
          device_, [&](const Pass& pass) { draw(pass); }, [&](const Window& window) { consume(window); });
    }
    // Counted in powers of 2, so that it may be above the most.
    measured.statistics.p99Spins = std::min(measured.statistics.p99Spins, measured.statistics.maxSpins);
    measured.findings = verification_.findings();
    measured.findings.rebuilt = static_cast<size_t>(measured.statistics.distrusted);
    measured.findings.overwritten = guards_.changedWords();
    measured.statistics.demand = load_.nodes();  // whatever the shaders made of it
    describeFault(measured.findings);
    measured.lookups = load_.cells() * lookupsPerCell;
    measured.buildSeconds = seconds("stress draw");
    measured.lookupSeconds = seconds("lookup");
    measured.resolveSeconds =
        seconds("stress lists") - measured.buildSeconds - measured.lookupSeconds - seconds("stress check");
    return measured;
  }

  void allocates(gl::Device& device) override { guards_.add(device); }
  void built(gl::Device&, const Lists&, const Window&, const Draw&) override {}

 private:
  ListOptions observed(ListOptions options) {
    options.observer = this;
    return options;
  }

  // Of what is no fault of one cell.
  void describeFault(Findings& findings) const {
    if (!findings.fault.empty()) return;
    if (findings.rebuilt > 0)
      findings.fault = "the strategy lost nodes: the lists were built again by another one";
    else if (findings.overwritten > 0)
      findings.fault = fmt::format("{} words beside the lists were overwritten", findings.overwritten);
  }

  // Of every pass of this name, whatever passes it was part of.
  double seconds(const std::string& name) const {
    double milliseconds = 0;
    for (const gl::PassTime& time : device_.profiler().times())
      if (("/" + time.name).ends_with("/" + name)) milliseconds += time.wallMilliseconds;
    return milliseconds / 1000;
  }

  // For windows, as a scissor does for what is rasterised; layers that fill the picture need no index.
  void indexNodes() {
    const auto most = static_cast<size_t>(device_.limits().storageBlockBytes);
    if (load_.distribution == Distribution::Uniform || load_.nodes() * sizeof(uint32_t) > most) return;
    const NumbersByBlock index = numbersByBlock(load_);
    firsts_ = index.firsts;
    numbers_ = gl::Buffer(device_, "stress numbers", std::span<const uint32_t>(index.numbers));
  }

  // Nodes that a pass dispatches: not many more than those of its window.
  struct Dispatched {
    int which = STRESS_ALL;
    size_t first = 0;  // place of the first number
    size_t nodes = 0;
  };
  Dispatched nodesFor(const Window& window) const {
    if (load_.distribution == Distribution::Uniform)
      return {STRESS_LAYERS, 0, window.cells * static_cast<size_t>(load_.layers)};
    if (firsts_.empty()) return {STRESS_ALL, 0, load_.nodes()};
    const size_t block = NumbersByBlock::blockCells;
    const size_t first = firsts_[window.firstCell / block];
    return {STRESS_NUMBERS, first, firsts_[(window.firstCell + window.cells - 1) / block + 1] - first};
  }

  void useParams(const Window& window, const Dispatched& dispatched) {
    params_.writeValue(shared::StressParams{
        .load = {load_.width, load_.height, static_cast<int>(load_.seed),
                 static_cast<int>(load_.distribution)},
        .window = {static_cast<int>(window.firstCell), static_cast<int>(window.cells),
                   static_cast<int>(dispatched.nodes), static_cast<int>(dispatched.first)}});
    params_.bindUniform(UNIFORM_PASS);
  }

  void draw(const Pass& pass) {
    const Dispatched dispatched = nodesFor(pass.window);
    gl::ShaderDefines defines = pass.defines;
    defines.emplace_back("LOAD_WORDS", std::to_string(load_.payloadWords));
    defines.emplace_back("STRESS_NODES", std::to_string(dispatched.which));
    const gl::Program& program = device_.program({"lists/stress/insert.comp"}, defines);
    useParams(pass.window, dispatched);
    if (dispatched.which == STRESS_NUMBERS) numbers_.bindStorage(STORAGE_STRESS_NUMBERS);
    const Profiler::Scope time(device_.profiler(), "stress draw");
    gl::dispatchLinear(program, dispatched.nodes);
  }

  void consume(const Window& window) {
    const std::vector<uint32_t> sums = lookUp(device_, lists_, window, 1.f, "stress check");
    const Profiler::Scope time(device_.profiler(), "stress check");
    const std::vector<shared::ListRun> runs = lists_.readRuns();
    const std::vector<shared::ListKey> keys = lists_.readKeys();
    const std::vector<uint32_t> payloads = lists_.readPayloads();
    base::parallelFor(static_cast<long>(window.cells), [&](long i) {
      const shared::ListRun& run = runs[static_cast<size_t>(i)];
      const auto cell = static_cast<uint32_t>(window.firstCell + static_cast<size_t>(i));
      if (size_t{run.first} + run.count > keys.size()) {
        verification_.addBrokenRun(cell, run.first, run.count);
        return;
      }
      std::vector<NodeKey> nodes(run.count);
      uint32_t sum = 0;
      for (uint32_t k = 0; k < run.count; ++k) {
        const shared::ListKey& key = keys[run.first + k];
        nodes[k] = {key.depth, key.id};
        sum += lookupsThatFind(key.depth, 1.f);
      }
      verification_.addCell(cell, nodes,
                            std::span(payloads).subspan(size_t{run.first} * load_.payloadWords,
                                                        size_t{run.count} * load_.payloadWords));
      if (sum != sums[static_cast<size_t>(i)]) verification_.addMisread(cell);
    });
  }

  gl::Device& device_;
  const Load load_;
  Guards guards_;
  Lists lists_;
  gl::Buffer params_;
  gl::Buffer numbers_;  // NumbersByBlock, where windows need them
  std::vector<size_t> firsts_;
  Verification verification_;
};

}  // namespace

Measured measure(gl::Device& device, const Load& load, const ListOptions& options) {
  return Measurement(device, load, options).run();
}

}  // namespace sfumato::lists::stress
