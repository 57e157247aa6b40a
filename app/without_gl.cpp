// Stands in for what needs OpenGL, in a build without it.
#ifndef SFUMATO_GL
#include "app/display.h"
#include "app/options.h"
#include "app/shot.h"
#include "base/error.h"

namespace sfumato::app {

Drawn drawOnGpu(const RenderOptions&, const Shot&, Clock::time_point) {
  base::fail(base::ExitCode::NoGl,
             "render: this program was built without OpenGL: add --reference to draw on the CPU, or build it "
             "with SFUMATO_GL=ON");
}

PostProcess openPostProcess(const RenderOptions& options, const Shot& shot) {
  if (shot.post.any())
    base::fail(
        base::ExitCode::NoGl,
        "--bloom, --aa: need OpenGL, and this program was built without it: leave them out, or build it "
        "with SFUMATO_GL=ON");
  return [&](Drawn& drawn) { measureBrightness(options, shot, drawn); };
}

int info(const InfoOptions&) {
  base::fail(base::ExitCode::NoGl,
             "info: this program was built without OpenGL: build it with SFUMATO_GL=ON");
}

int validate(const ValidateOptions&) {
  base::fail(base::ExitCode::NoGl,
             "validate: this program was built without OpenGL: build it with SFUMATO_GL=ON");
}

int stress(const StressOptions&) {
  base::fail(base::ExitCode::NoGl,
             "stress: this program was built without OpenGL: build it with SFUMATO_GL=ON");
}

int bench(const BenchOptions&) {
  base::fail(base::ExitCode::NoGl,
             "bench: this program was built without OpenGL: build it with SFUMATO_GL=ON");
}

int benchPapers(const PapersOptions&) {
  return bench({});
}

}  // namespace sfumato::app
#endif
