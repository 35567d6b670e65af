// The stock pipeline: what a good engineer assembles from packages in a few days. Spectra for the eigenpairs, one
// Eigen solve a source for the distances, plain loops for the votes; all in double. What is no question of speed
// (signatures, forest, peaks, constellation) is focal's own, so that both sides do the same job.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "mesh/prepare.h"
#include "model/landmark_model.h"
#include "operators/operators.h"
#include "spectrum/eigenbasis.h"
#include "vote/vote.h"

namespace focal_bench {

// Spectra's shift-invert Lanczos on M^-1/2 L M^-1/2, Krylov space of 300 for 200 pairs, tolerance 1e-6.
focal::Eigenbasis stock_eigenpairs(const focal::Operators& operators, int32_t count);

// The heat method as published: factors made once, then two solves a source, sources shared out over threads.
class StockHeat {
 public:
  StockHeat(const focal::TriangleMesh& mesh, const focal::Operators& operators);
  ~StockHeat();
  // sources x vertices.
  focal::RowMatrix distances(std::span<const int32_t> sources, int threads) const;

 private:
  struct Parts;
  void distance(int32_t source, focal::Vector& heat, focal::Vector& right_side, double* out) const;
  std::unique_ptr<Parts> parts_;
};

// Every sample asks its table at every vertex for every landmark. distances: samples x vertices.
focal::RowMatrixf stock_votes(const focal::VoteTables& tables, const focal::RowMatrix& distances,
                              int threads);

struct StockDetection {
  std::vector<int32_t> vertex;                                 // of the surface, one a landmark; -1: none
  double eigenpairs = 0, distances = 0, votes = 0, total = 0;  // seconds
};
StockDetection stock_detect(const focal::LandmarkModel& model, focal::TriangleMesh mesh, int threads);

}  // namespace focal_bench
