// What a pass that lights surfaces or marches through smoke is told.
#include "shaders/shared/bindings.h"
#include "shaders/shared/resolve.h"

layout(std140, binding = UNIFORM_PASS) uniform Pass {
  ResolveParams params;
};
