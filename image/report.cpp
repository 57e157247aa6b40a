#include "image/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/markup.h"
#include "image/heat_map.h"
#include "image/report/files.h"

namespace sfumato::image {
namespace {

using base::escapedForMarkup;
using Json = nlohmann::json;

// JSON that a browser takes for nothing else within a <script>.
std::string scriptText(const Json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

const char* nameOf(Plot::Kind kind) {
  switch (kind) {
    case Plot::Kind::Lines:
      return "lines";
    case Plot::Kind::Points:
      return "points";
    case Plot::Kind::Bars:
      return "bars";
    default:
      return "stacked";
  }
}

Json toJson(const Plot& plot) {
  Json series = Json::array();
  for (const Series& one : plot.series)
    series.push_back({{"name", one.name}, {"points", one.points}, {"reference", one.reference}});
  return {{"kind", nameOf(plot.kind)},  {"x", plot.xTitle},          {"y", plot.yTitle},
          {"logX", plot.logarithmicX},  {"logY", plot.logarithmicY}, {"categories", plot.categories},
          {"series", std::move(series)}};
}

Json toJson(const CountMap& map) {
  return {{"kind", "counts"},
          {"width", map.width},
          {"height", map.height},
          {"counts", map.counts},
          {"unit", map.unit}};
}

std::string figure(const std::string& title, const std::string& caption) {
  return fmt::format(
      "<figure><h2>{}</h2><div class=\"plot\"><canvas></canvas></div><figcaption>{}</figcaption>"
      "</figure>\n",
      escapedForMarkup(title), escapedForMarkup(caption));
}

std::string tableRow(const std::vector<std::string>& cells, const char* tag) {
  std::string text;
  for (const std::string& cell : cells) text += fmt::format("<{0}>{1}</{0}>", tag, escapedForMarkup(cell));
  return text;
}

std::string tableText(const Table& table) {
  std::string rows;
  for (size_t i = 0; i < table.rows.size(); ++i) {
    const bool wrong =
        std::find(table.highlighted.begin(), table.highlighted.end(), i) != table.highlighted.end();
    rows += fmt::format("<tr{}>{}</tr>\n", wrong ? " class=\"bad\"" : "", tableRow(table.rows[i], "td"));
  }
  return fmt::format(
      "<section><h2>{}</h2><div "
      "class=\"scroll\"><table><thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody></table>"
      "</div><p class=\"caption\">{}</p></section>\n",
      escapedForMarkup(table.title), tableRow(table.header, "th"), rows, escapedForMarkup(table.caption));
}

std::string picturesText(const Pictures& part) {
  std::string pictures;
  for (const Pictures::Picture& picture : part.pictures)
    pictures +=
        fmt::format("<div><img src=\"{}\" alt=\"{}\"><p>{}</p></div>\n", escapedForMarkup(picture.file),
                    escapedForMarkup(picture.label), escapedForMarkup(picture.label));
  return fmt::format(
      "<section><h2>{}</h2><div class=\"pictures\">\n{}</div><p class=\"caption\">{}</p></section>\n",
      escapedForMarkup(part.title), pictures, escapedForMarkup(part.caption));
}

// The colours of CountMaps, from none to most.
Json palette() {
  Json colours = Json::array();
  for (int i = 0; i < 256; ++i) colours.push_back(heatColour(i / 255.0));
  return colours;
}

}  // namespace

void checkReports() {
  if (report::chartJs().empty())
    base::fail(base::ExitCode::Usage,
               "report: this program was built without Chart.js: install libjs-chart.js and build it again");
}

std::string reportPage(const Report& report) {
  checkReports();
  std::string body;
  Json drawn = Json::array();  // what each <figure> shows, in order
  for (const auto& part : report.parts) {
    if (const auto* table = std::get_if<Table>(&part)) {
      body += tableText(*table);
    } else if (const auto* pictures = std::get_if<Pictures>(&part)) {
      body += picturesText(*pictures);
    } else if (const auto* plot = std::get_if<Plot>(&part)) {
      body += figure(plot->title, plot->caption);
      drawn.push_back(toJson(*plot));
    } else {
      const auto& map = std::get<CountMap>(part);
      body += figure(map.title, map.caption);
      drawn.push_back(toJson(map));
    }
  }
  std::string facts;
  for (const auto& [name, value] : report.facts)
    facts += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escapedForMarkup(name), escapedForMarkup(value));
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{0}</title>\n<style>\n{1}</style>\n</head>\n"
      "<body>\n<header><h1>{0}</h1>\n<p class=\"{2}\">{3}</p>\n<dl>\n{4}</dl></header>\n<main>\n{5}</main>\n",
      escapedForMarkup(report.title), report::css(), report.good ? "good" : "bad",
      escapedForMarkup(report.verdict), facts, body);
  page += "<script>\n" + std::string(report::chartJs()) + "</script>\n";
  page +=
      "<script>\nconst palette = " + scriptText(palette()) + ";\nconst drawn = " + scriptText(drawn) + ";\n";
  page += std::string(report::js()) + "</script>\n</body>\n</html>\n";
  return page;
}

}  // namespace sfumato::image
