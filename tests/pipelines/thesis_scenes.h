// Scenes after the pictures of Lindbeck 2015: what its section 2.2.4 lets objects say of their shadows, the
// results of its chapter 3, and the faults that it shows there, each as a tiny scene.
#pragma once

#include <vector>

#include "tests/pipelines/known_scenes.h"

namespace sfumato::tests {

// Section 2.2.4 and figure 3.4. Sun straight down onto a white floor at y = 0, seen from above it, unless a
// line says otherwise.

// Left (x < 0) two panes of one object, right two objects of one pane each, all with shadow_once.
KnownScene panesOfOneObjectAndOfTwo();
// One object of a red pane above a blue one, shadow_once; its indices name the blue one first.
KnownScene redPaneOverBluePane();
// A thin ball of glass about (0, 2, 0), radius 1, whose shadow darkens to its rim by `rim`.
KnownScene glassBall(float rim);
// An opaque L of one object: a wall at x in [-0.2, 0] and a foot to its right, in a slanting light from the
// left; `shadowSelf` of its material.
KnownScene lShape(bool shadowSelf);
// Everything that says something of its shadow, in and around smoke under three kinds of light.
KnownScene flagsInSmoke();

// Chapter 3.
KnownScene curtainsBeforeLamp();  // figure 3.1 a: three fabrics around a point light
KnownScene curtainUnderSpot();    // 3.1 b: the spot on the camera's side
KnownScene rotatedCube();         // 3.2 a: a cube of smoke on its edge, lit from above
KnownScene staircase();           // 3.2 b: three steps of smoke, lit from above
KnownScene slideProjector();      // 3.5: a spot through a textured pane onto a wall; its texels are 0 or 1,
                                  // which every driver decodes exactly
KnownScene smokeCrossedByGeometry();  // 3.7: columns stand in the smoke
KnownScene lampInSmoke();             // 3.9: a point light inside the smoke
KnownScene cameraInSmoke();
KnownScene cameraInManyLights();  // 60 lamps, the camera within the reach of most

// All of the above.
std::vector<KnownScene> thesisScenes();

// Figure 3.8: a floor, or a ball on it, in a light `elevation` radians above the horizon.
KnownScene floorAtAngle(double elevation);
KnownScene ballAtAngle(double elevation);
// A closed box with walls of a thickness (metres, 0: single faces), the camera inside and the light outside,
// and the other way round.
KnownScene insideOfClosedBox(const scene::Light& lightOutside, float thickness);
KnownScene outsideOfClosedBox();

}  // namespace sfumato::tests
