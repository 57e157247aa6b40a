// Stands in for the subcommands that draw, in a build without OpenGL.
#ifndef SFUMATO_GL
#include "app/options.h"
#include "base/error.h"

namespace sfumato::app {

int render(const RenderOptions&) {
  base::fail(base::ExitCode::NoGl,
             "render: this program was built without OpenGL: build it with SFUMATO_GL=ON");
}

int info(const InfoOptions&) {
  base::fail(base::ExitCode::NoGl,
             "info: this program was built without OpenGL: build it with SFUMATO_GL=ON");
}

}  // namespace sfumato::app
#endif
