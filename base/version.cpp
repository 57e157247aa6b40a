#include "base/version.h"

namespace sfumato::base {

const char* version() {
  return SFUMATO_VERSION;
}

}  // namespace sfumato::base
