// Settings of the pipelines that light layers of surfaces one at a time; the core pipeline takes none of
// them.
#pragma once

#include <optional>

#include "base/choice.h"

namespace sfumato::pipelines {

// None: every light reaches everything. Opaque, Interlaced: shadow maps of a depth, or of a depth and a
// colour (Aladagli 2015, section 3.2.1). Deep: as the core pipeline has them.
enum class ShadowKind { None, Opaque, Interlaced, Deep };

// Which pixels hold translucent surfaces rather than what is behind them. Full: none has to choose, both are
// stored.
enum class Interlace { Lines, Checkerboard, Full };

// How a layer's surfaces and the light on them are stored: in floats, as the core pipeline has them, or in 8
// and 10 bits (Aladagli 2015, tables 3.1 and 3.2).
enum class Storage { Exact, Table };

// What is drawn in one pass of the re-entrant pipeline: the nearest of all translucent surfaces, or those of
// one object after the other, from back to front.
enum class Passes { One, PerObject };

struct DeferredOptions {
  std::optional<ShadowKind> shadows;  // none: those that the pipeline is known for
  Interlace interlace = Interlace::Lines;
  Storage storage = Storage::Exact;
  Passes passes = Passes::PerObject;
  int samples =
      0;  // of a pixel that hold fragments in one pass of the stencil-routed pipeline; 0: all there are
  int layers = 0;  // translucent ones that are peeled at most; 0: until nothing is left
  double refraction =
      0;  // how far a normal shifts what is seen through a surface, part of the image's height
};

const base::Choice<ShadowKind>& shadowKinds();  // "none", "opaque", "interlaced", "deep"
const base::Choice<Interlace>& interlaces();    // "lines", "checkerboard", "full"
const base::Choice<Storage>& storages();        // "exact", "table"
const base::Choice<Passes>& passesNames();      // "one", "object"

}  // namespace sfumato::pipelines
