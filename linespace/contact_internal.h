// The one contact test: how a line given by exact points meets a set of faces, contact by
// contact, and whether each contact blocks or only grazes.
// For occlusion.cpp and the skeleton; CGAL's numbers stay in .cpp and *_internal.h files.

#pragma once

#include <CGAL/Exact_rational.h>

#include <array>
#include <span>
#include <vector>

#include "linespace/occlusion.h"

namespace sightline::internal {

using Rational = CGAL::Exact_rational;
using ExactPoint = std::array<Rational, 3>;

[[nodiscard]] ExactPoint exact_point(const Point& p);

/// A Contact with its exact ends along the line a + t (b - a).
struct ExactContact {
  Rational from, to;
  bool blocked;
  std::vector<Touch> touches;
};

/// All contacts of the *whole line* through a and b with the given faces (any superset of
/// those it meets in the range of interest; others are rejected by intervals first), in
/// order of `from`.  Touching faces are grouped by geometry, whatever object they are of.
/// Requires a != b.
[[nodiscard]] std::vector<ExactContact> line_contacts(const Scene& scene,
                                                      std::span<const int> faces,
                                                      const ExactPoint& a,
                                                      const ExactPoint& b);

}  // namespace sightline::internal
