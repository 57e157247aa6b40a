// Whether the library under test was built with OpenImageIO.
#pragma once

#include "base/error.h"
#include "image/image_file.h"

namespace sfumato::test {

inline bool hasOpenImageIO() {
  try {
    image::checkImageName("a.exr");
    return true;
  } catch (const base::Error&) {
    return false;
  }
}

}  // namespace sfumato::test
