#include "mesh/wrap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "mesh/solid_grid.h"

namespace focal {
namespace {

// Corner k of a cube of cells is at (k & 1, k >> 1 & 1, k >> 2).
constexpr std::array<std::array<int, 2>, 12> cube_edges = {{{0, 1},
                                                            {2, 3},
                                                            {4, 5},
                                                            {6, 7},  // along x
                                                            {0, 2},
                                                            {1, 3},
                                                            {4, 6},
                                                            {5, 7},  // y
                                                            {0, 4},
                                                            {1, 5},
                                                            {2, 6},
                                                            {3, 7}}};  // z

// Vertices of the surface net, one per cube of cells that contains both kinds.
class SurfaceNet {
 public:
  SurfaceNet(const SolidGrid& grid, const Execution& execution) : grid_(grid), cubes_(grid.mixed_cubes()) {
    vertex_.assign(static_cast<size_t>(grid_.cell_count()), -1);
    for (size_t v = 0; v < cubes_.size(); ++v) vertex_[cubes_[v]] = static_cast<int32_t>(v);
    place_vertices();
    execution.check_cancelled();
    make_triangles();
    smooth();
  }
  TriangleMesh mesh() && { return std::move(mesh_); }

 private:
  void place_vertices() {
    mesh_.positions.resize(static_cast<Eigen::Index>(cubes_.size()), 3);
    exact_.assign(cubes_.size(), 1);
    for (size_t v = 0; v < cubes_.size(); ++v) {
      const int corners = grid_.corners(cubes_[v]);
      Vector3 sum = Vector3::Zero();
      int count = 0;
      for (int e = 0; e < 12; ++e) {
        const auto [a, b] = cube_edges[e];
        if (((corners >> a) & 1) == ((corners >> b) & 1)) continue;
        const int axis = e / 4;
        const auto crossing = grid_.crossing(cubes_[v] + grid_.offset(a), axis, ((corners >> a) & 1) != 0);
        Vector3 at(a & 1, (a >> 1) & 1, a >> 2);
        at[axis] += crossing.value_or(0.5);
        if (!crossing) exact_[v] = 0;
        sum += at, ++count;
      }
      mesh_.positions.row(static_cast<Eigen::Index>(v)) =
          (grid_.centre(cubes_[v]) + grid_.cell() * sum / count).transpose();
    }
  }

  // Every edge of the grid between the two kinds of cell is crossed by a quadrilateral of the four cubes
  // around it.
  void make_triangles() {
    std::vector<std::array<int32_t, 3>> triangles;
    triangles.reserve(2 * cubes_.size() + 16);
    const std::array<int64_t, 3> step = {grid_.offset(1), grid_.offset(2), grid_.offset(4)};
    for (const int64_t cube : cubes_)
      for (int axis = 0; axis < 3; ++axis) {
        const bool from = grid_.is_solid(cube), to = grid_.is_solid(cube + step[axis]);
        if (from == to) continue;
        const int64_t u = step[(axis + 1) % 3], v = step[(axis + 2) % 3];
        std::array<int32_t, 4> corner = {vertex_[cube], vertex_[cube - u], vertex_[cube - u - v],
                                         vertex_[cube - v]};
        if (!from) std::swap(corner[1], corner[3]);
        add_quadrilateral(corner, triangles);
      }
    mesh_.triangles.resize(static_cast<Eigen::Index>(triangles.size()), 3);
    for (size_t t = 0; t < triangles.size(); ++t)
      for (int c = 0; c < 3; ++c) mesh_.triangles(static_cast<Eigen::Index>(t), c) = triangles[t][c];
  }

  void add_quadrilateral(const std::array<int32_t, 4>& q,
                         std::vector<std::array<int32_t, 3>>& triangles) const {
    const auto length = [&](int a, int b) {
      return (mesh_.positions.row(q[a]) - mesh_.positions.row(q[b])).squaredNorm();
    };
    const int first = length(0, 2) <= length(1, 3) ? 0 : 1;
    triangles.push_back({q[first], q[first + 1], q[(first + 2) % 4]});
    triangles.push_back({q[first], q[(first + 2) % 4], q[(first + 3) % 4]});
  }

  // Smooths the stairs where no triangle of the input gives the position of the surface: ends of open parts,
  // bridges, rims of sheets.
  void smooth() {
    constexpr int rounds = 3;
    std::vector<int32_t> rough;
    for (size_t v = 0; v < exact_.size(); ++v)
      if (!exact_[v]) rough.push_back(static_cast<int32_t>(v));
    if (rough.empty()) return;
    MatrixX3 sum(mesh_.positions.rows(), 3);
    Vector count(mesh_.positions.rows());
    for (int round = 0; round < rounds; ++round) {
      sum.setZero(), count.setZero();
      for (int32_t t = 0; t < mesh_.triangle_count(); ++t)
        for (int c = 0; c < 3; ++c) {
          const int32_t a = mesh_.triangles(t, c), b = mesh_.triangles(t, (c + 1) % 3);
          if (!exact_[a]) sum.row(a) += mesh_.positions.row(b), count[a] += 1;
        }
      for (const int32_t v : rough)
        mesh_.positions.row(v) = (mesh_.positions.row(v) + sum.row(v) / count[v]) / 2;
    }
  }

  const SolidGrid& grid_;
  TriangleMesh mesh_;
  std::vector<int64_t> cubes_;   // per vertex
  std::vector<int32_t> vertex_;  // per cell: of the cube whose lowest cell it is, or -1
  std::vector<char> exact_;      // per vertex: positioned by triangles of the input
};

}  // namespace

WrappedMesh wrap(const TriangleMesh& mesh, const WrapParams& params, const Execution& execution) {
  const double longest =
      (mesh.positions.colwise().maxCoeff() - mesh.positions.colwise().minCoeff()).maxCoeff();
  SolidGrid grid(mesh, std::max(longest / params.cells, std::sqrt(surface_area(mesh) / params.area_cells)),
                 execution);
  WrappedMesh result;
  result.cell = grid.cell();
  grid.make_manifold();
  execution.check_cancelled();
  grid.join_parts(result.bridged, result.left_out);
  grid.make_manifold();
  grid.fill_cavities();
  execution.check_cancelled();
  result.mesh = SurfaceNet(grid, execution).mesh();
  return result;
}

}  // namespace focal
