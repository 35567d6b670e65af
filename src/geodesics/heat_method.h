// Geodesic distance by the heat method: K. Crane, C. Weischedel, M. Wardetzky, "Geodesics in Heat", 2013.
#pragma once
#include "geodesics/distance.h"

namespace focal {

// Two factors, made once.
class HeatMethod final : public Distance {
 public:
  HeatMethod() = default;
  // t = time_factor * mean edge length squared, raised on meshes so large that heat would underflow at the far end.
  // execution is asked for cancellation between the factors. keep_negative_heat: obtuse triangles can make far heat
  // slightly negative; its gradient counts like any other (the method to the letter) or not at all, which measured
  // better (lion set, 18 % of such weights: 10 instead of 16 % of the diameter off the exact distance).
  HeatMethod(const TriangleMesh& mesh, const Operators& operators, const Execution& execution = {},
             double time_factor = 1, bool keep_negative_heat = false);

  double time() const { return time_; }
  bool time_was_raised() const { return time_was_raised_; }
  const char* warning() const override;
  std::shared_ptr<const SymbolicFactor> symbolic() const override { return heat_.symbolic(); }

 private:
  void choose_time(const TriangleMesh& mesh, const Operators& operators, double time_factor);
  void sort_faces(const Operators& operators);
  void solve_block(std::span<const Source> sources, float* out, const Execution& execution) const override;

  double time_ = 0;
  bool time_was_raised_ = false, keep_negative_heat_ = false;
  SparseCholesky heat_, poisson_;
  MatrixX3i faces_;              // sorted, with permuted corners, for memory locality
  RowMatrixf face_coefficient_;  // per face: half cotangents of its corners, area
};

}  // namespace focal
