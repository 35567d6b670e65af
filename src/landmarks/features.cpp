#include "landmarks/features.h"

#include "descriptors/bulge.h"
#include "descriptors/descriptor.h"

namespace focal {
namespace {

// A split looks at a few components drawn from all: those that few numbers hold come several times, to be drawn as often as they
// deserve.
constexpr int32_t bulge_copies = 2, frame_copies = 3, frame_components = 6;
constexpr auto bulge_components = static_cast<int32_t>(bulge_radii.size());

}  // namespace

int32_t feature_count(const TrainParams& params) {
  const int32_t signature = descriptor_kinds()[params.descriptor].dimension;
  if (params.preset == Preset::paper) return signature;
  return signature + (params.bulge ? bulge_copies * bulge_components : 0) +
         (params.oriented ? frame_copies * frame_components : 0);
}

RowMatrixf features_of(const SurfaceAnalysis& analysis, int32_t count, const TrainParams& params,
                       const Matrix3& frame) {
  RowMatrixf result(count, feature_count(params));
  const Eigen::Index signature = analysis.descriptors.cols();
  result.leftCols(signature) = analysis.descriptors.topRows(count);
  if (params.preset == Preset::paper) return result;
  const Vector3 centre =
      analysis.surface().positions.transpose() * analysis.operators.mass / analysis.operators.mass.sum();
  for (int32_t s = 0; s < count; ++s) {
    const int32_t v = analysis.samples[s];
    Eigen::Index at = signature;
    for (int32_t copy = 0; params.bulge && copy < bulge_copies; ++copy, at += bulge_components)
      result.row(s).segment<bulge_components>(at) = analysis.bulge.row(v);
    if (!params.oriented) continue;
    Eigen::Matrix<float, 1, frame_components> placed;
    placed.head<3>() = (frame * (analysis.surface().positions.row(v).transpose() - centre)).cast<float>();
    placed.tail<3>() = (frame * analysis.normals.row(v).transpose()).cast<float>();
    for (int32_t copy = 0; copy < frame_copies; ++copy, at += frame_components)
      result.row(s).segment<frame_components>(at) = placed;
  }
  return result;
}

}  // namespace focal
