// What the stages need of a device, and memory on it. A Queue runs what it is given in order and offers:
//   void* allocate(size_t bytes);  void release(void*) noexcept;
//   void upload(void* to, const void* from, size_t bytes);
//   void download(void* to, const void* from, size_t bytes);      waits for all before
//   void launch(int64_t count, kernel);                           kernel(i) for i in [0, count)
//   void multiply(char a, char b, m, n, k, alpha, A, lda, B, ldb, beta, C, ldc);   as BLAS gemm, by columns
//   void invert(double* A, int32_t n);                            symmetric positive definite, whole
//   void cholesky(double* A, int32_t n);                          lower triangle
//   void solve_lower(const double* L, int32_t m, double* X, int32_t n);            X (m x n, by columns) <- L^-1 X
//   void symmetric_eigen(double* A, int32_t m, double* lambda);   A <- eigenvectors by columns, lambda ascending
//   Mark mark();  static double milliseconds(const Mark&, const Mark&);
// All of them throw DeviceFailure.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace focal {

struct DeviceFailure {
  bool lasting;
  std::string reason;
};

template <class T, class Queue>
class DeviceArray {
 public:
  DeviceArray() = default;
  DeviceArray(Queue& queue, int64_t size)
      : queue_(&queue),
        data_(static_cast<T*>(queue.allocate(static_cast<size_t>(size) * sizeof(T)))),
        size_(size) {}
  DeviceArray(Queue& queue, const T* from, int64_t size) : DeviceArray(queue, size) {
    queue.upload(data_, from, static_cast<size_t>(size) * sizeof(T));
  }
  DeviceArray(DeviceArray&& other) noexcept { swap(other); }
  DeviceArray& operator=(DeviceArray&& other) noexcept {
    swap(other);
    return *this;
  }
  ~DeviceArray() {
    if (data_) queue_->release(data_);
  }
  T* data() const { return data_; }
  int64_t size() const { return size_; }
  void download(T* to, int64_t count) const {
    queue_->download(to, data_, static_cast<size_t>(count) * sizeof(T));
  }

 private:
  void swap(DeviceArray& other) noexcept {
    std::swap(queue_, other.queue_), std::swap(data_, other.data_), std::swap(size_, other.size_);
  }
  Queue* queue_ = nullptr;
  T* data_ = nullptr;
  int64_t size_ = 0;
};

template <class T, class Queue>
DeviceArray<T, Queue> uploaded(Queue& queue, const T* from, int64_t size) {
  return DeviceArray<T, Queue>(queue, from, size);
}

}  // namespace focal
