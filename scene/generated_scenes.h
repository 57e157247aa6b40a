// Scenes that pipelines are compared on, made from nothing but numbers: the same bits on every run.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/scene.h"
#include "volumes/grid.h"

namespace sfumato::scene {

// The camera to look through is scene.cameras[0]; aspect is that of the picture, width / height.
struct GeneratedScene {
  Scene scene;
  std::vector<volumes::Medium> media;
};

// Triangles by the materials they have.
struct TriangleCounts {
  size_t opaque = 0;
  size_t translucent = 0;
};

// Four stacks of 1, 2, 4 and 8 overlapping coloured panes side by side before a wall, shifted against each
// other so that every number of layers from 0 to 8 is seen, and a column of smoke that stands among them; a
// spot, a point and a directional light, each of a colour. `voxelsHigh` in [8, 512] is the smoke's
// resolution.
GeneratedScene layersScene(double aspect, int voxelsHigh = 96);

// A vaulted hall with two rows of fluted columns, and vases on plinths in its nave: up to twelve of glass,
// the others of porcelain. After Aladagli 2015, sections 4.2 and 4.3: lit by `lights` spot lights, of which
// more are the same and others. Throws Bug for fewer than 4,000 opaque triangles.
GeneratedScene hallScene(const TriangleCounts& triangles, int lights, double aspect);
constexpr int mostHallLights = 64;

// After Ferko 2012, section 7: a court with two storeys of arcades, hung with panes of coloured glass; a
// statue that is a knot; a house in its garden, with a glass porch. Six point lights that cast no shadows,
// and a directional one that does, and ambient light. Throws Bug for fewer than 4,000 opaque triangles.
GeneratedScene courtScene(const TriangleCounts& triangles, double aspect);
GeneratedScene statueScene(const TriangleCounts& triangles, double aspect);
GeneratedScene houseScene(const TriangleCounts& triangles, double aspect);

// The scene without the instances of translucent materials.
Scene withoutTranslucent(const Scene& scene);

}  // namespace sfumato::scene
