// Systems of strict linear inequalities in at most five unknowns, decided exactly: for
// example that c0 - c1 > 0 and c1 > 0 have a common solution, (2, 1).

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "linespace/contacts/seen_along.h"

namespace sightline::internal::contacts {

/// A row, or a solution, of a homogeneous system.  `r` is `e` times some power of two,
/// rounded: each entry within a relative 2^-52 or 2^-1022.
struct Row {
  static constexpr int kMax = 5;
  std::array<Ring, kMax> e;
  std::array<double, kMax> r{};

  void round(int dimension) {
    double largest = 0;
    for (int i = 0; i < dimension; ++i) {
      r[i] = CGAL::to_double(e[i]);
      largest = std::max(largest, std::abs(r[i]));
    }
    if (!(largest > 1e-290 && largest < 1e290)) {
      r.fill(std::numeric_limits<double>::quiet_NaN());  // only exact from here
      return;
    }
    int exponent = 0;
    std::frexp(largest, &exponent);
    for (int i = 0; i < dimension; ++i) r[i] = std::ldexp(r[i], -exponent);
  }
};

/// Some c, of `dimension` numbers, has row * c > 0 for all rows and row * c = 0 for all
/// equalities.
[[nodiscard]] bool feasible(std::vector<Row> rows, std::vector<Row> equalities,
                            int dimension);

}  // namespace sightline::internal::contacts
