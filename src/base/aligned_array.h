// Uninitialised scratch memory aligned to a cache line, where the widest vector loads are fastest.
#pragma once
#include <cstddef>
#include <memory>
#include <new>

namespace focal {

template <class T>
class AlignedArray {
 public:
  AlignedArray() = default;
  explicit AlignedArray(size_t count)
      : data_(static_cast<T*>(::operator new(count * sizeof(T), std::align_val_t(64)))), size_(count) {}
  T* data() const { return data_.get(); }
  size_t size() const { return size_; }

 private:
  struct Free {
    void operator()(T* data) const { ::operator delete(data, std::align_val_t(64)); }
  };
  std::unique_ptr<T, Free> data_;
  size_t size_ = 0;
};

}  // namespace focal
