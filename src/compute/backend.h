// What a GPU module does for focal: a C table behind one exported function, so that module and library may come from
// different compilers. Matrices are dense; every array belongs to the caller and lies in the host's memory.
//
// Functions return 0, or fill `failure` and return 1; nothing is written to the out arguments then. Any thread may call
// any function; of one surface only one thread at a time.
#pragma once
#include <stdint.h>

namespace focal {

inline constexpr uint32_t compute_version = 3;  // changes whenever the table does
inline constexpr const char* compute_entry_name = "focal_compute_entry";

struct ComputeFailure {
  int32_t lasting;  // 1: no later call on this device can work; 0: another mesh may
  char reason[252];
};

// A surface as the heat method and the spectrum need it. L, mass, corners: n vertices, f faces.
struct ComputeSurface {
  int32_t vertices, faces;
  const int32_t *column_start, *row;  // L, symmetric, by columns
  const double* value;
  const double* mass;
  const double* position;      // n x 3
  const int32_t* corner;       // f x 3
  const float* coefficient;    // f x 4: half cotangents of the corners, area
  double area, heat_time;      // of the heat step; its inverse is also the shift of the spectrum
  int32_t keep_negative_heat;  // see HeatMethod
};

struct ComputeSource {  // of distances: a point between three vertices
  int32_t vertex[3];
  float corner_distance;
  double weight[3];
};

// Linear maps from squared eigenfunctions to SI-HKS, each by rows. See descriptors/si_hks.cpp. frequencies 0: the first map
// alone is the signature, of `times` components, as HKS and WKS are.
struct ComputeSignature {
  int32_t times, frequencies, components;
  double scale;           // of the squared eigenfunctions
  const double* decay;    // times x eigenpairs
  const double* fourier;  // 2 frequencies x (times - 1)
  const double* spline;   // components x frequencies
};

// A forest whose leaves keep training samples, and these samples' distances to all landmarks. Arrays of all trees one after
// the other; node, leaf and sample numbers as in RegressionTree.
struct ComputeForest {
  int32_t trees, landmarks, components;
  const int32_t *node_start, *leaf_start_start,
      *leaf_sample_start;  // trees + 1 each: where a tree begins in the next ones
  const int32_t *feature, *child;
  const float* threshold;
  const int32_t *leaf_start, *leaf_sample;
  int64_t training_samples;
  const uint16_t* target;  // training samples x landmarks; 65535: none
  int32_t bins;            // of a histogram of distances
  float target_to_bin;
  double bin_width;
  int32_t kernel_half;  // entries of the smoothing kernel
  const float* kernel;  // at 1/2, 3/2 ... bins
  const float* decay;   // bins + 1: of a vote at the bins' edges
};

// What preset paper votes with: distances at which samples see landmarks, in `columns` columns (landmarks, for each side of
// the symmetry plane). See paper/paper.cpp.
struct ComputeIsolines {
  int32_t samples, columns;
  const int32_t* vertex;         // samples
  const float *radius, *weight;  // samples x columns; radius: share of the sample's largest distance
  const int32_t *neighbour_start, *neighbour;  // of each vertex along the surface's edges; n + 1
  float neighbourhood;  // share of a vertex' own largest distance over which votes are averaged
};

// A functional map from some points to the surface, to be refined; see spectrum/functional_map.h.
struct ComputeMap {
  const float*
      eigenfunctions;  // of the surface, n x eigenpairs by rows; the same at every call for one surface
  int32_t eigenpairs;
  int32_t points, most;  // most: eigenfunctions of the last round
  const float *place,
      *weighted;           // points x most by rows: the points' eigenfunctions, and these times their weights
  const float* whitening;  // most x most by columns: L^-1, where L L^T = place^T weighted
  const int32_t* spread;
  int32_t spread_count, first, step;
  int32_t exact_from;  // points from here on lie at the nearest of all vertices in the last round
};

struct ComputeStage {
  char name[32];
  double milliseconds;  // by the device's own clock, since the report before
  double flops, bytes;  // the least that the stage must do
};

struct ComputeTable {
  uint32_t struct_size, version;
  int32_t (*device_open)(int32_t index, void** device, char* name, int32_t name_size,
                         ComputeFailure* failure);
  void (*device_close)(void* device);
  int32_t (*surface_create)(void* device, const ComputeSurface* surface, void** out, ComputeFailure* failure);
  void (*surface_destroy)(void* surface);
  // The `count` smallest eigenpairs of L phi = lambda M phi. phi: n x count by rows.
  int32_t (*spectrum)(void* surface, int32_t count, double tolerance, double* lambda, double* phi,
                      ComputeFailure* failure);
  // After spectrum. out: count x signature->components.
  int32_t (*signatures)(void* surface, const ComputeSignature* signature, const int32_t* vertex,
                        int32_t count, float* out, ComputeFailure* failure);
  // out: n x count by rows, >= 0.
  int32_t (*distances)(void* surface, const ComputeSource* source, int32_t count, float* out,
                       ComputeFailure* failure);
  int32_t (*forest_create)(void* device, const ComputeForest* forest, void** out, ComputeFailure* failure);
  void (*forest_destroy)(void* forest);
  // Votes of `count` samples. descriptor: count x components. out: n x stride by rows, stride >= landmarks; what is beyond
  // the landmarks is set to 0.
  int32_t (*votes)(void* surface, void* forest, const int32_t* vertex, const float* descriptor, int32_t count,
                   int32_t stride, float* out, ComputeFailure* failure);
  // The `peaks` best vertices of each landmark after votes, each outside the connected part of the balls round the better ones;
  // -1: none left. out: landmarks x peaks.
  int32_t (*peaks)(void* surface, int32_t peaks, double radius, int32_t* out, ComputeFailure* failure);
  // Votes along isolines, averaged. out: n x columns.
  int32_t (*isoline_votes)(void* surface, const ComputeIsolines* isolines, float* out,
                           ComputeFailure* failure);
  // image, weight: points x 3, between which vertices they lie at first and at last, the nearest first; C: most x most by
  // columns; error: points x 2, how far the points lie from their nearest vertices in the embedding, and their size, squared.
  int32_t (*zoom_out)(void* surface, const ComputeMap* map, int32_t* image, float* weight, float* C,
                      double* error, ComputeFailure* failure);
  // Stages of this surface since the last report; returns how many, at most `room`.
  int32_t (*stages)(void* surface, ComputeStage* out, int32_t room);
};

using ComputeEntry = const ComputeTable* (*)(uint32_t version);  // null: another version than the module's

}  // namespace focal
