// What a fragment of validation::drawPatches knows of itself. Those outside the patches do nothing.
flat in uint layer;

// Its place in its patch.
uvec2 patchPixel() {
  return uvec2(gl_FragCoord.xy) % 64u;
}

bool inPatch() {
  return all(lessThan(patchPixel(), uvec2(PATCH)));
}

// Its number in its layer.
uint patchId() {
  uvec2 square = uvec2(gl_FragCoord.xy) / 64u;
  uvec2 pixel = patchPixel();
  return ((square.y * GRID + square.x) * PATCH + pixel.y) * PATCH + pixel.x;
}
