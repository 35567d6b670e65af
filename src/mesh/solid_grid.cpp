#include "mesh/solid_grid.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "mesh/nearest_vertex.h"

namespace focal {
namespace {

constexpr int32_t rim = 3;        // empty cells around the mesh
constexpr uint8_t min_votes = 4;  // of six rays

// Whether p is left of the line from a to b; computed identically for both triangles at an edge, so that no
// ray passes between them or hits both.
bool is_left(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  const bool swapped = b.x() < a.x() || (b.x() == a.x() && b.y() < a.y());
  const Eigen::Vector2d& low = swapped ? b : a;
  const Eigen::Vector2d& high = swapped ? a : b;
  const bool left = (high.x() - low.x()) * (p.y() - low.y()) - (high.y() - low.y()) * (p.x() - low.x()) >= 0;
  return left != swapped;
}

// Calls visit(column, row) for the points of the integer grid within a triangle of the plane, of either
// orientation.
template <class Visit>
void visit_within(const std::array<Eigen::Vector2d, 3>& t, const Visit& visit) {
  const double area = (t[1] - t[0]).x() * (t[2] - t[0]).y() - (t[1] - t[0]).y() * (t[2] - t[0]).x();
  if (area == 0) return;
  const auto low = t[0].cwiseMin(t[1]).cwiseMin(t[2]).eval(),
             high = t[0].cwiseMax(t[1]).cwiseMax(t[2]).eval();
  for (auto row = static_cast<int32_t>(std::ceil(low.y())); row <= high.y(); ++row)
    for (auto column = static_cast<int32_t>(std::ceil(low.x())); column <= high.x(); ++column) {
      const Eigen::Vector2d p(column, row);
      const bool side = is_left(t[0], t[1], p);
      if (is_left(t[1], t[2], p) == side && is_left(t[2], t[0], p) == side && side == (area > 0))
        visit(column, row);
    }
}

}  // namespace

SolidGrid::SolidGrid(const TriangleMesh& mesh, double cell, const Execution& execution) : cell_(cell) {
  choose_grid(mesh);
  std::array<std::vector<uint8_t>, 3> votes;
  parallel_for(execution, 3, [&](int64_t axis) {
    lines_[axis] = cast_lines(mesh, static_cast<int>(axis));
    vote(static_cast<int>(axis), votes[axis]);
  });
  for (int64_t i = 0; i < cell_count(); ++i) solid_[i] = votes[0][i] + votes[1][i] + votes[2][i] >= min_votes;
  execution.check_cancelled();
  fill_enclosed();
  execution.check_cancelled();
  add_sheets(mesh);
}

void SolidGrid::choose_grid(const TriangleMesh& mesh) {
  constexpr double max_cells = 6e6;
  const Vector3 low = mesh.positions.colwise().minCoeff(),
                extent = mesh.positions.colwise().maxCoeff() - low.transpose();
  double count = 0;
  for (;; cell_ *= 1.02) {
    count = 1;
    for (int a = 0; a < 3; ++a) {
      // The longest side often has a whole number of cells: rounding must not add a cell, which would move
      // the lattice by half a cell.
      size_[a] = static_cast<int32_t>(std::ceil(extent[a] / cell_ - 0.01)) + 2 * rim + 1;
      count *= size_[a];
    }
    if (count <= max_cells) break;
  }
  step_ = {1, size_[0], static_cast<int64_t>(size_[0]) * size_[1]};
  // The lattice avoids the planes on which modellers place vertices and edges.
  const Vector3 slack = cell_ * Vector3(size_[0] - 1, size_[1] - 1, size_[2] - 1) - extent;
  origin_ = low - slack / 2 + cell_ * Vector3(0.0137, 0.0171, 0.0193);
  solid_.assign(static_cast<size_t>(step_[2]) * size_[2], 0);
}

std::array<int32_t, 3> SolidGrid::place(int64_t i) const {
  return {static_cast<int32_t>(i % size_[0]), static_cast<int32_t>(i / step_[1] % size_[1]),
          static_cast<int32_t>(i / step_[2])};
}

Vector3 SolidGrid::centre(int64_t i) const {
  const auto [x, y, z] = place(i);
  return origin_ + cell_ * Vector3(x, y, z);
}

int64_t SolidGrid::line_of(int64_t i, int axis) const {
  const auto at = place(i);
  return at[(axis + 1) % 3] + static_cast<int64_t>(size_[(axis + 1) % 3]) * at[(axis + 2) % 3];
}

SolidGrid::Lines SolidGrid::cast_lines(const TriangleMesh& mesh, int axis) const {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  struct Met {
    int64_t line;
    Crossing crossing;
  };
  std::vector<Met> met;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    std::array<Vector3, 3> corner;
    std::array<Eigen::Vector2d, 3> flat;
    for (int c = 0; c < 3; ++c) {
      corner[c] = (mesh.positions.row(mesh.triangles(t, c)).transpose() - origin_) / cell_;
      flat[c] = {corner[c][u], corner[c][v]};
    }
    const Vector3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    visit_within(flat, [&](int32_t column, int32_t row) {
      const double at = corner[0][axis] -
                        (normal[u] * (column - flat[0].x()) + normal[v] * (row - flat[0].y())) / normal[axis];
      const double low = std::min({corner[0][axis], corner[1][axis], corner[2][axis]}),
                   high = std::max({corner[0][axis], corner[1][axis], corner[2][axis]});
      met.push_back(
          {column + static_cast<int64_t>(size_[u]) * row,
           {static_cast<float>(std::clamp(at, low, high)), static_cast<int8_t>(normal[axis] > 0 ? 1 : -1)}});
    });
  }
  Lines lines;
  lines.start.assign(static_cast<size_t>(size_[u]) * size_[v] + 1, 0);
  for (const Met& one : met) ++lines.start[one.line + 1];
  std::partial_sum(lines.start.begin(), lines.start.end(), lines.start.begin());
  lines.crossings.resize(met.size());
  std::vector<int32_t> next(lines.start.begin(), lines.start.end() - 1);
  for (const Met& one : met) lines.crossings[next[one.line]++] = one.crossing;
  for (size_t l = 0; l + 1 < lines.start.size(); ++l)
    std::sort(lines.crossings.begin() + lines.start[l], lines.crossings.begin() + lines.start[l + 1],
              [](const Crossing& a, const Crossing& b) {
                return a.at < b.at || (a.at == b.at && a.exits < b.exits);
              });
  return lines;
}

// Two rays per cell along the axis: each votes by whether it leaves more often than it enters.
void SolidGrid::vote(int axis, std::vector<uint8_t>& votes) const {
  votes.assign(solid_.size(), 0);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const Lines& lines = lines_[axis];
  for (int32_t row = 0; row < size_[v]; ++row)
    for (int32_t column = 0; column < size_[u]; ++column) {
      const int64_t l = column + static_cast<int64_t>(size_[u]) * row;
      const int32_t begin = lines.start[l], end = lines.start[l + 1];
      if (begin == end) continue;
      int32_t ahead = 0, behind = 0;
      for (int32_t k = begin; k < end; ++k) ahead += lines.crossings[k].exits;
      int64_t i = column * step_[u] + row * step_[v];
      int32_t k = begin;
      for (int32_t at = 0; at < size_[axis]; ++at, i += step_[axis]) {
        for (; k < end && lines.crossings[k].at <= static_cast<float>(at); ++k)
          ahead -= lines.crossings[k].exits, behind -= lines.crossings[k].exits;
        votes[i] = static_cast<uint8_t>((ahead != 0) + (behind != 0));
      }
    }
}

// Cells that no path reaches from outside without crossing a triangle.
void SolidGrid::fill_enclosed() {
  std::vector<uint8_t> blocked(solid_.size(), 0);  // bit a: between a cell and the next along axis a
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int32_t row = 0; row < size_[v]; ++row)
      for (int32_t column = 0; column < size_[u]; ++column) {
        const int64_t l = column + static_cast<int64_t>(size_[u]) * row;
        const int64_t first = column * step_[u] + row * step_[v];
        for (int32_t k = lines_[axis].start[l]; k < lines_[axis].start[l + 1]; ++k)
          blocked[first + static_cast<int64_t>(std::floor(lines_[axis].crossings[k].at)) * step_[axis]] |=
              1 << axis;
      }
  }
  fill_unreached(blocked);
}

void SolidGrid::fill_cavities() { fill_unreached(std::vector<uint8_t>(solid_.size(), 0)); }

void SolidGrid::fill_unreached(const std::vector<uint8_t>& blocked) {
  std::vector<uint8_t> reached(solid_);
  std::vector<int64_t> open;
  const auto visit = [&](int64_t i) {
    if (reached[i]) return;
    reached[i] = 1;
    open.push_back(i);
  };
  // The outermost layer represents the outside: paths start in the next layer and never enter it.
  for (int32_t z = 0; z < size_[2]; ++z)
    for (int32_t y = 0; y < size_[1]; ++y) {
      const bool at_rim = z == 0 || z + 1 == size_[2] || y == 0 || y + 1 == size_[1];
      const int64_t row = index(0, y, z);
      if (at_rim)
        std::fill_n(reached.begin() + row, size_[0], uint8_t{1});
      else
        reached[row] = reached[row + size_[0] - 1] = 1;
    }
  visit(index(1, 1, 1));
  while (!open.empty()) {
    const int64_t i = open.back();
    open.pop_back();
    for (int axis = 0; axis < 3; ++axis) {
      if (!(blocked[i] & (1 << axis))) visit(i + step_[axis]);
      if (!(blocked[i - step_[axis]] & (1 << axis))) visit(i - step_[axis]);
    }
  }
  for (size_t i = 0; i < solid_.size(); ++i) solid_[i] |= !reached[i];
}

// Triangles without a solid on either side: marks the cells that they pass through.
void SolidGrid::add_sheets(const TriangleMesh& mesh) {
  constexpr double spacing = 0.6,
                   beside = 0.75;  // of samples, and of the position where a solid would be; in cells
  std::vector<int64_t> added;
  const auto cell_at = [&](const Vector3& p) {
    return index(static_cast<int32_t>(std::lround(p.x())), static_cast<int32_t>(std::lround(p.y())),
                 static_cast<int32_t>(std::lround(p.z())));
  };
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    std::array<Vector3, 3> corner;
    for (int c = 0; c < 3; ++c)
      corner[c] = (mesh.positions.row(mesh.triangles(t, c)).transpose() - origin_) / cell_;
    const Vector3 ab = corner[1] - corner[0], ac = corner[2] - corner[0];
    const Vector3 side = beside * ab.cross(ac).stableNormalized();
    const auto steps =
        static_cast<int32_t>(std::ceil(std::max({ab.norm(), ac.norm(), (ac - ab).norm()}) / spacing)) + 1;
    for (int32_t i = 0; i <= steps; ++i)
      for (int32_t j = 0; i + j <= steps; ++j) {
        const Vector3 p = corner[0] + (ab * i + ac * j) / steps;
        if (!solid_[cell_at(p)] && !solid_[cell_at(p + side)] && !solid_[cell_at(p - side)])
          added.push_back(cell_at(p));
      }
  }
  for (const int64_t i : added) solid_[i] = 1;
}

std::vector<int64_t> SolidGrid::mixed_cubes() const {
  std::vector<int64_t> result;
  std::vector<uint8_t> sum(size_[0]);
  for (int32_t z = 0; z + 1 < size_[2]; ++z)
    for (int32_t y = 0; y + 1 < size_[1]; ++y) {
      const int64_t row = index(0, y, z);
      const uint8_t *a = &solid_[row], *b = a + step_[1], *c = a + step_[2], *d = c + step_[1];
      for (int32_t x = 0; x < size_[0]; ++x) sum[x] = a[x] + b[x] + c[x] + d[x];
      for (int32_t x = 0; x + 1 < size_[0]; ++x)
        if (const int solid = sum[x] + sum[x + 1]; solid != 0 && solid != 8) result.push_back(row + x);
    }
  return result;
}

std::optional<double> SolidGrid::crossing(int64_t i, int axis, bool starts_solid) const {
  const Lines& lines = lines_[axis];
  const int64_t l = line_of(i, axis);
  const auto at = static_cast<float>(place(i)[axis]);
  std::optional<double> result;
  for (int32_t k = lines.start[l]; k < lines.start[l + 1]; ++k) {
    const float along = lines.crossings[k].at - at;
    if (along < 0 || along > 1) continue;
    if (!result || starts_solid) result = along;
  }
  return result;
}

// A component number for each cell, -1 for empty ones; cells that share a face are connected.
std::vector<int32_t> SolidGrid::label_parts(std::vector<int64_t>& sizes) const {
  std::vector<int32_t> part(solid_.size(), -1);
  std::vector<int64_t> open;
  for (int64_t first = 0; first < cell_count(); ++first) {
    if (!solid_[first] || part[first] >= 0) continue;
    const auto number = static_cast<int32_t>(sizes.size());
    sizes.push_back(0);
    part[first] = number;
    open = {first};
    while (!open.empty()) {
      const int64_t i = open.back();
      open.pop_back();
      ++sizes[number];
      for (int axis = 0; axis < 3; ++axis)
        for (const int64_t next : {i - step_[axis], i + step_[axis]})  // the rim is empty
          if (solid_[next] && part[next] < 0) part[next] = number, open.push_back(next);
    }
  }
  return part;
}

void SolidGrid::join_parts(int32_t& bridged, int32_t& left_out) {
  constexpr double far = 0.08, small = 0.02;  // relative to the longest side and to the largest part
  std::vector<int64_t> sizes;
  const std::vector<int32_t> part = label_parts(sizes);
  if (sizes.size() < 2) return;
  std::vector<std::vector<int64_t>> cells(sizes.size());  // of each part
  for (int64_t i = 0; i < cell_count(); ++i)
    if (part[i] >= 0) cells[part[i]].push_back(i);
  std::vector<int32_t> order(sizes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int32_t a, int32_t b) { return sizes[a] > sizes[b]; });
  const double most = far * std::max({size_[0], size_[1], size_[2]});
  std::vector<int64_t> rim;  // cells at the surface, part by part in that order
  std::vector<int32_t> start{0};
  for (const int32_t p : order) {
    std::copy_if(cells[p].begin(), cells[p].end(), std::back_inserter(rim),
                 [&](int64_t i) { return corners(i) != 255; });
    start.push_back(static_cast<int32_t>(rim.size()));
  }
  MatrixX3 places(static_cast<Eigen::Index>(rim.size()), 3);  // in cells
  for (size_t k = 0; k < rim.size(); ++k) {
    const auto at = place(rim[k]);
    places.row(static_cast<Eigen::Index>(k)) << at[0], at[1], at[2];
  }
  NearestOfGrowingSet joined(places);
  const auto join = [&](size_t o) {
    std::vector<int32_t> own(start[o + 1] - start[o]);
    std::iota(own.begin(), own.end(), start[o]);
    joined.add(std::move(own));
  };
  join(0);
  for (size_t o = 1; o < order.size(); ++o) {
    std::pair<int64_t, int64_t> link;
    double least = std::numeric_limits<double>::infinity();
    for (int32_t k = start[o]; k < start[o + 1]; ++k) {
      const auto [other, squared] = joined.nearest(places.row(k));
      if (squared < least) least = squared, link = {rim[k], rim[other]};
    }
    if (std::sqrt(least) > most &&
        static_cast<double>(sizes[order[o]]) < small * static_cast<double>(sizes[order[0]])) {
      ++left_out;
      for (const int64_t i : cells[order[o]]) solid_[i] = 0;
      continue;
    }
    ++bridged;
    const auto a = place(link.first), b = place(link.second);
    const int32_t steps = std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])}) * 2;
    const int32_t radius = std::sqrt(least) < 3 ? 0 : 1;
    for (int32_t s = 0; s <= steps; ++s) {
      std::array<int32_t, 3> at;
      for (int k = 0; k < 3; ++k)
        at[k] = static_cast<int32_t>(std::lround(a[k] + (b[k] - a[k]) * static_cast<double>(s) / steps));
      for (int32_t dz = -radius; dz <= radius; ++dz)
        for (int32_t dy = -radius; dy <= radius; ++dy)
          for (int32_t dx = -radius; dx <= radius; ++dx)
            solid_[index(at[0] + dx, at[1] + dy, at[2] + dz)] = 1;
    }
    join(o);
  }
}

namespace {

// For each pattern of a cube's solid corners, the corners to fill so that no two of one kind touch only at an
// edge or corner.
std::array<uint8_t, 256> fillings() {
  std::array<uint8_t, 256> result{};
  const auto has = [](int bits, int k) { return ((bits >> k) & 1) != 0; };
  for (int bits = 0; bits < 256; ++bits) {
    int fill = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {  // a face of four corners: diagonal pairs
        const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
        const bool a = has(bits, base), b = has(bits, base + u), c = has(bits, base + v),
                   d = has(bits, base + u + v);
        if (a && d && !b && !c) fill |= 1 << (base + u);
        if (b && c && !a && !d) fill |= 1 << base;
      }
    for (int k = 0; k < 4; ++k) {  // opposite corners alone, solid or empty
      const int pair = (1 << k) | (1 << (7 - k));
      if (bits == pair) fill |= 1 << (k ^ 1) | 1 << (k ^ 3);
      if (bits == 255 - pair) fill |= 1 << k;
    }
    result[bits] = static_cast<uint8_t>(fill);
  }
  return result;
}

}  // namespace

void SolidGrid::make_manifold() {
  static const std::array<uint8_t, 256> filling = fillings();
  std::vector<int64_t> open = mixed_cubes();
  while (!open.empty()) {  // the rim is three cells wide, and cells are filled beside solid ones only
    const int64_t cube = open.back();
    open.pop_back();
    const int fill = filling[corners(cube)];
    for (int k = 0; k < 8; ++k)
      if ((fill >> k) & 1) {
        solid_[cube + offset(k)] = 1;
        for (int other = 0; other < 8; ++other) {
          const int64_t touched = cube + offset(k) - offset(other);
          if (touched >= 0 && touched + offset(7) < cell_count()) open.push_back(touched);
        }
      }
  }
}

}  // namespace focal
