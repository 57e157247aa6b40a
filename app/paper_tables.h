// The performance tables of the papers, and what we draw for each of their figures.
#pragma once

#include <compare>
#include <string>
#include <vector>

#include "pipelines/deferred_options.h"
#include "scene/generated_scenes.h"

namespace sfumato::app {

enum class PaperScene { Hall, Court, Statue, House };  // scene/generated_scenes.h

// One measurement of ours. Its fields say all that it depends on, so that equal ones are measured once.
struct PaperSetting {
  PaperScene scene = PaperScene::Hall;
  size_t opaque = 0;  // triangles of the scene
  size_t translucent = 0;
  bool drawsTranslucent = true;
  int lights = 0;  // of the hall
  std::string pipeline;
  int layers = 0;
  pipelines::ShadowKind shadows = pipelines::ShadowKind::None;
  bool refraction = false;
  bool ambientOcclusion = false;
  int preset = 2;  // of Ferko 2012: 0 low, 1 medium, 2 high
  int width = 1920;
  int height = 1080;
  int shadowTexels = 1024;  // a side of a light's map
  auto operator<=>(const PaperSetting&) const = default;
};

// Frames a second of the paper, and our settings, for each row and column. A ratio is of a figure to its
// baseline: to the first column of its row, or to a row of its column.
struct PaperTable {
  std::string paper;   // "metu" or "cescg"
  std::string number;  // "4.2"
  std::string title;
  std::string rowTitle;
  std::vector<std::string> rows;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> figures;
  std::vector<std::vector<PaperSetting>> settings;
  std::vector<size_t> baselineRows;  // for each row; empty: the first column is the baseline

  struct Place {
    size_t row = 0;
    size_t column = 0;
  };
  Place baselineOf(size_t row, size_t column) const {
    return baselineRows.empty() ? Place{row, 0} : Place{baselineRows[row], column};
  }
  bool isBaseline(size_t row, size_t column) const {
    const Place baseline = baselineOf(row, column);
    return baseline.row == row && baseline.column == column;
  }
};

// All of Aladagli 2015 (tables 4.2 to 4.9) and Ferko 2012 (table 1), at the papers' resolutions.
std::vector<PaperTable> paperTables();

// The scene of a setting, without what is translucent where the setting draws none.
scene::GeneratedScene sceneOf(const PaperSetting& setting);

}  // namespace sfumato::app
