// A proof, in closed form, that no line passes three lines through one point on given
// hands.
//
// For lines through v with directions d1, d2, d3 the side of a line pq is linear in the
// direction: f_i = m . d_i, where m is the moment of pq about v.  By Cramer's rule
//     det(d1, d2, d3) (q - p) = sum_i w_i d_i,   w_1 = det(q - p, d2, d3), ...
// and m . (q - p) = 0, so that  sum_i w_i f_i = 0  for all p and q.  Where each
// s_i w_i >= 0 and some are positive, the three s_i f_i cannot all be positive.  The w_i
// are linear in p and in q: their values at corner pairs say where that is.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "linespace/between/sight_space.h"
#include "linespace/numbers/rational.h"

namespace sightline::internal {

/// A line with the hand on which lines of a cell pass it.
struct SignedLine {
  FormPoints points;  ///< of which the first two are the line's
  int sign;
};

/// |w_i| at the nine corner pairs of two triangles, when these prove that no segment
/// between them passes all three on their hands; nullopt otherwise.  Exact.
[[nodiscard]] std::optional<std::array<std::array<Rational, 9>, 3>> concurrent_weights(
    const std::array<SignedLine, 3>& lines, const std::array<ExactPoint, 3>& a,
    const std::array<ExactPoint, 3>& b);

/// The same without exact numbers: whether it is worth asking.
[[nodiscard]] bool may_have_concurrent_weights(const std::array<SignedLine, 3>& lines,
                                               const Triangle& a, const Triangle& b);

/// Triples of lines that share an end, at most `most`.
[[nodiscard]] std::vector<std::array<int, 3>> concurrent_triples(
    const std::vector<SignedLine>& lines, std::size_t most);

}  // namespace sightline::internal
