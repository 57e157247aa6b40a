// Corners of triangles are rounded to parts of a pixel: Mesa's software drivers have 8 bits, whatever they answer to
// GL_SUBPIXEL_BITS. Tests set others.
#ifndef SUBPIXEL_BITS
#define SUBPIXEL_BITS 8
#endif
