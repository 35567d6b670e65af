#include "mesh/collapse.h"

#include <meshoptimizer.h>

#include <limits>
#include <new>

#include "base/memory_budget.h"

namespace focal {

std::vector<unsigned> collapse_edges(
    std::span<const unsigned> indices,
    const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>& positions, size_t wanted,
    unsigned options) {
  std::vector<unsigned> kept(indices.size());
  // meshoptimizer 0.18 takes at most 94 bytes a vertex, 10 of them for a moment, and 24 an index.
  const ExternalAllocation scratch(104 * positions.rows() + 24 * static_cast<int64_t>(indices.size()));
  try {
    kept.resize(meshopt_simplify(kept.data(), indices.data(), indices.size(), positions.data(),
                                 positions.rows(), 3 * sizeof(float), 3 * wanted,
                                 std::numeric_limits<float>::max(), options, nullptr));
  } catch (const std::bad_alloc&) {
    // Its exception comes from its own C++ runtime. Kept in an exception_ptr it would be freed by ours, which ends the
    // process when the exception lies in the reserve that the other runtime has for the case that there is no memory.
    throw std::bad_alloc();
  }
  return kept;
}

}  // namespace focal
