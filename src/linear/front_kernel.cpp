// Register-tiled loops. The order of every sum does not depend on the vector width, so all versions give the
// same bits.
#include "linear/front_kernel.h"

#include <algorithm>
#include <cmath>

#include "base/multiversion.h"

namespace focal {
namespace {

// Subtracts from rows [row, row + height) of the front, from column `from` on, the products of the eliminated
// rows [begin, end).
template <int vector_bytes, int height>
FOCAL_INLINE void update_rows(double* front, int64_t stride, int64_t begin, int64_t end, int64_t row) {
  typedef double Lane __attribute__((vector_size(vector_bytes), may_alias));
  constexpr int width = vector_bytes == 16 ? 4 : 8, vectors = width * int{sizeof(double)} / vector_bytes;
  for (int64_t j = row / width * width; j < stride; j += width) {
    Lane sum[height][vectors];
    const auto target = [&](int h) { return reinterpret_cast<Lane*>(front + (row + h) * stride + j); };
    for (int h = 0; h < height; ++h)
      for (int v = 0; v < vectors; ++v) sum[h][v] = target(h)[v];
    for (int64_t k = begin; k < end; ++k) {
      const double* factor = front + k * stride + row;
      const Lane* source = reinterpret_cast<const Lane*>(front + k * stride + j);
      for (int h = 0; h < height; ++h)
        for (int v = 0; v < vectors; ++v) sum[h][v] -= factor[h] * source[v];
    }
    for (int h = 0; h < height; ++h)
      for (int v = 0; v < vectors; ++v) target(h)[v] = sum[h][v];
  }
}

template <int vector_bytes>
FOCAL_INLINE void update_range(double* front, int64_t stride, int64_t begin, int64_t end, int64_t first,
                               int64_t last) {
  for (; first + 4 <= last; first += 4) update_rows<vector_bytes, 4>(front, stride, begin, end, first);
  for (; first < last; ++first) update_rows<vector_bytes, 1>(front, stride, begin, end, first);
}

template <int vector_bytes>
FOCAL_INLINE bool eliminate_body(double* front, int64_t size, int64_t stride, int64_t width) {
  constexpr int64_t step = 8;  // pivots eliminated before the following pivots are updated
  for (int64_t begin = 0; begin < width; begin += step) {
    const int64_t end = std::min(width, begin + step);
    for (int64_t k = begin; k < end; ++k) {
      update_range<vector_bytes>(front, stride, begin, k, k, k + 1);
      double* pivot = front + k * stride;
      if (!(pivot[k] > 0 && std::isfinite(pivot[k]))) return false;
      const double scale = 1 / std::sqrt(pivot[k]);
      for (int64_t j = k; j < size; ++j) pivot[j] *= scale;
    }
    update_range<vector_bytes>(front, stride, begin, end, end, width);
  }
  update_range<vector_bytes>(front, stride, 0, width, width, size);
  return true;
}

FOCAL_MULTIVERSION(bool eliminate_front(double* front, int64_t size, int64_t stride, int64_t width),
                   return eliminate_body<vector_bytes>(front, size, stride, width);)

}  // namespace

bool eliminate(double* front, int64_t size, int64_t stride, int64_t width) {
  return eliminate_front(front, size, stride, width);
}

}  // namespace focal
