#include "pipelines/deferred_options.h"

namespace sfumato::pipelines {

const base::Choice<ShadowKind>& shadowKinds() {
  static const base::Choice<ShadowKind> choice{"--shadows", {"none", "opaque", "interlaced", "deep"}};
  return choice;
}

const base::Choice<Interlace>& interlaces() {
  static const base::Choice<Interlace> choice{"--interlace", {"lines", "checkerboard", "full"}};
  return choice;
}

const base::Choice<Storage>& storages() {
  static const base::Choice<Storage> choice{"--storage", {"exact", "table"}};
  return choice;
}

const base::Choice<Passes>& passesNames() {
  static const base::Choice<Passes> choice{"--passes", {"one", "object"}};
  return choice;
}

}  // namespace sfumato::pipelines
