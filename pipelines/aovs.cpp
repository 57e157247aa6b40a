#include "pipelines/aovs.h"

#include <algorithm>

#include "base/error.h"

namespace sfumato::pipelines {
namespace {

std::vector<std::string> channelsOf(Aov aov) {
  switch (aov) {
    case Aov::Depth:
      return {"Z"};
    case Aov::Normal:
      return {"X", "Y", "Z"};
    case Aov::Albedo:
    case Aov::Transmittance:
      return {"R", "G", "B"};
    default:
      return {"Y"};
  }
}

}  // namespace

const std::vector<std::string>& aovNames() {
  static const std::vector<std::string> names = {"depth",  "normal",    "albedo",      "transmittance",
                                                 "lights", "fragments", "shadow-nodes"};
  return names;
}

const std::string& nameOf(Aov aov) {
  return aovNames().at(static_cast<size_t>(aov));
}

Aov aovNamed(const std::string& name) {
  const auto found = std::ranges::find(aovNames(), name);
  if (found == aovNames().end()) base::fail(base::ExitCode::Usage, "--aov {}: unknown", name);
  return static_cast<Aov>(found - aovNames().begin());
}

bool isCount(Aov aov) {
  return aov == Aov::Fragments || isOfLists(aov);
}

bool isOfLists(Aov aov) {
  return aov == Aov::Lights || aov == Aov::ShadowNodes;
}

AovImages emptyImages(const AovSet& aovs, int width, int height) {
  AovImages images;
  for (const Aov aov : aovs)
    images.emplace(aov, image::Image(width, height, static_cast<int>(channelsOf(aov).size())));
  return images;
}

image::Layer layerOf(Aov aov, image::Image image) {
  std::string name = nameOf(aov);
  std::ranges::replace(name, '-', '_');
  return {std::move(name), channelsOf(aov), std::move(image)};
}

}  // namespace sfumato::pipelines
