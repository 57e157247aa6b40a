#include "shaders/lists/validation/float_sum.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  if (linearId() < COUNT) addToSum(linearId());
}
