// The forest on a device, and the votes of the leaves that samples reach.
#pragma once
#include "device/surface.h"
#include "device/vote_kernels.h"

namespace focal {

template <class Queue>
struct DeviceForest {
  template <class T>
  using Array = DeviceArray<T, Queue>;

  DeviceForest(Queue& queue, const ComputeForest& from);
  DeviceForest(const DeviceForest&) = delete;

  ForestTable table() const {
    return {node_start.data(),
            leaf_start_start.data(),
            leaf_sample_start.data(),
            feature.data(),
            child.data(),
            threshold.data(),
            leaf_start.data(),
            leaf_sample.data(),
            target_bin.data(),
            trees,
            landmarks,
            bins,
            half,
            kernel.data(),
            decay.data()};
  }

  int32_t trees, landmarks, components, bins, half;
  double bin_width;
  Array<int32_t> node_start, leaf_start_start, leaf_sample_start, feature, child, leaf_start, leaf_sample;
  Array<float> threshold, kernel, decay;
  Array<uint16_t> target_bin;
};

template <class Queue>
DeviceForest<Queue>::DeviceForest(Queue& queue, const ComputeForest& from)
    : trees(from.trees),
      landmarks(from.landmarks),
      components(from.components),
      bins(from.bins),
      half(from.kernel_half),
      bin_width(from.bin_width) {
  const int64_t nodes = from.node_start[trees], targets = from.training_samples * landmarks;
  node_start = uploaded(queue, from.node_start, trees + 1),
  leaf_start_start = uploaded(queue, from.leaf_start_start, trees + 1);
  leaf_sample_start = uploaded(queue, from.leaf_sample_start, trees + 1);
  feature = uploaded(queue, from.feature, nodes), child = uploaded(queue, from.child, nodes);
  threshold = uploaded(queue, from.threshold, nodes);
  leaf_start = uploaded(queue, from.leaf_start, from.leaf_start_start[trees]);
  leaf_sample = uploaded(queue, from.leaf_sample, from.leaf_sample_start[trees]);
  kernel = uploaded(queue, from.kernel, half), decay = uploaded(queue, from.decay, bins + 1);
  target_bin = {queue, targets};
  const Array<uint16_t> target(queue, from.target, targets);
  queue.launch(targets, TargetBin{target.data(), target_bin.data(), from.target_to_bin, bins});
  uint16_t last;
  if (targets > 0) queue.download(&last, target_bin.data(), sizeof last);  // waits: other queues will read it
}

// Tables of votes of `count` samples: count x (bins + 1) x landmarks.
template <class Queue>
DeviceArray<float, Queue> vote_tables(DeviceSurface<Queue>& surface, const DeviceForest<Queue>& forest,
                                      const float* descriptor, int32_t count) {
  Queue& queue = surface.queue;
  const ForestTable trees = forest.table();
  const int64_t columns = int64_t{count} * forest.landmarks, rows = forest.bins + 1;
  DeviceArray<float, Queue> table(queue, columns * rows);
  surface.clock.time("forest", 30.0 * count * forest.trees, 200.0 * count * forest.trees, [&] {
    const DeviceArray<float, Queue> descriptors(queue, descriptor, int64_t{count} * forest.components);
    const DeviceArray<int32_t, Queue> leaf(queue, int64_t{count} * forest.trees);
    const DeviceArray<float, Queue> histogram(queue, columns * (rows + 2 * forest.half));
    queue.launch(leaf.size(), LeafEntry{trees, descriptors.data(), leaf.data(), forest.components});
    queue.launch(columns, HistogramColumn{trees, leaf.data(), histogram.data()});
    queue.launch(table.size(), TableEntry{trees, histogram.data(), table.data()});
  });
  return table;
}

template <class Queue>
void votes(DeviceSurface<Queue>& surface, const DeviceForest<Queue>& forest, const int32_t* vertex,
           const float* descriptor, int32_t count, int32_t stride, float* out) {
  Queue& queue = surface.queue;
  const int32_t n = surface.n, L = forest.landmarks;
  if (stride < L) throw DeviceFailure{false, "there is no room for all landmarks"};
  const std::vector<float> none(static_cast<size_t>(n) * static_cast<size_t>(L));
  DeviceArray<float, Queue> sums(queue, none.data(), int64_t{n} * L);
  for (int32_t first = 0; first < count; first += sources_at_once) {
    const int32_t some = std::min(sources_at_once, count - first);
    std::vector<ComputeSource> sources;
    for (int32_t j = 0; j < some; ++j) {
      const int32_t v = vertex[first + j];
      sources.push_back({{v, v, v}, 0, {1, 0, 0}});
    }
    const auto distance = distances_on_device(surface, sources.data(), some);
    const auto table = vote_tables(surface, forest, descriptor + int64_t{first} * forest.components, some);
    surface.clock.time("votes", 5.0 * n * L * some, 4.0 * n * some + 4.0 * table.size() + 8.0 * n * L, [&] {
      queue.launch(sums.size(),
                   VoteEntry{table.data(), distance.data(), sums.data(),
                             static_cast<float>(1 / forest.bin_width), forest.bins + 1, L, some, some});
    });
  }
  const DeviceArray<float, Queue> wide(queue, int64_t{n} * stride);
  queue.launch(wide.size(), WidenEntry{sums.data(), wide.data(), L, stride});
  wide.download(out, wide.size());
  surface.votes = std::move(sums), surface.landmarks = L;
}

template <class Queue>
void peaks(DeviceSurface<Queue>& surface, int32_t count, double radius, int32_t* out) {
  Queue& queue = surface.queue;
  const int32_t n = surface.n, L = surface.landmarks,
                chunks = (n + BestInChunk::length - 1) / BestInChunk::length;
  if (L == 0) throw DeviceFailure{false, "peaks need votes"};
  const std::vector<int32_t> none(static_cast<size_t>(n) * static_cast<size_t>(L));
  const DeviceArray<int32_t, Queue> mark(queue, none.data(), int64_t{n} * L), open(queue, int64_t{n} * L),
      peak(queue, int64_t{L} * count), vertex(queue, int64_t{chunks} * L);
  const DeviceArray<float, Queue> best(queue, int64_t{chunks} * L);
  surface.clock.time("peaks", 1.0 * count * n * L, 4.0 * count * n * L, [&] {
    for (int32_t number = 0; number < count; ++number) {
      queue.launch(best.size(), BestInChunk{surface.votes.data(), best.data(), vertex.data(), n, L});
      queue.launch(L, TakePeak{best.data(), vertex.data(), surface.laplacian(), surface.position.data(),
                               surface.votes.data(), mark.data(), open.data(), peak.data(), radius, n, L,
                               chunks, count, number});
    }
  });
  peak.download(out, peak.size());
  surface.votes = {}, surface.landmarks = 0;  // they are used up
}

template <class Queue>
void isoline_votes(DeviceSurface<Queue>& surface, const ComputeIsolines& from, float* out) {
  using Array = DeviceArray<float, Queue>;
  Queue& queue = surface.queue;
  const int32_t n = surface.n, columns = from.columns;
  const auto neighbour_start = uploaded(queue, from.neighbour_start, n + 1),
             neighbour = uploaded(queue, from.neighbour, from.neighbour_start[n]);
  const auto radius = uploaded(queue, from.radius, int64_t{from.samples} * columns),
             weight = uploaded(queue, from.weight, int64_t{from.samples} * columns);
  const std::vector<float> none(static_cast<size_t>(n) * static_cast<size_t>(columns));
  const Array votes(queue, none.data(), int64_t{n} * columns), mean(queue, int64_t{n} * columns);
  // Of `some` vertices, with the largest distance from each.
  const auto for_portions = [&](int32_t count, const auto& vertex_at, const auto& work) {
    for (int32_t first = 0; first < count; first += sources_at_once) {
      const int32_t some = std::min(sources_at_once, count - first);
      std::vector<ComputeSource> sources;
      for (int32_t j = 0; j < some; ++j) {
        const int32_t v = vertex_at(first + j);
        sources.push_back({{v, v, v}, 0, {1, 0, 0}});
      }
      const Array distance = distances_on_device(surface, sources.data(), some), largest(queue, some);
      queue.launch(some, LargestDistance{distance.data(), largest.data(), n, some});
      work(first, some, distance, largest);
    }
  };
  const double N = n, K = columns;
  for_portions(
      from.samples, [&](int32_t j) { return from.vertex[j]; },
      [&](int32_t first, int32_t some, const Array& distance, const Array& largest) {
        const int64_t offset = int64_t{first} * columns;
        surface.clock.time("isolines", 30 * N * K * some, 4 * N * some + 8 * N * K, [&] {
          queue.launch(distance.size(), ShareOfLargest{largest.data(), distance.data(), some});
          queue.launch(votes.size(), IsolineEntry{distance.data(), neighbour_start.data(), neighbour.data(),
                                                  radius.data() + offset, weight.data() + offset,
                                                  votes.data(), columns, some});
        });
      });
  for_portions(
      n, [](int32_t v) { return v; },
      [&](int32_t first, int32_t some, const Array& distance, const Array& largest) {
        surface.clock.time("means of votes", 2 * N * some, 4 * N * some + 4 * N * K, [&] {
          queue.launch(int64_t{some} * columns, NearbyMean{distance.data(), largest.data(), votes.data(),
                                                           mean.data() + int64_t{first} * columns,
                                                           from.neighbourhood, n, columns, some});
        });
      });
  mean.download(out, mean.size());
}

}  // namespace focal
