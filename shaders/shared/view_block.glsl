// What the pass looks from.
#include "shaders/shared/bindings.h"
#include "shaders/shared/view.h"

layout(std140, binding = UNIFORM_VIEW) uniform View {
  ViewParams view;
};
