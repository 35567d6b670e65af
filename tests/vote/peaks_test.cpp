// Planted maxima are found, best first, apart from each other.
#include "vote/peaks.h"

#include <doctest/doctest.h>

#include <cmath>
#include <span>

#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

struct Hill {
  int32_t vertex;
  double height;
};

void add_hills(const TriangleMesh& mesh, std::span<const Hill> hills, int32_t landmark, RowMatrixf& votes) {
  for (int32_t v = 0; v < mesh.vertex_count(); ++v)
    for (const Hill& hill : hills) {
      const double squared = (mesh.positions.row(v) - mesh.positions.row(hill.vertex)).squaredNorm();
      votes(v, landmark) += static_cast<float>(hill.height * std::exp(-squared / 0.02));
    }
}

Surroundings disc_on(const TriangleMesh& mesh, double radius) {
  return [&mesh, radius](int32_t vertex) {
    std::vector<int32_t> disc;
    for (int32_t v = 0; v < mesh.vertex_count(); ++v)
      if ((mesh.positions.row(v) - mesh.positions.row(vertex)).norm() < radius) disc.push_back(v);
    return disc;
  };
}

}  // namespace

TEST_CASE("peaks come best first, for every landmark its own") {
  const TriangleMesh mesh = square(15);
  RowMatrixf votes = RowMatrixf::Zero(mesh.vertex_count(), 2);
  const Hill first[] = {{5 * 31 + 5, 0.6}, {25 * 31 + 20, 1.0}, {15 * 31 + 28, 0.3}};
  const Hill second[] = {{3 * 31 + 25, 2.0}, {28 * 31 + 3, 1.5}};
  add_hills(mesh, first, 0, votes);
  add_hills(mesh, second, 1, votes);
  const auto peaks = find_peaks(votes, 2, 3, 0.2, disc_on(mesh, 0.5), {});
  REQUIRE(peaks.size() == 2);
  CHECK(peaks[0] == std::vector<int32_t>{25 * 31 + 20, 5 * 31 + 5, 15 * 31 + 28});
  CHECK(peaks[1] == std::vector<int32_t>{3 * 31 + 25, 28 * 31 + 3});  // nothing else reaches the floor
  CHECK(find_peaks(votes, 2, 1, 0, disc_on(mesh, 0.5), {})[0].size() == 1);
}

TEST_CASE("peaks keep their distance, and stop when the surface is full") {
  const TriangleMesh mesh = square(15);
  const RowMatrixf flat = RowMatrixf::Ones(mesh.vertex_count(), 1);
  const auto peaks = find_peaks(flat, 1, 100, 0, disc_on(mesh, 0.7), {})[0];
  CHECK(peaks.size() > 4);
  CHECK(peaks.size() < 40);
  for (size_t a = 0; a < peaks.size(); ++a)
    for (size_t b = 0; b < a; ++b)
      CHECK((mesh.positions.row(peaks[a]) - mesh.positions.row(peaks[b])).norm() >= 0.7);
}
