#include "scaling_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <vector>

namespace focal_bench {
namespace {

constexpr double panel_width = 300, panel_height = 230, left = 56, top = 40, gap = 84, bottom = 52;

std::string text(const char* format, ...) {
  char buffer[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

struct Curve {
  const char* name;
  const char* colour;
  std::vector<double> values;
};

struct Panel {
  const char* title;
  double x;  // of its left edge
  std::vector<double> vertices;
  std::vector<Curve> curves;
};

// A logarithmic axis over whole decades.
struct Axis {
  double low, high, from, to;  // powers of ten; pixels
  double at(double value) const { return from + (std::log10(value) - low) / (high - low) * (to - from); }
};

Axis axis_over(const std::vector<double>& values, double from, double to) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double low = std::floor(std::log10(*least)), high = std::ceil(std::log10(*most));
  return {low, std::max(high, low + 1), from, to};
}

std::string tick_label(double value) {
  if (value >= 1e6) return text("%.3gM", value / 1e6);
  return value >= 2e3 ? text("%.3gK", value / 1e3) : text("%g", value);
}

std::string grid(const Panel& panel, const Axis& across, const Axis& up) {
  std::string svg;
  for (double power = up.low; power <= up.high; ++power) {
    const double y = up.at(std::pow(10, power));
    svg += text("<path class=\"grid\" d=\"M%.1f %.1fh%.1f\"/>", panel.x, y, panel_width);
    svg += text("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%s</text>\n", panel.x - 6, y + 4,
                tick_label(std::pow(10, power)).c_str());
  }
  double last = -100;
  for (const double count : panel.vertices) {
    const double x = across.at(count);
    svg += text("<path class=\"grid\" d=\"M%.1f %.1fv%.1f\"/>", x, top, panel_height);
    if (x - last < 30) continue;  // labels would touch
    last = x;
    svg += text("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n", x, top + panel_height + 16,
                tick_label(count).c_str());
  }
  return svg;
}

std::string draw(const Panel& panel) {
  std::vector<double> all;
  for (const Curve& curve : panel.curves) all.insert(all.end(), curve.values.begin(), curve.values.end());
  const auto [least, most] = std::minmax_element(panel.vertices.begin(), panel.vertices.end());
  const Axis across = {std::log10(*least) - 0.1, std::log10(*most) + 0.1, panel.x, panel.x + panel_width};
  const Axis up = axis_over(all, top + panel_height, top);
  std::string svg = grid(panel, across, up);
  svg += text("<text class=\"title\" x=\"%.1f\" y=\"%.1f\">%s</text>\n", panel.x, top - 16, panel.title);
  svg += text("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">vertices</text>\n",
              panel.x + panel_width / 2, top + panel_height + 36);
  for (const Curve& curve : panel.curves) {
    // Above the end of the upper curve, well below that of the lower one: between them a label would be crossed.
    const double beside = &curve == &panel.curves.front() ? -8 : 76;
    std::string line, dots;
    for (size_t i = 0; i < curve.values.size(); ++i) {
      const double x = across.at(panel.vertices[i]), y = up.at(curve.values[i]);
      line += text("%s%.1f %.1f", i ? "L" : "M", x, y);
      dots += text("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>", x, y, curve.colour);
    }
    svg += text("<path fill=\"none\" stroke-width=\"2\" stroke=\"%s\" d=\"", curve.colour) + line + "\"/>" +
           dots;
    svg += text("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\" style=\"fill:%s\">%s</text>\n",
                across.at(panel.vertices.back()) - 6, up.at(curve.values.back()) + beside, curve.colour,
                curve.name);
  }
  return svg;
}

std::vector<double> column(const nlohmann::json& rows, const char* name) {
  std::vector<double> values;
  for (const auto& row : rows) values.push_back(std::max(row[name].get<double>(), 1e-4));
  return values;
}

}  // namespace

std::string scaling_picture(const nlohmann::json& rows) {
  if (rows.empty()) return "";
  const auto vertices = column(rows, "vertices");
  const Panel time = {"Seconds",
                      left,
                      vertices,
                      {{"detect", "#2b7bba", column(rows, "detect_seconds")},
                       {"prepare", "#c1572b", column(rows, "prepare_seconds")}}};
  const Panel memory = {"Memory, MB",
                        left + panel_width + gap,
                        vertices,
                        {{"at most", "#2b7bba", column(rows, "peak_memory_mb")},
                         {"mesh, model and program", "#c1572b", column(rows, "memory_before_mb")}}};
  const double width = left + 2 * panel_width + gap + 20, height = top + panel_height + bottom;
  std::string svg =
      text("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\">\n", width,
           height, width);
  svg +=
      "<style>text{font:12px sans-serif;fill:#777}.title{font-weight:bold}"
      ".grid{stroke:#999;stroke-opacity:.35;fill:none}</style>\n";
  return svg + draw(time) + draw(memory) + "</svg>\n";
}

}  // namespace focal_bench
