// How long a pipeline takes for a frame.
#pragma once

#include "pipelines/pipeline_gpu.h"

namespace sfumato::app {

struct TimedFrame {
  pipelines::Frame frame;
  double milliseconds = 0;  // until its image is here
};

TimedFrame timeFrame(pipelines::Pipeline& pipeline, const scene::Camera& camera, int width, int height,
                     const pipelines::Quality& quality);

}  // namespace sfumato::app
