// Until the block method lands, both methods are the reference.
#include "spectrum/eigensolvers.h"
namespace focal {
Eigenbasis chebyshev_eigenpairs(const StandardProblem& problem, const Execution& execution) {
  return lanczos_eigenpairs(problem, execution);
}
}  // namespace focal
