// A stream of a CUDA device with what runs on it: kernels, cuBLAS, cuSOLVER, and a memory pool that no one else draws from.
#pragma once
#include <cublas_v2.h>
#include <cuda.h>
#include <cuda_runtime.h>
#include <cusolverDn.h>

#include <cstdint>
#include <memory>
#include <string>

#include "device/array.h"

namespace focal {

// Throws DeviceFailure unless the call went well. An error that outlives the call is lasting: the context is lost.
void check(cudaError_t status, const char* what);
void check(cublasStatus_t status, const char* what);
void check(cusolverStatus_t status, const char* what);

template <class Kernel>
__global__ void run_kernel(int64_t count, Kernel kernel) {
  const int64_t i = static_cast<int64_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (i < count) kernel(i);
}

class CudaQueue {
 public:
  using Mark = std::shared_ptr<CUevent_st>;

  // The calling thread works on the device while this lives; then the host's own context is current again.
  class Scope {
   public:
    explicit Scope(int32_t device);
    ~Scope();
    Scope(const Scope&) = delete;

   private:
    CUcontext before_ = nullptr;
  };

  static int32_t open(int32_t index, char* name, int32_t name_size);
  explicit CudaQueue(int32_t device);
  CudaQueue(const CudaQueue&) = delete;
  bool works() const { return works_; }

  void* allocate(size_t bytes);
  void release(void* at) noexcept;
  void upload(void* to, const void* from, size_t bytes);
  void download(void* to, const void* from, size_t bytes);

  template <class Kernel>
  void launch(int64_t count, const Kernel& kernel) {
    constexpr int64_t threads = 256;
    if (count == 0) return;
    run_kernel<<<static_cast<unsigned>((count + threads - 1) / threads), threads, 0, on_.stream>>>(count,
                                                                                                   kernel);
    require(cudaGetLastError(), "a launch");
  }

  void multiply(char a, char b, int32_t m, int32_t n, int32_t k, double alpha, const double* A, int32_t lda,
                const double* B, int32_t ldb, double beta, double* C, int32_t ldc);
  void multiply(char a, char b, int32_t m, int32_t n, int32_t k, float alpha, const float* A, int32_t lda,
                const float* B, int32_t ldb, float beta, float* C, int32_t ldc);
  void invert(double* A, int32_t n);
  void cholesky(double* A, int32_t n);
  void solve_lower(const double* L, int32_t m, double* X, int32_t n);
  void symmetric_eigen(double* A, int32_t m, double* lambda);

  Mark mark();
  static double milliseconds(const Mark& begin, const Mark& end);

 private:
  struct Handles {  // given back also when the constructor fails half way
    cudaMemPool_t pool = nullptr;
    cudaStream_t stream = nullptr;
    cublasHandle_t blas = nullptr;
    cusolverDnHandle_t solver = nullptr;
    Handles() = default;
    Handles(const Handles&) = delete;
    ~Handles();
  };

  // As check, and remembers when the context is lost.
  template <class Status>
  void require(Status status, const char* what);
  // A cuSOLVER call with its work space; waits for its answer.
  template <class Call>
  void solve(const char* what, int work_size, const Call& call);

  bool works_ = true;
  Handles on_;
};

template <class Status>
void CudaQueue::require(Status status, const char* what) {
  try {
    check(status, what);
  } catch (const DeviceFailure& failure) {
    works_ = works_ && !failure.lasting;
    throw;
  }
}

}  // namespace focal
