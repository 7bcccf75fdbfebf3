// The families of stabbing lines that may end at one extremal line, few of them however
// many portals the line touches.
//
// Let M be an extremal line.  A family T of stabbing lines that has M in its closure
// touches some of the edges that M touches.  Two facts keep the number of such sets small
// (docs/portals.md proves them):
//   - two edges that M touches in different places, in one plane with M, are touched
//     together only by lines in that plane; two that M touches in one place, in different
//     planes with M, only by lines through that point;
//   - lines near M that leave such a plane pass above it on one side of where they cross
//     it and below it on the other, so they can touch its edges in few places: in a row
//     of equal doors only in the first and in the last.

#pragma once

#include <array>
#include <vector>

#include "linespace/portals/portals.h"

namespace sightline::internal {

/// Lines through a point in one plane: that of the point and an edge beside it.
struct Pencil {
  int point;  ///< a number in PortalState::points
  int edge;   ///< a number in PortalState::edges
};

/// What fixes the families at an extremal line.  Edges that lie on one line are told
/// once.
struct LineFamilies {
  std::vector<int> edges;                   ///< families that touch one edge
  std::vector<std::array<int, 2>> pairs;    ///< two skew edges
  std::vector<std::array<int, 3>> triples;  ///< three edges, skew to each other
  std::vector<int> stars;                   ///< families all through a point
  std::vector<Pencil> pencils;
  std::vector<PlaneThrough> planes;  ///< families in a plane
  /// Edges of which any three are tried; only where nothing better is known.
  std::vector<int> any_three;
};

/// The families at a held line.  Adds points to the state.
[[nodiscard]] LineFamilies families_at(PortalState& state, const HeldLine& held);

/// All that edges and corners of the portals before `portal` can fix.
[[nodiscard]] LineFamilies all_families(PortalState& state, int portal);

/// Whether no line near it has the same contacts.
[[nodiscard]] bool is_extremal(const PortalState& state, const HeldLine& held);

/// Pluecker coordinates of an edge's line, exact.
using PlueckerRow = std::array<CGAL::Gmpq, 6>;
[[nodiscard]] PlueckerRow pluecker(const LineThrough& line);

}  // namespace sightline::internal
