// Borders between the cells of a picture, for the naive views.

#pragma once

#include <vector>

#include "tests/support/naive_picture.h"

namespace sightline::testing {

/// A piece of the line between two cells on which nothing changes.
struct Border {
  Ray line;                   ///< normal of the plane through the eye, canonical
  Ray begin, end;             ///< counter-clockwise about it
  int plus = -1, minus = -1;  ///< the cells on the sides of positive and negative `line`
};

/// All borders between cells.  Where what is seen on one side changes from the nearer to
/// the farther, they are cut in two.  Throws std::logic_error for cells that overlap.
[[nodiscard]] std::vector<Border> borders(const std::vector<PictureCell>& cells);

}  // namespace sightline::testing
