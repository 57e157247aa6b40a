// Instances and their materials (scene/geometry): rows of gl::Records.
#include "shaders/shared/bindings.h"
#include "shaders/shared/geometry.h"

layout(binding = TEXTURE_DRAWS) uniform usamplerBuffer drawRows;          // of DrawData
layout(binding = TEXTURE_MATERIALS) uniform usamplerBuffer materialRows;  // of MaterialData

vec4 drawRow(int row) {
  return uintBitsToFloat(texelFetch(drawRows, row));
}

DrawData drawAt(uint number) {
  int row = 9 * int(number);
  return DrawData(mat4(drawRow(row), drawRow(row + 1), drawRow(row + 2), drawRow(row + 3)),
                  mat4(drawRow(row + 4), drawRow(row + 5), drawRow(row + 6), drawRow(row + 7)),
                  ivec4(texelFetch(drawRows, row + 8)));
}

vec4 materialRow(int row) {
  return uintBitsToFloat(texelFetch(materialRows, row));
}

MaterialData materialAt(int number) {
  int row = (6 + 2 * MATERIAL_TEXTURES) * number;
  MaterialData material;
  material.baseColour = materialRow(row);
  material.emissive = materialRow(row + 1);
  material.specularColour = materialRow(row + 2);
  material.factors = materialRow(row + 3);
  material.flags = ivec4(texelFetch(materialRows, row + 4));
  material.shadow = materialRow(row + 5);
  for (int i = 0; i < 2 * MATERIAL_TEXTURES; ++i) material.uvTransforms[i] = materialRow(row + 6 + i);
  return material;
}
