// Bodies of the kernels: one call computes one entry. The same text runs on the device, one thread a call, and in a loop on
// the host, where tests compare it with the CPU's own code. Matrices of vertices are by rows: neighbouring threads read
// neighbouring columns.
#pragma once
#include <math.h>
#include <stdint.h>

#ifdef __CUDACC__
#define FOCAL_HOST_DEVICE __host__ __device__
#else
#define FOCAL_HOST_DEVICE
#endif

namespace focal {

// A pseudo-random number of [-1/2, 1/2) (G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators",
// 2014).
FOCAL_HOST_DEVICE inline double random_entry(uint64_t index) {
  uint64_t z = (index + 1) * 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-53 - 0.5;
}

struct RandomColumns {
  double* X;
  FOCAL_HOST_DEVICE void operator()(int64_t i) const { X[i] = random_entry(static_cast<uint64_t>(i)); }
};

// A sparse matrix by columns, symmetric, so by rows as well.
struct SparseColumns {
  const int32_t *start, *row;
  const double* value;
};

// diagonal M + rank_one M 1 1^T M, dense.
struct DenseMass {
  const double* mass;
  double* A;
  double diagonal, rank_one;
  int32_t n;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t i = at / n, j = at % n;
    A[at] = rank_one * mass[i] * mass[j] + (i == j ? diagonal * mass[i] : 0);
  }
};

// A += scale L, one column a call.
struct AddSparseColumn {
  SparseColumns L;
  double* A;
  double scale;
  int32_t n;
  FOCAL_HOST_DEVICE void operator()(int64_t j) const {
    for (int32_t e = L.start[j]; e < L.start[j + 1]; ++e) A[j * n + L.row[e]] += scale * L.value[e];
  }
};

struct ToFloat {
  const double* from;
  float* to;
  FOCAL_HOST_DEVICE void operator()(int64_t i) const { to[i] = static_cast<float>(from[i]); }
};

// S = factor M^1/2 H M^1/2 - 2 I: twice the argument of the Chebyshev polynomials.
struct FilterMatrix {
  const double *H, *mass;
  double* S;
  double factor;
  int32_t n;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t i = at / n, j = at % n;
    S[at] = factor * sqrt(mass[i] * mass[j]) * H[at] - (i == j ? 2 : 0);
  }
};

// Y = M^-1/2 L M^-1/2 X, n x m.
struct ApplyLaplacian {
  SparseColumns L;
  const double *mass, *X;
  double* Y;
  int32_t m;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t v = at / m, j = at % m;
    double sum = 0;
    for (int32_t e = L.start[v]; e < L.start[v + 1]; ++e) {
      const int32_t u = L.row[e];
      sum += L.value[e] / sqrt(mass[v] * mass[u]) * X[static_cast<int64_t>(u) * m + j];
    }
    Y[at] = sum;
  }
};

// Makes the diagonal of a Gram matrix a little larger, so that its factor exists.
struct RaiseDiagonal {
  double* G;
  double share;  // of the trace
  int32_t m;
  FOCAL_HOST_DEVICE void operator()(int64_t) const {
    double trace = 0;
    for (int32_t i = 0; i < m; ++i) trace += G[static_cast<int64_t>(i) * m + i];
    for (int32_t i = 0; i < m; ++i) G[static_cast<int64_t>(i) * m + i] += share * trace;
  }
};

// Squares of Y - X lambda summed over a chunk of rows: partial is chunks x m.
struct ResidualChunk {
  static constexpr int32_t rows = 64;
  const double *X, *Y, *lambda;
  double* partial;
  int32_t n, m;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t chunk = at / m, j = at % m;
    double sum = 0;
    for (int64_t v = chunk * rows; v < n && v < (chunk + 1) * rows; ++v) {
      const double r = Y[v * m + j] - X[v * m + j] * lambda[j];
      sum += r * r;
    }
    partial[at] = sum;
  }
};

// The first `count` columns of M^-1/2 X, the eigenvectors of the generalised problem.
struct EigenvectorEntry {
  const double *X, *mass;
  double* phi;
  int32_t m, count;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t v = at / count, j = at % count;
    phi[at] = X[v * m + j] / sqrt(mass[v]);
  }
};

// ---- SI-HKS (see descriptors/si_hks.cpp); matrices are samples x what is said

struct SquaredEigenfunctions {
  const double* phi;
  const int32_t* vertex;
  double* squared;
  double scale;
  int32_t k;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const double value = phi[static_cast<int64_t>(vertex[at / k]) * k + at % k];
    squared[at] = value * value * scale;
  }
};

struct LogDifference {
  const double* hks;  // samples x times
  double* difference;
  int32_t times;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const double* here = hks + at / (times - 1) * times + at % (times - 1);
    difference[at] = log(here[1] > 1e-300 ? here[1] : 1e-300) - log(here[0] > 1e-300 ? here[0] : 1e-300);
  }
};

struct Magnitude {
  const double* spectrum;  // samples x 2 frequencies: real parts, then imaginary ones
  double* magnitude;
  int32_t frequencies;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const double* here = spectrum + at / frequencies * 2 * frequencies + at % frequencies;
    magnitude[at] = sqrt(here[0] * here[0] + here[frequencies] * here[frequencies]);
  }
};

// ---- Heat method (see geodesics/heat_method.cpp); matrices are n x s, a column a source

struct Sources {
  const int32_t* vertex;  // s x 3
  const double* weight;   // s x 3
  const float* corner_distance;
};

// Heat is a weighted sum of columns of H; H is symmetric and read by rows.
struct HeatEntry {
  const double* H;
  Sources sources;
  double* heat;
  int32_t n, s;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t v = at / s, j = at % s;
    const double* row = H + v * n;
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      if (sources.weight[3 * j + i] != 0) sum += sources.weight[3 * j + i] * row[sources.vertex[3 * j + i]];
    heat[at] = sum;
  }
};

struct FaceTable {
  const int32_t* corner;           // faces x 3
  const float* coefficient;        // faces x 4: half cotangents, area
  const int32_t *fan_start, *fan;  // per vertex: 3 face + corner of the faces round it, ascending
};

// What a face gives to its corner `at` in the right-hand side of the Poisson equation: L_f u / |gradient u|, u divided by
// its largest corner.
FOCAL_HOST_DEVICE inline float face_flow(const float* coefficient, const double u[3], int at,
                                         bool keep_negative) {
  const double a0 = fabs(u[0]), a1 = fabs(u[1]), a2 = fabs(u[2]);
  const double largest = fmax(fmax(a0, a1), a2);
  if (!((keep_negative ? largest : fmax(fmax(u[0], u[1]), u[2])) > 1e-290)) return 0;
  const double scale = 1 / fmax(largest, 1e-290);
  const float d[3] = {static_cast<float>((u[1] - u[2]) * scale), static_cast<float>((u[2] - u[0]) * scale),
                      static_cast<float>((u[0] - u[1]) * scale)};
  const float* c = coefficient;
  const float energy = c[0] * d[0] * d[0] + c[1] * d[1] * d[1] + c[2] * d[2] * d[2];
  const float weight = sqrtf(c[3] / fmaxf(energy, 1e-30f));
  const int next = at == 2 ? 0 : at + 1, last = at == 0 ? 2 : at - 1;
  return weight * c[next] * d[next] - weight * c[last] * d[last];
}

// Gathered by vertex, in the order of the faces: no two threads add to one number, and the sum is the same each time.
struct FlowEntry {
  FaceTable faces;
  const double* heat;
  float* flow;
  int32_t s;
  bool keep_negative;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t v = at / s, j = at % s;
    float sum = 0;
    for (int32_t e = faces.fan_start[v]; e < faces.fan_start[v + 1]; ++e) {
      const int32_t face = faces.fan[e] / 3;
      const int32_t* corner = faces.corner + 3 * face;
      const double u[3] = {heat[static_cast<int64_t>(corner[0]) * s + j],
                           heat[static_cast<int64_t>(corner[1]) * s + j],
                           heat[static_cast<int64_t>(corner[2]) * s + j]};
      sum += face_flow(faces.coefficient + 4 * face, u, faces.fan[e] % 3, keep_negative);
    }
    flow[at] = sum;
  }
};

// The level that is distance 0 for each source.
struct ZeroLevel {
  const float* potential;
  Sources sources;
  float* zero;
  int32_t s;
  FOCAL_HOST_DEVICE void operator()(int64_t j) const {
    float sum = -sources.corner_distance[j];
    for (int i = 0; i < 3; ++i)
      sum += static_cast<float>(sources.weight[3 * j + i]) *
             potential[static_cast<int64_t>(sources.vertex[3 * j + i]) * s + j];
    zero[j] = sum;
  }
};

struct DistanceEntry {
  const float* zero;
  float* distance;  // the potential before
  int32_t s;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const float above = distance[at] - zero[at % s];
    distance[at] = above > 0 ? above : 0;
  }
};

}  // namespace focal
