#include "app/display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "image/image_file.h"

namespace sfumato::app {

using base::ExitCode;
using base::fail;

namespace {

// The first flag that shapes pictures; nullptr when none was given.
const char* firstFlag(const DisplayOptions& options) {
  if (options.toneCurve != "neutral") return "--tonemap";
  if (options.bloom != "off") return "--bloom";
  if (options.antiAliasing != "off") return "--aa";
  return nullptr;
}

}  // namespace

pipelines::PostOptions wantedPostProcessing(const RenderOptions& options) {
  const DisplayOptions& display = options.display;
  if (display.white && display.toneCurve != "reinhard")
    fail(ExitCode::Usage, "--white: is of a curve that was not asked for: add --tonemap reinhard");
  if (display.bloomStrength && display.bloom == "off")
    fail(ExitCode::Usage, "--bloom-strength: of no bloom: add --bloom mipmap or separable");
  const char* flag = options.effects.empty() ? firstFlag(display) : nullptr;
  const bool hasPicture =
      std::any_of(options.outputs.begin(), options.outputs.end(), std::not_fn(image::holdsLayers));
  if (flag && !hasPicture && !options.dryRun)
    fail(ExitCode::Usage, "{}: shapes a .png only, an .exr keeps linear radiance: name a .png with -o", flag);
  if (!hasPicture) return {};
  pipelines::PostOptions post{.bloom = pipelines::blooms().named(display.bloom),
                              .antiAliasing = pipelines::antiAliasings().named(display.antiAliasing)};
  post.bloomStrength = display.bloomStrength.value_or(post.bloomStrength);
  return post;
}

void measureBrightness(const RenderOptions& options, const Shot& shot, Drawn& drawn) {
  if (options.display.toneCurve == "reinhard" || shot.post.bloom == pipelines::Bloom::Mipmap)
    drawn.brightness = image::brightnessOf(drawn.radiance);
}

image::ToneMapping toneMappingOf(const DisplayOptions& options, const image::Brightness& brightness) {
  if (image::toneCurves().named(options.toneCurve) == image::ToneCurve::Reinhard)
    return image::reinhard(brightness, options.exposureStops, options.white);
  return {.scale = std::exp2(options.exposureStops)};
}

image::Metadata displayMetadata(const RenderOptions& options, const Shot& shot, const Drawn& drawn) {
  const DisplayOptions& display = options.display;
  image::Metadata result = {{"sfumato:tone_map", display.toneCurve}};
  if (display.toneCurve == "reinhard") {
    const image::ToneMapping mapping = toneMappingOf(display, drawn.brightness);
    result.emplace_back("sfumato:log_average_luminance", fmt::format("{}", drawn.brightness.logAverage));
    result.emplace_back("sfumato:white_luminance", fmt::format("{}", mapping.white / mapping.scale));
  }
  result.emplace_back("sfumato:bloom",
                      shot.post.bloom == pipelines::Bloom::Off
                          ? display.bloom
                          : fmt::format("{}, strength {}", display.bloom, shot.post.bloomStrength));
  result.emplace_back("sfumato:anti_aliasing", display.antiAliasing);
  return result;
}

}  // namespace sfumato::app
