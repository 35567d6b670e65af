// Painter's algorithm (Newell, Newell, Sancha 1972), coarsely: slabs of depth back to front; within a slab the
// triangles of one shade share a path, which makes the file several times smaller.
#include "drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "surface.h"

namespace picture {
namespace {

// The drawing's unit is a tenth of a pixel, so that coordinates are short integers.
constexpr int panel_width = 2300, panel_height = 3000, margin = 160, caption_height = 300;
constexpr int slab_count = 28, shade_count = 26;
constexpr size_t long_caption = 24;  // letters that fit into a panel
constexpr double ball_radius = 46;

int rounded(double x) { return static_cast<int>(std::lround(x)); }

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

std::string colour(double red, double green, double blue) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", rounded(255 * red), rounded(255 * green),
                rounded(255 * blue));
  return text;
}

// Clay: warm shadows, nearly white lights.
std::string clay(int shade) {
  const double t = (shade + 0.5) / shade_count;
  return colour(0.24 + 0.72 * t, 0.24 + 0.70 * t, 0.30 + 0.62 * t);
}

// Hues a golden angle apart stay different however many marks there are.
std::string hue(int index) {
  const double turn = std::fmod(0.02 + 0.61803398875 * index, 1.0);
  const auto channel = [&](double offset) {
    const double x = std::fabs(std::fmod(6 * (turn + offset), 6.0) - 3) - 1;
    return 0.12 + 0.8 * std::clamp(x, 0.0, 1.0);
  };
  return colour(channel(0), channel(2.0 / 3), channel(1.0 / 3));
}

std::string path_of(const std::vector<const Patch*>& patches) {
  std::string path;
  for (const Patch* patch : patches) {
    int x[3], y[3];
    for (int k = 0; k < 3; ++k) x[k] = rounded(patch->corners[k][0]), y[k] = rounded(patch->corners[k][1]);
    if ((x[1] - x[0]) * (y[2] - y[0]) == (x[2] - x[0]) * (y[1] - y[0])) continue;  // too small to see
    char text[96];
    std::snprintf(text, sizeof text, "M%d %dl%d %d %d %dz", x[0], y[0], x[1] - x[0], y[1] - y[0], x[2] - x[1],
                  y[2] - y[1]);
    path += text;
  }
  return path;
}

int step_of(double share, int steps) { return std::clamp(static_cast<int>(share * steps), 0, steps - 1); }

std::string surface_of(const Panel& panel) {
  const auto depth = [](const Patch& p) { return p.corners[0][2] + p.corners[1][2] + p.corners[2][2]; };
  double low = 1e300, high = -1e300;
  for (const Patch& patch : panel.patches)
    low = std::min(low, depth(patch)), high = std::max(high, depth(patch));
  std::map<std::array<int, 2>, std::vector<const Patch*>> layers;  // by slab, then shade
  for (const Patch& patch : panel.patches) {
    const int slab = static_cast<int>((depth(patch) - low) / (high - low + 1e-9) * slab_count);
    layers[{slab, step_of(patch.shade, shade_count)}].push_back(&patch);
  }
  std::string svg;
  for (const auto& [key, patches] : layers) {
    const std::string path = path_of(patches);
    if (!path.empty()) svg += "<path class=\"s" + std::to_string(key[1]) + "\" d=\"" + path + "\"/>\n";
  }
  return svg;
}

std::string bones_of(const Figure& figure, const Panel& panel) {
  std::string svg;
  for (const auto& [a, b] : figure.bones) {
    const auto &from = panel.marks[a], &to = panel.marks[b];
    svg += "<path fill=\"none\" stroke=\"#222\" style=\"stroke-width:28\" d=\"M" +
           std::to_string(rounded(from[0])) + " " + std::to_string(rounded(from[1])) + "L" +
           std::to_string(rounded(to[0])) + " " + std::to_string(rounded(to[1])) + "\"/>\n";
  }
  return svg;
}

std::string balls_of(const Figure& figure, const Panel& panel, std::map<std::string, int>& colours) {
  std::vector<size_t> order(figure.marks.size());
  for (size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
    colours.try_emplace(figure.marks[i].name, static_cast<int>(colours.size()));
  }
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return panel.marks[a][2] < panel.marks[b][2]; });
  std::string svg;
  for (const size_t i : order) {
    const Mark& mark = figure.marks[i];
    const bool hidden = !mark.inside && is_hidden(panel, i);
    const std::string paint = hue(colours.at(mark.name));
    const std::string place = "cx=\"" + std::to_string(rounded(panel.marks[i][0])) + "\" cy=\"" +
                              std::to_string(rounded(panel.marks[i][1])) + "\"";
    svg += std::string("<g") + (hidden ? " opacity=\".3\"" : "") + "><title>" + escaped(mark.name) +
           "</title><circle " + place + " r=\"" + std::to_string(rounded(ball_radius)) + "\" fill=\"" +
           (mark.uncertain ? "none" : paint) + "\" stroke=\"" + (mark.uncertain ? paint : "#222") + "\"/>";
    if (!mark.uncertain) svg += "<circle " + place + " r=\"46\" fill=\"url(#shine)\"/>";
    svg += "</g>\n";
  }
  return svg;
}

// Styles are of this picture alone, as a page may hold other ones.
std::string head_of(int width, int height) {
  const std::string size = std::to_string(width) + " " + std::to_string(height);
  std::string svg = "<svg class=\"figure\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size +
                    "\" width=\"" + std::to_string(width / 10) + "\" height=\"" +
                    std::to_string(height / 10) + "\">\n<style>\n" +
                    ".figure text{font:150px sans-serif;fill:#444;text-anchor:middle}\n" +
                    ".figure path{stroke-width:6;stroke-linejoin:round}.figure circle{stroke-width:9}\n";
  for (int shade = 0; shade < shade_count; ++shade) {
    const std::string paint = clay(shade);
    svg += ".s" + std::to_string(shade) + "{fill:" + paint + ";stroke:" + paint + "}\n";
  }
  return svg +
         "</style>\n<radialGradient id=\"shine\" cx=\".35\" cy=\".3\" r=\".75\"><stop stop-color=\"#fff\" " +
         "stop-opacity=\".75\"/><stop offset=\".6\" stop-color=\"#fff\" stop-opacity=\"0\"/><stop "
         "offset=\"1\" " +
         "stop-opacity=\".35\"/></radialGradient>\n<rect width=\"" + std::to_string(width) + "\" height=\"" +
         std::to_string(height) + "\" rx=\"120\" fill=\"#f7f5f1\"/>\n";
}

}  // namespace

std::string draw(const std::vector<Figure>& figures, size_t columns) {
  if (columns == 0) columns = std::max<size_t>(1, figures.size());
  std::map<std::string, int> colours;
  const int rows = static_cast<int>((figures.size() + columns - 1) / columns);
  std::string svg = head_of(panel_width * static_cast<int>(columns), (panel_height + caption_height) * rows);
  for (size_t i = 0; i < figures.size(); ++i) {
    const Panel panel = fit_into_panel(figures[i], panel_width - 2 * margin, panel_height - 2 * margin);
    const int x = panel_width * static_cast<int>(i % columns);
    const int y = (panel_height + caption_height) * static_cast<int>(i / columns);
    svg += "<g transform=\"translate(" + std::to_string(x + margin) + " " + std::to_string(y + margin) +
           ")\">\n" + surface_of(panel) + bones_of(figures[i], panel) + balls_of(figures[i], panel, colours) +
           "<text x=\"" + std::to_string(panel_width / 2 - margin) + "\" y=\"" +
           std::to_string(panel_height - margin + caption_height / 4) + "\"" +
           (figures[i].caption.size() > long_caption ? " style=\"font-size:112px\"" : "") + ">" +
           escaped(figures[i].caption) + "</text>\n</g>\n";
  }
  return svg + "</svg>\n";
}

}  // namespace picture
