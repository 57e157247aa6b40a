// `sfumato compare`: how far two images are apart, and whether that is too far.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "app/options.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json_text.h"
#include "base/log.h"
#include "base/version.h"
#include "image/heat_map.h"
#include "image/image_file.h"
#include "image/metrics.h"

namespace sfumato::app {

using base::ExitCode;
using base::fail;

namespace {

struct Comparison {
  int averaged = 1;  // factor that A was averaged down by
  size_t pixels = 0;
  image::Difference difference;
  size_t failing = 0;
  size_t warning = 0;
  size_t perceptual = 0;
};

double percentOf(size_t count, const Comparison& comparison) {
  return 100.0 * static_cast<double>(count) / static_cast<double>(comparison.pixels);
}

std::string placeText(const image::Place& place, int channels) {
  constexpr const char* names[] = {"red", "green", "blue", "alpha"};
  const std::string channel =
      channels >= 3 && place.channel < 4 ? names[place.channel] : fmt::format("channel {}", place.channel);
  return fmt::format("({}, {}) {}", place.x, place.y, channel);
}

// How many times A is larger than B in both directions; fails where there is no such number.
int factorBetween(const CompareOptions& options, const image::Image& a, const image::Image& b) {
  const int factor = a.width / b.width;
  if (factor < 1 || a.width != factor * b.width || a.height != factor * b.height)
    fail(ExitCode::Usage,
         "{}: {} x {} pixels are no whole multiple of the {} x {} of {}: give images of one size",
         options.image, a.width, a.height, b.width, b.height, options.reference);
  return factor;
}

void checkFinite(const std::string& file, const image::Image& image) {
  const image::NotFinite found = image::findNotFinite(image);
  if (found.count > 0)
    fail(ExitCode::CheckFailed,
         "{}: {} at {}, and {} values in all that are no finite numbers: render it anew", file,
         std::isnan(found.value) ? "NaN" : "infinity", placeText(found.first, image.channels), found.count);
}

Comparison compareImages(const CompareOptions& options, const image::Image& a, const image::Image& b) {
  return {.pixels = static_cast<size_t>(b.width) * static_cast<size_t>(b.height),
          .difference = image::compare(a, b),
          .failing = image::pixelsBeyond(a, b, options.fail.threshold),
          .warning = image::pixelsBeyond(a, b, options.warn.threshold),
          .perceptual = image::perceptualFailures(a, b)};
}

bool isBeyond(const Tolerance& tolerance, size_t pixels, const Comparison& comparison) {
  return percentOf(pixels, comparison) > tolerance.percent || comparison.difference.maximum > tolerance.hard;
}

std::string describe(const Tolerance& tolerance, size_t pixels, const Comparison& comparison) {
  if (comparison.difference.maximum > tolerance.hard)
    return fmt::format("a pixel differs by {:.6g}, more than {:.6g}", comparison.difference.maximum,
                       tolerance.hard);
  return fmt::format("{} of {} pixels ({:.4g} %) differ by more than {:.6g}", pixels, comparison.pixels,
                     percentOf(pixels, comparison), tolerance.threshold);
}

const char* verdict(const CompareOptions& options, const Comparison& comparison) {
  if (isBeyond(options.fail, comparison.failing, comparison)) return "fail";
  return isBeyond(options.warn, comparison.warning, comparison) ? "warning" : "pass";
}

nlohmann::json toJson(const CompareOptions& options, const Comparison& comparison) {
  const image::Difference& difference = comparison.difference;
  const image::Place& place = difference.maximumAt;
  return {{"image", options.image},
          {"reference", options.reference},
          {"averaged", comparison.averaged},
          {"pixels", comparison.pixels},
          {"rmse", difference.rmse},
          {"relative_rmse", difference.relativeRmse},
          {"psnr", difference.psnr},  // null for equal images, whose PSNR is infinite
          {"maximum", difference.maximum},
          {"maximum_at", {{"x", place.x}, {"y", place.y}, {"channel", place.channel}}},
          {"mean_ratio", difference.meanRatio},
          {"failing_pixels", comparison.failing},
          {"warning_pixels", comparison.warning},
          {"perceptual_failures", comparison.perceptual},
          {"verdict", verdict(options, comparison)}};
}

void print(const CompareOptions& options, const Comparison& comparison, int channels) {
  const image::Difference& difference = comparison.difference;
  if (comparison.averaged > 1)
    base::print("{}: averaged down, {} x {} pixels to one\n", options.image, comparison.averaged,
                comparison.averaged);
  base::print("RMSE                 {:.6g}\n", difference.rmse);
  base::print("relative RMSE        {:.6g}\n", difference.relativeRmse);
  base::print("PSNR                 {:.6g} dB\n", difference.psnr);
  base::print("maximum              {:.6g}", difference.maximum);
  if (difference.maximum > 0) base::print(" at {}", placeText(difference.maximumAt, channels));
  base::print("\nmean ratio           {:.6g}\n", difference.meanRatio);
  base::print("failing pixels       {} of {} ({:.4g} %), by more than {:.6g}\n", comparison.failing,
              comparison.pixels, percentOf(comparison.failing, comparison), options.fail.threshold);
  base::print("perceptual failures  {} ({:.4g} %)\n", comparison.perceptual,
              percentOf(comparison.perceptual, comparison));
}

void writeHeatMap(const CompareOptions& options, const image::Image& a, const image::Image& b,
                  double maximum) {
  const image::Metadata metadata = {{"Software", fmt::format("sfumato {}", base::version())},
                                    {"sfumato:command_line", options.commandLine},
                                    {"sfumato:heat_map_scale", fmt::format("0 to {}", maximum)}};
  image::writePicture(options.heatMap, image::heatMap(a, b, maximum), metadata);
  base::note("wrote {}: from 0, black, to {:.6g}, nearly white", options.heatMap, maximum);
}

// The heat map is a .png, can be written, and is neither of the images.
void checkHeatMap(const CompareOptions& options) {
  if (options.heatMap.empty()) return;
  image::checkPictureName(options.heatMap);
  std::error_code ignored;
  for (const std::string& input : {options.image, options.reference})
    if (std::filesystem::equivalent(options.heatMap, input, ignored))
      fail(ExitCode::Usage, "{}: is an image to compare: give the heat map another name", options.heatMap);
  base::checkWritable(options.heatMap);
}

}  // namespace

int compare(const CompareOptions& options) {
  checkHeatMap(options);
  image::Image a = image::readImage(options.image);
  const image::Image b = image::readImage(options.reference);
  const int factor = factorBetween(options, a, b);
  checkFinite(options.image, a);
  checkFinite(options.reference, b);
  if (factor > 1) a = image::averageDown(a, factor);
  if (a.channels != b.channels)
    base::warn("{}: {} channels against the {} of {}: only those that both have are compared", options.image,
               a.channels, b.channels, options.reference);

  Comparison comparison = compareImages(options, a, b);
  comparison.averaged = factor;
  if (!options.heatMap.empty()) writeHeatMap(options, a, b, comparison.difference.maximum);
  if (options.json)
    base::printResult(base::jsonText(toJson(options, comparison)));
  else if (base::verbosity() != base::Verbosity::Quiet)
    print(options, comparison, b.channels);

  if (isBeyond(options.fail, comparison.failing, comparison))
    fail(ExitCode::CheckFailed, "{}: {}: look at a --heat-map, or allow more with --fail, --failpercent",
         options.image, describe(options.fail, comparison.failing, comparison));
  if (isBeyond(options.warn, comparison.warning, comparison))
    base::warn("{}: {}", options.image, describe(options.warn, comparison.warning, comparison));
  return 0;
}

}  // namespace sfumato::app
