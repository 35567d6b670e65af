#include "surface.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace picture {
namespace {

constexpr double nearby = 90;  // depth that two things may differ by and still touch

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Point unit(const Point& a) {
  const double length = std::sqrt(dot(a, a));
  return length > 0 ? Point{a[0] / length, a[1] / length, a[2] / length} : a;
}

Point turned(const Point& p, const Figure& figure) {
  const double a = figure.yaw * std::numbers::pi / 180, b = figure.pitch * std::numbers::pi / 180;
  const double x = std::cos(a) * p[0] + std::sin(a) * p[2], z = -std::sin(a) * p[0] + std::cos(a) * p[2];
  return {x, std::cos(b) * p[1] - std::sin(b) * z, std::sin(b) * p[1] + std::cos(b) * z};
}

// Shades come from the full mesh, so that the few triangles drawn still look round.
std::vector<Point> vertex_normals(const Figure& figure) {
  std::vector<Point> normals(figure.positions.size(), Point{});
  for (const auto& t : figure.triangles) {
    const Point& a = figure.positions[t[0]];
    const Point normal = cross(minus(figure.positions[t[1]], a), minus(figure.positions[t[2]], a));
    for (const uint32_t v : t)
      for (int k = 0; k < 3; ++k) normals[v][k] += normal[k];
  }
  for (Point& normal : normals) normal = unit(normal);
  return normals;
}

std::vector<std::array<uint32_t, 3>> simplified(const Figure& figure) {
  if (figure.triangles.size() <= figure.triangles_drawn) return figure.triangles;
  std::vector<float> positions;
  for (const Point& p : figure.positions)
    for (const double x : p) positions.push_back(static_cast<float>(x));
  std::vector<uint32_t> indices;
  for (const auto& t : figure.triangles) indices.insert(indices.end(), t.begin(), t.end());
  std::vector<uint32_t> kept(indices.size());
  const size_t count =
      meshopt_simplify(kept.data(), indices.data(), indices.size(), positions.data(), figure.positions.size(),
                       3 * sizeof(float), 3 * figure.triangles_drawn, 0.05f, 0, nullptr);
  std::vector<std::array<uint32_t, 3>> triangles;
  for (size_t i = 0; i + 2 < count; i += 3) triangles.push_back({kept[i], kept[i + 1], kept[i + 2]});
  return triangles;
}

double shade_of(const Point& normal) {
  static const Point key = unit({-0.45, 0.6, 0.65}), fill = unit({0.8, 0.1, 0.4});
  return 0.12 + 0.8 * std::max(0.0, dot(normal, key)) + 0.15 * std::max(0.0, dot(normal, fill));
}

}  // namespace

Panel fit_into_panel(const Figure& figure, double width, double height) {
  std::vector<Point> turned_positions;
  Point low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (const Point& p : figure.positions) {
    turned_positions.push_back(turned(p, figure));
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], turned_positions.back()[k]);
      high[k] = std::max(high[k], turned_positions.back()[k]);
    }
  }
  const double scale = std::min(width / (high[0] - low[0]), height / (high[1] - low[1]));
  const auto placed = [&](const Point& p) {
    return Point{width / 2 + scale * (p[0] - (low[0] + high[0]) / 2),
                 height / 2 - scale * (p[1] - (low[1] + high[1]) / 2), scale * (p[2] - low[2])};
  };
  Panel panel;
  const std::vector<Point> normals = vertex_normals(figure);
  for (const auto& t : simplified(figure)) {
    const std::array<Point, 3> corners = {placed(turned_positions[t[0]]), placed(turned_positions[t[1]]),
                                          placed(turned_positions[t[2]])};
    // y points down here, so a triangle that faces the viewer turns clockwise.
    if (cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]))[2] >= 0) continue;
    Point normal{};
    for (const uint32_t v : t)
      for (int k = 0; k < 3; ++k) normal[k] += normals[v][k];
    panel.patches.push_back({corners, shade_of(unit(turned(normal, figure)))});
  }
  for (const Mark& mark : figure.marks) panel.marks.push_back(placed(turned(mark.position, figure)));
  return panel;
}

bool is_hidden(const Panel& panel, size_t mark) {
  const Point& point = panel.marks[mark];
  return std::any_of(panel.patches.begin(), panel.patches.end(), [&](const Patch& patch) {
    const auto& c = patch.corners;
    std::array<double, 3> weights;  // twice the areas opposite each corner, all of one sign inside
    for (int k = 0; k < 3; ++k) {
      const Point &a = c[(k + 1) % 3], &b = c[(k + 2) % 3];
      weights[k] = (a[0] - point[0]) * (b[1] - point[1]) - (a[1] - point[1]) * (b[0] - point[0]);
    }
    if (std::max({weights[0], weights[1], weights[2]}) > 0) return false;
    const double sum = weights[0] + weights[1] + weights[2];
    if (sum == 0) return false;
    const double depth = (weights[0] * c[0][2] + weights[1] * c[1][2] + weights[2] * c[2][2]) / sum;
    return depth > point[2] + nearby;
  });
}

double best_yaw(const Figure& figure) {
  Figure turning = figure;
  double best = 0;
  size_t most = 0;
  for (const double yaw : {25., -25., 0., 40., -40., 55., -55., 70., -70.}) {
    turning.yaw = yaw;
    const Panel panel = fit_into_panel(turning, 2000, 2700);
    size_t shown = 0;
    for (size_t i = 0; i < panel.marks.size(); ++i) shown += !is_hidden(panel, i);
    if (shown > most) most = shown, best = yaw;
  }
  return best;
}

}  // namespace picture
