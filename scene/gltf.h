// glTF 2.0 files into a Scene. This room's gltf.cpp is the one file that includes tinygltf.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace sfumato::scene {

// Reads a .gltf or .glb with its buffers and pictures (embedded, data: or beside it).
// Supported: node hierarchies and instances, perspective and orthographic cameras, KHR_lights_punctual,
// metallic-roughness materials with KHR_materials_transmission and KHR_materials_specular, and volumes: a
// node with extras "volume" (path relative to the file), "volume_grid", "volume_scale", "volume_albedo",
// "volume_g". Throws Input in one line that starts with the path: missing, damaged or hostile file, an index
// out of range, a cyclic node graph, a required extension that is not supported (named). An unknown optional
// extension is a warning, once.
Scene readGltf(const std::filesystem::path& path);

}  // namespace sfumato::scene
