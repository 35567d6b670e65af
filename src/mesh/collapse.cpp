#include "mesh/collapse.h"

#include <meshoptimizer.h>

#include <limits>
#include <new>

namespace focal {

std::vector<unsigned> collapse_edges(
    std::span<const unsigned> indices,
    const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>& positions, size_t wanted,
    unsigned options) {
  std::vector<unsigned> kept(indices.size());
  try {
    kept.resize(meshopt_simplify(kept.data(), indices.data(), indices.size(), positions.data(),
                                 positions.rows(), 3 * sizeof(float), 3 * wanted,
                                 std::numeric_limits<float>::max(), options, nullptr));
  } catch (const std::bad_alloc&) {
    // With FOCAL_MESHOPTIMIZER=PACKAGE the exception comes from another C++ runtime. In an exception_ptr it
    // would be freed by our runtime, which terminates the process when the exception was allocated from the
    // other runtime's emergency pool.
    throw std::bad_alloc();
  }
  return kept;
}

}  // namespace focal
