// Functional maps on a device: see spectrum/functional_map.cpp, whose rounds these are.
#pragma once
#include "device/map_kernels.h"
#include "device/surface.h"

namespace focal {

namespace device_detail {

template <class Queue>
class MapRefinement {
 public:
  MapRefinement(DeviceSurface<Queue>& surface, const ComputeMap& map, const int32_t* vertex,
                const float* weight)
      : queue_(surface.queue),
        phi_(surface.eigenfunctions.data()),
        position_(surface.position.data()),
        n_(surface.n),
        stride_(map.eigenpairs),
        points_(map.points),
        most_(map.most),
        place_(queue_, map.place, int64_t{points_} * most_),
        weighted_(queue_, map.weighted, int64_t{points_} * most_),
        whitening_(queue_, map.whitening, int64_t{most_} * most_),
        spread_rows_(queue_, int64_t{map.spread_count} * most_),
        C_(queue_, int64_t{most_} * most_),
        product_(queue_, int64_t{most_} * most_),
        at_images_(queue_, int64_t{points_} * most_),
        spread_(queue_, map.spread, map.spread_count),
        image_(queue_, points_),
        vertex_(queue_, vertex, int64_t{points_} * GatherBetween::between),
        weight_(queue_, weight, int64_t{points_} * GatherBetween::between) {
    queue_.launch(spread_rows_.size(), GatherRow{phi_, spread_.data(), spread_rows_.data(), stride_, most_});
  }

  // C = (place^T W place)^-1 place^T W Phi(images): the least-squares fit.
  void fit(int32_t k) {
    queue_.launch(int64_t{points_} * k,
                  GatherBetween{phi_, vertex_.data(), weight_.data(), at_images_.data(), stride_, k});
    queue_.multiply('N', 'T', k, k, points_, 1.0f, weighted_.data(), most_, at_images_.data(), k, 0.0f,
                    C_.data(), k);
    queue_.multiply('N', 'N', k, k, k, 1.0f, whitening_.data(), most_, C_.data(), k, 0.0f, product_.data(),
                    k);
    queue_.multiply('T', 'N', k, k, k, 1.0f, whitening_.data(), most_, product_.data(), k, 0.0f, C_.data(),
                    k);
  }
  void assign_spread(int32_t k) {
    assign(k, spread_rows_.data(), most_, static_cast<int32_t>(spread_.size()), spread_.data(), 0);
  }
  void assign_all(int32_t k, int32_t first) { assign(k, phi_, stride_, n_, nullptr, first); }

  void finish(int32_t* vertex, float* weight, float* C, double* error) {
    queue_.launch(at_images_.size(), GatherRow{phi_, image_.data(), at_images_.data(), stride_, most_});
    const Array<float> embedded(queue_, at_images_.size());
    const Array<double> errors(queue_, int64_t{2} * points_);
    queue_.multiply('N', 'N', most_, points_, most_, 1.0f, C_.data(), most_, at_images_.data(), most_, 0.0f,
                    embedded.data(), most_);
    queue_.launch(points_, MapError{place_.data(), embedded.data(), errors.data(), most_, most_});
    errors.download(error, errors.size());
    vertex_.download(vertex, vertex_.size()), weight_.download(weight, weight_.size());
    C_.download(C, C_.size());
  }

 private:
  template <class T>
  using Array = DeviceArray<T, Queue>;

  // Of each point from `first` on, the nearest targets in the embedding of the points.
  void assign(int32_t k, const float* rows, int32_t row_stride, int32_t targets, const int32_t* numbers,
              int32_t first) {
    const int32_t points = points_ - first;
    const int32_t chunks = (targets + NearestInChunk::length - 1) / NearestInChunk::length;
    const Array<float> moved(queue_, int64_t{targets} * k), half(queue_, targets),
        product(queue_, int64_t{targets} * points), best(queue_, int64_t{chunks} * NearestFew::kept * points);
    const Array<int32_t> target(queue_, best.size());
    queue_.multiply('N', 'N', k, targets, k, 1.0f, C_.data(), k, rows, row_stride, 0.0f, moved.data(), k);
    queue_.launch(targets, HalfSquare{moved.data(), half.data(), k});
    queue_.multiply('T', 'N', points, targets, k, 1.0f, place_.data() + int64_t{first} * most_, most_,
                    moved.data(), k, 0.0f, product.data(), points);
    queue_.launch(int64_t{chunks} * points,
                  NearestInChunk{product.data(), half.data(), best.data(), target.data(), points, targets});
    queue_.launch(points,
                  NearestOfAll{position_, best.data(), target.data(), numbers, image_.data() + first,
                               vertex_.data() + int64_t{first} * GatherBetween::between,
                               weight_.data() + int64_t{first} * GatherBetween::between, points, chunks});
  }

  Queue& queue_;
  const float* phi_;
  const double* position_;
  int32_t n_, stride_, points_, most_;
  Array<float> place_, weighted_, whitening_, spread_rows_, C_, product_, at_images_;
  Array<int32_t> spread_, image_, vertex_;
  Array<float> weight_;
};

}  // namespace device_detail

template <class Queue>
void zoom_out(DeviceSurface<Queue>& surface, const ComputeMap& map, int32_t* image, float* weight, float* C,
              double* error) {
  if (!surface.eigenfunctions.data())
    surface.eigenfunctions = uploaded(surface.queue, map.eigenfunctions, int64_t{surface.n} * map.eigenpairs);
  const double P = map.points, k = map.most, T = map.spread_count, rounds = (k - map.first) / map.step + 1;
  const double exact = map.exact_from < map.points ? 2 * k * (P - map.exact_from + k) * surface.n : 0;
  surface.clock.time("maps", rounds * k * k * (2 * P + T) + rounds * k * P * T + exact,
                     rounds * 4 * (P + T) * (k + 16), [&] {  // on average half of the eigenfunctions a round
                       device_detail::MapRefinement<Queue> refinement(surface, map, image, weight);
                       int32_t round = map.first < map.most ? map.first : map.most;
                       for (; refinement.fit(round), round < map.most;
                            round = std::min(round + map.step, map.most))
                         refinement.assign_spread(round);
                       if (map.exact_from > 0) refinement.assign_spread(map.most);
                       if (map.exact_from < map.points) refinement.assign_all(map.most, map.exact_from);
                       refinement.finish(image, weight, C, error);
                     });
}

}  // namespace focal
