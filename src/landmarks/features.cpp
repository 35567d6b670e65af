#include "landmarks/features.h"

#include <algorithm>
#include <cmath>

namespace focal {

RowMatrixf features_of(const SurfaceAnalysis& analysis, int32_t count, const TrainParams& params,
                       const Matrix3& frame) {
  if (!params.bulge && !params.oriented) return analysis.descriptors.topRows(count);
  RowMatrixf result(count, feature_count(params));
  Eigen::Index at = params.bulge ? invariant_feature_count(params) : analysis.descriptors.cols();
  result.leftCols(at) = params.bulge ? invariant_features(analysis, first_samples(analysis, count))
                                     : RowMatrixf(analysis.descriptors.topRows(count));
  if (!params.oriented) return result;
  RowMatrixf placed = placed_features(analysis, first_samples(analysis, count).vertices);
  const Eigen::Matrix3f turn = frame.cast<float>();
  placed.leftCols<3>() *= turn.transpose(), placed.rightCols<3>() *= turn.transpose();
  for (int32_t copy = 0; copy < frame_copies; ++copy, at += frame_components)
    result.middleCols<frame_components>(at) = placed;
  return result;
}

Described first_samples(const SurfaceAnalysis& analysis, int32_t count) {
  return {std::span(analysis.samples).first(static_cast<size_t>(count)), analysis.descriptors.topRows(count)};
}

RowMatrixf invariant_features(const SurfaceAnalysis& analysis, const Described& of) {
  const Eigen::Index signature = of.descriptors.cols(), count = of.descriptors.rows();
  RowMatrixf result(count, signature + bulge_copies * bulge_components);
  result.leftCols(signature) = of.descriptors;
  for (Eigen::Index s = 0; s < count; ++s)
    for (int32_t copy = 0; copy < bulge_copies; ++copy)
      result.row(s).segment<bulge_components>(signature + copy * bulge_components) =
          analysis.bulge.row(of.vertices[s]);
  return result;
}

RowMatrixf upright_features(const SurfaceAnalysis& analysis, const Described& of, const RowMatrixf& placed) {
  const RowMatrixf invariant = invariant_features(analysis, of);
  RowMatrixf result(invariant.rows(), invariant.cols() + frame_copies * upright_components);
  result.leftCols(invariant.cols()) = invariant;
  for (Eigen::Index s = 0; s < invariant.rows(); ++s)
    for (int32_t copy = 0; copy < frame_copies; ++copy)
      result.row(s).segment<upright_components>(invariant.cols() + copy * upright_components) << placed(s, 1),
          placed(s, 4), std::hypot(placed(s, 0), placed(s, 2)),
          (placed(s, 0) * placed(s, 3) + placed(s, 2) * placed(s, 5)) /
              std::max(std::hypot(placed(s, 0), placed(s, 2)), 1e-6f);
  return result;
}

RowMatrixf placed_features(const SurfaceAnalysis& analysis, std::span<const int32_t> vertices) {
  const MatrixX3& positions = analysis.surface().positions;
  const Eigen::RowVector3d centre =
      (positions.transpose() * analysis.operators.mass / analysis.operators.mass.sum()).transpose();
  RowMatrixf result(static_cast<Eigen::Index>(vertices.size()), frame_components);
  for (Eigen::Index s = 0; s < result.rows(); ++s) {
    const int32_t v = vertices[s];
    result.row(s).head<3>() = (positions.row(v) - centre).cast<float>();
    result.row(s).tail<3>() = analysis.normals.row(v).cast<float>();
  }
  return result;
}

}  // namespace focal
