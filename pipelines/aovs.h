// What a frame can tell of a pixel beside its radiance (arbitrary output variables), for compositing and for
// looking at what the lists hold.
#pragma once

#include <map>
#include <set>

#include "base/choice.h"
#include "image/image.h"

namespace sfumato::pipelines {

// The opaque surface is the nearest one that is neither BLEND nor transmissive and that no MASK cuts. Where a
// pixel has several samples, each says for the GPU what is at the pixel's centre.
enum class Aov {
  Depth,          // metres along the view's axis to the opaque surface, the nearest of the samples'; infinity
  Normal,         // its shading normal in the world, unit, towards the viewer, of the nearest sample; 0
  Albedo,         // its base colour, linear, mean of the samples; 0
  Transmittance,  // to it, or to the end of what is seen, through surfaces and smoke; mean of the samples.
                  // The GPU stops below the quality's throughput cutoff
  Lights,         // directional lights, and those in the light list of the pixel's 4x4 cell. GPU only
  Fragments,      // translucent fragments before it: on the GPU those in the pixel's list, whatever samples
                  // they cover; of the reference the most of any sample
  ShadowNodes  // nodes in the texels of the deep shadow maps that the opaque surface lies in at the pixel's
               // centre, one texel for each light that reaches it; 0 where there is no surface. GPU only
};

using AovSet = std::set<Aov>;
using AovImages = std::map<Aov, image::Image>;  // a channel each, or three

const base::Choice<Aov>& aovKinds();  // "depth", "shadow-nodes", ...

// Whether it is a number of things, which a heat map shows.
bool isCount(Aov aov);
// Whether it is of the GPU's lists, which the reference has none of.
bool isOfLists(Aov aov);

// An image of an AOV's channels for each; all zeros.
AovImages emptyImages(const AovSet& aovs, int width, int height);

// As a layer of a file, by the names that compositors know: depth.Z, normal.X Y Z, albedo.R G B, lights.Y;
// what is no letter, digit or underscore becomes one.
image::Layer layerOf(Aov aov, image::Image image);

}  // namespace sfumato::pipelines
