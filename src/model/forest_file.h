// A forest as packed bytes: the largest part of a model file.
#pragma once
#include "base/archive.h"
#include "forest/regression_forest.h"

namespace focal {

enum class LeafKind : uint8_t { samples = 0, means = 1 };

// Every tree must be in breadth-first order, its leaves numbered in that order, as tree_builder creates it:
// the file then needs no child indices. sample_count: one more than the largest sample number.
void write_forest(const RegressionForest& forest, int32_t sample_count, ByteWriter& out);
// components: number of components of the descriptor that the trees test.
RegressionForest read_forest(ByteReader& in, LeafKind leaves, int32_t tree_count, int32_t sample_count,
                             int32_t components);

}  // namespace focal
