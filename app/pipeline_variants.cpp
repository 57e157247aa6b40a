#include "app/pipeline_variants.h"

#include <algorithm>
#include <functional>

#include "pipelines/pipeline_names.h"

namespace sfumato::app {
namespace {

using pipelines::DeferredOptions;

struct Entry {
  const char* name;
  const char* pipeline;
  std::function<void(DeferredOptions&)> set;
  const char* paper;
  const char* cannot;
};

const std::vector<Entry>& entries() {
  const auto asItIs = [](DeferredOptions&) {};
  static const std::vector<Entry> all = {
      {"lund", "lund", asItIs, "Lindbeck 2015", "Cannot refract; its lists grow with what is seen."},
      {"interlaced", "interlaced", asItIs, "Aladagli 2015, chapter 3",
       "Cannot show more than the nearest translucent surface, and that one and what is behind it at half "
       "the "
       "resolution."},
      {"interlaced, full", "interlaced",
       [](DeferredOptions& options) { options.interlace = pipelines::Interlace::Full; },
       "Aladagli 2015, chapter 3", "Cannot show more than the nearest translucent surface."},
      {"peeling", "peeling", [](DeferredOptions& options) { options.layers = 0; }, "Aladagli 2015, 4.1.2",
       "Cannot do with fewer passes over the scene than its deepest pixel has layers."},
      {"peeling, 1 layer", "peeling", [](DeferredOptions& options) { options.layers = 1; },
       "Aladagli 2015, 4.1.2", "Cannot show more than the nearest translucent surface."},
      {"forward", "forward", asItIs, "Aladagli 2015, 4.1.3",
       "Cannot show more than the nearest translucent surface, and draws all triangles again for each "
       "light."},
      {"forward-mask", "forward-mask", asItIs, "Aladagli 2015, 4.1.3",
       "Cannot tell what is before a refracting surface from what is behind it, nor show more than one."},
      {"reentrant", "reentrant",
       [](DeferredOptions& options) { options.passes = pipelines::Passes::PerObject; },
       "Chapman, Deferred Rendering",
       "Cannot sort surfaces within an object, nor objects that pass through "
       "each other, and takes a pass for each object."},
      {"reentrant, one pass", "reentrant",
       [](DeferredOptions& options) { options.passes = pipelines::Passes::One; },
       "Chapman, Deferred Rendering", "Cannot show more than the nearest translucent surface."},
      {"stencil-routed", "stencil-routed", asItIs, "Ferko 2012, section 5",
       "Cannot hold more layers in a pass than the driver has samples: more layers are more passes."},
      {"stencil-routed, 1 sample", "stencil-routed", [](DeferredOptions& options) { options.samples = 1; },
       "Ferko 2012, section 5", "Cannot hold more than one layer in a pass."},
  };
  return all;
}

}  // namespace

std::vector<Variant> variantsOf(const std::vector<std::string>& pipelines, const DeferredOptions& deferred) {
  const std::vector<std::string>& wanted = pipelines.empty() ? pipelines::pipelineNames() : pipelines;
  std::vector<Variant> variants;
  for (const Entry& entry : entries()) {
    if (std::ranges::find(wanted, entry.pipeline) == wanted.end()) continue;
    if (std::ranges::find(pipelines::pipelineNames(), entry.pipeline) == pipelines::pipelineNames().end())
      continue;
    Variant variant{entry.name, entry.pipeline, deferred, entry.paper, entry.cannot};
    entry.set(variant.deferred);
    variants.push_back(std::move(variant));
  }
  return variants;
}

}  // namespace sfumato::app
