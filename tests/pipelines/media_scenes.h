// Scenes of what media do to light beside scattering it once and greyly, for the reference and the GPU alike.
#pragma once

#include "tests/pipelines/known_scenes.h"

namespace sfumato::tests {

// A wall of radiance (0.5, 1, 2) behind a block of optical depth 1.5, extinction colour (1, 0.5, 0); no
// light.
KnownScene colouredSlab();
// The same wall behind two blocks in one place, of different colours, albedos and g; a light that nothing
// shadows falls in at a cosine of -0.8 to the view.
KnownScene overlappingColours();
// smokeOverFloor() in colours: the floor (0.75, 0.5, 0.25) gets an irradiance of 0.8 (4, 5, 6) exp(-(0, 0.5,
// 2)).
KnownScene colouredShadow();
// Two balls of different colours that overlap before a wall, with a box in one of them and a pane before
// both, under a spot, a point light and a sun.
KnownScene colouredBalls();

// A coloured ball that absorbs nothing and scatters evenly, in a surround that is as bright as radiance 1
// everywhere, made of so many directional lights; the surround itself is not seen.
KnownScene furnace(int lights);

// A block that burns evenly before the wall of colouredSlab(): radiance (3, 2, 1) per metre over 1 m. Its
// smoke has an optical depth of 1.5 and the extinction colour (1, 0.5, 0).
KnownScene burningSlab();
// The same fire without smoke, 1 m behind a block of smoke of optical depth 0.75 that does not burn.
KnownScene fireBehindSmoke();
// A burning ball of smoke, hot as a black body, before a floor and a wall that two of its own lights light; a
// box in it.
KnownScene burningBall();

}  // namespace sfumato::tests
