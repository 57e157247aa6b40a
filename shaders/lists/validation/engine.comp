// Stores the items FRAGMENTS … FRAGMENTS + COUNT - 1.
#include "shaders/lists/validation/engine.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  if (linearId() < COUNT) storeItem(FRAGMENTS + linearId());
}
