// Geodesic distance by the heat method: K. Crane, C. Weischedel, M. Wardetzky, "Geodesics in Heat", 2013.
#pragma once
#include <functional>
#include <span>

#include "base/parallel.h"
#include "linear/sparse_cholesky.h"
#include "mesh/triangle_mesh.h"
#include "operators/operators.h"

namespace focal {

// Two factors made once, then distances from any number of sources, 32 at a time. Immutable once made: thread-safe.
class HeatMethod {
 public:
  static constexpr int lanes = SparseCholesky::lanes;

  HeatMethod() = default;
  // t = time_factor * mean edge length squared, raised on meshes so large that heat would underflow at the far end.
  // execution is asked for cancellation between the factors. keep_negative_heat: obtuse triangles can make far heat
  // slightly negative; its gradient counts like any other (the method to the letter) or not at all, which measured
  // better (lion set, 18 % of such weights: 10 instead of 16 % of the diameter off the exact distance).
  HeatMethod(const TriangleMesh& mesh, const Operators& operators, const Execution& execution = {},
             double time_factor = 1, bool keep_negative_heat = false);

  // Called once a block of up to 32 sources, from several threads at once: distances[v * lanes + j] is the distance, in
  // the mesh's units and >= 0, of vertex v from source first + j, for j < count.
  using BlockSink = std::function<void(int64_t first, int32_t count, const float* distances)>;
  void for_each_block(std::span<const SurfacePoint> sources, const Execution& execution,
                      const BlockSink& sink) const;
  void for_each_block(std::span<const int32_t> source_vertices, const Execution& execution,
                      const BlockSink& sink) const;

  // sources x vertices.
  RowMatrixf distances(std::span<const SurfacePoint> sources, const Execution& execution) const;
  RowMatrixf distances(std::span<const int32_t> source_vertices, const Execution& execution) const;

  double time() const { return time_; }
  bool time_was_raised() const { return time_was_raised_; }
  // No two vertices are farther apart.
  double distance_bound() const { return distance_bound_; }
  int32_t vertex_count() const { return heat_.size(); }
  // The analysis of L's pattern, for other factors of the same surface.
  std::shared_ptr<const SymbolicFactor> symbolic() const { return heat_.symbolic(); }

 private:
  struct Source {
    int32_t vertex[3];
    double weight[3];
    float corner_distance = 0;  // weighted mean of the corners' distances from the source
  };
  void choose_time(const TriangleMesh& mesh, const Operators& operators, double time_factor);
  void sort_faces(const TriangleMesh& mesh, const Operators& operators);
  void solve_block(std::span<const Source> sources, double* heat, float* distance, float* out) const;
  void run(std::span<const Source> sources, const Execution& execution, const BlockSink& sink) const;

  double time_ = 0, distance_bound_ = 0;
  bool time_was_raised_ = false, keep_negative_heat_ = false;
  SparseCholesky heat_, poisson_;
  MatrixX3 positions_;
  MatrixX3i triangles_, faces_;  // as given; and sorted, with permuted corners, for memory locality
  RowMatrixf face_coefficient_;  // per face: half cotangents of its corners, area
};

}  // namespace focal
