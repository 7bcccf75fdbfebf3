// Proofs that a cell of a cover search is empty.
//
// Each is a mean, with positive weights, of conditions that hold in the cell, and is
// nowhere positive.  They differ in where the weights come from: a matrix game on the
// nine corner pairs, one on the 36 coefficients of products of two conditions, or
// Cramer's rule where three lines meet.  A proof found in doubles counts when a bound on
// its roundings leaves it one; otherwise it is sought in exact numbers.

#pragma once

#include <memory>

#include "linespace/between/cover_cell.h"
#include "linespace/between/cover_writer.h"
#include "linespace/polygon_visibility.h"

namespace sightline::internal {

class Emptiness {
 public:
  /// Keeps references; counts the games played.
  Emptiness(const SightSpace& space, const CellPath& path, Domains& domains,
            CoverWriter& writer, Precision precision, VisibilityCost& counts);
  ~Emptiness();

  // Each function below tries to prove that the cell of this path and this domain is
  // empty.  True: it is empty, and the proof has been written.  At Precision::Double the
  // proof is only as good as rounded numbers are.

  /// By linear inequalities at the corner pairs.  False: `start` is where they have the
  /// largest margin.
  [[nodiscard]] bool first_order(Domain& d, LocalPoint& start);
  /// That margin, when first_order was asked last: each form counts by its largest value.
  [[nodiscard]] double margin() const;
  /// By three lines of the path through one point: outlines are full of such corners, and
  /// there halving never ends.
  [[nodiscard]] bool at_a_corner(Domain& d);
  /// By products of two conditions, once the domain is small.
  [[nodiscard]] bool second_order(Domain& d);

 private:
  class Proofs;
  std::unique_ptr<Proofs> proofs_;
};

}  // namespace sightline::internal
