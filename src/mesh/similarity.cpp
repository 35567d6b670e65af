#include "mesh/similarity.h"

#include <Eigen/SVD>
#include <cmath>

namespace focal {

Matrix3 nearest_rotation(const Matrix3& matrix) {
  if (!matrix.allFinite()) return Matrix3::Identity();
  const Eigen::JacobiSVD<Matrix3> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (!(svd.singularValues()[1] > 1e-12 * svd.singularValues()[0])) return Matrix3::Identity();
  Vector3 sign = Vector3::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign[2] = -1;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

Similarity fit_similarity(const MatrixX3& from, const MatrixX3& to, const Vector& weight) {
  const Vector share = weight / weight.sum();
  const Vector3 from_centre = from.transpose() * share, to_centre = to.transpose() * share;
  const MatrixX3 a = from.rowwise() - from_centre.transpose(), b = to.rowwise() - to_centre.transpose();
  Similarity result;
  const Matrix3 covariance = b.transpose() * share.asDiagonal() * a;
  result.rotation = nearest_rotation(covariance);
  const double spread = (a.rowwise().squaredNorm().array() * share.array()).sum();
  const double along = (result.rotation.transpose() * covariance).trace();
  if (spread > 0 && along > 0) result.scale = along / spread;
  result.offset = to_centre - result.scale * (result.rotation * from_centre);
  const MatrixX3 left = b - result.scale * a * result.rotation.transpose();
  result.residual = std::sqrt((left.rowwise().squaredNorm().array() * share.array()).sum());
  return result;
}

}  // namespace focal
