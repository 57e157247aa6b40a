// The results of `sfumato bench pipelines`, and how they are told.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/pipeline_variants.h"
#include "base/error.h"
#include "image/image.h"
#include "image/metrics.h"
#include "image/report.h"

namespace sfumato::app {

struct PassCalls {
  std::string name;
  int calls = 0;
  double milliseconds = 0;
};

// Pixels by the translucent surfaces before what is behind them.
struct LayerClass {
  int fewest = 0;
  int most = 0;
  size_t pixels = 0;
  double rmse = 0;
};

// A scene drawn in one way.
struct VariantRun {
  Variant variant;
  std::string refused;  // why it was not drawn, or empty; then nothing of what follows is there
  base::ExitCode refusal = base::ExitCode::Done;  // of the same
  image::Image radiance;
  image::Difference difference;      // from the exact image
  std::optional<size_t> perceptual;  // pixels in which a viewer sees one; none in a build without image files
  std::vector<LayerClass> layers;    // those that the image has
  std::vector<double> milliseconds;  // of each frame after the first
  std::vector<PassCalls> passes;     // without those that consist of others
  size_t sceneBytes = 0;             // that stay from frame to frame
  size_t frameBytes = 0;             // what a frame adds to them at its peak
  std::map<std::string, size_t> frameBytesByLabel;  // peaks, each of its own time

  double median() const;
  int passCount() const;
};

struct Comparison {
  std::string device;
  std::string commandLine;
  std::string scene;
  std::string quality;
  int width = 0;
  int height = 0;
  image::Image exact;
  std::string exactBy;  // what drew it, and how
  double exactMilliseconds = 0;
  std::vector<VariantRun> runs;

  size_t pixels() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
};

// The middle one, or the mean of the two in the middle; 0 of none.
double medianOf(std::vector<double> values);

// What the image's error is in pixels with so many surfaces before them; `layers` has one channel.
std::vector<LayerClass> errorsByLayers(const image::Image& radiance, const image::Image& exact,
                                       const image::Image& layers);

std::string tableOf(const Comparison& comparison);
nlohmann::json jsonOf(const Comparison& comparison);
// Without pictures; writePictures() adds them.
image::Report reportOf(const Comparison& comparison);
// Writes the exact picture, and of each run its picture and the heat map of its error, into `folder`, and
// adds them to the report. Nothing in a build without image files.
void writePictures(const Comparison& comparison, const std::string& folder, image::Report& report);

}  // namespace sfumato::app
