// The nodes of a load: what stands in lists/stress/load.h, written for the GPU.
#include "shaders/shared/bindings.h"
#include "shaders/shared/hash.glsl"
#include "shaders/shared/stress.h"

layout(std140, binding = UNIFORM_PASS) uniform StressPass {
  StressParams stressParams;
};

// What a hash is used for.
const uint USE_DEPTH = 0u;
const uint USE_CELL = 1u;
const uint USE_SPOT = 2u;
const uint USE_SPOT_X = 3u;
const uint USE_SPOT_Y = 4u;
const uint USE_CLUMP = 5u;
const uint USE_CLUMP_ROOT = 6u;
const uint USE_CLUMP_DRIFT = 7u;
const uint USE_CLUMP_DEPTH = 8u;
const uint USE_FRAY = 9u;
const uint USE_PAYLOAD = 64u;

uint loadDraw(uint number, uint use) {
  return hash(number ^ hash(uint(stressParams.load.z) * 128u + use));
}

uint loadPayload(uint number, uint word) {
  return loadDraw(number, USE_PAYLOAD + word);
}

// A place along a side of the hot spot, which starts at `start`.
uint loadSpot(uint start, uint bits, uint side) {
  uint radius = max(side / 8u, 1u);
  return (start + (bits & 0xffffu) % radius + (bits >> 16) % radius) % side;
}

// Distributions, as in lists/stress/load.h.
const int HOT_SPOT = 1;
const int ONE_CELL = 2;
const int HAIR = 3;

bool loadIs(int distribution) {
  return stressParams.load.w == distribution;
}

uint hotSpotCell(uint number, uint width, uint height) {
  if (loadDraw(number, USE_SPOT) % 2u == 0u) return loadDraw(number, USE_CELL) % (width * height);
  uint x = loadSpot(loadDraw(0u, USE_SPOT_X), loadDraw(number, USE_SPOT_X), width);
  uint y = loadSpot(loadDraw(0u, USE_SPOT_Y), loadDraw(number, USE_SPOT_Y), height);
  return y * width + x;
}

void hairNode(uint number, uint width, uint height, out uint cell, out float depth) {
  uint strand = number / width;
  uint x = number - strand * width;
  uint clump = loadDraw(strand, USE_CLUMP) % max(height / 16u, 1u);
  uint fray = loadDraw(strand, USE_FRAY) % max(height / 8u, 1u);
  uint climb = (loadDraw(clump, USE_CLUMP_DRIFT) % height + fray) * x / width;
  uint y = (loadDraw(clump, USE_CLUMP_ROOT) % height + climb) % height;
  cell = y * width + x;
  depth = float(loadDraw(clump, USE_CLUMP_DEPTH) % 1024u + fray % 8u + 1u) / 2048.0;
}

void loadNode(uint number, out uint cell, out float depth) {
  uint width = uint(stressParams.load.x);
  uint height = uint(stressParams.load.y);
  if (loadIs(HAIR)) {
    hairNode(number, width, height, cell, depth);
    return;
  }
  depth = float(loadDraw(number, USE_DEPTH) % 65536u + 1u) / 65536.0;
  if (loadIs(HOT_SPOT)) cell = hotSpotCell(number, width, height);
  else if (loadIs(ONE_CELL)) cell = loadDraw(0u, USE_CELL) % (width * height);
  else cell = number % (width * height);
}
