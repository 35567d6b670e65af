// The files of report/ as text; the definitions are made by report/embed.cmake at build time.
#pragma once
#include <string_view>

namespace focal_cli {

extern const std::string_view report_page_text, report_style_text, report_script_text;
extern const std::string_view
    report_three_text;  // empty where three.js could not be had: the page then draws by itself

}  // namespace focal_cli
