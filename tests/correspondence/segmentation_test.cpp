// Every triangle gets the label it should, by a truth that is computed otherwise.
#include "correspondence/segmentation.h"

#include <doctest/doctest.h>

#include <set>

#include "landmarks/regions.h"
#include "skeleton/small_rig.h"

using namespace focal;
using namespace focal_test;

TEST_CASE("a triangle has the label of most of its corners") {
  PreparedMesh mesh;
  mesh.source.positions = MatrixX3::Zero(4, 3);
  mesh.source.triangles.resize(3, 3);
  mesh.source.triangles << 0, 1, 2, 1, 2, 3, 2, 3, 0;
  CHECK(triangle_labels(mesh, {7, 5, 5, -1}) == std::vector<int32_t>{5, 5, 5});
  CHECK(triangle_labels(mesh, {1, 2, 3, 3}) == std::vector<int32_t>{1, 3, 3});
}

TEST_CASE(
    "geodesic parts: almost every triangle belongs to its nearest landmark; k-means names each landmark it "
    "starts from") {
  const creatures::Character body = humanoid(22);
  const auto mesh = mesh_of(body.posed, body);
  const Detection detection = detect(rig_model(), mesh, {}, execution);
  const auto labels = segment_geodesic(detection, execution);
  REQUIRE(labels.size() == static_cast<size_t>(mesh->source.triangle_count()));
  const DistanceFields distances(detection.proxy, execution);
  RowMatrixf field(static_cast<Eigen::Index>(detection.landmarks.size()), mesh->source.vertex_count());
  for (size_t l = 0; l < detection.landmarks.size(); ++l) {
    const auto one = distances.from(detection.landmarks[l].source_point, execution);
    for (Eigen::Index v = 0; v < field.cols(); ++v) field(static_cast<Eigen::Index>(l), v) = one[v];
    if (detection.places[l].triangle < 0) field.row(static_cast<Eigen::Index>(l)).setConstant(1e9F);
  }
  size_t agree = 0;
  for (size_t t = 0; t < labels.size(); ++t) {
    const Eigen::VectorXf sum = field.col(mesh->source.triangles(t, 0)) +
                                field.col(mesh->source.triangles(t, 1)) +
                                field.col(mesh->source.triangles(t, 2));
    Eigen::Index nearest = 0;
    sum.minCoeff(&nearest);
    agree += labels[t] == nearest;
  }
  CHECK(static_cast<double>(agree) > 0.9 * static_cast<double>(labels.size()));

  const auto clusters = segment_k_means(detection, execution);
  const std::set<int32_t> used(clusters.begin(), clusters.end());
  CHECK(used.size() > detection.landmarks.size() / 2);
  CHECK(*used.begin() >= 0);
  CHECK(*used.rbegin() < static_cast<int32_t>(detection.landmarks.size()));
  CHECK(segment_k_means(detection, execution) == clusters);
}
