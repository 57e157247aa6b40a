// The number of this invocation in gl::dispatchLinear.
#include "shaders/shared/division.glsl"

layout(local_size_x = 64) in;

// Some drivers give each of their threads a stretch of groups, and what takes long is seldom spread evenly: the whole is cut
// into 8 x 8 bands, of which first the first of each eight are done, then the second ones, and so on.
uint linearId() {
  const uint BANDS_A_SIDE = 8u;
  uint groups = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint band = groups / (BANDS_A_SIDE * BANDS_A_SIDE);
  if (group < band * BANDS_A_SIDE * BANDS_A_SIDE) {
    uint number = quotient(group, band);
    uint inBand = group - number * band;
    group = (number % BANDS_A_SIDE * BANDS_A_SIDE + number / BANDS_A_SIDE) * band + inBand;
  }
  return group * 64u + gl_LocalInvocationID.x;
}
