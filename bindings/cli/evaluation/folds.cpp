// Which meshes are left out together in cross-validation.
#include "evaluation/folds.h"

namespace focal_cli {

std::vector<size_t> folds_of(size_t count, size_t folds) {
  std::vector<size_t> fold(count);
  for (size_t i = 0; i < count; ++i) fold[i] = i * folds / count;
  return fold;
}

}  // namespace focal_cli
