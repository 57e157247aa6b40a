#include "shaders/lists/validation/live_out.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  uint id = linearId();
  if (id < COUNT) values[id] = liveOut(id);
}
