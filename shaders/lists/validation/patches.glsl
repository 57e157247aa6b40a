// What a fragment of validation::drawPatches knows of itself.
flat in uint layer;

// Its place in its patch.
uvec2 patchPixel() {
  return uvec2(gl_FragCoord.xy) % 64u;
}

// Its number in its layer.
uint patchId() {
  uvec2 square = uvec2(gl_FragCoord.xy) / 64u;
  uvec2 pixel = patchPixel();
  return ((square.y * GRID + square.x) * PATCH + pixel.y) * PATCH + pixel.x;
}
