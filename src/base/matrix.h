// The linear-algebra types of focal's headers; no other header names Eigen.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SparseCore>
#include <cstdint>

namespace focal {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Matrix4 = Eigen::Matrix4d;  // acts on column vectors
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;                                                // column-major
using MatrixX3 = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;    // points
using Edges = Eigen::Matrix<int32_t, Eigen::Dynamic, 2, Eigen::RowMajor>;      // pairs of vertices
using MatrixX3i = Eigen::Matrix<int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>;  // triangles
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using RowMatrixf = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Eigen's constructors leak their first array when the allocation of the second fails. Here the matrix exists
// before it is filled, so its destructor frees whatever was allocated.
class SparseMatrix : public Eigen::SparseMatrix<double, Eigen::ColMajor, int32_t> {
 public:
  using Base = Eigen::SparseMatrix<double, Eigen::ColMajor, int32_t>;
  SparseMatrix() = default;
  SparseMatrix(Eigen::Index rows, Eigen::Index columns) : SparseMatrix() { resize(rows, columns); }
  SparseMatrix(const SparseMatrix& other) : SparseMatrix() { Base::operator=(other); }
  SparseMatrix(SparseMatrix&& other) : SparseMatrix() { swap(other); }
  template <class Expression>
  SparseMatrix(const Eigen::EigenBase<Expression>& other) : SparseMatrix() {
    Base::operator=(other.derived());
  }
  ~SparseMatrix() = default;
  SparseMatrix& operator=(const SparseMatrix& other) { return Base::operator=(other), *this; }
  SparseMatrix& operator=(SparseMatrix&& other) noexcept { return swap(other), *this; }
};

}  // namespace focal
