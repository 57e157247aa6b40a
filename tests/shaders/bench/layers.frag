// A node of hashed depth in [0, 1) for every pixel and layer.
#define LIST_PAYLOAD float
#include "shaders/lists/insert.glsl"
#include "shaders/shared/hash.glsl"
#include "shaders/shared/view.h"

layout(std140, binding = UNIFORM_VIEW) uniform View {
  ViewParams view;
};
flat in uint vLayer;

void main() {
  uint cell = uint(int(gl_FragCoord.y) * view.size.x + int(gl_FragCoord.x));
  uint bits = hash(cell * 977u + vLayer * 0x9e3779b9u);
  listStore(cell, float(bits >> 8) * (1.0 / 16777216.0), vLayer, 0.01 + float(bits & 0xffu) * 0.0005);
}
