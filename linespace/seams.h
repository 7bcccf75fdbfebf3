// Seams: gaps in a model that nobody meant, closed by growing every occluder.
//
// Wall pieces that should meet end a rounding apart, or a millimetre.  With a seam width
// W every occluder counts as grown by W/2 in its own plane, so that gaps up to W between
// pieces of one plane are closed.  What that closed is told with a segment that was open.

#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "linespace/face_visibility.h"
#include "linespace/polygon_visibility.h"

namespace sightline {

/// What lies around the polygon in its plane, up to `by` away: a quadrilateral beside
/// each side, as two triangles, and at a corner sharper than a right angle a triangle
/// more, which cuts it off at that distance.  Together with the polygon they hold every
/// point at most `by` from it, and none farther than sqrt(2) times that, up to rounding
/// of their outer corners (a few 2^-52 of the coordinates, off the plane too; `by` is
/// made larger by that much).  They share their sides with it and with each other
/// exactly.  None for a polygon without area, or for `by` 0.
[[nodiscard]] std::vector<Polygon> flaps(const Polygon& polygon, double by);

/// A segment that misses all occluders, and those that meet it once they are grown.
struct ClosedSeam {
  std::array<ExactPosition, 2> segment;
  std::vector<int> occluders;  ///< ascending
};

struct SeamAnswer {
  VisibilityAnswer answer;  ///< of the question with grown occluders
  /// That question: the occluders of the one asked, then their flaps.
  VisibilityQuestion grown;
  /// Hidden only because occluders were grown.
  std::optional<ClosedSeam> closed;
  /// The answer is hidden, and budget or stop ended the search for what was closed.
  bool closed_unknown = false;
};

/// polygon_visibility with every occluder grown by seam/2.  Throws as it does, and for a
/// seam that is negative or not finite.
[[nodiscard]] SeamAnswer polygon_visibility(const VisibilityQuestion& question,
                                            double seam,
                                            const VisibilityRequest& request = {});

/// What growing hid between two sets of faces.
struct ClosedPairs {
  struct Pair {
    int a, b;  ///< faces
    ClosedSeam seam;
  };
  /// In order of the given faces: all pairs when all were asked for, else one that shows
  /// that the sets would see each other, or none.
  std::vector<Pair> pairs;
  /// False when budget or stop ended the search.
  bool complete = true;
};

/// `group`: the answer of `grown`, which has a seam, to the same sets and all_pairs.
[[nodiscard]] ClosedPairs closed_pairs(const Scene& scene, const FaceVisibility& grown,
                                       std::span<const int> as, std::span<const int> bs,
                                       const GroupAnswer& group, bool all_pairs,
                                       const VisibilityRequest& request = {});

}  // namespace sightline
