#include "app/report_file.h"

#include "base/error.h"
#include "base/file.h"
#include "image/report.h"

namespace sfumato::app {

std::filesystem::path pageOf(const std::string& folder) {
  return std::filesystem::path(folder) / "index.html";
}

void checkReport(const std::string& folder) {
  if (folder.empty()) return;
  image::checkReports();
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (problem) base::fail(base::ExitCode::Input, "{}: cannot be made: {}", folder, problem.message());
  base::checkWritable(pageOf(folder));
}

}  // namespace sfumato::app
