#include "lists/sorting_network.h"

#include <fmt/format.h>

namespace sfumato::lists {
namespace {

// Merges the sorted halves of every `step`-th element of [first, first + size).
void merge(int first, int size, int step, Network& network) {
  const int next = step * 2;
  if (next >= size) {
    network.emplace_back(first, first + step);
    return;
  }
  merge(first, size, next, network);
  merge(first + step, size, next, network);
  for (int i = first + step; i + step < first + size; i += next) network.emplace_back(i, i + step);
}

void sort(int first, int size, Network& network) {
  if (size <= 1) return;
  sort(first, size / 2, network);
  sort(first + size / 2, size / 2, network);
  merge(first, size, 1, network);
}

}  // namespace

Network sortingNetwork(int size) {
  Network network;
  sort(0, size, network);
  return network;
}

Network mergingNetwork(int size) {
  Network network;
  for (int distance = size / 2; distance > 0; distance /= 2)
    for (int i = 0; i < size; ++i)
      if ((i & distance) == 0) network.emplace_back(i, i + distance);
  return network;
}

std::string networkText(const Network& network) {
  std::string text;
  for (const auto& [first, second] : network) text += fmt::format("S({},{}) ", first, second);
  return text;
}

std::string elementsText(int size) {
  std::string text;
  for (int i = 0; i < size; ++i) text += fmt::format("E({}) ", i);
  return text;
}

}  // namespace sfumato::lists
