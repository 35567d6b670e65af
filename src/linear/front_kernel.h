// The inner loop of the sparse Cholesky factor: dense elimination within one supernode.
#pragma once
#include <cstdint>

namespace focal {

// A front is the upper triangle of a small dense matrix, `size` rows of `stride` numbers, stride a multiple
// of 8 and 64-byte aligned; the part left of the diagonal is scratch. Eliminates the first `width` rows and
// updates the others. Returns false when a pivot is not positive or not finite.
bool eliminate(double* front, int64_t size, int64_t stride, int64_t width);

}  // namespace focal
