#include "pipelines/quality.h"

#include "base/error.h"

namespace sfumato::pipelines {

int tapsOf(ShadowFilter filter) {
  switch (filter) {
    case ShadowFilter::Nearest:
      return 1;
    case ShadowFilter::Bilinear:
      return 2;
    case ShadowFilter::Soft:
      return 4;
  }
  return 2;
}

const base::Choice<ShadowFilter>& shadowFilters() {
  static const base::Choice<ShadowFilter> choice{"--shadow-filter", {"nearest", "bilinear", "soft"}};
  return choice;
}

const std::vector<std::string>& qualityNames() {
  static const std::vector<std::string> names = {"draft", "medium", "high", "reference"};
  return names;
}

namespace {

Quality choose(const std::string& name) {
  if (name == "draft")
    return {.samples = 1,
            .shadowResolution = 512,
            .stepVoxels = 3.0,
            .shadowError = 1.0 / 128,
            .smokeRaySpacing = 3.2,
            .throughputCutoff = 1e-2};
  if (name == "medium")
    return {.shadowResolution = 1024,
            .stepVoxels = 1.5,
            .shadowError = 1.0 / 512,
            .smokeRaySpacing = 1.6,
            .throughputCutoff = 1e-3};
  if (name == "high")
    return {.shadowResolution = 2048,
            .stepVoxels = 1.0,
            .shadowError = 1.0 / 1024,
            .smokeRaySpacing = 0.8,
            .throughputCutoff = 1e-4,
            .surfaceShadows = ShadowFilter::Soft,
            .smokeShadows = ShadowFilter::Bilinear};
  if (name == "reference")
    return {.shadowResolution = 2048,
            .stepVoxels = 0.5,
            .shadowError = 1.0 / 4096,
            .throughputCutoff = 1e-6,
            .surfaceShadows = ShadowFilter::Soft,
            .smokeShadows = ShadowFilter::Bilinear};
  base::fail(base::ExitCode::Usage, "--quality {}: unknown: choose draft, medium, high or reference", name);
}

}  // namespace

Quality qualityNamed(const std::string& name) {
  Quality quality = choose(name);
  quality.exactShadowResolution = false;
  quality.exactShadowError = false;
  return quality;
}

}  // namespace sfumato::pipelines
