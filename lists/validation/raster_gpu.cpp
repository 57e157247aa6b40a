// Fragments whose side effects count: are there as many as there should be, no more and no less?
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/hash.h"
#include "gl/commands.h"
#include "gl/texture.h"
#include "lists/validation/probe_gpu.h"

namespace sfumato::lists::validation {
namespace {

using base::hash;

constexpr const char* vertexFile = "raster_depth.vert";

std::string number(size_t value) {
  return std::to_string(value) + "u";
}

// Draws `layers` instances and counts the fragments of each pixel of `target`, a square.
std::vector<uint32_t> countFragments(const Context& context, const gl::Program& program,
                                     const gl::Framebuffer& target, size_t vertices, size_t layers = 1,
                                     bool depthTest = false) {
  const auto side = static_cast<size_t>(target.size().x);
  const gl::Buffer counts = zeroWords(context.device, side * side);
  counts.bindStorage(0);
  gl::setDrawState(
      {.program = &program, .target = &target, .viewport = {0, 0, target.size()}, .depthTest = depthTest});
  gl::drawGenerated(context.device, vertices, layers);
  gl::storageBarrier();
  return counts.readValues<uint32_t>(side * side);
}

int64_t sum(const std::vector<uint32_t>& counts) {
  int64_t all = 0;
  for (const uint32_t count : counts) all += count;
  return all;
}

Result earlyZ(const Context& context) {
  constexpr int side = 64;
  gl::Device& device = context.device;
  const gl::Texture depth(device, "validation", {.format = gl::Format::Depth32F, .size = {side, side, 1}});
  const gl::Framebuffer target({}, &depth);
  const int64_t pixels = int64_t{side} * side;
  Result result;
  for (const bool early : {true, false})
    for (const bool passes : {true, false}) {
      gl::ShaderDefines defines = {{"SIDE", number(side)}, {"DEPTH", passes ? "0.25" : "0.75"}};
      if (early) defines.emplace_back("EARLY", "1");
      target.clearDepth(0.5f);
      const int64_t counted = sum(countFragments(
          context, probeProgram(context, {vertexFile, "raster_count.frag"}, defines), target, 3, 1, true));
      const int64_t expected = passes || !early ? pixels : 0;
      const std::string label =
          fmt::format("{}, depth {}", early ? "early tests" : "late tests", passes ? "passes" : "fails");
      result.figures.emplace_back(label, counted);
      if (counted == expected || result.verdict == Verdict::Fail) continue;
      result.verdict = Verdict::Fail;
      result.finding =
          fmt::format("{}: {} fragments had side effects, {} should have", label, counted, expected);
      result.meaning =
          early ? "early_fragment_tests is not obeyed: lists hold what is hidden"
                : "fragments that fail the depth test have no side effects here: draw lists without a "
                  "depth test, as the engine does";
    }
  return result;
}

// A cut of the viewport into triangles (shaders/lists/validation/raster_mesh.vert).
struct Mesh {
  std::string name;
  size_t cells = 1;
  bool fan = false;

  size_t vertices() const { return fan ? cells * 4 * 3 : cells * cells * 6; }
  gl::ShaderDefines defines(const Context& context, size_t side) const {
    gl::ShaderDefines all = {
        {"CELLS", number(cells)}, {"SEED", number(context.seed % 1000)}, {"SIDE", number(side)}};
    if (fan) all.emplace_back("FAN", "1");
    return all;
  }
};

Result coverage(const Context& context) {
  const size_t side = sized(context, 128, 512);
  const gl::Framebuffer target(glm::ivec2(static_cast<int>(side)));
  Result result;
  int64_t twiceWithout = 0;
  for (const Mesh& mesh : {Mesh{"1-pixel triangles", side}, Mesh{"4-pixel triangles", side / 4},
                           Mesh{"40-pixel triangles", side / 40 + 1}, Mesh{"slivers", side, true}}) {
    const auto draw = [&](bool swollen) {
      gl::ShaderDefines defines = mesh.defines(context, side);
      if (swollen) defines.emplace_back("SWOLLEN", "1");
      return countFragments(context,
                            probeProgram(context, {"raster_mesh.vert", "raster_count.frag"}, defines), target,
                            mesh.vertices());
    };
    const auto missed = [](const std::vector<uint32_t>& counts) {
      return std::count(counts.begin(), counts.end(), 0u);
    };
    const auto twice = [](const std::vector<uint32_t>& counts) {
      return std::count_if(counts.begin(), counts.end(), [](uint32_t count) { return count > 1; });
    };
    const auto counts = draw(false);
    twiceWithout += twice(draw(true));
    result.figures.emplace_back(mesh.name + ": missed", missed(counts));
    result.figures.emplace_back(mesh.name + ": twice", twice(counts));
    if (result.verdict == Verdict::Fail || missed(counts) + twice(counts) == 0) continue;
    result.verdict = Verdict::Fail;
    result.finding = fmt::format("{}: {} pixels were missed, {} drawn more than once", mesh.name,
                                 missed(counts), twice(counts));
    result.meaning = "surfaces have holes or double nodes along the edges of their triangles";
  }
  result.figures.emplace_back("twice where triangles overlap", twiceWithout);
  if (result.verdict == Verdict::Pass && twiceWithout == 0)
    return {Verdict::NoPower, "triangles that overlap were not counted twice", "nothing, good or bad",
            std::move(result.figures)};
  return result;
}

Result discarded(const Context& context) {
  const size_t side = sized(context, 128, 512);
  const gl::Framebuffer target(glm::ivec2(static_cast<int>(side)));
  const Mesh mesh{"", side / 3};
  const auto expected = countFragments(
      context,
      probeProgram({context.device}, {"raster_mesh.vert", "raster_count.frag"}, mesh.defines(context, side)),
      target, mesh.vertices());
  Result result;
  for (const bool after : {false, true}) {
    gl::ShaderDefines defines = mesh.defines(context, side);
    if (after) defines.emplace_back("DISCARD_AFTER", "1");
    const gl::Buffer heads = zeroWords(context.device, side * side);
    const gl::Buffer nodes = zeroWords(context.device, side * side * 4);
    heads.bindStorage(0);
    nodes.bindStorage(1);
    const gl::Program& program = probeProgram(context, {"raster_mesh.vert", "raster_mask.frag"}, defines);
    gl::setDrawState({.program = &program, .target = &target, .viewport = {0, 0, target.size()}});
    gl::drawGenerated(context.device, mesh.vertices(), 1);
    gl::storageBarrier();
    const auto first = heads.readValues<uint32_t>(side * side);
    const auto next = nodes.readValues<uint32_t>(side * side * 4);
    int64_t wrong = 0;
    int64_t extra = 0;
    for (uint32_t pixel = 0; pixel < first.size(); ++pixel) {
      int64_t length = 0;
      for (uint32_t node = first[pixel]; node != 0 && node < next.size() && length < 1000; node = next[node])
        ++length;
      const bool live = (hash(pixel) & 1u) != 0;
      const int64_t should = after || live ? expected[pixel] : 0;
      wrong += length != should;
      extra += std::max<int64_t>(0, length - should);
    }
    const std::string label = after ? "discard after the push" : "discard before the push";
    result.figures.emplace_back(label + ": nodes", int64_t{next[0]});
    result.figures.emplace_back(label + ": wrong pixels", wrong);
    if (wrong == 0 || result.verdict == Verdict::Fail) continue;
    result.verdict = Verdict::Fail;
    result.finding =
        fmt::format("{}: {} of {} lists are wrong, {} nodes too many", label, wrong, first.size(), extra);
    result.meaning =
        after ? "what a fragment did before it was discarded is lost"
              : "fragments that are cut out, or lanes beside a triangle, push nodes: lists hold too much";
  }
  return result;
}

Result opaqueTiles(const Context& context) {
  const size_t side = sized(context, 256, 1024);
  constexpr size_t layers = 4;
  gl::Device& device = context.device;
  const auto extent = static_cast<int>(side);
  const gl::Texture colour(device, "validation", {.format = gl::Format::RGBA8, .size = {extent, extent, 1}});
  const gl::Texture* const colours[] = {&colour};
  const gl::Framebuffer nothing{glm::ivec2(extent)};
  const gl::Framebuffer coloured(colours, nullptr);
  const auto all = static_cast<int64_t>(side * side * layers);
  const auto count = [&](const gl::Framebuffer& target, bool colourWritten) {
    gl::ShaderDefines defines = {{"SIDE", number(side)}, {"DEPTH", "0.5"}};
    if (colourWritten) defines.emplace_back("COLOUR", "1");
    return sum(countFragments(context, probeProgram(context, {vertexFile, "raster_count.frag"}, defines),
                              target, 3, layers));
  };
  const int64_t bare = count(nothing, false);
  const int64_t drawn = count(coloured, true);
  Result result;
  result.figures = {
      {"fragments", all}, {"counted, nothing attached", bare}, {"counted, colour attached", drawn}};
  if (bare != all) {
    result.verdict = Verdict::Fail;
    result.finding = fmt::format("{} of {} fragments had side effects with nothing attached", bare, all);
    result.meaning = "fragments vanish: no list that they build can be trusted";
  } else if (drawn != all) {
    result.verdict = Verdict::Fail;
    result.finding = fmt::format(
        "{} of {} fragments had side effects where opaque triangles cover a colour attachment; all with "
        "nothing attached",
        drawn, all);
    result.meaning = "lists are built on framebuffers without attachments; the engine does";
  }
  return result;
}

}  // namespace

std::vector<Check> rasterChecks() {
  const std::vector<std::string> all = {"spinlock", "lockfree", "append", "count"};
  return {
      {"early-z",
       "raster",
       "side effects with early and with late depth tests that pass and fail: for information",
       {},
       {"NO_EARLY", "NO_COUNT"},
       earlyZ},
      {"discard",
       "raster",
       "MASK materials: discard before and after the push, lanes beside small triangles",
       all,
       {"NO_DISCARD"},
       discarded},
      {"coverage",
       "raster",
       "triangles that share edges, down to a pixel and to slivers: each pixel exactly once",
       all,
       {"SWOLLEN"},
       coverage},
      {"opaque-tiles",
       "raster",
       "no fragment's side effects vanish under opaque triangles, with a colour attachment: for information",
       {},
       {"NO_COUNT"},
       opaqueTiles},
  };
}

}  // namespace sfumato::lists::validation
