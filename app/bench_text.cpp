// The results of a comparison of pipelines as a table, as JSON and as a page.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "app/bench.h"
#include "app/text_table.h"
#include "base/log.h"
#include "base/size_text.h"
#include "image/heat_map.h"
#include "image/image_file.h"

namespace sfumato::app {
namespace {

using Json = nlohmann::json;

constexpr LayerClass layerClasses[] = {{0, 0}, {1, 1}, {2, 2}, {3, 4}, {5, 8}, {9, 1 << 30}};

std::string nameOf(const LayerClass& one) {
  if (one.fewest == one.most) return std::to_string(one.fewest);
  return one.fewest == 9 ? "9+" : fmt::format("{}-{}", one.fewest, one.most);
}

std::string bytesPerPixel(size_t bytes, const Comparison& comparison) {
  return fmt::format("{:.0f}", static_cast<double>(bytes) / static_cast<double>(comparison.pixels()));
}

size_t shadowBytes(const VariantRun& run) {
  size_t bytes = 0;
  for (const auto& [label, peak] : run.frameBytesByLabel)
    if (label.find("shadow") != std::string::npos) bytes += peak;
  return bytes;
}

// The classes of layers that any image has.
std::vector<LayerClass> classesOf(const Comparison& comparison) {
  for (const VariantRun& run : comparison.runs)
    if (run.refused.empty()) return run.layers;
  return {};
}

Row headOf(const Comparison& comparison) {
  Row row = {"pipeline", "rmse", "seen"};
  for (const LayerClass& one : classesOf(comparison)) row.push_back("rmse " + nameOf(one));
  row.insert(row.end(), {"ms", "B/pixel", "shadows", "passes"});
  return row;
}

Row rowOf(const VariantRun& run, const Comparison& comparison) {
  Row row = {run.variant.name};
  if (!run.refused.empty()) {
    row.push_back("refused");
    row.resize(headOf(comparison).size(), "-");
    return row;
  }
  row.push_back(fmt::format("{:.5f}", run.difference.rmse));
  row.push_back(run.perceptual ? fmt::format("{:.2f}", 100.0 * static_cast<double>(*run.perceptual) /
                                                           static_cast<double>(comparison.pixels()))
                               : "-");
  for (const LayerClass& one : run.layers) row.push_back(fmt::format("{:.5f}", one.rmse));
  row.push_back(fmt::format("{:.1f}", run.median()));
  row.push_back(bytesPerPixel(run.frameBytes, comparison));
  row.push_back(base::sizeText(shadowBytes(run)));
  row.push_back(std::to_string(run.passCount()));
  return row;
}

std::string legend() {
  return "rmse: from the exact image, over all pixels, and over those with so many translucent surfaces; "
         "seen: % of pixels in which a viewer sees a difference; ms: median of the frames after the first; "
         "B/pixel: what a frame takes at its peak, and shadows what of it is for shadow maps";
}

// At which a heat map is brightest: one for all, so that they compare.
double heatScale(const Comparison& comparison) {
  double worst = 0;
  for (const VariantRun& run : comparison.runs) worst = std::max(worst, run.difference.rmse);
  return std::max(4 * worst, 1e-3);
}

Json passesJson(const VariantRun& run) {
  Json passes = Json::array();
  for (const PassCalls& pass : run.passes)
    passes.push_back({{"pass", pass.name}, {"calls", pass.calls}, {"ms", pass.milliseconds}});
  return passes;
}

Json runJson(const VariantRun& run, const Comparison& comparison) {
  Json json = {{"name", run.variant.name},
               {"pipeline", run.variant.pipeline},
               {"paper", run.variant.paper},
               {"cannot", run.variant.cannot}};
  if (!run.refused.empty()) {
    json["refused"] = run.refused;
    return json;
  }
  Json layers = Json::array();
  for (const LayerClass& one : run.layers)
    layers.push_back({{"from", one.fewest}, {"to", one.most}, {"pixels", one.pixels}, {"rmse", one.rmse}});
  json.update(
      {{"rmse", run.difference.rmse},
       {"relative_rmse", run.difference.relativeRmse},
       {"maximum", run.difference.maximum},
       {"perceptual_pixels", run.perceptual ? Json(*run.perceptual) : Json()},
       {"layers", layers},
       {"ms", run.median()},
       {"ms_of_each", run.milliseconds},
       {"scene_bytes", run.sceneBytes},
       {"frame_bytes", run.frameBytes},
       {"bytes_per_pixel", static_cast<double>(run.frameBytes) / static_cast<double>(comparison.pixels())},
       {"shadow_bytes", shadowBytes(run)},
       {"frame_bytes_by_label", run.frameBytesByLabel},
       {"passes", run.passCount()},
       {"calls", passesJson(run)}});
  return json;
}

std::string fileNameOf(const std::string& name) {
  std::string file;
  for (const char c : name)
    if (c != ',') file += c == ' ' ? '_' : c;
  return file;
}

}  // namespace

double medianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double VariantRun::median() const {
  return medianOf(milliseconds);
}

int VariantRun::passCount() const {
  return std::accumulate(passes.begin(), passes.end(), 0,
                         [](int sum, const PassCalls& pass) { return sum + pass.calls; });
}

std::vector<LayerClass> errorsByLayers(const image::Image& radiance, const image::Image& exact,
                                       const image::Image& layers) {
  std::vector<LayerClass> found;
  for (LayerClass one : layerClasses) {
    double squares = 0;
    for (int y = 0; y < exact.height; ++y)
      for (int x = 0; x < exact.width; ++x) {
        const float count = layers.pixel(x, y)[0];
        if (count < static_cast<float>(one.fewest) || count > static_cast<float>(one.most)) continue;
        ++one.pixels;
        for (int c = 0; c < 3; ++c)
          squares += std::pow(double{radiance.pixel(x, y)[c]} - exact.pixel(x, y)[c], 2);
      }
    if (one.pixels == 0) continue;
    one.rmse = std::sqrt(squares / (3 * static_cast<double>(one.pixels)));
    found.push_back(one);
  }
  return found;
}

std::string tableOf(const Comparison& comparison) {
  std::vector<Row> rows = {headOf(comparison)};
  for (const VariantRun& run : comparison.runs) rows.push_back(rowOf(run, comparison));
  std::string text = fmt::format(
      "device   {}\nscene    {}, {}x{}, quality {}\nexact    {}, {:.0f} ms\n\n{}{}\n\n", comparison.device,
      comparison.scene, comparison.width, comparison.height, comparison.quality, comparison.exactBy,
      comparison.exactMilliseconds, aligned(rows, 1), legend());
  for (const VariantRun& run : comparison.runs)
    text += fmt::format("{} ({}): {}\n", run.variant.name, run.variant.paper,
                        run.refused.empty() ? run.variant.cannot : "refused: " + run.refused);
  return text;
}

nlohmann::json jsonOf(const Comparison& comparison) {
  Json json = {{"device", comparison.device},
               {"command", comparison.commandLine},
               {"scene", comparison.scene},
               {"quality", comparison.quality},
               {"width", comparison.width},
               {"height", comparison.height},
               {"exact", {{"by", comparison.exactBy}, {"ms", comparison.exactMilliseconds}}},
               {"pipelines", Json::array()}};
  for (const VariantRun& run : comparison.runs) json["pipelines"].push_back(runJson(run, comparison));
  return json;
}

image::Report reportOf(const Comparison& comparison) {
  const auto refused =
      std::ranges::count_if(comparison.runs, [](const auto& run) { return !run.refused.empty(); });
  image::Report report{
      .title = "Sfumato: pipelines side by side",
      .facts = {{"Device", comparison.device},
                {"Command", comparison.commandLine},
                {"Scene", fmt::format("{}, {}x{}, quality {}", comparison.scene, comparison.width,
                                      comparison.height, comparison.quality)},
                {"Exact", fmt::format("{}, {:.0f} ms", comparison.exactBy, comparison.exactMilliseconds)}},
      .verdict = refused == 0
                     ? fmt::format("{} ways to draw", comparison.runs.size())
                     : fmt::format("{} of {} ways to draw were refused", refused, comparison.runs.size()),
      .good = refused == 0};
  image::Table figures{.title = "Figures", .caption = legend(), .header = headOf(comparison)};
  image::Table limits{.title = "What each cannot do", .header = {"pipeline", "paper", "what"}};
  image::Plot times{.title = "Milliseconds a frame",
                    .kind = image::Plot::Kind::Bars,
                    .yTitle = "ms",
                    .series = {{.name = "ms"}}};
  image::Plot errors{.title = "Error",
                     .caption = "Root of the mean squared difference from the exact image.",
                     .kind = image::Plot::Kind::Bars,
                     .yTitle = "rmse",
                     .logarithmicY = true,
                     .series = {{.name = "rmse"}}};
  for (const VariantRun& run : comparison.runs) {
    if (!run.refused.empty()) figures.highlighted.push_back(figures.rows.size());
    figures.rows.push_back(rowOf(run, comparison));
    limits.rows.push_back({run.variant.name, run.variant.paper,
                           run.refused.empty() ? run.variant.cannot : "Refused: " + run.refused});
    if (!run.refused.empty()) continue;
    times.categories.push_back(run.variant.name);
    times.series[0].points.emplace_back(0, run.median());
    errors.categories.push_back(run.variant.name);
    errors.series[0].points.emplace_back(0, run.difference.rmse);
  }
  report.parts = {figures, errors, times, limits};
  return report;
}

void writePictures(const Comparison& comparison, const std::string& folder, image::Report& report) {
  if (!image::readsAndWritesImages()) {
    base::note("{}: without pictures: this build writes no images", folder);
    return;
  }
  const std::filesystem::path place = folder;
  image::Pictures pictures{
      .title = "Pictures", .caption = "Tone-mapped alike.", .pictures = {{"exact.png", "exact"}}};
  const double scale = heatScale(comparison);
  image::Pictures errors{
      .title = "Where they are wrong",
      .caption =
          fmt::format("Largest difference of a pixel's channels from the exact image, from 0 (black) to "
                      "{:.3g} (pale yellow) and beyond.",
                      scale)};
  image::writeImage(place / "exact.png", comparison.exact, {});
  for (const VariantRun& run : comparison.runs) {
    if (!run.refused.empty()) continue;
    const std::string name = fileNameOf(run.variant.name);
    image::writeImage(place / (name + ".png"), run.radiance, {});
    image::writePicture(place / (name + "_error.png"), image::heatMap(run.radiance, comparison.exact, scale),
                        {});
    pictures.pictures.push_back({name + ".png", run.variant.name});
    errors.pictures.push_back({name + "_error.png", run.variant.name});
  }
  report.parts.insert(report.parts.begin(), {pictures, errors});
}

}  // namespace sfumato::app
