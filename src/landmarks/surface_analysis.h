// What is computed of a surface before any model is asked: a value, to be kept and used with many models.
#pragma once
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "geodesics/heat_method.h"
#include "mesh/prepare.h"
#include "operators/operators.h"

namespace focal {

struct AnalysisParams {
  int32_t eigenpair_count = 200;
  double sampling_rate = 0.1;  // of the vertices
  int32_t max_samples = 1250;
  uint64_t seed = 0, stream = 0;
  bool keep_negative_heat = false;  // see HeatMethod; true for preset `paper`
};

struct SurfaceAnalysis {
  Operators operators;
  HeatMethod heat;
  std::vector<int32_t> samples;  // surface vertices, in random order: any beginning is a random sample too
  RowMatrixf descriptors;        // samples x 96, SI-HKS
  double spectrum_seconds = 0, descriptor_seconds = 0, geodesic_seconds = 0;
};

SurfaceAnalysis analyse_surface(const PreparedMesh& mesh, const AnalysisParams& params,
                                const Execution& execution);

}  // namespace focal
