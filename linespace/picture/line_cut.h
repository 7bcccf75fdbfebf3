// Positions on a line of the scene at which its view can change, and their exact order.
//
// A second kind beside Cut (linespace/swaths/edge_cuts.h), which the skeleton's vertex
// views use.  A Cut is where a plane through three points of the scene crosses an edge,
// which doubles and expansions compare at half of the size.  Here the eye may be a
// direction or have fractions for coordinates, lines end where faces cross, and the map
// goes on with the position as a picture vector, for which doubles are too rough.

#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "linespace/picture/eye_space.h"
#include "linespace/swaths/outline_stretch.h"

namespace sightline::internal {

/// A position on a line from its first end (0) to its second (1), as a ratio of lengths
/// in space.
struct LineCut {
  enum class Kind : std::uint8_t {
    Start,
    Side,   ///< where the line is seen to cross the line through points p and q
    Plane,  ///< where the line passes the plane of face p
    Finish
  };
  Kind kind;
  int p = -1, q = -1;
  /// The position, within the error.
  long double at = 0, error = 0;
  /// Of a Side or Plane: two numbers above 0 with at = w0 / (w0 + w1), each within 2^-35
  /// of itself.
  long double w0 = 0, w1 = 0;
};

[[nodiscard]] inline LineCut line_start() { return {.kind = LineCut::Kind::Start}; }
[[nodiscard]] inline LineCut line_finish() {
  return {.kind = LineCut::Kind::Finish, .at = 1};
}

/// All that is asked about positions on one line.
class LineCuts {
 public:
  LineCuts(const EyeSpace& eye, int line)
      : eye_(&eye), line_(line), ends_(eye.scene().lines()[line].ends) {}
  [[nodiscard]] int line() const { return line_; }

  /// Requires that the ends are seen on different sides of the line pq, neither on it.
  [[nodiscard]] LineCut at_side(int p, int q) const;
  /// Requires that the ends lie on different sides of the face's plane, neither in it.
  [[nodiscard]] LineCut at_plane(int face) const;

  /// For narrow_to_outline(): a side of something seen, from a point seen on the left of
  /// this line to one seen on the right.  `line`: of which the side is a part, for then
  /// all that end there give the same cut; -1: of none.
  [[nodiscard]] SideAgainstEdge<LineCut> against(int left, int right, int line) const;

  [[nodiscard]] std::strong_ordering compare(const LineCut& a, const LineCut& b) const;

  /// Sorts positions and leaves one of those that are equal.  merged(x, y) is told that y
  /// goes, which equals x.
  template <class Merged>
  void sort_unique(std::vector<LineCut>& at, Merged&& merged) const;
  /// Where a position stands among those that sort_unique() left, which have it.
  [[nodiscard]] std::ptrdiff_t rank(std::span<const LineCut> at,
                                    const LineCut& cut) const;

  /// s and t of a picture vector w = s u + t v on the line's picture, u and v being the
  /// vectors of its ends.  The position there is t / (s + t).
  [[nodiscard]] std::array<Rational, 2> shares(const ExactPoint& w) const;
  /// How near the line is to the eye where w sees it: at one w what is larger is nearer.
  [[nodiscard]] Rational nearness(const ExactPoint& w) const;

  /// The position as a fraction, exactly.
  [[nodiscard]] Rational exact(const LineCut& cut) const;

 private:
  [[nodiscard]] std::array<Rational, 2> exact_weights(const LineCut& cut) const;
  [[nodiscard]] LineCut weighted(LineCut cut, LongValue at0, LongValue at1) const;

  const EyeSpace* eye_;
  int line_;
  std::array<int, 2> ends_;
};

template <class Merged>
void LineCuts::sort_unique(std::vector<LineCut>& at, Merged&& merged) const {
  std::ranges::sort(
      at, [&](const LineCut& x, const LineCut& y) { return compare(x, y) < 0; });
  const auto same = [&](const LineCut& x, const LineCut& y) {
    if (compare(x, y) != 0) return false;
    merged(x, y);
    return true;
  };
  at.erase(std::unique(at.begin(), at.end(), same), at.end());
}

}  // namespace sightline::internal
