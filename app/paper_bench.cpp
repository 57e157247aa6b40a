// The papers' tables, planned and told.
#include "app/paper_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/bench.h"
#include "app/text_table.h"
#include "base/log.h"
#include "image/image_file.h"

namespace sfumato::app {
namespace {

using Json = nlohmann::json;

const char* nameOf(const std::string& paper) {
  return paper == "metu" ? "Aladagli 2015" : "Ferko 2012";
}

std::string titleOf(const PaperTable& table) {
  return fmt::format("{}, table {}: {}", nameOf(table.paper), table.number, table.title);
}

// Rows of light counts outside the range are left out; the others are all kept.
void keepLights(PaperTable& table, const glm::ivec2& range) {
  if (table.paper != "metu") return;
  PaperTable kept = table;
  kept.rows.clear();
  kept.figures.clear();
  kept.settings.clear();
  for (size_t row = 0; row < table.rows.size(); ++row) {
    const int lights = table.settings[row].front().lights;
    if (lights < range.x || lights > range.y) continue;
    kept.rows.push_back(table.rows[row]);
    kept.figures.push_back(table.figures[row]);
    kept.settings.push_back(table.settings[row]);
  }
  if (!kept.baselineRows.empty()) kept.baselineRows.assign(kept.rows.size(), 0);
  table = std::move(kept);
}

int scaled(int side, double factor) {
  return std::max(1, static_cast<int>(std::lround(side * factor)));
}

void scale(PaperSetting& setting, const PapersOptions& options) {
  const double x = options.width / 1920.0, y = options.height / 1080.0;
  setting.width = scaled(setting.width, x);
  setting.height = scaled(setting.height, y);
  setting.shadowTexels = std::max(32, scaled(setting.shadowTexels, std::sqrt(x * y)));
}

std::string text(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "-";
}

// Whether its columns are of other machines, and all one setting here.
bool isOfMachines(const PaperTable& table) {
  return std::ranges::all_of(table.settings, [](const std::vector<PaperSetting>& row) {
    return std::ranges::all_of(row, [&](const PaperSetting& setting) { return setting == row.front(); });
  });
}

// Of each row our milliseconds, then both ratios for each column that is no baseline.
std::vector<Row> rowsOf(const PaperResult& result, const PaperTable& table) {
  const bool machines = isOfMachines(table);
  const size_t columns = table.columns.size();
  const size_t timed = machines ? 1 : columns;
  const size_t firstRatio = table.baselineRows.empty() ? 1 : 0;
  Row head = {table.rowTitle};
  for (size_t column = 0; column < timed; ++column)
    head.push_back(machines ? "ms" : table.columns[column] + " ms");
  for (size_t column = firstRatio; column < columns; ++column) {
    head.push_back(table.columns[column] + (machines ? "" : " paper"));
    if (!machines || column + 1 == columns) head.push_back("here");
  }
  std::vector<Row> rows = {head};
  for (size_t row = 0; row < table.rows.size(); ++row) {
    Row line = {table.rows[row]};
    for (size_t column = 0; column < timed; ++column)
      line.push_back(text(result.ours(table, row, column), "{:.1f}"));
    for (size_t column = firstRatio; column < columns; ++column) {
      line.push_back(fmt::format("{:.2f}", paperRatio(table, row, column)));
      if (!machines || column + 1 == columns)
        line.push_back(text(result.ourRatio(table, row, column), "{:.2f}"));
    }
    rows.push_back(line);
  }
  return rows;
}

std::string baselineText(const PaperTable& table) {
  if (table.baselineRows.empty())
    return fmt::format("frame rates over those of \"{}\"", table.columns.front());
  const bool all = std::ranges::all_of(table.baselineRows, [](size_t row) { return row == 0; });
  return all ? fmt::format("frame rates over those with {} lights", table.rows.front())
             : "frame rates over those of OFF";
}

Json cellJson(const PaperResult& result, const PaperTable& table, size_t row, size_t column) {
  const auto json = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  const PaperSetting& setting = table.settings[row][column];
  return {{"row", table.rows[row]},
          {"column", table.columns[column]},
          {"pipeline", setting.pipeline},
          {"opaque_triangles", setting.opaque},
          {"translucent_triangles", setting.drawsTranslucent ? setting.translucent : 0},
          {"width", setting.width},
          {"height", setting.height},
          {"shadow_texels", setting.shadowTexels},
          {"paper_fps", table.figures[row][column]},
          {"paper_ratio", paperRatio(table, row, column)},
          {"ms", json(result.ours(table, row, column))},
          {"ratio", json(result.ourRatio(table, row, column))}};
}

image::Table pageTable(const PaperResult& result, const PaperTable& table) {
  std::vector<Row> rows = rowsOf(result, table);
  image::Table shown{
      .title = titleOf(table), .caption = "Ratios: " + baselineText(table) + ".", .header = rows.front()};
  shown.rows.assign(rows.begin() + 1, rows.end());
  return shown;
}

// Our ratios against the paper's: on the line where they agree.
image::Plot agreement(const PaperResult& result) {
  image::Plot plot{.title = "Ratios here against the papers'",
                   .caption = "On the dashed line both agree.",
                   .kind = image::Plot::Kind::Points,
                   .xTitle = "paper",
                   .yTitle = "here",
                   .logarithmicX = true,
                   .logarithmicY = true};
  double low = 1, high = 1;
  for (const PaperTable& table : result.tables) {
    image::Series series{.name = "table " + table.number};
    for (size_t row = 0; row < table.rows.size(); ++row)
      for (size_t column = 0; column < table.columns.size(); ++column) {
        const std::optional<double> here = result.ourRatio(table, row, column);
        if (!here || table.isBaseline(row, column)) continue;
        const double paper = paperRatio(table, row, column);
        series.points.emplace_back(paper, *here);
        low = std::min(low, paper);
        high = std::max(high, paper);
      }
    if (!series.points.empty()) plot.series.push_back(series);
  }
  plot.series.push_back({.name = "equal", .points = {{low, low}, {high, high}}, .reference = true});
  return plot;
}

}  // namespace

std::optional<double> PaperResult::ours(const PaperTable& table, size_t row, size_t column) const {
  const auto found = milliseconds.find(table.settings[row][column]);
  if (found == milliseconds.end()) return std::nullopt;
  return medianOf(found->second);
}

std::optional<double> PaperResult::ourRatio(const PaperTable& table, size_t row, size_t column) const {
  const PaperTable::Place baseline = table.baselineOf(row, column);
  const std::optional<double> one = ours(table, row, column),
                              other = ours(table, baseline.row, baseline.column);
  if (!one || !other || *one <= 0) return std::nullopt;
  return *other / *one;
}

std::string nameOf(const PaperSetting& setting) {
  const char* const names[] = {"hall", "court", "statue", "house"};
  return fmt::format("{}, {} opaque and {} translucent triangles", names[static_cast<size_t>(setting.scene)],
                     setting.opaque, setting.drawsTranslucent ? setting.translucent : 0);
}

double paperRatio(const PaperTable& table, size_t row, size_t column) {
  const PaperTable::Place baseline = table.baselineOf(row, column);
  return table.figures[row][column] / table.figures[baseline.row][baseline.column];
}

std::vector<PaperTable> plannedTables(const PapersOptions& options) {
  std::vector<PaperTable> tables = paperTables();
  std::erase_if(tables, [&](const PaperTable& table) {
    return !options.paper.empty() && table.paper != options.paper;
  });
  for (PaperTable& table : tables) {
    if (options.lights) keepLights(table, *options.lights);
    for (std::vector<PaperSetting>& row : table.settings)
      for (PaperSetting& setting : row) scale(setting, options);
  }
  std::erase_if(tables, [](const PaperTable& table) { return table.rows.empty(); });
  return tables;
}

std::string tableOf(const PaperResult& result) {
  std::string text =
      fmt::format("device   {}\nsize     {}x{} for the papers' 1920x1080; others in proportion\n",
                  result.device, result.width, result.height);
  for (const PaperTable& table : result.tables)
    text += fmt::format("\n{}\nratios: {}\n{}", titleOf(table), baselineText(table),
                        aligned(rowsOf(result, table), 1));
  return text;
}

nlohmann::json jsonOf(const PaperResult& result) {
  Json json = {{"device", result.device}, {"command", result.commandLine}, {"width", result.width},
               {"height", result.height}, {"seconds", result.seconds},     {"tables", Json::array()}};
  for (const PaperTable& table : result.tables) {
    Json cells = Json::array();
    for (size_t row = 0; row < table.rows.size(); ++row)
      for (size_t column = 0; column < table.columns.size(); ++column)
        cells.push_back(cellJson(result, table, row, column));
    json["tables"].push_back({{"paper", table.paper},
                              {"table", table.number},
                              {"title", table.title},
                              {"ratios", baselineText(table)},
                              {"cells", cells}});
  }
  return json;
}

image::Report reportOf(const PaperResult& result) {
  image::Report report{
      .title = "Sfumato: the papers' tests",
      .facts = {{"Device", result.device},
                {"Command", result.commandLine},
                {"Size", fmt::format("{}x{} for the papers' 1920x1080; others in proportion", result.width,
                                     result.height)},
                {"Time", fmt::format("{:.1f} s", result.seconds)}},
      .verdict = fmt::format("{} settings in {} tables", result.milliseconds.size(), result.tables.size())};
  report.parts.emplace_back(agreement(result));
  for (const PaperTable& table : result.tables) report.parts.emplace_back(pageTable(result, table));
  return report;
}

void writePictures(const PaperResult& result, const std::string& folder, image::Report& report) {
  if (!image::readsAndWritesImages()) {
    base::note("{}: without pictures: this build writes no images", folder);
    return;
  }
  image::Pictures pictures{.title = "Scenes", .caption = "As the last test of each drew it."};
  for (const auto& [name, picture] : result.pictures) {
    const std::string file = fmt::format("scene_{}.png", pictures.pictures.size() + 1);
    image::writeImage(std::filesystem::path(folder) / file, picture, {});
    pictures.pictures.push_back({file, name});
  }
  report.parts.emplace_back(std::move(pictures));
}

}  // namespace sfumato::app
