// The figures of a frame as JSON.
#pragma once

#include <string>
#include <vector>

#include "gl/device.h"
#include "pipelines/linked_lists_gpu.h"
#include "pipelines/list_prediction.h"

namespace sfumato::app {

struct RunTimes {
  double startupSeconds = 0;         // from program start to the first frame: files, uploads, shaders
  std::vector<double> frameSeconds;  // wall clock of each frame
  std::vector<gl::PassTime> startupPasses;
  std::vector<gl::PassTime> framePasses;  // of the last frame
};

// `fromBounds`: what was predicted for the frame.
std::string statisticsText(gl::Device& device, const pipelines::FrameStatistics& statistics,
                           const pipelines::ListPrediction& fromBounds, const RunTimes& times);

}  // namespace sfumato::app
