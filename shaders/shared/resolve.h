// The camera's walk through surfaces and smoke.
#include "shaders/shared/glsl.h"
SHARED_BEGIN

// How far a pixel has come; kept between dispatches, as one may only do so much work.
struct PixelState {
  float radianceR;
  float radianceG;
  float radianceB;
  float depth;      // how far the ray has been walked; 3e38: to its end
  float throughputR;
  float throughputG;
  float throughputB;
  uint node;        // the next surface, 0: none left but the opaque one
};

struct ResolveParams {
  vec4 march;    // x: step, m; y: throughput below which the rest is not looked at
  ivec4 options; // x: 1 when this is the first dispatch; y: 1 when smoke looks shadows up bilinearly;
                 // z: directional lights
};

struct ResolveCounters {
  uint unfinished;  // pixels that need another dispatch
  uint boundHit;    // walks of light lists that were cut (never silently)
};

SHARED_END

// Loop iterations after which a pixel stops and waits for the next dispatch.
#define RESOLVE_WORK_LIMIT 20000
