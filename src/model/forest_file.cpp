// Serialises a forest. The topology of a binary tree in breadth-first order takes one bit per node (G.
// Jacobson, "Space-efficient Static Trees and Graphs", 1989): the children of the k-th inner node are nodes
// 2k + 1 and 2k + 2.
#include "model/forest_file.h"

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "descriptors/descriptor.h"

namespace focal {
namespace {

constexpr uint32_t last_feature = max_components - 1;
constexpr float any_threshold = 1e30F;

// Node types (1: leaf), features and children in breadth-first order.
struct Shape {
  std::vector<uint32_t> is_leaf, inner_feature;
  std::vector<float> inner_threshold;
};

Shape shape_of(const RegressionTree& tree) {
  Shape shape;
  int32_t inner = 0, leaf = 0;
  for (size_t node = 0; node < tree.feature.size(); ++node) {
    const bool is_leaf = tree.feature[node] < 0;
    if (tree.child[node] != (is_leaf ? leaf++ : 2 * inner++ + 1))
      throw Error(Status::internal, "a tree is not in breadth-first order",
                  "This is a bug in focal: report it.");
    shape.is_leaf.push_back(is_leaf);
    if (is_leaf) continue;
    shape.inner_feature.push_back(static_cast<uint32_t>(tree.feature[node]));
    shape.inner_threshold.push_back(tree.threshold[node]);
  }
  return shape;
}

void write_tree(const RegressionTree& tree, LeafKind leaves, int32_t sample_count, ByteWriter& out) {
  const Shape shape = shape_of(tree);
  out.u32(static_cast<uint32_t>(shape.is_leaf.size()));
  out.packed(shape.is_leaf, 1);
  out.packed(shape.inner_feature, bits_for(last_feature));
  out.f32s(shape.inner_threshold);
  if (leaves == LeafKind::means) return out.f32s(tree.leaf_mean);
  std::vector<uint32_t> sizes;
  for (size_t leaf = 0; leaf + 1 < tree.leaf_start.size(); ++leaf)
    sizes.push_back(static_cast<uint32_t>(tree.leaf_start[leaf + 1] - tree.leaf_start[leaf]));
  const uint32_t largest = *std::max_element(sizes.begin(), sizes.end());
  out.u32(largest);
  out.packed(sizes, bits_for(largest));
  const std::vector<uint32_t> ids(tree.leaf_samples.begin(), tree.leaf_samples.end());
  out.packed(ids, bits_for(static_cast<uint32_t>(sample_count - 1)));
}

// Fills feature, threshold and child; returns the number of leaves.
int32_t read_shape(ByteReader& in, int32_t components, RegressionTree& tree) {
  const int32_t nodes = in.i32("node count", 1, std::numeric_limits<int32_t>::max());
  const std::vector<uint32_t> is_leaf = in.packed("node kind", static_cast<size_t>(nodes), 1, 1);
  const auto leaves = static_cast<int32_t>(std::count(is_leaf.begin(), is_leaf.end(), 1U));
  const int32_t inner_nodes = nodes - leaves;
  if (leaves != inner_nodes + 1) in.fail("the leaves and nodes of a tree do not match");
  const auto features = in.packed("feature", static_cast<size_t>(inner_nodes), bits_for(last_feature),
                                  static_cast<uint32_t>(components - 1));
  const auto thresholds =
      in.f32s("threshold", static_cast<size_t>(inner_nodes), -any_threshold, any_threshold);
  int32_t inner = 0, leaf = 0;
  for (int32_t node = 0; node < nodes; ++node) {
    const bool ends = is_leaf[node] != 0;
    const int32_t child = ends ? leaf++ : 2 * inner + 1;
    if (!ends && child <= node) in.fail("a node comes before its parent");
    tree.feature.push_back(ends ? -1 : static_cast<int32_t>(features[inner]));
    tree.threshold.push_back(ends ? 0 : thresholds[inner]);
    tree.child.push_back(child);
    if (!ends) ++inner;
  }
  return leaves;
}

void read_leaf_samples(ByteReader& in, int32_t leaves, int32_t sample_count, RegressionTree& tree) {
  const auto largest = static_cast<uint32_t>(in.i32("largest leaf", 1, std::numeric_limits<int32_t>::max()));
  const auto sizes = in.packed("leaf size", static_cast<size_t>(leaves), bits_for(largest), largest);
  int64_t total = 0;
  tree.leaf_start.push_back(0);
  for (const uint32_t size : sizes) {
    total += size;
    if (size == 0 || total > std::numeric_limits<int32_t>::max()) in.fail("a leaf's size is out of range");
    tree.leaf_start.push_back(static_cast<int32_t>(total));
  }
  const auto last = static_cast<uint32_t>(sample_count - 1);
  const auto ids = in.packed("leaf sample", static_cast<size_t>(total), bits_for(last), last);
  tree.leaf_samples.assign(ids.begin(), ids.end());
}

}  // namespace

void write_forest(const RegressionForest& forest, int32_t sample_count, ByteWriter& out) {
  const bool means = forest.trees.empty() || !forest.trees.front().leaf_mean.empty();
  const LeafKind leaves = means ? LeafKind::means : LeafKind::samples;
  out.u8(static_cast<uint8_t>(leaves));
  out.u32(static_cast<uint32_t>(forest.trees.size()));
  for (const RegressionTree& tree : forest.trees) write_tree(tree, leaves, sample_count, out);
}

RegressionForest read_forest(ByteReader& in, LeafKind leaves, int32_t tree_count, int32_t sample_count,
                             int32_t components) {
  if (in.u8("leaf kind") != static_cast<uint8_t>(leaves)) in.fail("the leaves are not those of the preset");
  RegressionForest forest;
  const int32_t count = in.i32("tree count", tree_count, tree_count);
  for (int32_t t = 0; t < count; ++t) {
    RegressionTree tree;
    const int32_t leaf_count = read_shape(in, components, tree);
    if (leaves == LeafKind::samples)
      read_leaf_samples(in, leaf_count, sample_count, tree);
    else
      tree.leaf_mean = in.f32s("leaf mean", static_cast<size_t>(leaf_count), -any_threshold, any_threshold);
    forest.trees.push_back(std::move(tree));
  }
  return forest;
}

}  // namespace focal
