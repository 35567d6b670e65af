#include "mesh/rig.h"

#include <algorithm>

namespace focal {

std::vector<Influence> heaviest(std::span<const Influence> influences, size_t most) {
  std::vector<Influence> merged(influences.begin(), influences.end());
  std::stable_sort(merged.begin(), merged.end(),
                   [](const Influence& a, const Influence& b) { return a.joint < b.joint; });
  size_t kept = 0;
  for (const Influence& one : merged) {
    if (!(one.weight > 0)) continue;
    if (kept > 0 && merged[kept - 1].joint == one.joint)
      merged[kept - 1].weight += one.weight;
    else
      merged[kept++] = one;
  }
  merged.resize(kept);
  std::stable_sort(merged.begin(), merged.end(),
                   [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
  merged.resize(std::min(merged.size(), most));
  float sum = 0;
  for (const Influence& one : merged) sum += one.weight;
  for (Influence& one : merged) one.weight /= sum;
  return merged;
}

VertexInfluences heaviest(std::span<const Influence> influences) {
  VertexInfluences result{};
  std::ranges::copy(heaviest(influences, max_influences), result.begin());
  return result;
}

MatrixX3 skinned(const MatrixX3& positions, const std::vector<VertexInfluences>& influences,
                 const std::vector<Matrix4>& transforms) {
  MatrixX3 result = positions;
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    Vector3 sum = Vector3::Zero();
    double total = 0;
    for (const Influence& one : influences[v]) {
      if (one.weight <= 0) continue;
      const Matrix4& T = transforms[one.joint];
      sum += one.weight * (T.topLeftCorner<3, 3>() * positions.row(v).transpose() + T.topRightCorner<3, 1>());
      total += one.weight;
    }
    if (total > 0) result.row(v) = (sum / total).transpose();
  }
  return result;
}

}  // namespace focal
