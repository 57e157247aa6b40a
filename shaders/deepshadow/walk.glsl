// Lookups in linked lists as Lindbeck 2015 has them, for comparisons: a walk from the head of a texel's list through all
// nodes up to the depth that is asked for.
layout(binding = TEXTURE_SHADOW_KNOTS) uniform usamplerBuffer shadowLinks;  // ListLink
layout(binding = TEXTURE_SHADOW_NODES) uniform usamplerBuffer shadowNodes;  // ShadowNode

vec3 opticalDepthAt(ShadowTexel texel, float depth) {
  vec3 tau = vec3(0.0);
  uint node = texel.first;
  while (node != 0u) {
    uvec3 link = texelFetch(shadowLinks, int(node)).xyz;
    float at = uintBitsToFloat(link.x);
    if (at <= depth) {
      uvec2 words = texelFetch(shadowNodes, int(node)).xy;
      if (link.y >= SHADOW_SMOKE_IDS)
        tau += uintBitsToFloat(words.y) * clamp((depth - at) / (uintBitsToFloat(words.x) - at), 0.0, 1.0);
      else
        tau += vec3(unpackHalf2x16(words.x), unpackHalf2x16(words.y).x);
    }
    node = at <= depth ? link.z : 0u;
  }
  return tau;
}
