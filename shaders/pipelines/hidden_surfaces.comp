// Counts the nodes of the camera's lists that lie behind the opaque depth of every sample of their pixel: none is stored
// there, and this proves it. Lists ascend, so such nodes stand at their ends.
#include "shaders/lists/runs.glsl"
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/linear_id.glsl"
#include "shaders/shared/view_block.glsl"

layout(std430, binding = STORAGE_COUNTERS) buffer Counting {
  uint hidden;
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform pixelSampler opaqueDepth;

const uint MOST = 30000u;  // of a pixel: more than none says enough

void main() {
  uint number = linearId();
  if (number >= uint(view.window.z * view.window.w)) return;
  ListRun run = listRun(number);
  if (run.count == 0u) return;
  ivec2 texel = view.window.xy - view.tile.xy + placeInRows(number, view.window.z);
  float opaque = 0.0;
  for (int i = 0; i < SAMPLES; ++i) opaque = max(opaque, texelFetch(opaqueDepth, texel, i).r);
  uint left = run.count;
  while (left > 0u && run.count - left < MOST && listDepth(run.first + left - 1u) >= opaque) --left;
  if (left < run.count) atomicAdd(hidden, run.count - left);
}
