// The proof that two polygons do not see each other, and its checker.
//
// A cover cuts the segments between two triangles into cells, by signs of bilinear forms
// and by halving the triangles, down to cells that one occluder blocks and cells that are
// empty because a positive combination of their conditions is nowhere positive
// (docs/polygon_visibility.md).  The checker knows nothing of how the cover was found: it
// evaluates determinants in rationals and follows the tree.

#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "linespace/polygon_visibility.h"

namespace sightline {

class VisibilityCover {
 public:
  struct Data;  // between/visibility_cover.h
  explicit VisibilityCover(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  [[nodiscard]] const Data& data() const { return *data_; }
  /// Number of cells in the leaves.
  [[nodiscard]] std::size_t leaves() const;

 private:
  std::shared_ptr<const Data> data_;
};

/// nullopt when the cover proves that the question's answer is "hidden"; otherwise what
/// is wrong with it, in one line.  Exact; about a millisecond per leaf.
[[nodiscard]] std::optional<std::string> check_cover(const VisibilityQuestion& question,
                                                     const VisibilityCover& cover);

}  // namespace sightline
