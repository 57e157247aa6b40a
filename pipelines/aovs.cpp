#include "pipelines/aovs.h"

#include <algorithm>

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

const base::Choice<Aov>& aovKinds() {
  static const base::Choice<Aov> choice{
      "--aov", {"depth", "normal", "albedo", "transmittance", "lights", "fragments", "shadow-nodes"}};
  return choice;
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
  std::string name = aovKinds().nameOf(aov);
  std::ranges::replace(name, '-', '_');
  return {std::move(name), channelsOf(aov), std::move(image)};
}

}  // namespace sfumato::pipelines
