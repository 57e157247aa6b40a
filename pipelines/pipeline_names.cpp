#include "pipelines/pipeline_names.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"

namespace sfumato::pipelines {

const std::vector<std::string>& pipelineNames() {
  static const std::vector<std::string> names = {"lund",         "interlaced", "peeling",       "forward",
                                                 "forward-mask", "reentrant",  "stencil-routed"};
  return names;
}

void checkPipelineName(const std::string& name) {
  const auto& names = pipelineNames();
  if (std::find(names.begin(), names.end(), name) == names.end())
    base::fail(base::ExitCode::Usage, "--pipeline {}: unknown: choose {}", name, fmt::join(names, ", "));
}

}  // namespace sfumato::pipelines
