#include "app/frame_times_gpu.h"

#include "app/shot.h"

namespace sfumato::app {

TimedFrame timeFrame(pipelines::Pipeline& pipeline, const scene::Camera& camera, int width, int height,
                     const pipelines::Quality& quality) {
  const Clock::time_point start = Clock::now();
  pipelines::Frame frame = pipeline.render(camera, width, height, quality);
  return {std::move(frame), 1000 * secondsSince(start)};
}

}  // namespace sfumato::app
