// The results of `sfumato bench papers`, and how they are told.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/options.h"
#include "app/paper_tables.h"
#include "image/image.h"
#include "image/report.h"

namespace sfumato::app {

struct PaperResult {
  std::string device;
  std::string commandLine;
  int width = 0;  // of what the papers drew with 1920 x 1080 pixels
  int height = 0;
  double seconds = 0;
  std::vector<PaperTable> tables;                            // with settings as they were drawn
  std::map<PaperSetting, std::vector<double>> milliseconds;  // of each frame after the first
  std::map<std::string, image::Image> pictures;              // of each scene, by a name for people

  // Median; nothing where it was not drawn.
  std::optional<double> ours(const PaperTable& table, size_t row, size_t column) const;
  // Frame rates over the baseline's; nothing where one is missing.
  std::optional<double> ourRatio(const PaperTable& table, size_t row, size_t column) const;
};

// The tables that the options want, with resolutions and shadow maps in proportion to theirs.
std::vector<PaperTable> plannedTables(const PapersOptions& options);

// Of the scene, for people.
std::string nameOf(const PaperSetting& setting);

double paperRatio(const PaperTable& table, size_t row, size_t column);

std::string tableOf(const PaperResult& result);
nlohmann::json jsonOf(const PaperResult& result);
// Without pictures; writePictures() adds them.
image::Report reportOf(const PaperResult& result);
// Writes the scenes' pictures into `folder` and adds them to the report; nothing in a build without image
// files.
void writePictures(const PaperResult& result, const std::string& folder, image::Report& report);

}  // namespace sfumato::app
