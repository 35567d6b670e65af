#include "chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace paper {
namespace {

constexpr double kLeft = 58, kRight = 348, kTop = 30, kBottom = 190;  // of the axes, in pixels
constexpr int kTicks = 4;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, std::fabs(value) < 100 ? "%.3g" : "%.0f", value);
  return text;
}

std::string text_at(double x, double y, const std::string& words, const char* anchor) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\">" + words +
         "</text>";
}

struct Range {
  double low = 1e300, high = -1e300;
  void add(double value) { low = std::min(low, value), high = std::max(high, value); }
  double share(double value) const { return high > low ? (value - low) / (high - low) : 0.5; }
  double at(double share) const { return low + share * (high - low); }
};

double x_of(const Range& range, double value) { return kLeft + (kRight - kLeft) * range.share(value); }
double y_of(const Range& range, double value) { return kBottom - (kBottom - kTop) * range.share(value); }

std::string axes(const Range& x, const Range& y) {
  std::string svg;
  for (int i = 0; i <= kTicks; ++i) {
    const double share = static_cast<double>(i) / kTicks;
    const double across = kLeft + share * (kRight - kLeft), up = kBottom - share * (kBottom - kTop);
    svg += "<path class=\"grid\" d=\"M" + number(kLeft) + " " + number(up) + "H" + number(kRight) + "\"/>";
    svg += text_at(kLeft - 5, up + 4, rounded(y.at(share)), "end");
    svg += text_at(across, kBottom + 14, rounded(x.at(share)), i == kTicks ? "end" : "middle");
  }
  return svg;
}

std::string drawn(const Curve& curve, const Range& x, const Range& y) {
  std::string svg, path;
  for (const auto& [px, py] : curve.points) {
    const std::string at = number(x_of(x, px)) + " " + number(y_of(y, py));
    path += curve.dots ? "M" + at + "h0" : (path.empty() ? "M" : "L") + at;
  }
  const char* style = curve.dots ? "stroke-width:2.2;stroke-linecap:round" : "stroke-width:2";
  return "<path fill=\"none\" stroke=\"" + curve.paint + "\" style=\"" + style + "\" d=\"" + path + "\"/>";
}

}  // namespace

std::string chart(const std::string& title, const std::string& x_name, const std::string& y_name,
                  const std::vector<Curve>& curves) {
  Range x, y;
  y.add(0);
  for (const Curve& curve : curves)
    for (const auto& [px, py] : curve.points) x.add(px), y.add(1.04 * py);
  std::string svg =
      "<svg class=\"chart\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 360 236\" width=\"360\">" +
      text_at(kLeft, 16, title, "start") + axes(x, y) + text_at(kRight, kBottom + 29, x_name, "end") +
      text_at(kLeft + 4, kTop + 10, y_name, "start");
  double legend = kLeft;
  for (const Curve& curve : curves) {
    svg += drawn(curve, x, y);
    if (curve.name.empty()) continue;
    svg += "<rect x=\"" + number(legend) + "\" y=\"224\" width=\"9\" height=\"9\" fill=\"" + curve.paint +
           "\"/>" + text_at(legend + 13, 233, curve.name, "start");
    legend += 26 + 6.4 * static_cast<double>(curve.name.size());
  }
  return svg + "</svg>\n";
}

}  // namespace paper
