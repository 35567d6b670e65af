#include "landmarks/features.h"

#include <algorithm>
#include <cmath>

namespace focal {

RowMatrixf features_of(const SurfaceAnalysis& analysis, int32_t count, const TrainParams& params,
                       const Matrix3& frame) {
  if (!params.bulge && !params.oriented) return analysis.descriptors.topRows(count);
  RowMatrixf result(count, feature_count(params));
  Eigen::Index at = params.bulge ? invariant_feature_count(params) : analysis.descriptors.cols();
  result.leftCols(at) =
      params.bulge ? invariant_features(analysis, count) : RowMatrixf(analysis.descriptors.topRows(count));
  if (!params.oriented) return result;
  RowMatrixf placed = placed_features(analysis, count);
  const Eigen::Matrix3f turn = frame.cast<float>();
  placed.leftCols<3>() *= turn.transpose(), placed.rightCols<3>() *= turn.transpose();
  for (int32_t copy = 0; copy < frame_copies; ++copy, at += frame_components)
    result.middleCols<frame_components>(at) = placed;
  return result;
}

RowMatrixf invariant_features(const SurfaceAnalysis& analysis, int32_t count) {
  const Eigen::Index signature = analysis.descriptors.cols();
  RowMatrixf result(count, signature + bulge_copies * bulge_components);
  result.leftCols(signature) = analysis.descriptors.topRows(count);
  for (int32_t s = 0; s < count; ++s)
    for (int32_t copy = 0; copy < bulge_copies; ++copy)
      result.row(s).segment<bulge_components>(signature + copy * bulge_components) =
          analysis.bulge.row(analysis.samples[s]);
  return result;
}

RowMatrixf upright_features(const SurfaceAnalysis& analysis, const RowMatrixf& placed) {
  const auto count = static_cast<int32_t>(placed.rows());
  const RowMatrixf invariant = invariant_features(analysis, count);
  RowMatrixf result(count, invariant.cols() + frame_copies * upright_components);
  result.leftCols(invariant.cols()) = invariant;
  for (int32_t s = 0; s < count; ++s)
    for (int32_t copy = 0; copy < frame_copies; ++copy)
      result.row(s).segment<upright_components>(invariant.cols() + copy * upright_components) << placed(s, 1),
          placed(s, 4), std::hypot(placed(s, 0), placed(s, 2)),
          (placed(s, 0) * placed(s, 3) + placed(s, 2) * placed(s, 5)) /
              std::max(std::hypot(placed(s, 0), placed(s, 2)), 1e-6f);
  return result;
}

RowMatrixf placed_features(const SurfaceAnalysis& analysis, int32_t count) {
  const MatrixX3& positions = analysis.surface().positions;
  const Eigen::RowVector3d centre =
      (positions.transpose() * analysis.operators.mass / analysis.operators.mass.sum()).transpose();
  RowMatrixf result(count, frame_components);
  for (int32_t s = 0; s < count; ++s) {
    const int32_t v = analysis.samples[s];
    result.row(s).head<3>() = (positions.row(v) - centre).cast<float>();
    result.row(s).tail<3>() = analysis.normals.row(v).cast<float>();
  }
  return result;
}

}  // namespace focal
