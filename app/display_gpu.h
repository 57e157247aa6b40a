// Post-processing of what was drawn, on a device that is open.
#pragma once

#include "app/shot.h"
#include "gl/device.h"

namespace sfumato::app {

// Measures it, and fills `display` where an effect is on; drops AOVs that were drawn for that alone.
void postProcess(gl::Device& device, const RenderOptions& options, const Shot& shot, Drawn& drawn);

}  // namespace sfumato::app
