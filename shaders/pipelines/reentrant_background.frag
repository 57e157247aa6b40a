// What a layer's surfaces let through, to be added to the light on them.
#include "shaders/shared/bindings.h"
#include "shaders/shared/resolve.h"
#include "shaders/shared/view_block.glsl"

layout(std430, binding = STORAGE_RAYS) readonly buffer Rays {
  RayState rays[];
};
layout(location = 0) out vec4 background;

void main() {
  RayState ray = rays[int(gl_FragCoord.y) * view.size.x + int(gl_FragCoord.x)];
  background = vec4(ray.radianceR, ray.radianceG, ray.radianceB, 0.0);
}
