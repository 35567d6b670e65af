// One surface on a device: its operators, dense inverses of the two matrices of the heat method, and what is made of them.
// A few thousand vertices: a dense inverse turns every solve into a matrix product, or into the reading of a column.
#pragma once
#include <algorithm>
#include <vector>

#include "compute/backend.h"
#include "device/array.h"
#include "device/kernels.h"

namespace focal {

// Times of the stages, and the floors of their work.
template <class Queue>
class StageClock {
 public:
  explicit StageClock(Queue& queue) : queue_(queue) {}
  template <class Work>
  void time(const char* name, double flops, double bytes, const Work& work) {
    const auto begin = queue_.mark();
    work();
    if (stages_.size() < most) stages_.push_back({name, flops, bytes, begin, queue_.mark()});
  }
  int32_t report(ComputeStage* out, int32_t room) {
    int32_t count = 0;
    for (const Timed& stage : stages_) {
      if (count == room) break;
      ComputeStage& to = out[count++] = {};
      for (size_t i = 0; i + 1 < sizeof to.name && stage.name[i]; ++i) to.name[i] = stage.name[i];
      to.milliseconds = Queue::milliseconds(stage.begin, stage.end);
      to.flops = stage.flops, to.bytes = stage.bytes;
    }
    stages_.clear();
    return count;
  }

 private:
  static constexpr size_t most = 64;  // a surface that nobody asks for its times
  struct Timed {
    const char* name;
    double flops, bytes;
    typename Queue::Mark begin, end;
  };
  Queue& queue_;
  std::vector<Timed> stages_;
};

template <class Queue>
struct DeviceSurface {
  template <class T>
  using Array = DeviceArray<T, Queue>;

  DeviceSurface(Queue& queue_, const ComputeSurface& from);
  DeviceSurface(const DeviceSurface&) = delete;

  SparseColumns laplacian() const { return {column_start.data(), row.data(), value.data()}; }
  FaceTable faces() const { return {corner.data(), coefficient.data(), fan_start.data(), fan.data()}; }

  Queue& queue;
  StageClock<Queue> clock;
  int32_t n, face_count;
  double area, heat_time, norm_bound;
  bool keep_negative;
  Array<int32_t> column_start, row, corner, fan_start, fan;
  Array<double> value, mass, position;
  Array<float> coefficient;
  Array<double> heat_inverse;    // (M + t L)^-1, n x n
  Array<float> poisson_inverse;  // of L on what is orthogonal to the constant
  Array<double> phi;             // n x eigenpairs by rows, after the spectrum
  int32_t eigenpairs = 0;
  Array<float> votes;  // n x landmarks, after the last votes
  int32_t landmarks = 0;
  Array<float> eigenfunctions;  // as the caller has them, after the first map
};

// Distances are made so many sources at a time: their fields stay small.
inline constexpr int32_t sources_at_once = 256;

namespace device_detail {

struct Fans {
  std::vector<int32_t> start, entry;
};

inline Fans fans_of(const ComputeSurface& surface) {
  Fans fans{std::vector<int32_t>(static_cast<size_t>(surface.vertices) + 1),
            std::vector<int32_t>(static_cast<size_t>(surface.faces) * 3)};
  for (int32_t e = 0; e < 3 * surface.faces; ++e) ++fans.start[static_cast<size_t>(surface.corner[e]) + 1];
  for (size_t v = 1; v < fans.start.size(); ++v) fans.start[v] += fans.start[v - 1];
  std::vector<int32_t> next(fans.start.begin(), fans.start.end() - 1);
  for (int32_t e = 0; e < 3 * surface.faces; ++e)
    fans.entry[static_cast<size_t>(next[static_cast<size_t>(surface.corner[e])]++)] = e;
  return fans;
}

// Of M^-1/2 L M^-1/2: the largest sum of magnitudes of a column.
inline double norm_bound(const ComputeSurface& surface) {
  double largest = 0;
  for (int32_t j = 0; j < surface.vertices; ++j) {
    double sum = 0;
    for (int32_t e = surface.column_start[j]; e < surface.column_start[j + 1]; ++e)
      sum += fabs(surface.value[e]) / sqrt(surface.mass[j] * surface.mass[surface.row[e]]);
    largest = std::max(largest, sum);
  }
  return largest;
}

template <class Queue>
DeviceArray<double, Queue> inverse_of(const DeviceSurface<Queue>& surface, double scale, double diagonal,
                                      double rank_one) {
  const int32_t n = surface.n;
  DeviceArray<double, Queue> A(surface.queue, int64_t{n} * n);
  surface.queue.launch(int64_t{n} * n, DenseMass{surface.mass.data(), A.data(), diagonal, rank_one, n});
  surface.queue.launch(n, AddSparseColumn{surface.laplacian(), A.data(), scale, n});
  surface.queue.invert(A.data(), n);
  return A;
}

}  // namespace device_detail

template <class Queue>
DeviceSurface<Queue>::DeviceSurface(Queue& queue_, const ComputeSurface& from)
    : queue(queue_),
      clock(queue_),
      n(from.vertices),
      face_count(from.faces),
      area(from.area),
      heat_time(from.heat_time),
      norm_bound(device_detail::norm_bound(from)),
      keep_negative(from.keep_negative_heat != 0) {
  const double N = n, entries = N * N;
  const auto nonzeros = from.column_start[n];
  clock.time("upload", 0, nonzeros * 12.0 + face_count * 40.0 + n * 32.0, [&] {
    const auto fans = device_detail::fans_of(from);
    column_start = uploaded(queue, from.column_start, n + 1), row = uploaded(queue, from.row, nonzeros);
    value = uploaded(queue, from.value, nonzeros), mass = uploaded(queue, from.mass, n);
    position = uploaded(queue, from.position, int64_t{3} * n);
    corner = uploaded(queue, from.corner, int64_t{3} * face_count);
    coefficient = uploaded(queue, from.coefficient, int64_t{4} * face_count);
    fan_start = uploaded(queue, fans.start.data(), n + 1),
    fan = uploaded(queue, fans.entry.data(), int64_t{3} * face_count);
  });
  clock.time("heat inverse", N * N * N, 16 * entries,
             [&] { heat_inverse = device_detail::inverse_of(*this, heat_time, 1, 0); });
  // The constant is lifted to the size of the others, so that float holds the inverse; where parts are apart, each has a
  // constant of its own.
  clock.time("Poisson inverse", N * N * N, 20 * entries, [&] {
    const auto inverse = device_detail::inverse_of(*this, 1, 1e-6 / area, 10 / (area * area));
    poisson_inverse = {queue, int64_t{n} * n};
    queue.launch(int64_t{n} * n, ToFloat{inverse.data(), poisson_inverse.data()});
  });
}

// Sources on the device, from what the caller gives or from vertices.
template <class Queue>
struct DeviceSources {
  DeviceArray<int32_t, Queue> vertex;
  DeviceArray<double, Queue> weight;
  DeviceArray<float, Queue> corner_distance;
  Sources table() const { return {vertex.data(), weight.data(), corner_distance.data()}; }
};

template <class Queue>
DeviceSources<Queue> upload_sources(Queue& queue, const ComputeSource* source, int32_t count) {
  std::vector<int32_t> vertex;
  std::vector<double> weight;
  std::vector<float> corner_distance;
  for (int32_t j = 0; j < count; ++j) {
    vertex.insert(vertex.end(), source[j].vertex, source[j].vertex + 3);
    weight.insert(weight.end(), source[j].weight, source[j].weight + 3);
    corner_distance.push_back(source[j].corner_distance);
  }
  return {{queue, vertex.data(), int64_t{3} * count},
          {queue, weight.data(), int64_t{3} * count},
          {queue, corner_distance.data(), count}};
}

// n x count by rows, of at most sources_at_once sources.
template <class Queue>
DeviceArray<float, Queue> distances_on_device(DeviceSurface<Queue>& surface, const ComputeSource* source,
                                              int32_t count) {
  Queue& queue = surface.queue;
  const int32_t n = surface.n;
  const int64_t entries = int64_t{n} * count;
  const auto sources = upload_sources(queue, source, count);
  DeviceArray<float, Queue> flow(queue, entries), distance(queue, entries), zero(queue, count);
  const double E = static_cast<double>(entries);
  surface.clock.time("heat", 70 * E, 4.0 * n * n + 12 * E, [&] {  // of the inverse, the sources' sectors
    const DeviceArray<double, Queue> heat(queue, entries);
    queue.launch(entries, HeatEntry{surface.heat_inverse.data(), sources.table(), heat.data(), n, count});
    queue.launch(entries, FlowEntry{surface.faces(), heat.data(), flow.data(), count, surface.keep_negative});
  });
  surface.clock.time("Poisson", 2 * E * n, 4.0 * n * n + 8 * E, [&] {
    queue.multiply('N', 'N', count, n, n, 1.0f, flow.data(), count, surface.poisson_inverse.data(), n, 0.0f,
                   distance.data(), count);
    queue.launch(count, ZeroLevel{distance.data(), sources.table(), zero.data(), count});
    queue.launch(entries, DistanceEntry{zero.data(), distance.data(), count});
  });
  return distance;
}

template <class Queue>
void distances(DeviceSurface<Queue>& surface, const ComputeSource* source, int32_t count, float* out) {
  if (count <= sources_at_once) {
    const auto result = distances_on_device(surface, source, count);
    result.download(out, result.size());
    return;
  }
  std::vector<float> part;
  for (int32_t first = 0; first < count; first += sources_at_once) {
    const int32_t some = std::min(sources_at_once, count - first);
    part.resize(static_cast<size_t>(surface.n) * static_cast<size_t>(some));
    distances(surface, source + first, some, part.data());
    for (int64_t v = 0; v < surface.n; ++v)
      std::copy_n(part.data() + v * some, some, out + v * count + first);
  }
}

}  // namespace focal
