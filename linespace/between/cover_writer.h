// Writes down the cover that a search goes through, where it is wanted.

#pragma once

#include <vector>

#include "linespace/between/cover_cell.h"
#include "linespace/between/cover_search.h"

namespace sightline::internal {

class CoverWriter {
 public:
  /// Keeps references.
  CoverWriter(const SightSpace& space, CellPath& path, bool keep)
      : space_(space), path_(path), keep_(keep) {}

  [[nodiscard]] bool keeps() const { return keep_; }
  void node(const CoverNode& node);
  /// The blocker blocks all of the cell.  Two blockers in one: on either side of their
  /// common edge, one of them.
  void blocked(int blocker);
  /// The shares prove it empty.  Their weights, the exact ones too, are those of forms on
  /// the scale of CornerValues.
  void empty(const std::vector<CoverShare>& shares);
  /// The position of a new exact weight.
  [[nodiscard]] int exact_weight(const Rational& weight);
  [[nodiscard]] Cover take() { return std::move(cover_); }

 private:
  const SightSpace& space_;
  CellPath& path_;
  bool keep_;
  Cover cover_;
};

/// Times that power of two.
void scale(Rational& x, int exponent);

}  // namespace sightline::internal
