// Nodes of deep shadow lists.
#include "shaders/lists/linked_insert.glsl"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/geometry.h"

layout(std430, binding = STORAGE_OLD_PAYLOADS) buffer ShadowNodes {
  ShadowNode shadowNodes[];
};

// Smoke sorts behind a surface of the same depth.
const uint SMOKE_ID = 0x80000000u;

// A drop by optical depth `tau` over [depth, depth + range], for `object` see DrawData::indices. Returns the node, 0 when the pool is full.
uint insertShadowNode(uint cell, float depth, float range, vec3 tau, uint object, uint id, uint hint) {
  uint node = listAllocate();
  if (node != 0u) {
    shadowNodes[node].range = range;
    shadowNodes[node].tauRg = packHalf2x16(tau.rg);
    shadowNodes[node].tauBObject = packHalf2x16(vec2(tau.b, 0.0)) | object << 16;
    listInsert(cell, node, depth, id, hint);
  }
  return node;
}

vec3 shadowNodeTau(uint node) {
  return vec3(unpackHalf2x16(shadowNodes[node].tauRg), unpackHalf2x16(shadowNodes[node].tauBObject).x);
}

uint shadowNodeObject(uint node) {
  return shadowNodes[node].tauBObject >> 16;
}
