// Which meshes are left out together in cross-validation.
#pragma once
#include <cstddef>
#include <vector>

namespace focal_cli {

// The fold of each of `count` meshes, 0..folds-1, sizes differing by one at most. Neighbours share a fold:
// sets list the poses of one subject together, and a subject in both training and test would flatter the
// result.
std::vector<size_t> folds_of(size_t count, size_t folds);

}  // namespace focal_cli
