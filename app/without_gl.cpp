// Stands in for what needs OpenGL, in a build without it.
#ifndef SFUMATO_GL
#include "app/display.h"
#include "app/options.h"
#include "app/shot.h"
#include "base/error.h"

namespace sfumato::app {
namespace {

[[noreturn]] void failWithoutGl(const char* command) {
  base::fail(base::ExitCode::NoGl, "{}: this program was built without OpenGL: build it with SFUMATO_GL=ON",
             command);
}

}  // namespace

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
  failWithoutGl("info");
}

int validate(const ValidateOptions&) {
  failWithoutGl("validate");
}

int stress(const StressOptions&) {
  failWithoutGl("stress");
}

int bench(const BenchOptions&) {
  failWithoutGl("bench");
}

int benchPapers(const PapersOptions&) {
  failWithoutGl("bench");
}

}  // namespace sfumato::app
#endif
