// Sends a node's number to a fragment, as it is and as the bits of a float, and as a float.
layout(std430, binding = 0) readonly buffer Wanted {
  uint wanted[];
};
flat out uint number;
flat out float bits;
flat out float rounded;
flat out uint place;

void main() {
  place = uint(gl_InstanceID);
  number = wanted[place];
  rounded = float(number);
  bits = uintBitsToFloat(number);
  gl_Position = vec4((float(place) + 0.5) / 32.0 - 1.0, 0.0, 0.0, 1.0);
}
