// How textures are read; for what describes them (scene/scene.h) and what uploads them (gl/texture.h).
#pragma once

namespace sfumato::scene {

enum class Wrap { Repeat, ClampToEdge, MirroredRepeat };

// Where a texture is smaller on screen: filter within a level, then between levels.
enum class Minify {
  Nearest,
  Linear,
  NearestMipmapNearest,
  LinearMipmapNearest,
  NearestMipmapLinear,
  LinearMipmapLinear
};

}  // namespace sfumato::scene
