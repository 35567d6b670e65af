// Bodies of the kernels of functional maps; see kernels.h.
#pragma once
#include "device/kernels.h"

namespace focal {

// ---- Functional maps (see spectrum/functional_map.cpp)

struct GatherRow {  // the first columns of some rows
  const float* from;
  const int32_t* row;
  float* to;
  int32_t stride, columns;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    to[at] = from[static_cast<int64_t>(row[at / columns]) * stride + at % columns];
  }
};

struct GatherBetween {  // the first columns of places between rows
  static constexpr int32_t between = 3;
  const float* from;
  const int32_t* row;   // places x between
  const float* weight;  // the same
  float* to;
  int32_t stride, columns;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t first = at / columns * between;
    float sum = 0;
    for (int32_t i = 0; i < between; ++i)
      sum += weight[first + i] * from[static_cast<int64_t>(row[first + i]) * stride + at % columns];
    to[at] = sum;
  }
};

struct HalfSquare {  // of the length of a row
  const float* rows;
  float* half;
  int32_t columns;
  FOCAL_HOST_DEVICE void operator()(int64_t t) const {
    float sum = 0;
    for (int32_t c = 0; c < columns; ++c) sum += rows[t * columns + c] * rows[t * columns + c];
    half[t] = sum / 2;
  }
};

// The best targets of a point so far, as NearestFew in functional_map.cpp.
struct NearestFew {
  static constexpr int32_t kept = GatherBetween::between + 1;
  static constexpr float worst = -3.402823466e38F;
  float score[kept];
  int32_t target[kept];

  FOCAL_HOST_DEVICE explicit NearestFew(int32_t first) {  // stands in where there are no numbers
    for (int32_t i = 0; i < kept; ++i) score[i] = worst, target[i] = first;
  }
  FOCAL_HOST_DEVICE void add(float next, int32_t number) {
    if (!(next > score[kept - 1])) return;
    int32_t at = kept - 1;
    for (; at > 0 && next > score[at - 1]; --at) score[at] = score[at - 1], target[at] = target[at - 1];
    score[at] = next, target[at] = number;
  }
  template <class Near>
  FOCAL_HOST_DEVICE void weigh(float* weight, const Near& near) const {
    int32_t last = kept - 1;
    while (last > 0 && score[last] == worst) --last;
    float sum = 0;
    for (int32_t i = 0; i < kept - 1; ++i) {
      const float ahead = i < last ? score[i] - score[last] : 0;
      sum += weight[i] = ahead * ahead * near(i);
    }
    for (int32_t i = 0; i < kept - 1; ++i) weight[i] = sum > 0 ? weight[i] / sum : static_cast<float>(i == 0);
  }
};

// The best targets of each point among a chunk: place . target - |target|^2 / 2 is largest where the distance is smallest; the
// first of equal ones. Products: targets x points.
struct NearestInChunk {
  static constexpr int32_t length = 64;
  const float *product, *half;
  float* best;  // chunks x kept x points
  int32_t* target;
  int32_t points, targets;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t chunk = at / points, p = at % points;
    NearestFew few(static_cast<int32_t>(chunk * length));
    for (int64_t t = chunk * length; t < targets && t < (chunk + 1) * length; ++t)
      few.add(product[t * points + p] - half[t], static_cast<int32_t>(t));
    for (int64_t i = 0; i < NearestFew::kept; ++i) {
      const int64_t to = (chunk * NearestFew::kept + i) * points + p;
      best[to] = few.score[i], target[to] = few.target[i];
    }
  }
};

struct NearestOfAll {
  static constexpr double neighbourhood = 0.06;  // as in functional_map.cpp
  const double* position;                        // of all vertices, n x 3
  const float* best;
  const int32_t *target, *spread;  // spread: numbers of the targets, or null
  int32_t *image, *vertex;         // vertex, weight: what each point lies between, as in GatherBetween
  float* weight;
  int32_t points, chunks;
  FOCAL_HOST_DEVICE void operator()(int64_t p) const {
    NearestFew few(0);
    for (int64_t at = p; at < static_cast<int64_t>(chunks) * NearestFew::kept * points; at += points)
      few.add(best[at], target[at]);
    constexpr int32_t between = GatherBetween::between;
    int32_t* to = vertex + p * between;
    for (int32_t i = 0; i < between; ++i) to[i] = spread ? spread[few.target[i]] : few.target[i];
    few.weigh(weight + p * between, Near{position, to});
    image[p] = vertex[p * between];
  }

 private:
  struct Near {
    const double* position;
    const int32_t* vertex;
    FOCAL_HOST_DEVICE float operator()(int32_t i) const {
      double square = 0;
      for (int c = 0; c < 3; ++c) {
        const double apart = position[3 * int64_t{vertex[i]} + c] - position[3 * int64_t{vertex[0]} + c];
        square += apart * apart;
      }
      const double inside = 1 - square / (neighbourhood * neighbourhood);
      return static_cast<float>(inside > 0 ? inside * inside : 0);
    }
  };
};

struct MapError {
  const float *place, *image;  // points x stride, points x columns
  double* error;               // points x 2
  int32_t stride, columns;
  FOCAL_HOST_DEVICE void operator()(int64_t p) const {
    double away = 0, size = 0;
    for (int32_t c = 0; c < columns; ++c) {
      const double there = place[p * stride + c], off = there - image[p * columns + c];
      away += off * off, size += there * there;
    }
    error[2 * p] = away, error[2 * p + 1] = size;
  }
};

}  // namespace focal
