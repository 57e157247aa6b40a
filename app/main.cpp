#include <cstdio>

#include "base/version.h"

int main() {
  std::printf("sfumato %s\n", sfumato::base::version());
}
