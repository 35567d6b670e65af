#include <cstdio>
#include <map>
#include <mutex>
#include <utility>

#include "device/kernels.h"
#include "queue.h"

namespace focal {
namespace {

constexpr int oldest_capability = 75;
constexpr uint64_t kept_bytes = uint64_t{1} << 29;  // of freed memory a pool holds on to between calls

[[noreturn]] void fail(bool lasting, std::string reason) { throw DeviceFailure{lasting, std::move(reason)}; }

// The driver's functions without linking the driver, which may be missing.
template <class Function>
Function driver_function(const char* name) {
  void* function = nullptr;
  cudaDriverEntryPointQueryResult found;
#if CUDART_VERSION >= 12050
  const cudaError_t status =
      cudaGetDriverEntryPointByVersion(name, &function, 12000, cudaEnableDefault, &found);
#else
  const cudaError_t status = cudaGetDriverEntryPoint(name, &function, cudaEnableDefault, &found);
#endif
  check(status, name);
  if (found != cudaDriverEntryPointSuccess || !function) fail(true, std::string("the driver lacks ") + name);
  return reinterpret_cast<Function>(function);
}

struct Driver {
  CUresult (*get_current)(CUcontext*) = driver_function<CUresult (*)(CUcontext*)>("cuCtxGetCurrent");
  CUresult (*set_current)(CUcontext) = driver_function<CUresult (*)(CUcontext)>("cuCtxSetCurrent");
  CUresult (*device)(CUdevice*, int) = driver_function<CUresult (*)(CUdevice*, int)>("cuDeviceGet");
  CUresult (*retain)(CUcontext*, CUdevice) =
      driver_function<CUresult (*)(CUcontext*, CUdevice)>("cuDevicePrimaryCtxRetain");
};
const Driver& driver() {
  static const Driver functions;
  return functions;
}

struct Probe {
  double* at;
  FOCAL_HOST_DEVICE void operator()(int64_t) const { *at = 4; }
};

// By columns: what is above the diagonal becomes what is below it.
struct MirrorLower {
  double* A;
  int64_t n;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t i = at % n, j = at / n;
    if (i < j) A[at] = A[i * n + j];
  }
};

// The context that the CUDA runtime uses too, of this module and of the host: retained once, never reset.
CUcontext primary_context(int32_t index) {
  static std::mutex mutex;
  static std::map<int32_t, CUcontext> retained;
  const std::scoped_lock lock(mutex);
  CUcontext& context = retained[index];
  CUdevice device = 0;
  if (!context &&
      (driver().device(&device, index) != CUDA_SUCCESS || driver().retain(&context, device) != CUDA_SUCCESS))
    fail(false, "the device's context cannot be had");
  return context;
}

cublasOperation_t operation(char letter) { return letter == 'T' ? CUBLAS_OP_T : CUBLAS_OP_N; }

}  // namespace

void check(cudaError_t status, const char* what) {
  if (status == cudaSuccess) return;
  // The error is taken away so that the host never sees it. One that comes back has broken the context.
  cudaGetLastError();
  const bool lasting = status != cudaErrorMemoryAllocation && cudaDeviceSynchronize() != cudaSuccess;
  cudaGetLastError();
  fail(lasting, std::string(what) + " failed: " + cudaGetErrorString(status));
}

void check(cublasStatus_t status, const char* what) {
  if (status == CUBLAS_STATUS_SUCCESS) return;
  check(cudaGetLastError(), what);
  fail(false, std::string(what) + " failed: " + cublasGetStatusString(status));
}

void check(cusolverStatus_t status, const char* what) {
  if (status == CUSOLVER_STATUS_SUCCESS) return;
  check(cudaGetLastError(), what);
  fail(false, std::string(what) + " failed: cuSOLVER status " + std::to_string(status));
}

CudaQueue::Scope::Scope(int32_t device) {
  const CUcontext context = primary_context(device);
  driver().get_current(&before_);
  if (driver().set_current(context) != CUDA_SUCCESS)
    fail(false, "the device's context cannot be made current");
}

CudaQueue::Scope::~Scope() { driver().set_current(before_); }

int32_t CudaQueue::open(int32_t index, char* name, int32_t name_size) {
  cudaDeviceProp properties;
  check(cudaGetDeviceProperties(&properties, index), "looking at the device");
  if (properties.major * 10 + properties.minor < oldest_capability)
    fail(true, std::string(properties.name) + " is too old: compute capability 7.5 is needed");
  int pools = 0;
  check(cudaDeviceGetAttribute(&pools, cudaDevAttrMemoryPoolsSupported, index), "looking at the device");
  if (!pools) fail(true, std::string(properties.name) + " has no memory pools");
  const Scope scope(index);
  CudaQueue queue(index);  // the libraries work, and kernels of this module run on the device
  const DeviceArray<double, CudaQueue> probe(queue, 1);
  double result = 0;
  queue.launch(1, Probe{probe.data()});
  queue.invert(probe.data(), 1);
  probe.download(&result, 1);
  if (result != 0.25) fail(true, std::string(properties.name) + " computes wrong results");
  std::snprintf(name, static_cast<size_t>(name_size), "%s, %.0f GiB", properties.name,
                static_cast<double>(properties.totalGlobalMem) / (1 << 30));
  return index;
}

CudaQueue::CudaQueue(int32_t device) {
  cudaMemPoolProps properties = {};
  properties.allocType = cudaMemAllocationTypePinned;
  properties.location.type = cudaMemLocationTypeDevice;
  properties.location.id = device;
  require(cudaMemPoolCreate(&on_.pool, &properties), "making a memory pool");
  uint64_t threshold = kept_bytes;
  require(cudaMemPoolSetAttribute(on_.pool, cudaMemPoolAttrReleaseThreshold, &threshold),
          "making a memory pool");
  require(cudaStreamCreateWithFlags(&on_.stream, cudaStreamNonBlocking), "making a stream");
  require(cublasCreate(&on_.blas), "starting cuBLAS");
  require(cublasSetStream(on_.blas, on_.stream), "starting cuBLAS");
  require(cusolverDnCreate(&on_.solver), "starting cuSOLVER");
  require(cusolverDnSetStream(on_.solver, on_.stream), "starting cuSOLVER");
}

CudaQueue::Handles::~Handles() {
  if (solver) cusolverDnDestroy(solver);
  if (blas) cublasDestroy(blas);
  if (stream) cudaStreamDestroy(stream);
  if (pool) cudaMemPoolDestroy(pool);
  cudaGetLastError();
}

void* CudaQueue::allocate(size_t bytes) {
  void* at = nullptr;
  require(cudaMallocFromPoolAsync(&at, bytes > 0 ? bytes : 1, on_.pool, on_.stream),
          "allocation on the device");
  return at;
}

void CudaQueue::release(void* at) noexcept {
  if (cudaFreeAsync(at, on_.stream) != cudaSuccess) cudaGetLastError();
}

void CudaQueue::upload(void* to, const void* from, size_t bytes) {
  require(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, on_.stream), "an upload");
}

void CudaQueue::download(void* to, const void* from, size_t bytes) {
  require(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, on_.stream), "a download");
  require(cudaStreamSynchronize(on_.stream), "the work on the device");
}

void CudaQueue::multiply(char a, char b, int32_t m, int32_t n, int32_t k, double alpha, const double* A,
                         int32_t lda, const double* B, int32_t ldb, double beta, double* C, int32_t ldc) {
  require(cublasDgemm(on_.blas, operation(a), operation(b), m, n, k, &alpha, A, lda, B, ldb, &beta, C, ldc),
          "a matrix product");
}

void CudaQueue::multiply(char a, char b, int32_t m, int32_t n, int32_t k, float alpha, const float* A,
                         int32_t lda, const float* B, int32_t ldb, float beta, float* C, int32_t ldc) {
  require(cublasSgemm(on_.blas, operation(a), operation(b), m, n, k, &alpha, A, lda, B, ldb, &beta, C, ldc),
          "a matrix product");
}

template <class Call>
void CudaQueue::solve(const char* what, int work_size, const Call& call) {
  const DeviceArray<double, CudaQueue> work(*this, work_size);
  const DeviceArray<int, CudaQueue> info(*this, 1);
  require(call(work.data(), info.data()), what);
  int failed = 0;
  info.download(&failed, 1);
  if (failed != 0) fail(false, std::string(what) + " found a matrix that does not suit");
}

void CudaQueue::cholesky(double* A, int32_t n) {
  int size = 0;
  require(cusolverDnDpotrf_bufferSize(on_.solver, CUBLAS_FILL_MODE_LOWER, n, A, n, &size),
          "a Cholesky factor");
  solve("a Cholesky factor", size, [&](double* work, int* info) {
    return cusolverDnDpotrf(on_.solver, CUBLAS_FILL_MODE_LOWER, n, A, n, work, size, info);
  });
}

void CudaQueue::invert(double* A, int32_t n) {
  cholesky(A, n);
  int size = 0;
  require(cusolverDnDpotri_bufferSize(on_.solver, CUBLAS_FILL_MODE_LOWER, n, A, n, &size), "an inverse");
  solve("an inverse", size, [&](double* work, int* info) {
    return cusolverDnDpotri(on_.solver, CUBLAS_FILL_MODE_LOWER, n, A, n, work, size, info);
  });
  launch(int64_t{n} * n, MirrorLower{A, n});
}

void CudaQueue::solve_lower(const double* L, int32_t m, double* X, int32_t n) {
  const double one = 1;
  require(cublasDtrsm(on_.blas, CUBLAS_SIDE_LEFT, CUBLAS_FILL_MODE_LOWER, CUBLAS_OP_N, CUBLAS_DIAG_NON_UNIT,
                      m, n, &one, L, m, X, m),
          "a triangular solve");
}

void CudaQueue::symmetric_eigen(double* A, int32_t m, double* lambda) {
  int size = 0;
  require(cusolverDnDsyevd_bufferSize(on_.solver, CUSOLVER_EIG_MODE_VECTOR, CUBLAS_FILL_MODE_LOWER, m, A, m,
                                      lambda, &size),
          "eigenpairs");
  solve("eigenpairs", size, [&](double* work, int* info) {
    return cusolverDnDsyevd(on_.solver, CUSOLVER_EIG_MODE_VECTOR, CUBLAS_FILL_MODE_LOWER, m, A, m, lambda,
                            work, size, info);
  });
}

CudaQueue::Mark CudaQueue::mark() {
  cudaEvent_t event = nullptr;
  require(cudaEventCreate(&event), "an event");
  Mark result(event, cudaEventDestroy);
  require(cudaEventRecord(event, on_.stream), "an event");
  return result;
}

double CudaQueue::milliseconds(const Mark& begin, const Mark& end) {
  float passed = 0;
  if (cudaEventSynchronize(end.get()) != cudaSuccess ||
      cudaEventElapsedTime(&passed, begin.get(), end.get()) != cudaSuccess)
    cudaGetLastError();
  return static_cast<double>(passed);
}

}  // namespace focal
