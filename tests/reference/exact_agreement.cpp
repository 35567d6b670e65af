// exact_agreement: the distance `exact` against CGAL's on random surfaces; exits with 1 where they differ.
#include <cstdio>
#include <iostream>

#include "cgal_geodesics.h"
#include "geodesics/distance.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

constexpr double limit = 1e-6;  // of the largest distance: exact ones come as floats

// Crumpled more and more: full of saddles and slivers.
TriangleMesh crumpled(TriangleMesh mesh, double noise, uint64_t seed) {
  Random random(seed);
  for (Eigen::Index i = 0; i < mesh.positions.size(); ++i)
    mesh.positions.data()[i] += noise * random.normal();
  return mesh;
}

double disagreement(const TriangleMesh& mesh) {
  const auto kinds = distance_kinds();
  const auto exact =
      std::find_if(kinds.begin(), kinds.end(), [](const auto& k) { return k.name == "exact"; });
  const std::vector<int32_t> sources = {0, mesh.vertex_count() / 3, mesh.vertex_count() - 1};
  const RowMatrixf ours = exact->make({mesh, {}, make_operators(mesh)}, {})->distances(sources, {});
  const CgalMesh other = to_cgal(mesh);
  double largest = 0;
  for (size_t s = 0; s < sources.size(); ++s) {
    const auto theirs = cgal_distances(other, sources[s]);
    for (int32_t v = 0; v < mesh.vertex_count(); ++v)
      largest = std::max(largest, std::abs(ours(s, v) - theirs[v]));
  }
  return largest / ours.maxCoeff();
}

}  // namespace

int main() try {
  double worst = 0;
  for (uint64_t seed = 1; seed <= 4; ++seed)
    for (const double noise : {0.0, 0.01, 0.05, 0.15}) {
      const double closed = disagreement(crumpled(with_radius(sphere(3), lump), noise, seed));
      const double open = disagreement(crumpled(square(8, 0.2, seed), noise, seed));
      std::printf("seed %d, noise %.2f: closed %.1e, open %.1e of the largest distance\n",
                  static_cast<int>(seed), noise, closed, open);
      worst = std::max({worst, closed, open});
    }
  return worst < limit ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << "exact_agreement: " << error.what() << '\n';
  return 1;
}
