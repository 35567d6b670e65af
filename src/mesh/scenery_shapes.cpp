#include "mesh/scenery_shapes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace focal {
namespace {

using Point = Eigen::Vector2d;

double cross(const Point& a, const Point& b, const Point& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

Vector3 corner(const TriangleMesh& mesh, int32_t triangle, int i) {
  return mesh.positions.row(mesh.triangles(triangle, i));
}

// Twice the area, along the normal.
Vector3 area_vector(const TriangleMesh& mesh, int32_t triangle) {
  const Vector3 a = corner(mesh, triangle, 0);
  return (corner(mesh, triangle, 1) - a).cross(corner(mesh, triangle, 2) - a);
}

std::vector<int32_t> vertices_of(const TriangleMesh& mesh, std::span<const int32_t> triangles) {
  std::vector<int32_t> result;
  result.reserve(3 * triangles.size());
  for (const int32_t t : triangles)
    for (int i = 0; i < 3; ++i) result.push_back(mesh.triangles(t, i));
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

// The mean of the vertices, and their principal directions: smallest spread first.
void fit_plane(const TriangleMesh& mesh, std::span<const int32_t> vertices, FlatSheet& sheet) {
  sheet.centre.setZero();
  for (const int32_t v : vertices) sheet.centre += mesh.positions.row(v).transpose();
  sheet.centre /= static_cast<double>(vertices.size());
  double size = 0;
  for (const int32_t v : vertices)
    size = std::max(size, (mesh.positions.row(v).transpose() - sheet.centre).cwiseAbs().maxCoeff());
  if (!(size > 0)) return;
  Matrix3 spread = Matrix3::Zero();
  for (const int32_t v : vertices) {
    const Vector3 from = (mesh.positions.row(v).transpose() - sheet.centre) / size;  // keeps squares in range
    spread += from * from.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(spread);
  sheet.normal = solver.eigenvectors().col(0);
  sheet.u = solver.eigenvectors().col(1), sheet.v = sheet.normal.cross(sheet.u);
}

}  // namespace

double polygon_area(std::span<const Point> polygon) {
  double sum = 0;
  for (size_t i = 1; i + 1 < polygon.size(); ++i) sum += cross(polygon[0], polygon[i], polygon[i + 1]);
  return sum / 2;
}

std::vector<Point> convex_outline(std::vector<Point> points) {
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  if (points.size() < 3) return points;
  std::vector<Point> outline;
  const auto add_side = [&](auto begin, auto end) {
    const size_t first = outline.size();
    for (auto at = begin; at != end; ++at) {
      while (outline.size() >= first + 2 && cross(outline[outline.size() - 2], outline.back(), *at) <= 0)
        outline.pop_back();
      outline.push_back(*at);
    }
    outline.pop_back();  // the first point of the other side
  };
  add_side(points.begin(), points.end());
  add_side(points.rbegin(), points.rend());
  return outline;
}

Point on_sheet(const FlatSheet& sheet, const Vector3& point) {
  const Vector3 from = point - sheet.centre;
  return {sheet.u.dot(from), sheet.v.dot(from)};
}

std::optional<FlatSheet> flat_sheet(const TriangleMesh& mesh, std::span<const int32_t> triangles) {
  constexpr double flat = 0.02, filled = 0.9;
  FlatSheet sheet;
  const std::vector<int32_t> vertices = vertices_of(mesh, triangles);
  fit_plane(mesh, vertices, sheet);
  std::vector<Point> points;
  points.reserve(vertices.size());
  double above = 0, below = 0;
  for (const int32_t v : vertices) {
    const Vector3 at = mesh.positions.row(v);
    const double height = sheet.normal.dot(at - sheet.centre);
    above = std::max(above, height), below = std::min(below, height);
    points.push_back(on_sheet(sheet, at));
  }
  sheet.outline = convex_outline(std::move(points));
  sheet.outline_area = polygon_area(sheet.outline);
  Point low = Point::Zero(), high = Point::Zero();
  for (const Point& p : sheet.outline) low = low.cwiseMin(p), high = high.cwiseMax(p);
  double area = 0;
  for (const int32_t t : triangles) area += area_vector(mesh, t).norm() / 2;
  const bool is_flat = above - below <= flat * (high - low).minCoeff();
  if (!is_flat || !(sheet.outline_area > 0) || area < filled * sheet.outline_area) return std::nullopt;
  return sheet;
}

bool covers(const FlatSheet& sheet, const Vector3& point, double margin) {
  const Point at = on_sheet(sheet, point);
  for (size_t i = 0; i < sheet.outline.size(); ++i) {
    const Point &a = sheet.outline[i], &b = sheet.outline[(i + 1) % sheet.outline.size()];
    if (cross(a, b, at) < -margin * (b - a).norm()) return false;
  }
  return true;
}

bool ConvexBody::contains(const Vector3& point) const {
  if ((point.array() < box.low.array()).any() || (point.array() > box.high.array()).any()) return false;
  return std::all_of(sides.begin(), sides.end(),
                     [&](const HalfSpace& side) { return side.normal.dot(point) <= side.offset; });
}

ConvexBody convex_body(const TriangleMesh& mesh, std::span<const int32_t> triangles) {
  constexpr size_t max_triangles = 300, max_vertices = 5000;
  constexpr double slack = 0.01;  // of the diagonal
  ConvexBody body;
  const std::vector<int32_t> vertices = vertices_of(mesh, triangles);
  for (const int32_t v : vertices) body.box.add(Vector3(mesh.positions.row(v)));
  const double tolerance = slack * body.box.diagonal();
  const size_t every = 1 + triangles.size() / max_triangles, each = 1 + vertices.size() / max_vertices;
  double total = 0, supporting = 0;
  for (size_t i = 0; i < triangles.size(); i += every) {
    const Vector3 along = area_vector(mesh, triangles[i]);
    const double area = along.norm();
    if (!(area > 0)) continue;
    const Vector3 normal = along / area;
    const double own = normal.dot(corner(mesh, triangles[i], 0));
    double least = own, most = own;
    for (size_t v = 0; v < vertices.size(); v += each) {
      const double at = normal.dot(mesh.positions.row(vertices[v]));
      least = std::min(least, at), most = std::max(most, at);
    }
    total += area;
    if (most - own <= tolerance) {
      body.sides.push_back({normal, most}), supporting += area;
    } else if (own - least <= tolerance) {  // seen from inside, like the triangles of a dome
      body.sides.push_back({-normal, -least}), supporting += area;
    }
  }
  body.share = total > 0 ? supporting / total : 0;
  return body;
}

}  // namespace focal
