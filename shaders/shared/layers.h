// Layers of surfaces, one surface a pixel, that are lit one at a time: pipelines/layers_gpu.h.
#pragma once

#define INTERLACE_LINES 1
#define INTERLACE_CHECKERBOARD 2

// The lower half of PackedSurface::coverageObject in a layer, where nobody asks for samples: whether the surface lets
// light pass. A surface that is translucent may do so at some points and not at others.
#define LAYER_TRANSLUCENT 1u
