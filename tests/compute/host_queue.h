// A device that is none: the kernels in loops, linear algebra by Eigen. It can be told to fail.
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "device/array.h"
#include "host_faults.h"

namespace focal_test {

class HostQueue {
 public:
  using Mark = std::chrono::steady_clock::time_point;
  struct Scope {
    explicit Scope(int32_t) {}
  };

  static int32_t open(int32_t index, char* name, int32_t name_size) {
    if (host_faults.opening) throw focal::DeviceFailure{true, "the host's device was told to stay shut"};
    std::strncpy(name, "a device played by the host", static_cast<size_t>(name_size) - 1);
    return index;
  }
  explicit HostQueue(int32_t) {}
  bool works() const { return works_; }

  void* allocate(size_t bytes) {
    ++host_faults.allocations;
    fail_at_zero(host_faults.allocation, "out of device memory");
    auto* block = static_cast<size_t*>(std::malloc(bytes + 64));
    if (!block) throw focal::DeviceFailure{false, "out of device memory"};
    *block = bytes;
    host_faults.live += static_cast<int64_t>(bytes);
    std::memset(block + 8, 0xFF, bytes);  // NaNs: nothing may count on fresh memory
    return block + 8;
  }
  void release(void* at) noexcept {
    auto* block = static_cast<size_t*>(at) - 8;
    host_faults.live -= static_cast<int64_t>(*block);
    std::free(block);
  }
  void upload(void* to, const void* from, size_t bytes) {
    if (bytes > 0) std::memcpy(to, from, bytes);
  }
  void download(void* to, const void* from, size_t bytes) {
    ++host_faults.downloads;
    if (bytes > 0) std::memcpy(to, from, bytes);
    if (host_faults.download >= 0 && --host_faults.download < 0) std::memset(to, 0xFF, bytes);
  }

  template <class Kernel>
  void launch(int64_t count, const Kernel& kernel) {
    ++host_faults.launches;
    fail_at_zero(host_faults.launch, "a launch failed");
    for (int64_t i = count - 1; i >= 0; --i) kernel(i);  // backwards: no call may count on another
  }

  template <class T>
  void multiply(char a, char b, int32_t m, int32_t n, int32_t k, T alpha, const T* A, int32_t lda, const T* B,
                int32_t ldb, T beta, T* C, int32_t ldc) {
    using Dense = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
    using Stride = Eigen::OuterStride<>;
    const Eigen::Map<const Dense, 0, Stride> left(A, a == 'N' ? m : k, a == 'N' ? k : m, Stride(lda));
    const Eigen::Map<const Dense, 0, Stride> right(B, b == 'N' ? k : n, b == 'N' ? n : k, Stride(ldb));
    Eigen::Map<Dense, 0, Stride> result(C, m, n, Stride(ldc));
    if (beta == 0)
      result.setZero();  // whatever was there
    else
      result *= beta;
    if (a == 'N' && b == 'N') result.noalias() += alpha * left * right;
    if (a == 'T' && b == 'N') result.noalias() += alpha * left.transpose() * right;
    if (a == 'N' && b == 'T') result.noalias() += alpha * left * right.transpose();
  }
  void invert(double* A, int32_t n) {
    auto all = square(A, n);
    const Eigen::LLT<Eigen::MatrixXd> factor(all);
    require(factor.info() == Eigen::Success);
    all = factor.solve(Eigen::MatrixXd::Identity(n, n));
  }
  void cholesky(double* A, int32_t n) {
    auto all = square(A, n);
    const Eigen::LLT<Eigen::MatrixXd> factor(all);
    require(factor.info() == Eigen::Success);
    all.triangularView<Eigen::Lower>() = factor.matrixL();
  }
  void solve_lower(const double* L, int32_t m, double* X, int32_t n) {
    Eigen::Map<Eigen::MatrixXd> columns(X, m, n);
    Eigen::Map<const Eigen::MatrixXd>(L, m, m).triangularView<Eigen::Lower>().solveInPlace(columns);
  }
  void symmetric_eigen(double* A, int32_t m, double* lambda) {
    auto all = square(A, m);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(all);
    require(solver.info() == Eigen::Success);
    all = solver.eigenvectors();
    Eigen::Map<Eigen::VectorXd>(lambda, m) = solver.eigenvalues();
  }

  Mark mark() { return std::chrono::steady_clock::now(); }
  static double milliseconds(const Mark& begin, const Mark& end) {
    return std::chrono::duration<double, std::milli>(end - begin).count();
  }

 private:
  static Eigen::Map<Eigen::MatrixXd> square(double* A, int32_t n) { return {A, n, n}; }
  static void require(bool holds) {
    if (!holds) throw focal::DeviceFailure{false, "a matrix is not positive definite"};
  }
  void fail_at_zero(std::atomic<int64_t>& counter, const char* reason) {
    if (counter < 0 || --counter >= 0) return;
    works_ = !host_faults.lasting;
    throw focal::DeviceFailure{host_faults.lasting, reason};
  }
  bool works_ = true;
};

}  // namespace focal_test
