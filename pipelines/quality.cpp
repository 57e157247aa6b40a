#include "pipelines/quality.h"

#include "base/error.h"

namespace sfumato::pipelines {

const std::vector<std::string>& qualityNames() {
  static const std::vector<std::string> names = {"draft", "medium", "high", "reference"};
  return names;
}

Quality qualityNamed(const std::string& name) {
  if (name == "draft")
    return {.samples = 1,
            .shadowResolution = 512,
            .stepVoxels = 3.0,
            .shadowError = 1.0 / 128,
            .throughputCutoff = 1e-2};
  if (name == "medium")
    return {.shadowResolution = 1024, .stepVoxels = 1.5, .shadowError = 1.0 / 512, .throughputCutoff = 1e-3};
  if (name == "high")
    return {.shadowResolution = 2048,
            .stepVoxels = 1.0,
            .shadowError = 1.0 / 1024,
            .throughputCutoff = 1e-4,
            .bilinearSmokeShadows = true};
  if (name == "reference")
    return {.shadowResolution = 2048,
            .stepVoxels = 0.5,
            .shadowError = 1.0 / 4096,
            .throughputCutoff = 1e-6,
            .bilinearSmokeShadows = true};
  base::fail(base::ExitCode::Usage, "--quality {}: unknown: choose draft, medium, high or reference", name);
}

}  // namespace sfumato::pipelines
