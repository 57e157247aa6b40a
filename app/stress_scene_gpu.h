// The lists of a real scene under stress.
#pragma once

#include <functional>

#include "app/stress.h"
#include "gl/device.h"

namespace sfumato::app {

// Draws a small frame of the scene with each number of lights, strategy and budget, and adds three runs of
// each to the result: the lists of its deep shadow maps, of its lights and of its surfaces. The pictures must
// have the same bits whatever the strategy and the budget. Ends early when `stop` says so.
void stressScene(gl::Device& device, const StressOptions& options, const std::function<bool()>& stop,
                 StressResult& result);

}  // namespace sfumato::app
