#include "linespace/numbers/matrix_game.h"

#include "linespace/numbers/cpu_dispatch.h"

namespace sightline::internal {

SIGHTLINE_WIDE_VECTORS void subtract_multiple(double* __restrict row,
                                              const double* __restrict other,
                                              double factor, int n) {
  for (int i = 0; i < n; ++i) row[i] -= factor * other[i];
}

}  // namespace sightline::internal
