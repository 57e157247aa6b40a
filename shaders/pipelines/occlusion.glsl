// Places of the view, for the passes of ambient occlusion and for who looks their result up.
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/shared/ambient_occlusion.h"
#include "shaders/shared/math.glsl"
#include "shaders/shared/resolve.h"

// Texels of what the passes read and write, RGBA32UI: bits of the occlusion, 0 to 1, and of the depth (NOTHING_SEEN: nothing), and
// the packed normal of the triangle's plane.
struct Occluded {
  float occlusion;  // the part of the ambient light that is missing
  float depth;
  uint normal;
};

Occluded unpackOccluded(uvec4 texel) {
  return Occluded(uintBitsToFloat(texel.x), uintBitsToFloat(texel.y), texel.z);
}

uvec4 packOccluded(Occluded texel) {
  return uvec4(floatBitsToUint(texel.occlusion), floatBitsToUint(texel.depth), texel.normal, 0u);
}

// Where a surface of depth `depth` stands that is seen at a position of the image, pixels; view space.
vec3 placeOf(ViewParams camera, vec2 position, float depth) {
  vec2 plane = imagePlane(camera, position);
  return camera.halfExtent.z != 0.0 ? vec3(plane, -depth) : depth * vec3(plane, -1.0);
}

// Where a point of the view is seen, pixels of the image. It stands before the camera.
vec2 positionOf(ViewParams camera, vec3 p) {
  vec2 plane = camera.halfExtent.z != 0.0 ? p.xy : p.xy / -p.z;
  return (plane / camera.halfExtent.xy * 0.5 + 0.5) * vec2(camera.size.xy);
}

// The pixel that stands for those of one result.
ivec2 pixelOfResult(ViewParams camera, ivec2 result, int aside) {
  return min(result * aside + aside / 2, camera.size.xy - 1);
}

vec3 normalInView(ViewParams camera, uint words) {
  return mat3(camera.viewFromWorld) * unitFromOctahedral(unpackSnorm2x16(words));
}
