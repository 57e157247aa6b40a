// How long a pipeline takes for a frame.
#pragma once

#include <vector>

#include "pipelines/pipeline_gpu.h"

namespace sfumato::app {

struct TimedFrames {
  pipelines::Frame last;
  std::vector<double> milliseconds;
};

// Draws a frame that compiles what is needed, then `repeat` that are timed, each until its image is here.
TimedFrames timeFrames(pipelines::Pipeline& pipeline, const scene::Camera& camera, int width, int height,
                       const pipelines::Quality& quality, int repeat);

}  // namespace sfumato::app
