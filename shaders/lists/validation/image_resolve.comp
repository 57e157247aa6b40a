// A pixel for every cell: its nodes in their order, mixed so that any other order gives another value.
#include "shaders/lists/runs.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std430, binding = 0) writeonly buffer Image {
  uint pixels[];
};

void main() {
  uint cell = linearId();
  if (cell >= CELLS) return;
  ListRun run = listRun(cell);
  uint pixel = 17u;
  for (uint i = 0u; i < run.count && i < 4096u; ++i) pixel = pixel * 31u + listPayloadWord(run.first + i);
  pixels[cell] = pixel;
}
