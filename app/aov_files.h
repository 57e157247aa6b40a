// Where `sfumato render` puts the AOVs: layers of every .exr, and of counts a heat map beside every .png.
#pragma once

#include <string>
#include <vector>

#include "app/options.h"
#include "image/image.h"
#include "pipelines/aovs.h"

namespace sfumato::app {

// What --aov names. Throws Usage where the way of drawing has no such AOV, or no output would hold it.
pipelines::AovSet wantedAovs(const RenderOptions& options);

// Heat maps to be written: picture.png gets picture.lights.png.
std::vector<std::string> heatMapFiles(const RenderOptions& options);

// Black is 0, pale yellow the largest count of the frame, which the metadata and a note say.
void writeHeatMaps(const RenderOptions& options, const pipelines::AovImages& aovs,
                   const image::Metadata& settings);

}  // namespace sfumato::app
