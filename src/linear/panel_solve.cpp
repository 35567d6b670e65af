// The columns of a supernode share their rows, so a loaded row of X serves several rows or columns of the
// factor, whose sums stay in registers (E. Ng, B. Peyton, "Block sparse Cholesky algorithms on advanced
// uniprocessor computers", 1993).
#include "linear/panel_solve.h"

#include <algorithm>

#include "base/multiversion.h"

namespace focal {
namespace {

constexpr int lanes = 32;

// One supernode: entry (i, k) of the factor is at values[k * size + i]; rows i < width are its own.
template <class T>
struct Panel {
  const T* values;
  const T* inverse_diagonal;
  const int32_t* rows;
  int64_t width, size;
  T* own;    // of X: from the first own row on
  T* other;  // X
};

template <int vector_bytes_, class T_>
struct Tile {
  static constexpr int vector_bytes = vector_bytes_;
  using T = T_;
  typedef T Lane __attribute__((vector_size(vector_bytes), may_alias));
  static constexpr int vectors = std::min<int>(4, lanes * sizeof(T) / vector_bytes);
  static constexpr int lane_width = vectors * vector_bytes / int{sizeof(T)};
  static constexpr int height = vector_bytes == 64 ? 16 / vectors : 2;  // so that all sums stay in registers
};

// Calls visit.operator()<h>(begin) for steps of `height` from 0 to count, and smaller ones for the rest.
template <int height, class Visit>
FOCAL_INLINE void for_each_step(int64_t count, const Visit& visit) {
  int64_t i = 0;
  for (; i + height <= count; i += height) visit.template operator()<height>(i);
  if constexpr (height > 4)
    if (i + 4 <= count) visit.template operator()<4>(i), i += 4;
  if constexpr (height > 2)
    if (i + 2 <= count) visit.template operator()<2>(i), i += 2;
  if (i < count) visit.template operator()<1>(i);
}

// The same from the last step to the first.
template <int height, class Visit>
FOCAL_INLINE void for_each_step_back(int64_t count, const Visit& visit) {
  const int64_t whole = count / height * height;
  int64_t left = count - whole;
  if (left % 2) visit.template operator()<1>(whole + --left);
  if constexpr (height > 2)
    if (left % 4) visit.template operator()<2>(whole + (left -= 2));
  if constexpr (height > 4)
    if (left % 8) visit.template operator()<4>(whole + (left -= 4));
  for (int64_t i = whole - height; i >= 0; i -= height) visit.template operator()<height>(i);
}

// Subtracts from rows [i, i + h), at `row(i)`, their entries in the first `inner` columns; `finish` gets the
// sums last.
template <class Tile, int h, class Row, class Finish>
FOCAL_INLINE void forward_step(const Panel<typename Tile::T>& p, int64_t i, int64_t inner, int lane,
                               const Row& row, const Finish& finish) {
  using Lane = typename Tile::Lane;
  Lane sum[h][Tile::vectors];
  for (int r = 0; r < h; ++r)
    for (int v = 0; v < Tile::vectors; ++v) sum[r][v] = reinterpret_cast<const Lane*>(row(i + r))[v];
  const typename Tile::T* value = p.values + i;
  for (int64_t k = 0; k < inner; ++k, value += p.size) {
    const Lane* x = reinterpret_cast<const Lane*>(p.own + k * lanes + lane);
    for (int r = 0; r < h; ++r)
      for (int v = 0; v < Tile::vectors; ++v) sum[r][v] -= value[r] * x[v];
  }
  finish(sum);
  for (int r = 0; r < h; ++r)
    for (int v = 0; v < Tile::vectors; ++v) reinterpret_cast<Lane*>(row(i + r))[v] = sum[r][v];
}

template <class Tile>
FOCAL_INLINE void forward(const Panel<typename Tile::T>& p, int lane) {
  const auto own = [&](int64_t i) { return p.own + i * lanes + lane; };
  for_each_step<Tile::height>(
      p.width, [&]<int h>(int64_t i) __attribute__((always_inline)) {
        forward_step<Tile, h>(
            p, i, i, lane, own, [&](auto& sum) __attribute__((always_inline)) {
              for (int r = 0; r < h; ++r) {
                for (int l = 0; l < r; ++l)
                  for (int v = 0; v < Tile::vectors; ++v)
                    sum[r][v] -= p.values[(i + l) * p.size + i + r] * sum[l][v];
                for (int v = 0; v < Tile::vectors; ++v) sum[r][v] *= p.inverse_diagonal[i + r];
              }
            });
      });
  const auto below = [&](int64_t i) { return p.other + int64_t{p.rows[i - p.width]} * lanes + lane; };
  for_each_step<Tile::height>(
      p.size - p.width, [&]<int h>(int64_t i) __attribute__((always_inline)) {
        forward_step<Tile, h>(p, p.width + i, p.width, lane, below, [](auto&) {});
      });
}

// For columns [k, k + h): their rows of X minus the entries below them. Few columns have several sums each,
// to hide the latency of the subtraction.
template <class Tile, int h>
FOCAL_INLINE void backward_step(const Panel<typename Tile::T>& p, int64_t k, int lane) {
  using Lane = typename Tile::Lane;
  constexpr int parts = h == 1 ? 2 : 1;
  Lane sum[h][parts][Tile::vectors] = {};
  const auto own = [&](int64_t i) { return reinterpret_cast<Lane*>(p.own + i * lanes + lane); };
  for (int r = 0; r < h; ++r)
    for (int v = 0; v < Tile::vectors; ++v) sum[r][0][v] = own(k + r)[v];
  const typename Tile::T* value = p.values + k * p.size;
  for (int64_t i = k + h; i < p.width; ++i)
    for (int r = 0; r < h; ++r)
      for (int v = 0; v < Tile::vectors; ++v) sum[r][0][v] -= value[r * p.size + i] * own(i)[v];
  int64_t i = p.width;
  for (; i + parts <= p.size; i += parts)
    for (int part = 0; part < parts; ++part) {
      const Lane* x =
          reinterpret_cast<const Lane*>(p.other + int64_t{p.rows[i + part - p.width]} * lanes + lane);
      for (int r = 0; r < h; ++r)
        for (int v = 0; v < Tile::vectors; ++v) sum[r][part][v] -= value[r * p.size + i + part] * x[v];
    }
  for (; i < p.size; ++i) {
    const Lane* x = reinterpret_cast<const Lane*>(p.other + int64_t{p.rows[i - p.width]} * lanes + lane);
    for (int r = 0; r < h; ++r)
      for (int v = 0; v < Tile::vectors; ++v) sum[r][0][v] -= value[r * p.size + i] * x[v];
  }
  for (int r = h - 1; r >= 0; --r) {
    for (int part = 1; part < parts; ++part)
      for (int v = 0; v < Tile::vectors; ++v) sum[r][0][v] += sum[r][part][v];
    for (int l = r + 1; l < h; ++l)
      for (int v = 0; v < Tile::vectors; ++v) sum[r][0][v] -= value[r * p.size + k + l] * sum[l][0][v];
    for (int v = 0; v < Tile::vectors; ++v) own(k + r)[v] = sum[r][0][v] *= p.inverse_diagonal[k + r];
  }
}

template <class Tile>
FOCAL_INLINE void backward(const Panel<typename Tile::T>& p, int lane) {
  for_each_step_back<Tile::height>(
      p.width, [&]<int h>(int64_t k) __attribute__((always_inline)) { backward_step<Tile, h>(p, k, lane); });
}

// G X = B over the supernodes from first to last, then G^T X = B from last to first.
template <int vector_bytes, class T>
FOCAL_INLINE void solve_both(const Panels<T>& panels, T* X) {
  using Shape = Tile<vector_bytes, T>;
  const SymbolicFactor& symbolic = *panels.symbolic;
  const auto panel = [&](int32_t s) __attribute__((always_inline)) {
    const int32_t first = symbolic.first_column[s], width = symbolic.width(s);
    return Panel<T>{panels.values + symbolic.value_start[s],
                    panels.inverse_diagonal + first,
                    symbolic.rows.data() + symbolic.row_start[s],
                    width,
                    width + symbolic.row_count(s),
                    X + int64_t{first} * lanes,
                    X};
  };
  for (int32_t s = 0; s < symbolic.supernodes(); ++s)
    for (int lane = 0; lane < lanes; lane += Shape::lane_width) forward<Shape>(panel(s), lane);
  for (int32_t s = symbolic.supernodes() - 1; s >= 0; --s)
    for (int lane = 0; lane < lanes; lane += Shape::lane_width) backward<Shape>(panel(s), lane);
}

FOCAL_MULTIVERSION(void solve_lanes(const Panels<double>& panels, double* X),
                   solve_both<vector_bytes>(panels, X);)
FOCAL_MULTIVERSION(void solve_lanes(const Panels<float>& panels, float* X),
                   solve_both<vector_bytes>(panels, X);)

}  // namespace

void solve_panels(const Panels<double>& panels, double* X) { solve_lanes(panels, X); }
void solve_panels(const Panels<float>& panels, float* X) { solve_lanes(panels, X); }

}  // namespace focal
