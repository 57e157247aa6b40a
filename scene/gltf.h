// glTF 2.0 files into a Scene. This room's gltf.cpp is the one file that includes tinygltf.
#pragma once

#include <filesystem>
#include <optional>

#include "scene/scene.h"

namespace sfumato::scene {

// Reads a .gltf or .glb (told apart by their first bytes) with its buffers and pictures (embedded, data: or
// beside it): the default scene, else scene 0, else all root nodes.
//
// Supported: node hierarchies of any depth and instances; triangles, strips and fans, indexed or not, of any
// accessor (also strided, normalised and sparse); perspective and orthographic cameras; KHR_lights_punctual;
// metallic-roughness materials with KHR_materials_transmission, _specular, _ior (folded into the specular
// colour), _emissive_strength and _unlit; KHR_texture_transform; KHR_mesh_quantization; PNG and JPEG
// pictures; and volumes: a node with extras "volume" (path relative to the file), "volume_grid",
// "volume_scale", "volume_extinction" (three numbers: its colour), "volume_albedo" (likewise), "volume_g",
// "volume_fire" (a grid that glows), "volume_fire_kelvin", "volume_fire_ramp" (colours),
// "volume_fire_strength", "volume_fire_lights" (an integer): see VolumePlacement; materials with extras
// "shadow_self", "shadow_once" (booleans) and "shadow_rim" (a number, 0 or more): see Material; the scene
// with extras "ambient" (three numbers, 0 to 1e6): see Scene. A warning, once each: points and lines, and
// extensions that are used but not required and not supported. These are left out.
//
// `seconds`: the pose that all animations of the file have at that time, held before their first key and
// after their last; of two that target the same property, the later one in the file counts. Without it the
// scene is at rest, and animations are not read. Morph targets and skins are worked into the vertices:
// instances that differ in shape have meshes of their own, and skinned ones stand in the world.
//
// What is guaranteed, so that no consumer needs a special case:
// - every mesh has a material (the glTF default one is added last where a primitive names none), unit normals
//   (flat ones where the file has none, with vertices of their own), and tangents for its normal texture;
// - front faces are counter-clockwise in the world, and the bitangent there is cross(normal, tangent) * w: an
//   instance with a mirroring transform has a mesh of its own, wound and handed the other way;
// - worldFromObject has an inverse: a transform that flattens its mesh is applied to a mesh of its own;
// - cameras are rotation and translation only; light directions are unit, whatever the scale of the node;
// - cameras and lights have their node's name, else their own; names have no control characters;
// - instances, lights, cameras and volumes are in depth-first order of the nodes.
//
// Throws Input in one line that starts with the path: a missing, damaged or hostile file, an index out of
// range, a cyclic node graph, a number out of its range, a required extension that is not supported (named),
// more than 2^26 vertices and indices, 2^22 instances, or 4 GiB of files beside it or of textures. Throws
// Memory when that is more than the machine has.
Scene readGltf(const std::filesystem::path& path, std::optional<double> seconds = {});

}  // namespace sfumato::scene
