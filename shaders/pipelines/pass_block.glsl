// Parameters of passes that light surfaces or march.
#include "shaders/shared/bindings.h"
#include "shaders/shared/resolve.h"

layout(std140, binding = UNIFORM_PASS) uniform Pass {
  ResolveParams params;
};
