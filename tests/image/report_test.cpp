// A report's page: whole, inert where names are hostile, and with everything that was put into it.
#include "image/report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace sfumato::image {
namespace {

class ReportPage : public testing::Test {
 protected:
  void SetUp() override {
    try {
      checkReports();
    } catch (const base::Error& error) {
      EXPECT_EQ(error.exitCode, base::ExitCode::Usage);
      GTEST_SKIP() << error.what();
    }
  }
};

// What the page's script gets as `drawn`.
nlohmann::json drawnBy(const std::string& page) {
  const std::string start = "const drawn = ";
  const size_t at = page.find(start) + start.size();
  return nlohmann::json::parse(page.substr(at, page.find(";\n", at) - at));
}

Report wholeReport() {
  Report report{.title = "Title", .facts = {{"Name", "Value"}}, .verdict = "All is well"};
  report.parts.emplace_back(Plot{.title = "Bars",
                                 .caption = "Of two kinds",
                                 .kind = Plot::Kind::Bars,
                                 .categories = {"a", "b"},
                                 .series = {{.name = "one", .points = {{0, 1}, {0, 2}}}}});
  report.parts.emplace_back(
      Table{.title = "Table", .header = {"h"}, .rows = {{"r1"}, {"r2"}}, .highlighted = {1}});
  report.parts.emplace_back(
      CountMap{.title = "Map", .width = 2, .height = 1, .counts = {3, 4}, .unit = "nodes"});
  report.parts.emplace_back(
      Pictures{.title = "Pictures", .pictures = {{"a b.png", "left"}, {"c.png", "right"}}});
  return report;
}

TEST_F(ReportPage, HoldsWhatWasPutIn) {
  const std::string page = reportPage(wholeReport());
  for (const char* part :
       {"<title>Title</title>", "<dt>Name</dt><dd>Value</dd>", "<p class=\"good\">All is well</p>",
        "<h2>Bars</h2>", "Of two kinds", "<tr><td>r1</td></tr>", "<tr class=\"bad\"><td>r2</td></tr>",
        "<img src=\"a b.png\" alt=\"left\">", "<p>right</p>", "Chart.js v3", "</html>"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  const nlohmann::json drawn = drawnBy(page);
  ASSERT_EQ(drawn.size(), 2u);  // the table is HTML
  EXPECT_EQ(drawn[0]["kind"], "bars");
  EXPECT_EQ(drawn[0]["series"][0]["points"], nlohmann::json({{0.0, 1.0}, {0.0, 2.0}}));
  EXPECT_EQ(drawn[1]["counts"], nlohmann::json({3, 4}));
}

TEST_F(ReportPage, SaysWhenItIsBad) {
  Report report = wholeReport();
  report.good = false;
  EXPECT_NE(reportPage(report).find("<p class=\"bad\">All is well</p>"), std::string::npos);
}

TEST_F(ReportPage, IsTheSameForTheSameReport) {
  EXPECT_EQ(reportPage(wholeReport()), reportPage(wholeReport()));
}

TEST_F(ReportPage, TakesNoNameForMarkup) {
  const std::string hostile = "</script><script>alert('x')</script>&\xff";
  Report report{.title = hostile, .facts = {{hostile, hostile}}, .verdict = hostile};
  report.parts.emplace_back(
      Plot{.title = hostile, .caption = hostile, .series = {{.name = hostile, .points = {{1, 1}}}}});
  report.parts.emplace_back(
      Table{.title = hostile, .caption = hostile, .header = {hostile}, .rows = {{hostile}}});
  report.parts.emplace_back(Pictures{
      .title = hostile, .caption = hostile, .pictures = {{hostile, "\"><script>alert('x')</script>"}}});
  const std::string page = reportPage(report);
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(drawnBy(page)[0]["series"][0]["name"].get<std::string>().substr(0, 9), "</script>");
}

}  // namespace
}  // namespace sfumato::image
