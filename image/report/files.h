// The parts of a report's page that are files: compiled in by cmake/embed_report.cmake.
#pragma once

#include <string_view>

namespace sfumato::image::report {

std::string_view css();
std::string_view js();
std::string_view chartJs();  // empty: Chart.js was not there when the program was built

}  // namespace sfumato::image::report
