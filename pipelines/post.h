// What becomes of a frame before it is shown, whoever drew it.
#pragma once

#include "base/choice.h"
#include "pipelines/aovs.h"

namespace sfumato::pipelines {

// Light that bright parts of a picture spread around them.
enum class Bloom {
  Off,
  Separable,  // of a picture of about 180 rows, bright parts by contrast (Policarpo and Fonseca 2005, 3.5.2)
  Mipmap  // of ever smaller pictures, of what is brighter than the log-average luminance (Ferko 2012, 3.2)
};
enum class AntiAliasing {
  Off,
  Edges  // of opaque surfaces, told by their normals and depths (Policarpo and Fonseca 2005, 3.5.1)
};

const base::Choice<Bloom>& blooms();                // "off", "separable", "mipmap"
const base::Choice<AntiAliasing>& antiAliasings();  // "off", "edges"

struct PostOptions {
  Bloom bloom = Bloom::Off;
  double bloomStrength = 0.2;  // part of the light that glows which is added around it
  AntiAliasing antiAliasing = AntiAliasing::Off;

  bool any() const { return bloom != Bloom::Off || antiAliasing != AntiAliasing::Off; }
};

// The AOVs that postProcess() looks at.
AovSet aovsFor(const PostOptions& options);

}  // namespace sfumato::pipelines
