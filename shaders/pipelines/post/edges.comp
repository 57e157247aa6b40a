// Blurs the picture across the edges of opaque surfaces (Policarpo and Fonseca 2005, section 3.5.1, equation 7 over all
// eight neighbours): eight taps stand as far from the pixel, 0 to 1, as its neighbours' normals and depths differ.
#include "shaders/pipelines/post/post.glsl"

layout(binding = TEXTURE_PICTURE_SURFACES) uniform sampler2D surfaces;  // xyz: normal, 0: nothing; w: 1 / depth

const float QUIET = 0.02;       // sum of squares that is no edge yet
const float DEPTH_WEIGHT = 10.0;  // a step by a tenth of the depth weighs as much as normals a unit apart

// How far `here` is off the plane through two opposite neighbours: 1 / depth is linear on a plane.
float depthStep(float one, float here, float other) {
  return DEPTH_WEIGHT * (one + other - 2.0 * here) / max(max(one, other), max(here, 1e-20));
}

float edge(ivec2 pixel) {
  const ivec2 towards[4] = ivec2[](ivec2(1, 0), ivec2(0, 1), ivec2(1, 1), ivec2(1, -1));
  vec4 here = texelFetch(surfaces, pixel, 0);
  float sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    bvec2 inside = bvec2(isInside(pixel - towards[i], params.sizes.xy), isInside(pixel + towards[i], params.sizes.xy));
    vec4 one = inside.x ? texelFetch(surfaces, pixel - towards[i], 0) : here;
    vec4 other = inside.y ? texelFetch(surfaces, pixel + towards[i], 0) : here;
    float depth = all(inside) ? depthStep(one.w, here.w, other.w) : 0.0;
    sum += dot(one.xyz - here.xyz, one.xyz - here.xyz) + dot(other.xyz - here.xyz, other.xyz - here.xyz) + depth * depth;
  }
  return clamp(sum - QUIET, 0.0, 1.0);
}

void main() {
  ivec2 pixel = pixelHere();
  if (!isInside(pixel, params.sizes.zw)) return;
  vec4 here = texelFetch(picture, pixel, 0);
  float offset = edge(pixel);
  if (offset <= 0.0) {
    imageStore(result, pixel, here);
    return;
  }
  // The pixel counts twice beside its eight taps; each tap is bilinear, so the nine pixels around have these weights.
  float left = 1.0 - offset;
  float weights[3] = float[](2.0 + 4.0 * left + 4.0 * left * left, offset + 2.0 * offset * left, offset * offset);
  vec3 sum = vec3(0.0);
  float total = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      vec3 light = texelFetch(picture, clamp(pixel + ivec2(x, y), ivec2(0), params.sizes.xy - 1), 0).rgb;
      // As dim as a screen would show it: else a lamp's edge would stay as jagged as it is.
      float weight = weights[abs(x) + abs(y)] / (1.0 + luminance(light) / params.light.x);
      sum += weight * light;
      total += weight;
    }
  imageStore(result, pixel, vec4(sum / total, here.a));
}
