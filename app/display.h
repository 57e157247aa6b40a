// How `sfumato render` makes pictures for a screen of what was drawn.
#pragma once

#include <functional>

#include "app/options.h"
#include "app/shot.h"
#include "image/tone_map.h"
#include "pipelines/post.h"

namespace sfumato::app {

// What the flags ask for. Throws Usage where a flag has nothing to act on: no .png is written, or no effect
// is on that it belongs to.
pipelines::PostOptions wantedPostProcessing(const RenderOptions& options);

// Measures what was drawn, where a flag needs that.
void measureBrightness(const RenderOptions& options, const Shot& shot, Drawn& drawn);

image::ToneMapping toneMappingOf(const DisplayOptions& options, const image::Brightness& brightness);

// Settings that only pictures for a screen have.
image::Metadata displayMetadata(const RenderOptions& options, const Shot& shot, const Drawn& drawn);

// Post-processes what was drawn.
using PostProcess = std::function<void(Drawn&)>;

// For who draws without a device: opens one at once, so that it is known to be there before long work.
// Nothing is opened or done where no effect is on. Throws NoGl. In display_gpu.cpp; a build without OpenGL
// has another in without_gl.cpp.
PostProcess openPostProcess(const RenderOptions& options, const Shot& shot);

}  // namespace sfumato::app
