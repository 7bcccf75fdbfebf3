// One segment of a path: where the eye is, and where on its way it sees things in line.

#pragma once

#include <vector>

#include "linespace/numbers/rational.h"
#include "linespace/path/path_root.h"
#include "linespace/visibility_map.h"

namespace sightline::internal {

/// A point, exactly and rounded.
struct PathPoint {
  ExactPoint exact;
  Point rounded;
};

/// A straight line in space through two points.
struct PathLine {
  PathPoint a, b;
};

/// The eye at a rounded position.
struct RoundedEye {
  bool is_direction;
  Point at;  ///< the eye, or the direction towards it

  /// The direction of sight towards a point, of any length.
  [[nodiscard]] Eigen::Vector3d sight(const Point& x) const {
    return is_direction ? Eigen::Vector3d(-at) : Eigen::Vector3d(x - at);
  }
};

class SightPath {
 public:
  /// `size`: the largest magnitude of all coordinates, eyes included.
  SightPath(Viewpoint::Kind kind, ExactPoint from, ExactPoint to, double size);

  [[nodiscard]] Viewpoint eye(const Rational& u) const;
  [[nodiscard]] ExactPoint at(const Rational& u) const { return along(from_, to_, u); }
  [[nodiscard]] RoundedEye rounded(double u) const;
  [[nodiscard]] bool is_direction() const { return kind_ == Viewpoint::Kind::Direction; }

  /// Where, inside the segment, the eye passes the plane through three points; nullopt
  /// also where it lies in the plane all the time, or the points are in line.
  [[nodiscard]] std::optional<PathRoot> in_plane(const PathPoint& p, const PathPoint& q,
                                                 const PathPoint& r) const;
  /// It lies in this plane all the time; false where the points are in line.
  [[nodiscard]] bool stays_in_plane(const PathPoint& p, const PathPoint& q,
                                    const PathPoint& r) const;
  /// Where it sees three lines in one point of the picture.  The roots for which
  /// plausible(u), asked with a u within 2^-26, is false may be left out.
  template <class Plausible>
  [[nodiscard]] std::vector<PathRoot> in_one_point(
      const std::array<const PathLine*, 3>& lines, Plausible&& plausible) const {
    const Guess guess = guess_in_one_point(lines);
    if (guess.none) return {};
    if (guess.sure && !(guess.count > 0 && plausible(guess.at[0])) &&
        !(guess.count > 1 && plausible(guess.at[1]))) {
      return {};
    }
    return exact_in_one_point(lines);
  }

 private:
  struct Guess {
    bool none = false;  // certainly no root
    bool sure = false;  // all roots are near those in `at`
    int count = 0;
    std::array<double, 2> at{};
  };
  // Values at the ends of a linear function that is zero in the plane.
  [[nodiscard]] std::array<Rational, 2> plane_values(const ExactPoint& p,
                                                     const ExactPoint& normal) const;
  [[nodiscard]] Guess guess_in_one_point(
      const std::array<const PathLine*, 3>& lines) const;
  [[nodiscard]] std::vector<PathRoot> exact_in_one_point(
      const std::array<const PathLine*, 3>& lines) const;

  Viewpoint::Kind kind_;
  ExactPoint from_, to_, middle_;
  Point rounded_from_, rounded_to_, rounded_middle_;
  double rounding_;  // of coordinates
};

}  // namespace sightline::internal
