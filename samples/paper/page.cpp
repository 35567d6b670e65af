#include "page.h"

#include <cmath>
#include <cstdio>

namespace paper {

const char* const kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,"><title>The experiments of Xia et al. 2016</title>
<style>
:root { color-scheme: light dark; }
body { font: 16px/1.45 system-ui, sans-serif; max-width: 1180px; margin: 0 auto; padding: 1.2rem; background: #fff; color: #222; }
@media (prefers-color-scheme: dark) { body { background: #17181b; color: #e8e6e1; } .chart { background: #f7f5f1; } }
svg { max-width: 100%; height: auto; }
.chart { margin: 0 .8rem .8rem 0; border-radius: 8px; font: 11px sans-serif; }
.chart text { fill: #444; } .chart .grid { stroke: #ddd; fill: none; }
h2 { margin-top: 2.5rem; } .differs { font-size: .9em; opacity: .8; border-left: 3px solid #999; padding-left: .7rem; }
table { border-collapse: collapse; margin: .6rem 0; } th, td { padding: .2rem .7rem; text-align: right; border-bottom: 1px solid #9995; }
th:first-child, td:first-child { text-align: left; }
.ramp { display: inline-block; width: 9rem; height: .8rem; border-radius: 4px; vertical-align: middle;
  background: linear-gradient(90deg, #ccc7bd, #fadb8c, #f79940, #d93829, #800a29); }
.found, .marked { display: inline-block; width: .8rem; height: .8rem; border-radius: 50%; vertical-align: middle; }
.found { background: #2563eb; } .marked { border: 3px solid #0a7d3c; }
</style></head><body>
<h1>The experiments of Xia et al. 2016</h1>
<p>Q. Xia, S. Li, H. Qin, A. Hao, <i>Automatic Extraction of Generic Focal Features on 3D Shapes via Random Forest Regression
Analysis of Geodesics-in-Heat</i>, 2016: its tables and figures reproduced with the exact method (preset <b>paper</b>) and
with the one that measures best (preset <b>default</b>), side by side. No test shape was trained on.
Votes: none <span class="ramp"></span> most. <span class="marked"></span> marked by hand, <span class="found"></span> found.
Numbers in captions are errors in mean edge lengths of the test mesh.</p>
)";

std::string section(const std::string& title, const std::string& words, const std::string& differs,
                    const std::string& body) {
  return "<section><h3>" + title + "</h3><p>" + words + "</p>" + body +
         (differs.empty() ? "" : "<p class=\"differs\">Unlike the paper: " + differs + "</p>") +
         "</section>\n";
}

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::string html = "<table>";
  for (size_t i = 0; i < rows.size(); ++i) {
    html += "<tr>";
    for (const std::string& cell : rows[i])
      html += (i == 0 ? "<th>" : "<td>") + cell + (i == 0 ? "</th>" : "</td>");
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string pictures(const std::vector<picture::Figure>& figures, size_t columns) {
  return "<div>" + picture::draw(figures, columns) + "</div>";
}

std::string fixed(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

}  // namespace paper
