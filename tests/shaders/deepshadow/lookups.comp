// Asks a light's shadow maps at points; tests/deepshadow/interlaced_maps_gpu_test.cpp tells.
#include "shaders/deepshadow/shadows.glsl"
#include "shaders/shared/linear_id.glsl"

struct Probe {
  vec4 point;   // xyz, world; w: texels across that a lookup asks
  vec4 normal;  // xyz, of the surface it lies on; 0: a point in smoke; w: the light's first face
  vec4 light;   // xyz: the light's position; w: its faces
};

layout(std430, binding = 0) readonly buffer Probes {
  Probe probes[];
};
layout(std430, binding = 1) writeonly buffer Answers {
  vec4 answers[];
};

void main() {
  if (linearId() >= uint(probes.length())) return;
  Probe probe = probes[linearId()];
  vec3 point = probe.point.xyz;
  int side = int(probe.point.w);
  int firstFace = int(probe.normal.w);
  int faces = int(probe.light.w);
  vec3 passing;
  if (probe.normal.xyz == vec3(0.0)) {
    ShadowFace face = shadowFaceAt(firstFace + faceTowards(faces, point - probe.light.xyz));
    passing = shadowInSmoke(face, (face.faceFromWorld * vec4(point, 1.0)).xyz, side);
  } else {
    passing = shadowOnSurface(firstFace, faces, probe.light.xyz, point, probe.normal.xyz, 0u, side);
  }
  answers[linearId()] = vec4(passing, 1.0);
}
