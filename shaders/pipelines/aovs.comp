// What pipelines/aovs.h says of each pixel, but for the transmittance, which the resolve's rays have. ALBEDO is defined
// when the G-buffer holds the base colour.
#include "shaders/deepshadow/lookup.glsl"
#include "shaders/lights/light_lists.glsl"
#include "shaders/lists/runs.glsl"
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/shared/aovs.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/math.glsl"
#include "shaders/shared/resolve_block.glsl"
#include "shaders/shared/view_block.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = STORAGE_AOVS) writeonly buffer Aovs {
  AovPixel aovs[];
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform pixelSampler opaqueDepth;
layout(binding = TEXTURE_SURFACE_0) uniform pixelUsampler opaqueSurface0;
layout(binding = TEXTURE_BASE_COLOUR) uniform pixelSampler opaqueBaseColour;

const uint LIST_LIMIT = 20000u;  // of each of two walks: below the drivers' loop limit

// Nodes in the texels, of surfaces and of smoke, of a light's map that hold a point which the light reaches.
uint nodesOfTexel(uint number, vec3 p) {
  LightData light = lightAt(number);
  vec3 toLight;
  if (light.indices.y < 0 || maxComponent(lightFrom(light, p, toLight)) <= 0.0) return 0u;
  ShadowFace face = shadowFaceAt(light.indices.y + faceTowards(light.indices.z, p - light.position.xyz));
  vec3 pFace = (face.faceFromWorld * vec4(p, 1.0)).xyz;
  vec2 xy = face.texels.z != 0 ? pFace.xy / max(-pFace.z, 1e-20) : pFace.xy;
  vec2 place = xy * face.projection.xy + face.projection.zw;
  uint nodes = knotCount(shadowTexel(texelNumber(face, ivec2(floor(place)))));
  if (face.texels.w != 0) nodes += knotCount(shadowTexel(smokeTexelNumber(face, ivec2(floor(smokePlace(face, place))))));
  return nodes;
}

// Depth of a sample's surface where the sample is; G-buffers hold it for the pixel's centre.
float depthAtSample(ivec2 pixel, vec2 centre, float depth, int number) {
#if SAMPLES > 1
  if (depth < NOTHING_SEEN) {
    uvec4 words = texelFetch(opaqueSurface0, pixel - view.tile.xy, number);
    vec3 normal = mat3(view.viewFromWorld) * unitFromOctahedral(unpackSnorm2x16(words.y));
    vec2 there = imagePlane(view, vec2(pixel) + samplePosition(params, number));
    return depthOnPlane(view, normal, centre, depth, there);
  }
#endif
  return depth;
}

void main() {
  ivec2 pixel = view.window.xy + ivec2(gl_GlobalInvocationID.xy);
  if (!hasList(view, pixel)) return;
  ivec2 texel = pixel - view.tile.xy;
  vec2 plane = imagePlane(view, vec2(pixel) + 0.5);
  float depth = NOTHING_SEEN;  // at the pixel's centre, of the surface that is nearest where its sample is
  float least = NOTHING_SEEN;
  int nearest = 0;
  vec3 albedo = vec3(0.0);
  for (int i = 0; i < SAMPLES; ++i) {
    float seen = texelFetch(opaqueDepth, texel, i).r;
    float there = depthAtSample(pixel, plane, seen, i);
    if (there < least) {
      least = there;
      depth = seen;
      nearest = i;
    }
#ifdef ALBEDO
    albedo += texelFetch(opaqueBaseColour, texel, i).rgb / float(SAMPLES);
#endif
  }
  bool opaque = depth < NOTHING_SEEN;
  vec3 normal = opaque ? unitFromOctahedral(unpackSnorm2x16(texelFetch(opaqueSurface0, texel, nearest).x)) : vec3(0.0);

  vec3 pView = view.halfExtent.z != 0.0 ? vec3(plane, -depth) : depth * vec3(plane, -1.0);
  vec3 p = opaque ? (view.worldFromView * vec4(pView, 1.0)).xyz : vec3(0.0);
  uint directional = uint(params.options.z);
  uint shadowNodes = 0u;
  if (opaque)
    for (uint light = 0u; light < min(directional, LIST_LIMIT); ++light) shadowNodes += nodesOfTexel(light, p);
  ListRun run = lightRun(lightCell(pixel, view.window));
  for (uint i = 0u; i < min(opaque ? run.count : 0u, LIST_LIMIT); ++i) {
    ListedLight listed = listedLight(run.first + i);
    if (listed.front <= depth && depth <= listed.back) shadowNodes += nodesOfTexel(listed.light, p);
  }
  aovs[listOfPixel(view, pixel)] = AovPixel(depth, normal.x, normal.y, normal.z, albedo.r, albedo.g, albedo.b,
                                            directional + run.count, listRun(listOfPixel(view, pixel)).count, shadowNodes);
}
