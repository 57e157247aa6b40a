// The same picture every time: whatever the order of draws, the strategy, and how many threads a driver has.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>

#include "base/hash.h"
#include "gl/commands.h"
#include "lists/lists_gpu.h"
#include "lists/validation/probe_gpu.h"
#include "lists/validation/runner.h"
#include "shaders/shared/bindings.h"

namespace sfumato::lists::validation {
namespace {

using base::hash;

constexpr Strategy strategies[] = {Strategy::SpinLock, Strategy::LockFree, Strategy::Append, Strategy::Count};

struct Load {
  uint32_t cells;
  uint32_t nodes;
  uint32_t seed;

  uint32_t cellOf(uint32_t node) const { return hash(node + seed) % cells; }
  uint32_t depthOf(uint32_t node) const { return hash(node * 3 + seed) % 5; }
  uint32_t payloadOf(uint32_t node) const { return hash(node * 5 + seed); }
};

using Image = std::vector<uint32_t>;

uint64_t hashOf(const Image& image) {
  uint64_t all = 0xcbf29ce484222325u;  // FNV-1a, a word at a time
  for (const uint32_t pixel : image) all = (all ^ pixel) * 0x100000001b3u;
  return all;
}

Image expectedImage(const Load& load) {
  std::vector<std::vector<uint32_t>> cells(load.cells);
  for (uint32_t node = 0; node < load.nodes; ++node) cells[load.cellOf(node)].push_back(node);
  Image image;
  for (auto& cell : cells) {
    std::sort(cell.begin(), cell.end(), [&](uint32_t a, uint32_t b) {
      return std::pair(load.depthOf(a), a) < std::pair(load.depthOf(b), b);
    });
    uint32_t pixel = 17;
    for (const uint32_t node : cell) pixel = pixel * 31 + load.payloadOf(node);
    image.push_back(pixel);
  }
  return image;
}

Image render(const Context& context, const Load& load, Strategy strategy, uint32_t run) {
  gl::Device& device = context.device;
  const gl::ShaderDefines sizes = {{"NODES", fmt::format("{}u", load.nodes)},
                                   {"CELLS", fmt::format("{}u", load.cells)},
                                   {"SEED", fmt::format("{}u", load.seed)}};
  gl::Buffer order(device, "validation", 16);
  Lists lists(device, "validation lists", load.cells, sizeof(uint32_t), {.strategy = strategy});
  lists.build(device, [&](const Pass& pass) {
    order.writeValue(std::array<uint32_t, 4>{hash(run) | 1u, hash(run + 1000), 0, 0});
    order.bindUniform(UNIFORM_PASS);
    gl::dispatchLinear(probeProgram(context, {"image_store.comp"}, gl::joined(pass.defines, sizes)),
                       load.nodes);
  });
  const gl::Buffer image = zeroWords(device, load.cells);
  lists.bind(TEXTURE_LIST_RUNS, TEXTURE_LIST_KEYS, TEXTURE_LIST_PAYLOADS);
  image.bindStorage(0);
  gl::dispatchLinear(probeProgram(context, {"image_resolve.comp"}, sizes), load.cells);
  gl::storageBarrier();
  return image.readValues<uint32_t>(load.cells);
}

// Says that this process is one of those below.
constexpr const char* otherThreads = "SFUMATO_VALIDATE_OTHER_THREADS";

// The same check in processes whose driver has other numbers of threads: each must pass as well.
void withOtherThreads(const Context& context, Result& result) {
  if (context.again.empty() || std::getenv(otherThreads) != nullptr) return;
  if (!context.device.names().software || interpreted(context.device)) {
    result.figures.emplace_back("numbers of threads", "not for us to choose on this driver");
    return;
  }
  constexpr double timeout = 15;
  std::vector<std::string> threads = {"1", "2", "8"};
  std::vector<Command> commands;
  for (const std::string& count : threads) {
    Command command = {"/usr/bin/env", "LP_NUM_THREADS=" + count, std::string(otherThreads) + "=1"};
    // By its own name: "this program" would be another one in there.
    command.push_back(std::filesystem::canonical(context.again.front()).string());
    command.insert(command.end(), context.again.begin() + 1, context.again.end());
    commands.push_back(std::move(command));
  }
  runCommands(commands, 1, timeout, [&](size_t i, const Ended& ended) {
    const Result other = resultOf(ended, timeout);
    result.figures.emplace_back(threads[i] + " threads", std::string(name(other.verdict)));
    if (result.verdict != Verdict::Pass || other.verdict == Verdict::Pass) return;
    result.verdict = other.verdict;
    result.finding = fmt::format("with {} threads: {}", threads[i], other.finding);
    result.meaning = other.meaning;
  });
}

Result sortedImage(const Context& context) {
  const bool slow = interpreted(context.device);
  const uint32_t cells = slow ? 16 : context.scale == Scale::Full ? 16384 : 4096;
  const uint32_t runs = slow ? 4 : 20;
  const Load load{cells, cells * 8, static_cast<uint32_t>(context.seed)};
  const Image expected = expectedImage(load);
  Result result;
  int64_t wrong = 0;
  for (uint32_t run = 0; run < runs; ++run) {
    const Strategy strategy = strategies[run % std::size(strategies)];
    const Image image = render(context, load, strategy, run);
    if (image == expected) continue;
    int64_t pixels = 0;
    for (size_t i = 0; i < image.size(); ++i) pixels += image[i] != expected[i];
    if (wrong++ == 0)
      result.finding = fmt::format("run {} with strategy {}: {} of {} pixels are not what sorting gives", run,
                                   lists::strategies().nameOf(strategy), pixels, image.size());
  }
  result.figures = {{"runs", int64_t{runs}},
                    {"wrong runs", wrong},
                    {"nodes", int64_t{load.nodes}},
                    {"hash", fmt::format("{:016x}", hashOf(expected))}};
  if (wrong > 0) {
    result.verdict = Verdict::Fail;
    result.meaning =
        "pictures change from run to run, or are wrong: the strategy in which this was seen is not safe";
  }
  withOtherThreads(context, result);
  return result;
}

}  // namespace

std::vector<Check> determinismChecks() {
  return {
      {"sorted-image",
       "determinism",
       "20 images from shuffled nodes in all strategies, and with 1, 2 and 8 threads, are what sorting gives",
       {},
       {"SAME_ID"},
       sortedImage},
  };
}

}  // namespace sfumato::lists::validation
