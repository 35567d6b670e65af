// The forest on a device, and the votes of the leaves that samples reach.
#pragma once
#include "compute/device/surface.h"

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
  const DeviceArray<float, Queue> sums(queue, none.data(), int64_t{n} * L);
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
}

}  // namespace focal
