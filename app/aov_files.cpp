#include "app/aov_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/log.h"
#include "image/heat_map.h"
#include "image/image_file.h"

namespace sfumato::app {
namespace {

using base::ExitCode;
using base::fail;
using pipelines::Aov;

std::string heatMapFile(const std::string& picture, Aov aov) {
  const std::filesystem::path path(picture);
  return path.parent_path() /
         (path.stem().string() + "." + pipelines::aovKinds().nameOf(aov) + path.extension().string());
}

}  // namespace

pipelines::AovSet wantedAovs(const RenderOptions& options) {
  pipelines::AovSet aovs;
  for (const std::string& name : options.aovs) aovs.insert(pipelines::aovKinds().named(name));
  const bool hasLayers = std::ranges::any_of(options.outputs, image::holdsLayers);
  for (const Aov aov : aovs) {
    if (options.reference && isOfLists(aov))
      fail(ExitCode::Usage, "--aov {}: is of lists that --reference does not have: leave one of them out",
           pipelines::aovKinds().nameOf(aov));
    if (!hasLayers && !isCount(aov) && !options.dryRun)
      fail(ExitCode::Usage, "--aov {}: only an .exr holds it: name one with -o",
           pipelines::aovKinds().nameOf(aov));
  }
  return aovs;
}

std::vector<std::string> heatMapFiles(const RenderOptions& options) {
  std::vector<std::string> files;
  for (const std::string& output : options.outputs)
    for (const Aov aov : wantedAovs(options))
      if (isCount(aov) && !image::holdsLayers(output)) files.push_back(heatMapFile(output, aov));
  return files;
}

void writeHeatMaps(const RenderOptions& options, const pipelines::AovImages& aovs,
                   const image::Metadata& settings) {
  for (const auto& [aov, counts] : aovs) {
    if (!isCount(aov)) continue;
    const float most = std::max(1.f, *std::ranges::max_element(counts.values));
    image::Metadata metadata = settings;
    metadata.emplace_back("sfumato:aov", pipelines::aovKinds().nameOf(aov));
    metadata.emplace_back("sfumato:heat_map_scale", fmt::format("0 to {}", most));
    for (const std::string& output : options.outputs) {
      if (image::holdsLayers(output)) continue;
      const std::string file = heatMapFile(output, aov);
      image::writePicture(file, image::heatMap(counts, most), metadata);
      base::note("wrote {}: from 0, black, to {}, nearly white", file, most);
    }
  }
}

}  // namespace sfumato::app
