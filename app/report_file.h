// The folder of a --report.
#pragma once

#include <filesystem>
#include <string>

#include "base/file.h"
#include "base/json_text.h"
#include "base/log.h"
#include "image/report.h"

namespace sfumato::app {

// Its page, FOLDER/index.html.
std::filesystem::path pageOf(const std::string& folder);

// Before the long work: makes the folder, and throws unless a page can be made and written there. Nothing for
// an empty name.
void checkReport(const std::string& folder);

// Prints a result as text or JSON and, where a folder is named, writes its page and the pictures of that; by
// what the result's own header has: tableOf, jsonOf, reportOf, writePictures.
template <typename Result>
void tell(const Result& result, bool json, const std::string& folder) {
  base::printResult(json ? base::jsonText(jsonOf(result)) : tableOf(result));
  if (folder.empty()) return;
  image::Report report = reportOf(result);
  writePictures(result, folder, report);
  base::writeFile(pageOf(folder), image::reportPage(report));
  base::note("wrote {}", pageOf(folder).string());
}

}  // namespace sfumato::app
