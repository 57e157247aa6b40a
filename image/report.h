// Reports for a browser: one HTML page that holds its plots, their library (Chart.js) and its data, and opens
// without a network. Pictures alone are files beside it.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace sfumato::image {

struct Series {
  std::string name;
  std::vector<std::pair<double, double>> points;  // of Bars: the second is the height, in order of categories
  bool reference = false;                         // a thin dashed line without points
};

struct Plot {
  enum class Kind { Lines, Points, Bars, StackedBars };
  std::string title;
  std::string caption;
  Kind kind = Kind::Lines;
  std::string xTitle;
  std::string yTitle;
  bool logarithmicX = false;  // not of bars; what is not above 0 is then left out
  bool logarithmicY = false;
  std::vector<std::string> categories;  // of bars
  std::vector<Series> series;
};

// A whole number for each cell, shown as a colour on a logarithmic scale.
struct CountMap {
  std::string title;
  std::string caption;
  size_t width = 0;
  size_t height = 0;
  std::vector<uint32_t> counts;  // width * height, rows from the top
  std::string unit;              // plural: "nodes"
};

struct Table {
  std::string title;
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  // a reader can sort them by any column
  std::vector<size_t> highlighted;             // rows in which something is wrong
};

// Image files beside the page, side by side.
struct Pictures {
  struct Picture {
    std::string file;  // relative to the page
    std::string label;
  };
  std::string title;
  std::string caption;
  std::vector<Picture> pictures;
};

struct Report {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  // name and value, in the page's head
  std::string verdict;                                     // one line
  bool good = true;                                        // whether the verdict is
  std::vector<std::variant<Plot, CountMap, Table, Pictures>> parts;
};

// Throws Usage when the program was built without Chart.js.
void checkReports();

// The page, as UTF-8; about 220 kB and the data. The same report makes the same page. Throws as
// checkReports().
std::string reportPage(const Report& report);

}  // namespace sfumato::image
