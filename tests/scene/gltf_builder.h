// Small glTF files for tests: JSON that a test may bend, and one buffer.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "tests/base/temporary_folder.h"

namespace sfumato::test {

using Json = nlohmann::json;

inline std::string base64(std::span<const uint8_t> bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

template <typename T>
constexpr int componentType() {
  if constexpr (std::is_same_v<T, int8_t>) return 5120;
  if constexpr (std::is_same_v<T, uint8_t>) return 5121;
  if constexpr (std::is_same_v<T, int16_t>) return 5122;
  if constexpr (std::is_same_v<T, uint16_t>) return 5123;
  if constexpr (std::is_same_v<T, uint32_t>) return 5125;
  return 5126;
}

struct GltfBuilder {
  Json json = {{"asset", {{"version", "2.0"}}}};
  std::vector<uint8_t> buffer;

  template <typename T>
  int view(const std::vector<T>& values) {
    buffer.resize((buffer.size() + 3) / 4 * 4);
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", values.size() * sizeof(T)}});
    const auto* bytes = reinterpret_cast<const uint8_t*>(values.data());
    buffer.insert(buffer.end(), bytes, bytes + values.size() * sizeof(T));
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  // An accessor of `type` "SCALAR", "VEC3", … over its own view.
  template <typename T>
  int accessor(const char* type, const std::vector<T>& values, bool normalized = false) {
    const size_t width = type[0] == 'S' ? 1 : static_cast<size_t>(type[3] - '0');
    const int over = view(values);
    json["accessors"].push_back({{"bufferView", over},
                                 {"componentType", componentType<T>()},
                                 {"count", values.size() / width},
                                 {"type", type}});
    if (normalized) json["accessors"].back()["normalized"] = true;
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  int add(const char* list, Json value) {
    json[list].push_back(std::move(value));
    return static_cast<int>(json[list].size()) - 1;
  }

  // A mesh of one primitive, a node for it, and nothing else.
  int meshNode(Json primitive) {
    const int mesh = add("meshes", {{"primitives", Json::array({std::move(primitive)})}});
    return add("nodes", {{"mesh", mesh}});
  }

  Json& light(Json value) {
    Json& lights = json["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(std::move(value));
    const auto index = lights.size() - 1;
    Json& node = json["nodes"].emplace_back();
    node["extensions"]["KHR_lights_punctual"]["light"] = index;
    return node;
  }

  std::string text() const {
    Json whole = json;
    if (!buffer.empty() && !whole.contains("buffers"))
      whole["buffers"] = Json::array({{{"byteLength", buffer.size()},
                                       {"uri", "data:application/octet-stream;base64," + base64(buffer)}}});
    return whole.dump();
  }

  std::string binary() const {
    Json whole = json;
    if (!buffer.empty() && !whole.contains("buffers"))
      whole["buffers"] = Json::array({{{"byteLength", buffer.size()}}});
    std::string text = whole.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string chunk(buffer.begin(), buffer.end());
    chunk.resize((chunk.size() + 3) / 4 * 4, '\0');
    std::string file = "glTF";
    const auto word = [&](size_t value) {
      for (int shift = 0; shift < 32; shift += 8) file += static_cast<char>(value >> shift & 0xff);
    };
    word(2);
    word(20 + text.size() + (chunk.empty() ? 0 : 8 + chunk.size()));
    word(text.size());
    file += "JSON" + text;
    if (!chunk.empty()) {
      word(chunk.size());
      file += std::string("BIN\0", 4) + chunk;
    }
    return file;
  }
};

// One triangle (0,0,0) (1,0,0) (0,1,0), indexed, with no normals, at node 0.
inline GltfBuilder triangle() {
  GltfBuilder gltf;
  const int position = gltf.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int indices = gltf.accessor<uint16_t>("SCALAR", {0, 1, 2});
  gltf.meshNode({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
  return gltf;
}

}  // namespace sfumato::test
