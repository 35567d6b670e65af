// Distances between points of a surface: the interface of every distance, and the list of them.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "linear/sparse_cholesky.h"
#include "mesh/prepare.h"
#include "operators/operators.h"

namespace focal {

// Precomputation for a surface is done once; then distances are computed from any number of sources, 32 at a
// time. Immutable and thread-safe.
class Distance {
 public:
  static constexpr int lanes = SparseCholesky::lanes;

  virtual ~Distance() = default;

  // Called once per block of up to 32 sources, from several threads at once: distances[v * lanes + j] is the
  // distance, in the mesh's units and >= 0, of vertex v from source first + j, for j < count.
  using BlockSink = std::function<void(int64_t first, int32_t count, const float* distances)>;
  void for_each_block(std::span<const SurfacePoint> sources, const Execution& execution,
                      const BlockSink& sink) const;
  void for_each_block(std::span<const int32_t> source_vertices, const Execution& execution,
                      const BlockSink& sink) const;

  // sources x vertices.
  RowMatrixf distances(std::span<const SurfacePoint> sources, const Execution& execution) const;
  RowMatrixf distances(std::span<const int32_t> source_vertices, const Execution& execution) const;

  int32_t vertex_count() const { return static_cast<int32_t>(positions_.rows()); }
  // An upper bound of the distance between any two vertices.
  double distance_bound() const { return distance_bound_; }
  // A sentence on a workaround for this mesh, or null.
  virtual const char* warning() const { return nullptr; }
  // The symbolic analysis of L, if there is one, to be reused for other factors of the same surface; else
  // null.
  virtual std::shared_ptr<const SymbolicFactor> symbolic() const { return nullptr; }

  struct Source {
    int32_t vertex[3];
    double weight[3];
    float corner_distance = 0;  // weighted mean of the corners' distances from the source
    int32_t triangle = -1;      // -1: the source is vertex[0]
  };
  // The distances from 1 to 32 sources; out has vertex_count() * lanes numbers, lanes without a source are
  // undefined.
  virtual void solve_block(std::span<const Source> sources, float* out, const Execution& execution) const = 0;

 protected:
  Distance() = default;
  explicit Distance(const TriangleMesh& mesh) : positions_(mesh.positions), triangles_(mesh.triangles) {}

  double distance_bound_ = 0;
  MatrixX3 positions_;
  MatrixX3i triangles_;

 private:
  void run(std::span<const Source> sources, const Execution& execution, const BlockSink& sink) const;
};

// An upper bound of the largest distance: twice the farthest path along the entries of L from one vertex.
double diameter_bound(const TriangleMesh& mesh, const SparseMatrix& L);

// The input of a distance.
struct MeasuredSurface {
  const TriangleMesh& mesh;
  // Pairs of vertices that link separate parts; used only by make.
  std::span<const std::pair<int32_t, int32_t>> bridges;
  const Operators& operators;
  bool paper_exact = false;  // as in preset `paper` (see HeatMethod)
};

struct DistanceKind {
  std::string_view name;  // a literal, used on the command line and in model files
  bool is_geodesic;       // a length along the surface, as preset `default` requires
  bool is_length;         // proportional to the size of the mesh
  std::shared_ptr<const Distance> (*make)(const MeasuredSurface& surface, const Execution& execution);
};

// All distances, one per line: line n defines number n in focal.h, so lines may only be added at the end. A
// line `kind(NAME)` refers to a function `DistanceKind NAME_distance()` in a file of its own.
// clang-format off
#define FOCAL_DISTANCES(kind) \
  kind(heat)                  \
  kind(exact)                 \
  kind(biharmonic)            \
  kind(commute_time)
// clang-format on

std::span<const DistanceKind> distance_kinds();

// From a point of mesh.surface to every vertex of mesh.source, lengths in its units; infinite where no triangle uses the vertex.
std::vector<float> distances_on(const PreparedMesh& mesh, const DistanceKind& kind,
                                const SurfacePoint& source, const Execution& execution);

}  // namespace focal
