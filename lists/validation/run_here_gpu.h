// What the process of one check does.
#pragma once

#include "gl/device.h"
#include "lists/validation/check.h"

namespace sfumato::lists::validation {

struct Here {
  gl::DeviceOptions device;
  uint64_t seed = 1;
  Scale scale = Scale::Small;
  std::string mutant;
  std::vector<std::string> again;  // Context::again
};

// Runs the check on a device of its own. Crash when the driver reset the context; Fail when it cannot compile
// the check's shaders, Skip when it has no room. Throws NoGl.
Result runHere(const Check& check, const Here& here);

}  // namespace sfumato::lists::validation
