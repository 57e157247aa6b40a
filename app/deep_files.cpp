#include "app/deep_files.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "app/shot.h"
#include "base/error.h"
#include "base/log.h"
#include "image/image_file.h"
#include "pipelines/deep_pixels.h"

namespace sfumato::app {
namespace {

using base::ExitCode;
using base::fail;

// The number that the whole text is.
std::optional<size_t> numberOf(const std::string& text) {
  size_t number = 0;
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, number);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return number;
}

// By its name, else by its number.
size_t lightNamed(const std::string& wanted, const std::vector<scene::Light>& lights) {
  const auto isWanted = [&](const scene::Light& light) { return light.name == wanted; };
  const auto named = std::ranges::count_if(lights, isWanted);
  if (named > 1)
    fail(ExitCode::Usage, "--deep-shadow: {} lights are called \"{}\": give a number, 0 to {}", named, wanted,
         lights.size() - 1);
  if (named == 1) return static_cast<size_t>(std::ranges::find_if(lights, isWanted) - lights.begin());
  if (const auto number = numberOf(wanted); number && *number < lights.size()) return *number;
  std::vector<std::string> names;
  for (const scene::Light& light : lights) names.push_back("\"" + light.name + "\"");
  if (names.empty()) fail(ExitCode::Usage, "--deep-shadow: no light \"{}\": the scene has none", wanted);
  fail(ExitCode::Usage, "--deep-shadow: no light \"{}\": choose one of {}, or a number, 0 to {}", wanted,
       fmt::join(names, ", "), names.size() - 1);
}

}  // namespace

std::vector<std::string> deepFiles(const RenderOptions& options) {
  std::vector<std::string> files;
  if (!options.deep.empty()) files.push_back(options.deep);
  for (const auto& [light, file] : options.deepShadows) files.push_back(file);
  for (const std::string& file : files) {
    image::checkDeepName(file);
    if (options.reference)
      fail(ExitCode::Usage, "{}: --reference has no lists for a deep image: leave one of them out", file);
  }
  return files;
}

std::vector<size_t> deepShadowLights(const RenderOptions& options, const scene::Scene& scene) {
  std::vector<size_t> lights;
  for (const auto& [name, file] : options.deepShadows) {
    lights.push_back(lightNamed(name, scene.lights));
    if (!scene.lights[lights.back()].castsShadow)
      fail(ExitCode::Usage, "--deep-shadow: light \"{}\" casts no shadow: choose another", name);
  }
  return lights;
}

void writeDeepFiles(const RenderOptions& options, const Drawn& drawn, const image::Metadata& settings) {
  if (drawn.deep) {
    image::Metadata metadata = settings;
    metadata.emplace_back("sfumato:deep_error", fmt::format("{}", pipelines::deepError));
    image::writeDeep(options.deep, {&*drawn.deep, 1}, metadata);
    base::note("wrote {}", options.deep);
  }
  for (size_t i = 0; i < drawn.deepShadows.size(); ++i) {
    const auto& [light, file] = options.deepShadows[i];
    image::Metadata metadata = settings;
    metadata.emplace_back("sfumato:light", light);
    image::writeDeep(file, drawn.deepShadows[i], metadata);
    base::note("wrote {}", file);
  }
}

}  // namespace sfumato::app
