// How many texels each light's deep shadow map gets.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lights/light.h"
#include "pipelines/quality.h"
#include "scene/bounds.h"
#include "scene/scene.h"

namespace sfumato::pipelines {

// Image pixels that a light covers from which on its map has the quality's full resolution; below, it has as
// many texels for each pixel. A camera that looks at a small part of what a cone or a face of a cube lights
// gets as many for that part.
constexpr double pixelsOfFullResolution = 640;

// Longest side, in pixels of an image of width x height, of what a light may reach of the `parts`: boxes
// around what is seen of each object and medium. Negative: it reaches none of them. Never too small.
double pixelsLit(const lights::Light& light, std::span<const scene::Bounds> parts,
                 const scene::Camera& camera, int width, int height);

// Texels a side of every light's map; 0 for lights that cast no shadow or reach nothing that is seen.
std::vector<int> shadowResolutions(std::span<const lights::Light> lights,
                                   std::span<const scene::Bounds> parts, const scene::Camera& camera,
                                   int width, int height, const Quality& quality);

}  // namespace sfumato::pipelines
