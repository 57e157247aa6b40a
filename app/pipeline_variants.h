// The ways to draw that `sfumato bench` compares: the pipelines, and settings of theirs that the papers have.
#pragma once

#include <string>
#include <vector>

#include "pipelines/deferred_options.h"

namespace sfumato::app {

struct Variant {
  std::string name;  // the pipeline's, and what is set
  std::string pipeline;
  pipelines::DeferredOptions deferred;
  std::string paper;   // where it is from
  std::string cannot;  // a sentence
};

// Of the pipelines that are named, or of all where none is; settings that a variant does not have are those
// of `deferred`.
std::vector<Variant> variantsOf(const std::vector<std::string>& pipelines,
                                const pipelines::DeferredOptions& deferred);

}  // namespace sfumato::app
