#include "lists/stress/load.h"

#include <algorithm>
#include <numeric>

#include "base/hash.h"

namespace sfumato::lists::stress {
namespace {

using base::hash;

// What the hash of a number is used for. shaders/lists/stress/load.glsl has the same.
enum Use : uint32_t {
  Depth,
  Cell,
  Spot,
  SpotX,
  SpotY,
  Clump,
  ClumpRoot,
  ClumpDrift,
  ClumpDepth,
  Fray,
  Payload = 64
};

uint32_t draw(const Load& load, uint32_t number, uint32_t use) {
  return hash(number ^ hash(load.seed * 128u + use));
}

// Two hashed numbers below `radius` summed: a triangle of that radius around `radius`.
uint32_t triangle(uint32_t bits, uint32_t radius) {
  return (bits & 0xffffu) % radius + (bits >> 16) % radius;
}

uint32_t hotSpotCell(const Load& load, uint32_t number) {
  const auto width = static_cast<uint32_t>(load.width), height = static_cast<uint32_t>(load.height);
  if (draw(load, number, Spot) % 2 == 0) return draw(load, number, Cell) % (width * height);
  const uint32_t x = draw(load, 0, SpotX) + triangle(draw(load, number, SpotX), std::max(width / 8, 1u));
  const uint32_t y = draw(load, 0, SpotY) + triangle(draw(load, number, SpotY), std::max(height / 8, 1u));
  return y % height * width + x % width;
}

// Strands run from the left edge to the right. The strands of a clump share root, drift and, nearly, depth.
Node hairNode(const Load& load, uint32_t number) {
  const auto width = static_cast<uint32_t>(load.width), height = static_cast<uint32_t>(load.height);
  const uint32_t strand = number / width, x = number % width;
  const uint32_t clump = draw(load, strand, Clump) % std::max(height / 16, 1u);
  const uint32_t drift = draw(load, clump, ClumpDrift) % height;
  const uint32_t fray = draw(load, strand, Fray) % std::max(height / 8, 1u);
  const uint32_t y = draw(load, clump, ClumpRoot) % height + (drift + fray) * x / width;
  const uint32_t depth = draw(load, clump, ClumpDepth) % 1024u + fray % 8u;
  return {y % height * width + x, static_cast<float>(depth + 1u) / 2048.f};
}

}  // namespace

const base::Choice<Distribution>& distributions() {
  static const base::Choice<Distribution> choice{"--distribution",
                                                 {"uniform", "hot-spot", "one-cell", "hair"}};
  return choice;
}

size_t Load::nodes() const {
  const auto columns = static_cast<size_t>(width), rows = static_cast<size_t>(height);
  return static_cast<size_t>(layers) * columns * (distribution == Distribution::OneCell ? 1 : rows);
}

Node nodeOf(const Load& load, uint32_t number) {
  if (load.distribution == Distribution::Hair) return hairNode(load, number);
  const auto cells = static_cast<uint32_t>(load.cells());
  const float depth = static_cast<float>(draw(load, number, Depth) % 65536u + 1u) / 65536.f;
  switch (load.distribution) {
    case Distribution::HotSpot:
      return {hotSpotCell(load, number), depth};
    case Distribution::OneCell:
      return {draw(load, 0, Cell) % cells, depth};
    default:
      return {number % cells, depth};
  }
}

uint32_t payloadWord(const Load& load, uint32_t number, uint32_t word) {
  return draw(load, number, Payload + word);
}

std::vector<uint32_t> lengthsOf(const Load& load) {
  std::vector<uint32_t> lengths(load.cells());
  const auto nodes = static_cast<uint32_t>(load.nodes());
  for (uint32_t number = 0; number < nodes; ++number) ++lengths[nodeOf(load, number).cell];
  return lengths;
}

NumbersByBlock numbersByBlock(const Load& load) {
  const auto nodes = static_cast<uint32_t>(load.nodes());
  const auto blockOf = [&](uint32_t number) {
    return nodeOf(load, number).cell / NumbersByBlock::blockCells;
  };
  NumbersByBlock result;
  result.firsts.resize((load.cells() - 1) / NumbersByBlock::blockCells + 2);
  for (uint32_t number = 0; number < nodes; ++number) ++result.firsts[blockOf(number) + 1];
  std::partial_sum(result.firsts.begin(), result.firsts.end(), result.firsts.begin());
  std::vector<size_t> next = result.firsts;
  result.numbers.resize(nodes);
  for (uint32_t number = 0; number < nodes; ++number) result.numbers[next[blockOf(number)]++] = number;
  return result;
}

}  // namespace sfumato::lists::stress
