// How many lists of lights a light is in, without drawing it.
#pragma once

#include "lights/light.h"
#include "shaders/shared/view.h"

namespace sfumato::lights {

constexpr int cellSide = 4;  // pixels of a cell; shaders/lights/light_lists.glsl has the same

// Cells across or down an image of so many pixels.
constexpr int cellsAlong(int pixels) {
  return (pixels + cellSide - 1) / cellSide;
}

// The cells of a camera's whole image in whose lists a point or spot light will be: counted where the light
// covers up to 24 x 24 of them, else estimated from that many.
double cellsReached(const Light& light, const shared::ViewParams& camera);

}  // namespace sfumato::lights
