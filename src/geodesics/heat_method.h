// Geodesic distance by the heat method: K. Crane, C. Weischedel, M. Wardetzky, "Geodesics in Heat", 2013.
#pragma once
#include "geodesics/distance.h"

namespace focal {

// t = mean edge length squared, raised on meshes so large that heat would underflow at the farthest point.
struct HeatTime {
  double t, distance_bound;  // see Distance
  bool raised;
  // A sentence if it was raised, else null.
  const char* warning() const {
    return raised ? "the mesh is so fine that the time step of the heat method was raised" : nullptr;
  }
};
HeatTime heat_time(const TriangleMesh& mesh, const Operators& operators);

// Two factorisations, computed once.
class HeatMethod final : public Distance {
 public:
  HeatMethod() = default;
  // bridges: those of the operators; points beyond one are farther by the length of its gap. execution is
  // checked for cancellation between the factorisations. keep_negative_heat: obtuse triangles can make
  // distant heat slightly negative; its gradient is used like any other (the published method) or not at all,
  // which is more accurate (lion set, 18 % of such weights: 10 instead of 16 % of the diameter off the exact
  // distance).
  HeatMethod(const TriangleMesh& mesh, const Operators& operators, const Execution& execution = {},
             bool keep_negative_heat = false, std::span<const std::pair<int32_t, int32_t>> bridges = {});

  double time() const { return time_.t; }
  const char* warning() const override { return time_.warning(); }
  std::shared_ptr<const SymbolicFactor> symbolic() const override { return heat_.symbolic(); }
  void solve_block(std::span<const Source> sources, float* out, const Execution& execution) const override;

 private:
  void sort_faces(const Operators& operators);
  void add_bridges(const double* heat, float* rhs) const;

  struct Bridge {
    int32_t from, to;  // permuted numbers
    float length;
  };

  HeatTime time_{};
  bool keep_negative_heat_ = false;
  SparseCholesky heat_, poisson_;
  MatrixX3i faces_;  // sorted, with permuted corners, for memory locality
  std::vector<Bridge> bridges_;
  RowMatrixf face_coefficient_;  // per face: half cotangents of its corners, area
};

}  // namespace focal
