#include "correspondence/segmentation.h"

#include <algorithm>
#include <cmath>

#include "descriptors/si_hks.h"
#include "landmarks/vote_maps.h"

namespace focal {
namespace {

constexpr int32_t max_rounds = 50;
constexpr double descriptor_share = 0.15;  // weight of SI-HKS relative to positions, each of unit spread

// Position and SI-HKS of every vertex, each scaled to a mean squared length that is its weight.
RowMatrix features_of(const SurfaceAnalysis& analysis, const Execution& execution) {
  const Eigen::Index n = analysis.surface().vertex_count();
  Eigenbasis basis{Vector(analysis.eigenfunctions.cols()), analysis.eigenfunctions.cast<double>()};
  for (Eigen::Index k = 0; k < basis.lambda.size(); ++k)  // Phi^T M Phi = I
    basis.lambda[k] = std::max(0.0, basis.Phi.col(k).dot(analysis.operators.L * basis.Phi.col(k)));
  std::vector<int32_t> all(static_cast<size_t>(n));
  for (int32_t v = 0; v < n; ++v) all[v] = v;
  RowMatrix descriptors = si_hks(basis, analysis.operators.area, all, execution);
  RowMatrix positions = analysis.surface().positions;
  for (RowMatrix* part : {&positions, &descriptors}) {
    part->rowwise() -= part->colwise().mean().eval();
    const double spread = part->rowwise().squaredNorm().mean();
    if (spread > 0) *part /= std::sqrt(spread);
  }
  RowMatrix features(n, positions.cols() + descriptors.cols());
  features << positions, descriptor_share * descriptors;
  return features;
}

std::vector<int32_t> nearest_centres(const RowMatrix& features, const RowMatrix& centres) {
  std::vector<int32_t> label(static_cast<size_t>(features.rows()));
  for (Eigen::Index v = 0; v < features.rows(); ++v) {
    Eigen::Index nearest = 0;
    (centres.rowwise() - features.row(v)).rowwise().squaredNorm().minCoeff(&nearest);
    label[v] = static_cast<int32_t>(nearest);
  }
  return label;
}

// Lloyd's algorithm; a cluster that loses all its vertices keeps its centre.
std::vector<int32_t> k_means(const RowMatrix& features, RowMatrix centres, const Vector& mass,
                             const Execution& execution) {
  std::vector<int32_t> label;
  for (int32_t round = 0; round < max_rounds; ++round) {
    execution.check_cancelled();
    auto next = nearest_centres(features, centres);
    if (next == label) break;
    label = std::move(next);
    RowMatrix sum = RowMatrix::Zero(centres.rows(), centres.cols());
    Vector total = Vector::Zero(centres.rows());
    for (size_t v = 0; v < label.size(); ++v)
      sum.row(label[v]) += mass[v] * features.row(v), total[label[v]] += mass[v];
    for (Eigen::Index c = 0; c < centres.rows(); ++c)
      if (total[c] > 0) centres.row(c) = sum.row(c) / total[c];
  }
  return label;
}

// Labels of the caller's vertices from those of the analysed surface: the label of the nearest corner.
std::vector<int32_t> at_source_vertices(const Detection& detection, const std::vector<int32_t>& coarse,
                                        const Execution& execution) {
  const SurfaceAnalysis& analysis = *detection.analysis;
  const auto places = coarse_place_of_vertices(analysis.proxy, execution);
  std::vector<int32_t> result;
  for (const int32_t v : detection.mesh->surface_vertex) {
    result.push_back(-1);
    if (v < 0) continue;
    int corner = 0;
    places[v].barycentric.maxCoeff(&corner);
    result.back() = coarse[analysis.surface().triangles(places[v].triangle, corner)];
  }
  return result;
}

}  // namespace

std::vector<int32_t> segment_k_means(const Detection& detection, const Execution& execution,
                                     const std::vector<int32_t>& seed_vertices) {
  const SurfaceAnalysis& analysis = analysis_of(detection);
  const RowMatrix features = features_of(analysis, execution);
  const std::vector<int32_t> found = placed_landmarks(detection);
  const size_t count = seed_vertices.empty() ? found.size() : seed_vertices.size();
  if (count == 0)
    return triangle_labels(*detection.mesh, std::vector<int32_t>(detection.mesh->surface_vertex.size(), -1));
  RowMatrix centres = RowMatrix::Zero(static_cast<Eigen::Index>(count), features.cols());
  for (size_t c = 0; c < count; ++c) {
    if (!seed_vertices.empty()) {
      centres.row(c) = features.row(seed_vertices[c]);
      continue;
    }
    const SurfacePoint& place = detection.places[found[c]];
    for (int i = 0; i < 3; ++i)
      centres.row(c) += place.barycentric[i] * features.row(analysis.surface().triangles(place.triangle, i));
  }
  std::vector<int32_t> label = k_means(features, std::move(centres), analysis.operators.mass, execution);
  if (seed_vertices.empty())
    for (int32_t& l : label) l = found[l];
  return triangle_labels(*detection.mesh, at_source_vertices(detection, label, execution));
}

std::vector<int32_t> segment_geodesic(const Detection& detection, const Execution& execution) {
  const SurfaceAnalysis& analysis = analysis_of(detection);
  const std::vector<int32_t> found = placed_landmarks(detection);
  std::vector<int32_t> label(static_cast<size_t>(analysis.surface().vertex_count()), -1);
  if (!found.empty()) {
    const RowMatrixf distances = analysis.metric->distances(places_of(detection, found), execution);
    for (size_t v = 0; v < label.size(); ++v) {
      Eigen::Index nearest = 0;
      distances.col(static_cast<Eigen::Index>(v)).minCoeff(&nearest);
      label[v] = found[nearest];
    }
  }
  return triangle_labels(*detection.mesh, at_source_vertices(detection, label, execution));
}

std::vector<int32_t> triangle_labels(const PreparedMesh& mesh,
                                     const std::vector<int32_t>& source_vertex_labels) {
  std::vector<int32_t> result;
  for (int32_t t = 0; t < mesh.source.triangle_count(); ++t) {
    const auto label = [&](int i) { return source_vertex_labels[mesh.source.triangles(t, i)]; };
    result.push_back(label(1) == label(2) ? label(1) : label(0));
  }
  return result;
}

ColouredMesh coloured(const TriangleMesh& mesh, const std::vector<int32_t>& triangle_labels) {
  const auto count = static_cast<Eigen::Index>(mesh.triangle_count());
  ColouredMesh result{{MatrixX3(3 * count, 3), MatrixX3i(count, 3)}, RowMatrixf(3 * count, 3)};
  for (Eigen::Index t = 0; t < count; ++t)
    for (int i = 0; i < 3; ++i) {
      result.mesh.positions.row(3 * t + i) = mesh.positions.row(mesh.triangles(t, i));
      result.mesh.triangles(t, i) = static_cast<int32_t>(3 * t + i);
      result.colours.row(3 * t + i) = label_colour(triangle_labels[t]);
    }
  return result;
}

}  // namespace focal
