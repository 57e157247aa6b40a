#include "app/display_gpu.h"

#include <memory>

#include "app/display.h"
#include "base/error.h"
#include "pipelines/post_gpu.h"

namespace sfumato::app {

void postProcess(gl::Device& device, const RenderOptions& options, const Shot& shot, Drawn& drawn) {
  const gl::Profiler::Scope time(device.profiler(), "post-processing");
  measureBrightness(options, shot, drawn);
  if (!shot.post.any()) return;
  const double white = 1 / toneMappingOf(options.display, drawn.brightness).scale;
  drawn.display = pipelines::postProcess(
      device, {drawn.radiance, drawn.aovs, white, drawn.brightness.logAverage}, shot.post);
  std::erase_if(drawn.aovs, [&](const auto& aov) { return !shot.aovs.contains(aov.first); });
}

PostProcess openPostProcess(const RenderOptions& options, const Shot& shot) {
  if (!shot.post.any()) return [&](Drawn& drawn) { measureBrightness(options, shot, drawn); };
  try {
    const auto device = std::make_shared<gl::Device>(
        gl::DeviceOptions{.choice = options.device.device, .shaderDir = options.device.shaderDir});
    return [&, device](Drawn& drawn) { postProcess(*device, options, shot, drawn); };
  } catch (const base::Error& error) {
    base::fail(error.exitCode, "--bloom, --aa: need OpenGL, also with --reference: {}", error.what());
  }
}

}  // namespace sfumato::app
