// The files of report/ as text; the definitions are made by report/embed.cmake at build time.
#pragma once
#include <string_view>

namespace focal_cli {

extern const std::string_view kReportPage, kReportStyle, kReportScript;
extern const std::string_view
    kReportThree;  // empty where three.js could not be had: the page then draws by itself

}  // namespace focal_cli
