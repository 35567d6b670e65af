// Bodies of the kernels of functional maps; see kernels.h.
#pragma once
#include "compute/device/kernels.h"

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

// The best target of each point among a chunk: place . target - |target|^2 / 2 is largest where the distance is smallest; the
// first of equal ones. Products: targets x points.
struct NearestInChunk {
  static constexpr int32_t length = 64;
  const float *product, *half;
  float* best;  // chunks x points
  int32_t* target;
  int32_t points, targets;
  FOCAL_HOST_DEVICE void operator()(int64_t at) const {
    const int64_t chunk = at / points, p = at % points;
    int64_t found = chunk * length;
    float most = product[found * points + p] - half[found];
    for (int64_t t = found + 1; t < targets && t < (chunk + 1) * length; ++t) {
      const float score = product[t * points + p] - half[t];
      if (score > most) most = score, found = t;
    }
    best[at] = most, target[at] = static_cast<int32_t>(found);
  }
};

struct NearestOfAll {
  const float* best;
  const int32_t *target, *spread;  // spread: numbers of the targets, or null
  int32_t* image;
  int32_t points, chunks;
  FOCAL_HOST_DEVICE void operator()(int64_t p) const {
    int64_t found = p;
    for (int64_t at = p + points; at < static_cast<int64_t>(chunks) * points; at += points)
      if (best[at] > best[found]) found = at;
    image[p] = spread ? spread[target[found]] : target[found];
  }
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
