// The number of this invocation in gl::dispatchLinear.
layout(local_size_x = 64) in;

uint linearId() {
  return gl_GlobalInvocationID.y * (gl_NumWorkGroups.x * 64u) + gl_GlobalInvocationID.x;
}
