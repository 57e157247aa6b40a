// Buffers: how large, what lies behind their end, how exact an index is, and when the CPU sees what shaders
// wrote.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <optional>

#include "base/error.h"
#include "base/memory.h"
#include "gl/commands.h"
#include "gl/profiler.h"
#include "gl/texture.h"
#include "lists/validation/probe_gpu.h"

namespace sfumato::lists::validation {
namespace {

constexpr uint64_t mebi = uint64_t{1} << 20;

// The words of a buffer of `words` that a wrapped or shortened index would confuse.
std::array<uint32_t, 16> places(uint64_t words) {
  std::array<uint32_t, 16> all{};
  size_t used = 0;
  for (const uint64_t place :
       {words - 1, words - 2, words / 2, words / 2 - 1, uint64_t{0}, uint64_t{1}, uint64_t{1} << 24,
        (uint64_t{1} << 24) - 1, uint64_t{1} << 28, (uint64_t{1} << 28) - 1, uint64_t{1} << 29,
        (uint64_t{1} << 29) - 1, words - (uint64_t{1} << 23), uint64_t{2}, uint64_t{3}, uint64_t{4}})
    all[used++] = static_cast<uint32_t>(place < words ? place : used);
  return all;
}

// What is wrong with a buffer of so many bytes; empty when nothing is.
std::string faultOf(const Context& context, uint64_t bytes) {
  const uint64_t words = bytes / 4;
  const gl::Buffer data(context.device, "validation", bytes, gl::Buffer::Whole::Never);
  const auto where = places(words);
  std::array<uint32_t, 33> probed{};
  std::copy(where.begin(), where.end(), probed.begin() + 1);
  const gl::Buffer probe(context.device, "validation", std::span<const uint32_t>(probed));
  data.bindStorage(0);
  probe.bindStorage(1);
  gl::dispatch(probeProgram(context, {"size.comp"}), {1, 1, 1});
  gl::storageBarrier();
  gl::dispatch(probeProgram(context, {"size.comp"}, {{"READ", "1"}}), {1, 1, 1});
  gl::storageBarrier();
  const auto told = probe.readValues<uint32_t>(33);
  if (told[0] != words) return fmt::format("its length() is {}, not {}", told[0], words);
  for (size_t i = 0; i < where.size(); ++i) {
    const uint32_t wanted = where[i] ^ 0x5a5a5a5au;
    if (told[17 + i] != wanted)
      return fmt::format("word {} reads 0x{:08x}, 0x{:08x} was written", where[i], told[17 + i], wanted);
    uint32_t word = 0;
    data.read(std::as_writable_bytes(std::span(&word, 1)), size_t{where[i]} * 4);
    if (word != wanted)
      return fmt::format("word {} was not where the CPU looks: 0x{:08x}, not 0x{:08x}", where[i], word,
                         wanted);
  }
  return {};
}

// Sizes up to the limit of a block that the driver states, or beyond it.
enum class Sizes { Promised, Beyond };

Result sizeLadder(const Context& context, Sizes which) {
  std::vector<uint64_t> sizes = {64 * mebi, 128 * mebi, 256 * mebi};
  if (context.scale == Scale::Full)
    sizes.insert(sizes.end(), {512 * mebi, 1024 * mebi, 2048 * mebi - 4, 2048 * mebi, 2048 * mebi + 4,
                               3072 * mebi, 4096 * mebi - 4});
  const auto limit = static_cast<uint64_t>(context.device.limits().storageBlockBytes);
  std::erase_if(sizes, [&](uint64_t bytes) { return (bytes <= limit) != (which == Sizes::Promised); });
  if (sizes.empty())
    return {Verdict::Skip, "no size that is tried is on this side of the limit of a block", {}, {}};
  const std::optional<uint64_t> room = base::freeMemory();
  Result result;
  result.figures = {{"largest block that is promised (MiB)", static_cast<int64_t>(limit / mebi)}};
  for (const uint64_t bytes : sizes) {
    const std::string label = fmt::format("{} bytes", bytes);
    if (room && bytes + bytes / 4 + 512 * mebi > *room) {
      result.figures.emplace_back(label, "not tried: this machine has too little free memory");
      continue;
    }
    std::string fault;
    try {
      fault = faultOf(context, bytes);
    } catch (const base::Error& error) {
      if (error.exitCode != base::ExitCode::Memory) throw;
      result.figures.emplace_back(label, "refused");
      continue;
    }
    result.figures.emplace_back(label, fault.empty() ? "right" : fault);
    if (fault.empty() || result.verdict == Verdict::Fail) continue;
    result.verdict = Verdict::Fail;
    result.finding = fmt::format("a buffer of {} bytes: {}", bytes, fault);
    result.meaning = which == Sizes::Promised
                         ? "large pools are not safe here: keep memory budgets below that size"
                         : "the limit of a block is meant: the engine keeps to it";
  }
  return result;
}

Result outside(const Context& context) {
  constexpr size_t partWords = 1024;
  constexpr uint32_t canary = 0xca11ab1e;
  const std::vector<uint32_t> untouched(3 * partWords, canary);
  const gl::Buffer before(context.device, "validation", std::span<const uint32_t>(untouched));
  const gl::Buffer buffer(context.device, "validation", std::span<const uint32_t>(untouched));
  const gl::Buffer behind(context.device, "validation", std::span<const uint32_t>(untouched));
  const gl::Buffer found = zeroWords(context.device, 65);
  if (context.mutant == "NO_RANGE")
    buffer.bindStorageRange(0, partWords * 4, 2 * partWords * 4);  // too far
  else
    buffer.bindStorageRange(0, partWords * 4, partWords * 4);
  found.bindStorage(1);
  gl::dispatch(probeProgram(context, {"outside.comp"}, {{"PART_WORDS", std::to_string(partWords) + "u"}}),
               {1, 1, 1});
  gl::storageBarrier();
  const auto changed = [&](const gl::Buffer& where, size_t first, size_t count) {
    const auto words = where.readValues<uint32_t>(3 * partWords);
    return static_cast<int64_t>(std::count_if(words.begin() + static_cast<long>(first),
                                              words.begin() + static_cast<long>(first + count),
                                              [](uint32_t word) { return word != canary; }));
  };
  const auto told = found.readValues<uint32_t>(65);
  const int64_t inRest = changed(buffer, 0, partWords) + changed(buffer, 2 * partWords, partWords);
  const int64_t inOthers = changed(before, 0, 3 * partWords) + changed(behind, 0, 3 * partWords);
  const int64_t inPart = changed(buffer, partWords, partWords);
  Result result;
  result.figures = {
      {"length()", int64_t{told[0]}},
      {"words changed in the rest of the buffer", inRest},
      {"words changed in other buffers", inOthers},
      {"words changed inside the part (a wrapped index)", inPart},
      {"reads that were not 0",
       static_cast<int64_t>(std::count_if(told.begin() + 1, told.end(), [](uint32_t w) { return w != 0; }))}};
  if (told[0] != partWords || inRest + inOthers > 0) {
    result.verdict = Verdict::Fail;
    result.finding =
        told[0] != partWords
            ? fmt::format("a part of {} words has length() {}", partWords, told[0])
            : fmt::format("writes past the end of a part changed {} words of its buffer and {} of others",
                          inRest, inOthers);
    result.meaning =
        "an index past the end overwrites what others own: bound every index, as the engine does";
  } else if (inPart > 0) {
    result.finding = "index 2^30 wraps around to the start of its own buffer; nothing else was overwritten";
    result.meaning =
        "a wild index can overwrite the first nodes of a list: bound every index, as the engine does";
  }
  return result;
}

Result index24(const Context& context) {
  constexpr uint32_t far = 1u << 24;
  gl::Device& device = context.device;
  std::vector<uint32_t> wanted;
  for (uint32_t i = 0; i < 16; ++i) wanted.push_back(far + 2 * i + 1);      // a float rounds these
  for (uint32_t i = 0; i < 16; ++i) wanted.push_back(0xffffffffu - 3 * i);  // and takes these for NaN
  for (uint32_t i = 0; i < 16; ++i) wanted.push_back(i);                    // and these for denormals
  for (uint32_t i = 0; i < 16; ++i) wanted.push_back(0x7f800001u + (i << 17));
  const gl::Buffer given(device, "validation", std::span<const uint32_t>(wanted));
  const gl::Texture texture(device, "validation", {.format = gl::Format::R32UI, .size = {64, 1, 1}});
  const gl::Buffer pool(device, "validation", (size_t{far} + 64) * 4);
  const gl::Buffer fromCompute = zeroWords(device, 192);
  const gl::Buffer fromFragments = zeroWords(device, 192);
  given.bindStorage(0);
  fromCompute.bindStorage(1);
  pool.bindStorage(2);
  texture.bindImage(0);
  gl::dispatch(probeProgram(context, {"index.comp"}), {1, 1, 1});
  gl::storageBarrier();
  const gl::Framebuffer nothing(glm::ivec2(64, 1));
  fromFragments.bindStorage(1);
  gl::setDrawState({.program = &probeProgram(context, {"index.vert", "index.frag"}),
                    .target = &nothing,
                    .viewport = {0, 0, 64, 1}});
  const bool vertices = device.limits().vertexStorageBlocks > 0;
  if (vertices) gl::drawGenerated(device, 1, 64, gl::Primitive::Points);
  gl::storageBarrier();

  const auto computed = fromCompute.readValues<uint32_t>(192);
  const auto drawn = fromFragments.readValues<uint32_t>(192);
  std::vector<uint32_t> stored(64);
  pool.read(std::as_writable_bytes(std::span(stored)), size_t{far} * 4);
  const auto wrong = [&](std::span<const uint32_t> values) {
    int64_t count = 0;
    for (size_t i = 0; i < 64; ++i) count += values[i] != wanted[i];
    return count;
  };
  const std::span all(computed);
  const std::span sent(drawn);
  const int64_t exchanged = wrong(all.first(64));
  const int64_t fromImage = wrong(all.subspan(64, 64));
  const int64_t behind = wrong(stored);
  const int64_t flat = vertices ? wrong(sent.first(64)) : 0;
  const int64_t rounded = vertices ? wrong(sent.subspan(128, 64)) : 1;
  Result result;
  result.figures = {{"wrong after an exchange", exchanged},
                    {"wrong from an r32ui image", fromImage},
                    {"wrong at word 2^24 and after it", behind},
                    {"wrong from a flat varying", flat},
                    {"wrong as the bits of a float", vertices ? wrong(sent.subspan(64, 64)) : 0},
                    {"wrong as a float", rounded}};
  if (exchanged + fromImage + behind + flat > 0) {
    result.verdict = Verdict::Fail;
    result.finding = fmt::format(
        "of 64 node numbers {} are wrong after an exchange, {} from an image, {} stored behind "
        "word 2^24, {} from a varying",
        exchanged, fromImage, behind, flat);
    result.meaning = "node numbers are not exact here: pools must stay below 2^24 nodes";
  } else if (rounded == 0) {
    result.verdict = Verdict::NoPower;
    result.finding = "numbers above 2^24 went through a float unharmed";
    result.meaning = "nothing, good or bad";
  }
  return result;
}

Result readback(const Context& context) {
  gl::Device& device = context.device;
  Result result;
  // Clocks: the GPU's goes on, at about the rate of the CPU's; work takes time on it.
  using Clock = std::chrono::steady_clock;
  const auto nanoseconds = [](Clock::duration time) {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(time).count();
  };
  int64_t backwards = 0;
  const auto beforeFirst = Clock::now();
  const int64_t first = gl::timestamp();
  const auto afterFirst = Clock::now();
  int64_t last = first;
  auto beforeLast = afterFirst;
  while (beforeLast - afterFirst < std::chrono::milliseconds(20)) {
    beforeLast = Clock::now();
    const int64_t stamp = gl::timestamp();
    backwards += stamp < last;
    last = stamp;
  }
  const auto afterLast = Clock::now();
  // An operating system may take the thread away anywhere here: between these two the time on the GPU's clock
  // lies.
  const auto least = static_cast<double>(nanoseconds(beforeLast - afterFirst));
  const auto most = static_cast<double>(nanoseconds(afterLast - beforeFirst));
  const auto stamped = static_cast<double>(last - first);
  const bool keepsTime = stamped > 0.9 * least && stamped < 1.1 * most;
  const auto steps = static_cast<uint32_t>(sized(context, 4000, 40000));
  const gl::ShaderDefines work = {{"WORK", std::to_string(steps) + "u"}};
  const gl::Program& program = probeProgram(context, {"layers.vert", "readback.frag"}, work);
  gl::Buffer round = zeroWords(device, 1);
  const gl::Buffer warm = zeroWords(device, 64 * 64);
  warm.bindStorage(0);
  round.bindStorage(1);
  device.profiler().enable();
  {
    const gl::Profiler::Scope scope(device.profiler(), "work");
    drawLayers(device, program, 64, 1);
  }
  const gl::PassTime pass = device.profiler().times().front();
  result.figures = {{"timer bits", int64_t{device.limits().timerBits}},
                    {"stamps that went backwards", backwards},
                    {"GPU clock over CPU clock", stamped / most},
                    {"work by the GPU clock (ms)", pass.gpuMilliseconds},
                    {"work by the CPU clock (ms)", pass.wallMilliseconds}};
  if (backwards > 0 || !keepsTime || pass.gpuMilliseconds <= 0 ||
      pass.gpuMilliseconds > 2 * pass.wallMilliseconds + 1) {
    result.verdict = Verdict::Fail;
    result.finding = fmt::format(
        "timers: {} stamps backwards, {:.2f} of the CPU's rate, {:.3f} ms for work that took {:.3f} ms",
        backwards, stamped / most, pass.gpuMilliseconds, pass.wallMilliseconds);
    result.meaning = "times by the GPU's clock mean nothing here: measure by the wall's";
    return result;
  }
  // What a mapping shows after a fence, and before it.
  if (!device.has("GL_ARB_buffer_storage"))
    return {Verdict::Skip,
            "no GL_ARB_buffer_storage: timers are right, readback was not tried",
            {},
            result.figures};
  uint32_t factor = 1;  // all steps of the work in one
  uint32_t offset = 0;
  for (uint32_t i = 0; i < steps; ++i) {
    factor *= 1664525u;
    offset = offset * 1664525u + 1013904223u;
  }
  int64_t staleAfter = 0;
  int64_t staleBefore = 0;
  for (uint32_t i = 1; i <= 16; ++i) {
    const gl::MappedBuffer told("validation", 64 * 64 * 4);
    const auto stale = [&] {
      std::vector<uint32_t> words(64 * 64);
      std::memcpy(words.data(), told.bytes().data(), told.bytes().size());
      for (uint32_t at = 0; at < words.size(); ++at)
        if (words[at] != factor * (at + i) + offset) return true;
      return false;
    };
    round.writeValue(i);
    told.bindStorage(0);
    round.bindStorage(1);
    drawLayers(device, program, 64, 1);
    gl::barrierBefore(gl::Reader::Mapped);
    const gl::Fence fence;
    gl::flush();
    staleBefore += stale();
    if (context.mutant != "NO_FENCE" && !fence.wait(10))
      return {Verdict::Fail, "a fence was not reached within 10 s", "frames cannot be waited for",
              result.figures};
    staleAfter += stale();
    gl::Fence().wait(10);  // nothing is unmapped while it is drawn into
  }
  result.figures.emplace_back("rounds stale before the fence", staleBefore);
  result.figures.emplace_back("rounds stale after the fence", staleAfter);
  if (staleAfter > 0) {
    result.verdict = Verdict::Fail;
    result.finding = fmt::format("a mapping showed old words after the fence in {} of 16 rounds", staleAfter);
    result.meaning = "read back with glGetBufferSubData, as the engine does";
  } else if (staleBefore == 0) {
    result.verdict = Verdict::NoPower;
    result.finding = "timers are right; the work was done before the fence was waited for";
    result.meaning = "nothing about fences, good or bad";
  }
  return result;
}

}  // namespace

std::vector<Check> memoryChecks() {
  const std::vector<std::string> all = {"spinlock", "lockfree", "append", "count"};
  return {
      {"size-ladder",
       "memory",
       "storage buffers up to the stated limit, at most 256 MiB (full: 4 GiB - 4), their last words and "
       "length()",
       all,
       {"SHORT_INDEX"},
       [](const Context& context) { return sizeLadder(context, Sizes::Promised); }},
      {"size-beyond",
       "memory",
       "the same of buffers over the limit: for information",
       {},
       {},
       [](const Context& context) { return sizeLadder(context, Sizes::Beyond); }},
      {"outside",
       "memory",
       "reads, writes and atomics past the end of a bound range, up to index 2^32 - 1: for information",
       {},
       {"NO_RANGE"},
       outside},
      {"index-24", "memory", "node numbers above 2^24 stay exact", all, {"FLOAT_INDEX"}, index24},
      {"readback",
       "memory",
       "GPU clocks go on, and a mapping shows what was written once the fence is reached: for information",
       {},
       {"NO_FENCE"},
       readback},
  };
}

}  // namespace sfumato::lists::validation
