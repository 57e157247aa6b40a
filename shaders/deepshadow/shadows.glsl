// How much of a light gets to a point, by whichever shadow maps are bound. What both include stands before them, as a file
// comes only once, be it in a part that is left out.
#include "shaders/deepshadow/faces.glsl"
#include "shaders/volumes/extinction.glsl"
#ifdef INTERLACED_SHADOWS
#include "shaders/deepshadow/interlaced_lookup.glsl"
#else
#include "shaders/deepshadow/lookup.glsl"
#endif
