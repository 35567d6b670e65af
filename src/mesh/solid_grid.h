// The cells of a regular grid inside the solid that triangles enclose, and the intersections of the grid's
// edges with the triangles.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "mesh/triangle_mesh.h"

namespace focal {

class SolidGrid {
 public:
  // cell: edge length, increased where there would be too many cells. A few layers of cells at the rim are
  // empty.
  SolidGrid(const TriangleMesh& mesh, double cell, const Execution& execution);

  // Joins floating parts to the nearest other one and drops small ones far from everything else.
  void join_parts(int32_t& bridged, int32_t& left_out);
  // Fills cells until the surface between the two kinds of cell is a manifold, that is where cells of one
  // kind would touch only at an edge or corner.
  void make_manifold();
  void fill_cavities();  // cells that no path of empty ones reaches from outside

  const std::array<int32_t, 3>& size() const { return size_; }
  int64_t cell_count() const { return static_cast<int64_t>(solid_.size()); }
  double cell() const { return cell_; }
  int64_t index(int32_t x, int32_t y, int32_t z) const {
    return x + size_[0] * (y + static_cast<int64_t>(size_[1]) * z);
  }
  Vector3 centre(int64_t i) const;
  int64_t offset(int corner) const {
    return (corner & 1) + ((corner >> 1) & 1) * step_[1] + (corner >> 2) * step_[2];
  }
  bool is_solid(int64_t i) const { return solid_[i] != 0; }
  // One bit per corner of the cube whose lowest cell is i.
  int corners(int64_t i) const {
    int bits = 0;
    for (int k = 0; k < 8; ++k) bits |= (solid_[i + offset(k)] != 0) << k;
    return bits;
  }
  // The lowest cells of cubes of eight that contain both kinds, ascending.
  std::vector<int64_t> mixed_cubes() const;
  // Position 0..1 at which the edge from the centre of cell i to the next along the axis crosses a triangle;
  // of several the one nearest to the empty end. Empty: no crossing.
  std::optional<double> crossing(int64_t i, int axis, bool starts_solid) const;

 private:
  // Intersections of lines through the cells' centres along one axis with triangles, sorted along each line.
  struct Crossing {
    float at;      // in cells, from the centre of the first
    int8_t exits;  // 1: the triangle faces along the axis, -1: against it
  };
  struct Lines {
    std::vector<int32_t> start;  // per line, and one past the last
    std::vector<Crossing> crossings;
  };
  int64_t line_of(int64_t i, int axis) const;
  std::array<int32_t, 3> place(int64_t i) const;
  void choose_grid(const TriangleMesh& mesh);
  void fill_unreached(const std::vector<uint8_t>& blocked);
  Lines cast_lines(const TriangleMesh& mesh, int axis) const;
  void vote(int axis, std::vector<uint8_t>& votes) const;
  void fill_enclosed();
  void add_sheets(const TriangleMesh& mesh);
  std::vector<int32_t> label_parts(std::vector<int64_t>& sizes) const;

  std::array<int32_t, 3> size_{};
  std::array<int64_t, 3> step_{};
  double cell_ = 0;
  Vector3 origin_ = Vector3::Zero();  // centre of the first cell
  std::array<Lines, 3> lines_;
  std::vector<uint8_t> solid_;
};

}  // namespace focal
