// Stores items through the engine's own lists, many to a cell and many of one depth.
#define LIST_PAYLOAD uint
#include "shaders/lists/insert.glsl"
#include "shaders/shared/hash.glsl"

void storeItem(uint item) {
  float depth = float(hash(item * 3u + SEED) % DEPTHS);
  listStore(hash(item + SEED) % CELLS, depth, item, ~item);
}
