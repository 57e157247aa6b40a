// What a glTF file's JSON must keep to before tinygltf sees it. This room's gltf_json.cpp is the one file of
// the library that includes nlohmann's JSON parser.
#pragma once

#include <string>
#include <string_view>

namespace sfumato::scene {

// Throws Input, in one line that starts with `path`, when the JSON is malformed; when it is nested or filled
// so far that a reader that recurses, or keeps 200 bytes for each value, would exhaust the machine; when a
// buffer other than the first has no uri (each would be another copy of a .glb's binary chunk); when an
// integer that we use is beyond the 32 bits that tinygltf keeps of it, or bytes are counted by a negative or
// broken number.
void checkGltfJson(std::string_view json, const std::string& path);

}  // namespace sfumato::scene
