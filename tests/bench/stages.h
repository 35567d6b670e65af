// focal's stages one by one, on values made beforehand. With placing.cpp and stock.cpp the only place of the benchmarks
// that calls the stages' inner interfaces: when those change, this changes.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/aligned_array.h"
#include "geodesics/heat_method.h"
#include "landmarks/detect.h"
#include "placing.h"
#include "spectrum/eigenbasis.h"
#include "subject.h"
#include "vote/vote.h"

namespace focal_bench {

// Every value that some stage starts from, at full resolution, as the stock pipeline works.
struct Values {
  explicit Values(Subject of, std::shared_ptr<const focal::LandmarkModel> known = nullptr);

  Subject subject;
  std::shared_ptr<const focal::LandmarkModel> model;        // learned at full resolution, from 200 eigenpairs
  std::shared_ptr<const focal::LandmarkModel> quick_model;  // focal's default: on proxies
  std::shared_ptr<const focal::PreparedMesh> mesh;
  focal::Operators operators;
  focal::HeatMethod heat;
  focal::SparseCholesky factor;
  focal::Eigenbasis basis;
  std::vector<int32_t> samples;
  focal::RowMatrixf descriptors;
  focal::VoteTables tables;
  std::vector<uint16_t> blocks;  // the samples' distances, as the votes read them
  focal::RowMatrixf votes;
  Peaks peaks;
};

struct Stage {
  std::string name;
  std::function<void(const Values&, const focal::Execution&)> run;
  bool threaded = true;
};
std::vector<Stage> focal_stages();

// What detection is asked for, and of which of the two models.
struct Variant {
  std::string name;
  focal::DetectParams params;
  bool full_resolution = false;
};
std::vector<Variant> detect_variants();

// From a host's triangles to landmarks.
focal::Detection whole_detect(const std::shared_ptr<const focal::LandmarkModel>& model,
                              const focal::TriangleMesh& mesh, const focal::DetectParams& params,
                              int threads);

// A second model on a mesh that was analysed for the first.
focal::SurfaceAnalysis analysed(const Values& values, const focal::DetectParams& params, int threads);
focal::Detection second_detect(const Values& values, const focal::SurfaceAnalysis& analysis,
                               const focal::DetectParams& params, int threads);

// As focal's detection asks for them.
focal::Eigenbasis focal_eigenpairs(const focal::Operators& operators, int32_t count,
                                   const focal::Execution& execution);
// Distances of all sources, in blocks, and dropped, as the votes take them.
void focal_distances(const focal::HeatMethod& heat, const std::vector<int32_t>& sources,
                     const focal::Execution& execution);

}  // namespace focal_bench
