// A small glTF file that moves, for tests.
#pragma once

#include "tests/scene/gltf_builder.h"

namespace sfumato::test {

// A ribbon of 6 vertices, (x, y) = (i / 2, i % 2), facing +Z, at node 0. Node 1 is a joint at the origin,
// node 2 below it one at x = 1, which turns by a quarter about Y from 0 s to 1 s. The vertices at x = 1
// follow both.
inline GltfBuilder bendingRibbon() {
  GltfBuilder gltf;
  std::vector<float> positions, normals, weights;
  std::vector<uint8_t> joints;
  for (int i = 0; i < 6; ++i) {
    positions.insert(positions.end(), {static_cast<float>(i / 2), static_cast<float>(i % 2), 0});
    normals.insert(normals.end(), {0, 0, 1});
    joints.insert(joints.end(), {0, 1, 0, 0});
    const float second = 0.5f * static_cast<float>(i / 2);
    weights.insert(weights.end(), {1 - second, second, 0, 0});
  }
  Json attributes;
  attributes["POSITION"] = gltf.accessor<float>("VEC3", positions);
  attributes["NORMAL"] = gltf.accessor<float>("VEC3", normals);
  attributes["JOINTS_0"] = gltf.accessor<uint8_t>("VEC4", joints);
  attributes["WEIGHTS_0"] = gltf.accessor<float>("VEC4", weights);
  const int indices = gltf.accessor<uint8_t>("SCALAR", {0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5});
  gltf.meshNode({{"attributes", attributes}, {"indices", indices}});
  gltf.json["nodes"][0]["skin"] = 0;
  gltf.add("nodes", {{"name", "shoulder"}, {"children", {2}}});
  gltf.add("nodes", {{"name", "elbow"}, {"translation", {1, 0, 0}}});
  const int binds = gltf.view<float>(
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1});
  const int bindAccessor =
      gltf.add("accessors", {{"bufferView", binds}, {"componentType", 5126}, {"count", 2}, {"type", "MAT4"}});
  gltf.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", bindAccessor}});
  const int times = gltf.accessor<float>("SCALAR", {0, 1});
  const int turns = gltf.accessor<float>("VEC4", {0, 0, 0, 1, 0, 0.70710678f, 0, 0.70710678f});
  gltf.add("animations",
           {{"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}})},
            {"samplers", Json::array({{{"input", times}, {"output", turns}}})}});
  return gltf;
}

}  // namespace sfumato::test
