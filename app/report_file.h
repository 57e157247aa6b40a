// The folder of a --report.
#pragma once

#include <filesystem>
#include <string>

namespace sfumato::app {

// Its page, FOLDER/index.html.
std::filesystem::path pageOf(const std::string& folder);

// Before the long work: makes the folder, and throws unless a page can be made and written there. Nothing for
// an empty name.
void checkReport(const std::string& folder);

}  // namespace sfumato::app
