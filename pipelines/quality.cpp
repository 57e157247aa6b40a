#include "pipelines/quality.h"

#include <algorithm>

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

const std::vector<std::string>& shadowFilterNames() {
  static const std::vector<std::string> names = {"nearest", "bilinear", "soft"};
  return names;
}

const std::string& nameOf(ShadowFilter filter) {
  return shadowFilterNames()[static_cast<size_t>(filter)];
}

ShadowFilter shadowFilterNamed(const std::string& name) {
  const auto& names = shadowFilterNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    base::fail(base::ExitCode::Usage, "--shadow-filter {}: unknown: choose nearest, bilinear or soft", name);
  return static_cast<ShadowFilter>(found - names.begin());
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
            .throughputCutoff = 1e-2};
  if (name == "medium")
    return {.shadowResolution = 1024, .stepVoxels = 1.5, .shadowError = 1.0 / 512, .throughputCutoff = 1e-3};
  if (name == "high")
    return {.shadowResolution = 2048,
            .stepVoxels = 1.0,
            .shadowError = 1.0 / 1024,
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
