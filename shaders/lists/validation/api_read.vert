// Says what it was given: attributes (READ_VERTICES), the numbers of its vertices (READ_INDICES), or how many instances.
layout(location = 0) in float value;

layout(std430, binding = 2) buffer Found {
  uint found[];
};

void main() {
#if defined(READ_VERTICES)
  found[gl_VertexID] = uint(value);
#elif defined(READ_INDICES)
  found[gl_VertexID] = 1u;
#else
  atomicMax(found[0], uint(gl_InstanceID) + 1u);
#endif
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
