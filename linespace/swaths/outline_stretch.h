// Over which stretch of an edge a viewpoint sees a convex outline, and which part of that
// stretch lies behind a plane.
//
// All that looks for the visible parts of an edge takes this step for each face in the
// way: the views of scene corners (skeleton/build/vertex_view), the view from any eye
// (linespace/view/line_view), the view of a source (shadows/seen/source_view).  They
// differ in what a viewpoint is, so signs and positions are theirs: a Stretch has two
// positions `from` and `to` of whatever type, in the order of the edge.
//
// Left and right are those of the edge from its start to its end, as the viewpoint sees
// it.  In the plane of the viewpoint and the edge an outline fills an angle below half a
// turn.  It begins on one side that leads from left to right or from right to left, and
// ends on one that leads back, so two sides tell all.

#pragma once

#include <array>
#include <cstddef>

#include "linespace/predicates.h"

namespace sightline::internal {

/// A side of an outline as it is seen against the edge.
template <class Position>
struct SideAgainstEdge {
  /// On which hand the edge's ends are of one who walks along the side's line from the
  /// left of the edge to its right: Positive on the left hand.
  Sign start, end;
  /// Where the side's line crosses the edge; of no meaning unless `start` is Negative and
  /// `end` Positive.
  Position at;
};

/// Narrows a stretch, at first all of an edge, to where a convex outline of `sides` sides
/// is seen over it.  False: nowhere.
///
/// corners_of(k) -> std::array<Sign, 2>: of side k from its first corner to its second,
/// Positive where that corner is seen on the right of the edge.  Requires that some
/// corner is not Zero, and that the sides make a closed outline, in any order.
/// `front`: Positive if they go counter-clockwise, Negative if clockwise.
/// against(k, to_right) -> SideAgainstEdge, of a side that leads to the right or to the
/// left; asked of two sides at most.
///
/// An outline that the edge's line touches in a corner alone may be found at a stretch of
/// no length; one that it touches along a side has the stretch of that side.
template <class Stretch, class CornersOf, class Against>
[[nodiscard]] bool narrow_to_outline(Stretch& stretch, std::size_t sides, Sign front,
                                     CornersOf&& corners_of, Against&& against) {
  std::array<bool, 2> found{};  // where it begins, where it ends
  int backwards = 0;
  for (std::size_t k = 0; k < sides && !(found[0] && found[1]); ++k) {
    const std::array<Sign, 2> corners = corners_of(k);
    if (corners[0] == corners[1]) continue;
    const bool to_right = corners[0] < corners[1];
    const bool begins = to_right == (front == Sign::Positive);
    if (found[begins ? 0 : 1]) continue;  // beside a corner in line with the edge
    found[begins ? 0 : 1] = true;
    const auto side = against(k, to_right);
    if (side.start == Sign::Negative && side.end == Sign::Positive) {
      (begins ? stretch.from : stretch.to) = side.at;
      continue;
    }
    // The edge lies on one hand of the side's line, or that crosses it the other way, in
    // the direction opposite to one in which the side is seen.
    if (begins && side.start != Sign::Positive &&
        !(side.start == Sign::Zero && side.end == Sign::Positive)) {
      return false;
    }
    if (!begins && side.end != Sign::Negative &&
        !(side.end == Sign::Zero && side.start == Sign::Negative)) {
      return false;
    }
    backwards += side.start == Sign::Positive && side.end == Sign::Negative ? 1 : 0;
  }
  return found[0] && found[1] && backwards < 2;
}

/// Narrows a stretch to its part behind a plane that the edge pierces at `pierce`, with
/// the start or the end of the edge behind it: perhaps to nothing, `from` not before
/// `to`.  before(x, y): position x comes before y.
template <class Stretch, class Position, class Before>
void narrow_to_behind(Stretch& stretch, bool start_is_behind, const Position& pierce,
                      Before&& before) {
  if (start_is_behind) {
    if (before(pierce, stretch.to)) stretch.to = pierce;
  } else if (before(stretch.from, pierce)) {
    stretch.from = pierce;
  }
}

}  // namespace sightline::internal
