// A frame: what is asked for, what comes of it, and the figures of how it was drawn; whoever draws.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "deepshadow/maps_gpu.h"
#include "image/deep_image.h"
#include "image/image.h"
#include "lists/lists_gpu.h"
#include "pipelines/aovs.h"
#include "pipelines/deep_gpu.h"
#include "pipelines/tiles.h"

namespace sfumato::pipelines {

// How often the pixels of a frame looked at the light lists and the deep shadow maps; a light is asked once
// for up to four steps of a march.
struct Lookups {
  size_t pixels = 0;
  size_t lights = 0;  // asked what they give to a surface or to steps, in all pixels
  size_t shadows = 0;
  size_t mostLights = 0;  // of one pixel
  size_t mostShadows = 0;
  size_t steps = 0;        // of marches through smoke that asked for its density, in all pixels
  size_t jumpedSteps = 0;  // that did not, because nothing is there
};

struct ShadowFigures {
  std::vector<int> resolutions;  // texels a side of each light's map; 0: it has none
  double error = 0;              // the bound that deep maps were built with
  bool lowered = false;          // they are coarser than was asked for, to fit the budget
  size_t bytes = 0;              // of texels and knots; of interlaced maps, of the textures that hold them
  size_t predictedBytes = 0;     // that were counted beforehand; 0: no need
  size_t budgetBytes = 0;
};

struct FrameStatistics {
  lists::ListStatistics surfaces;             // of the camera
  lists::ListStatistics lights;               // light lists
  lists::ListStatistics shadowLists;          // of all deep shadow maps
  std::vector<deepshadow::LightMap> shadows;  // a light each, as in the scene
  ShadowFigures shadowMaps;                   // of all of them
  size_t splitPixels = 0;                     // walked sample by sample
  int resolveDispatches = 0;
  size_t cutWalks = 0;     // 0, or walks that a bound cut: the picture is then wrong, and the user is told
  Lookups lookups;         // where they were to be counted
  int geometryPasses = 0;  // of a pipeline of layers: draws of the scene's surfaces, shadow maps aside
  size_t triangles = 0;
  size_t tiles = 0;  // drawn one after the other; figures are sums over them
};

struct FrameOptions {
  AovSet aovs;                      // those that are not asked for cost nothing
  bool deep = false;                // the deep image as well; nor does this cost anything else
  std::vector<size_t> deepShadows;  // lights that cast shadows, whose maps are wanted as deep images
  DeepLimits deepLimits;
  // Most pixels of a tile, and of a window: the part of a tile that gets lists and rays at a time. Windows
  // are halved where the device has no room. Only tests ask for less.
  size_t tilePixels = pipelines::tilePixels;
  size_t windowPixels = std::numeric_limits<size_t>::max();
  bool countLookups = false;             // by another program, so that frames without are not slower
  std::function<void()> onTile = [] {};  // called as each is done
};

struct Frame {
  image::Image radiance;  // linear RGB
  AovImages aovs;
  std::optional<image::DeepImage> deep;                    // flattened it is the radiance
  std::vector<std::vector<image::DeepImage>> deepShadows;  // a light each, of an image for each face
  FrameStatistics statistics;
};

}  // namespace sfumato::pipelines
