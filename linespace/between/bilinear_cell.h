// Is there a segment at which some bilinear forms are all positive?  Decided in exact
// numbers, however narrow the cell between the forms is.
//
// For a fixed point p of the one triangle, each form is a linear condition on the point q
// of the other: a small linear program decides.  Whether it has a solution depends on the
// signs of the 3 x 3 determinants of the conditions' coefficients only (Gordan's theorem:
// at most four conditions with a vanishing positive combination rule each other out).
// Such a determinant is a polynomial in p of degree 3 or less, and so a plane curve.  One
// point p from each cell of the arrangement of these curves is therefore enough: they are
// found by projection (Collins 1975, cylindrical algebraic decomposition, open cells
// only), and every number that is computed with is rational.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "linespace/between/sight_space.h"
#include "linespace/numbers/rational.h"

namespace sightline::internal {

/// Values of a form at the nine corner pairs, its sign such that it has to be positive.
using PositiveForm = std::array<Rational, 9>;
/// Weights of p and of q, all positive, sums 1.
using ExactSegment = std::array<ExactWeights, 2>;

/// A segment at which all the forms are positive, where a few points p show one.  nullopt
/// proves nothing.  Cost: some 20 microseconds a point.
[[nodiscard]] std::optional<ExactSegment> probe_cell(std::span<const PositiveForm> forms);

struct CellDecision {
  enum class Outcome : std::uint8_t { Found, Empty, TooDear };
  Outcome outcome;
  std::optional<ExactSegment> segment;  ///< Found
};

/// Found or Empty; TooDear when more than `most_curves` curves would have to be arranged.
/// Hears a stop (work/stop_scope.h).
[[nodiscard]] CellDecision decide_cell(std::span<const PositiveForm> forms,
                                       int most_curves);

}  // namespace sightline::internal
