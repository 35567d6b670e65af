// The model-independent part of a detection: a value that can be kept and used with several models.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "analysis/engine.h"
#include "base/parallel.h"
#include "geodesics/distance.h"
#include "mesh/proxy.h"
#include "model/params.h"
#include "operators/operators.h"

namespace focal {

struct AnalysisParams {
  int32_t proxy_vertices = 0;  // analyse on a proxy of about this size; 0: on the surface itself
  int32_t eigenpair_count = 200;
  double sampling_rate = 0.1;  // share of the analysed vertices
  int32_t max_samples = 1250;
  int32_t max_described = 0;  // see SurfaceAnalysis::described
  uint64_t seed = 0, stream = 0;
  // Preset `paper`: the published method exactly, without intrinsic Delaunay triangulation and with negative
  // heat (see HeatMethod).
  bool paper_exact = false;
  int32_t descriptor = 0, distance = 0;  // as in TrainParams
};

// The parameters that a model with these parameters needs; the caller sets the sampling.
AnalysisParams analysis_params_of(const TrainParams& trained);

// Distances from all vertices to blocks of 32 samples, as 16-bit numbers: block b, vertex v, sample b * 32 + j at
// [(b * vertices + v) * 32 + j], in units of `step`.
struct SampleDistances {
  double step = 0;
  int32_t vertices = 0;
  std::vector<uint16_t> steps;
};

struct DescribedVertices {
  std::vector<int32_t> vertices;
  RowMatrixf descriptors;  // vertices x components
};

struct SurfaceAnalysis {
  AnalysisParams params;
  Proxy proxy;
  Operators operators;  // of surface(), like all fields below
  std::shared_ptr<const Distance> metric;
  std::shared_ptr<const Engine> engine = cpu_engine();  // a device's only until the analysis is returned
  std::vector<int32_t> samples;  // vertices, in random order: every prefix is a random sample too
  RowMatrixf descriptors;        // samples x components
  DescribedVertices described;   // independent of the seed: at most max_described, spread over the surface
  RowMatrixf eigenfunctions;     // vertices x eigenpairs
  MatrixX3 normals;              // vertices x 3, unit length
  RowMatrixf bulge;              // see descriptors/bulge.h
  SampleDistances distances;     // kept where they are small; else empty, and recomputed for each model
  double proxy_seconds = 0, spectrum_seconds = 0, descriptor_seconds = 0, geodesic_seconds = 0;

  const TriangleMesh& surface() const { return proxy.coarse->surface; }
};

// Uses the backend of the execution if there is one and it supports everything requested; throws
// BackendFailure.
SurfaceAnalysis analyse_surface(std::shared_ptr<const PreparedMesh> mesh, const AnalysisParams& params,
                                const Execution& execution);

// Operators of an existing proxy; bridges: pairs of vertices that link separate parts.
using Bridges = std::vector<std::pair<int32_t, int32_t>>;
void make_surface_operators(SurfaceAnalysis& analysis, const Bridges& bridges, const Execution& execution);
// Operators and metric, for the CPU.
void make_solvers(SurfaceAnalysis& analysis, const Execution& execution);

// Normals and bulge of a proxy with operators.
void describe_relief(SurfaceAnalysis& analysis, const Execution& execution);

// Computes and stores the distances of all samples if they take less than about 64 MB.
void keep_distances(SurfaceAnalysis& analysis, const Execution& execution);

// Passes the distances of the first `count` samples, stored or recomputed, to the sink in portions of whole
// blocks.
using DistanceSink = std::function<void(int32_t first, int32_t count, const SampleDistances& portion)>;
void for_each_portion(const SurfaceAnalysis& analysis, int32_t count, const Execution& execution,
                      const DistanceSink& sink);

}  // namespace focal
