// Loads for the list container: nodes of which everything is known in advance. Node `number` of a load has a
// cell, a depth and a payload that are hashed from the number and the seed, here and, written separately, in
// shaders/lists/stress/load.glsl; its number is its id. So each node that is read back can be judged alone.
#pragma once

#include <cstdint>
#include <vector>

#include "base/choice.h"

namespace sfumato::lists::stress {

enum class Distribution {
  Uniform,  // every cell gets `layers` nodes: layer after layer, as from quads that fill the picture
  HotSpot,  // half of the nodes in hashed cells anywhere, half in a spot an eighth of the picture in radius
  OneCell,  // `layers * width` nodes, all in one cell
  Hair,     // strands of `width` nodes in clumps: dense roots, frayed tips, many equal depths
};

const base::Choice<Distribution>& distributions();  // "uniform", "hot-spot", "one-cell", "hair"

struct Load {
  int width = 256;  // of the grid of cells, 1 to 16384
  int height = 256;
  int layers = 8;  // mean nodes a cell; but see OneCell
  Distribution distribution = Distribution::Uniform;
  uint32_t payloadWords = 1;
  uint32_t seed = 1;

  size_t cells() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
  size_t nodes() const;
};

// The most nodes of a load: their numbers, and four times them, are 32-bit; checking them takes memory.
constexpr size_t maxNodes = size_t{1} << 28;

struct Node {
  uint32_t cell;
  float depth;  // in (0, 1]
};
Node nodeOf(const Load& load, uint32_t number);
uint32_t payloadWord(const Load& load, uint32_t number, uint32_t word);

// Nodes of each cell.
std::vector<uint32_t> lengthsOf(const Load& load);

// The numbers of a load's nodes by the block of cells that they are in, ascending within it: what a window
// draws.
struct NumbersByBlock {
  static constexpr size_t blockCells = 64;
  std::vector<uint32_t> numbers;
  std::vector<size_t> firsts;  // place of each block's first number, and the end
};
NumbersByBlock numbersByBlock(const Load& load);

}  // namespace sfumato::lists::stress
