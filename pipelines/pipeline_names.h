// The pipelines by name.
#pragma once

#include <string>
#include <vector>

namespace sfumato::pipelines {

// "lund" first, the one that is used where nothing else is said.
const std::vector<std::string>& pipelineNames();

// Throws Usage, naming --pipeline, for another name.
void checkPipelineName(const std::string& name);

}  // namespace sfumato::pipelines
