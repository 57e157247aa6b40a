#include "app/frame_times_gpu.h"

#include "app/shot.h"

namespace sfumato::app {

TimedFrames timeFrames(pipelines::Pipeline& pipeline, const scene::Camera& camera, int width, int height,
                       const pipelines::Quality& quality, int repeat) {
  TimedFrames frames{pipeline.render(camera, width, height, quality)};
  for (int i = 0; i < repeat; ++i) {
    const Clock::time_point start = Clock::now();
    frames.last = pipeline.render(camera, width, height, quality);
    frames.milliseconds.push_back(1000 * secondsSince(start));
  }
  return frames;
}

}  // namespace sfumato::app
