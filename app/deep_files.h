// Where `sfumato render` puts deep images: --deep and --deep-shadow.
#pragma once

#include <string>
#include <vector>

#include "app/options.h"
#include "image/image.h"
#include "scene/scene.h"

namespace sfumato::app {

struct Drawn;

// Their files. Throws Usage where one is no .exr, or the way of drawing has no lists.
std::vector<std::string> deepFiles(const RenderOptions& options);

// The lights that --deep-shadow names, as numbers in the scene. Throws Usage for one that is not there or
// casts no shadow.
std::vector<size_t> deepShadowLights(const RenderOptions& options, const scene::Scene& scene);

void writeDeepFiles(const RenderOptions& options, const Drawn& drawn, const image::Metadata& settings);

}  // namespace sfumato::app
