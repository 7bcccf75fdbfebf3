// Lines that meet four lines: how many, of which class, and the lines themselves as exact
// values in Q(sqrt D) with predicates on them.
//
// Everything is projective: lines that are parallel meet at infinity.  Nothing depends on
// the order of the four lines or on their orientation.  Coordinates must be
// is_admissible(); the two points of a LineThrough must differ.  Neither is checked here.
// docs/transversals.md derives the classes, the stages and the bounds.  Lines through
// segments are one header up, in segment_transversals.h.

#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "linespace/predicates.h"

namespace sightline {

/// All that the lines meeting four lines can be.
enum class TransversalClass {
  None,                ///< no real line
  Two,                 ///< two lines
  OneOtherAtInfinity,  ///< two lines, one of them in the plane at infinity: the four are
                       ///< parallel to one plane
  Double,              ///< one line, counted twice: a tangency
  DoubleAtInfinity,    ///< a tangency in the plane at infinity, so no finite line
  // One parameter.
  Pencil,      ///< the lines through a point in a plane
  TwoPencils,  ///< two pencils that share a line
  Regulus,     ///< one family of rulings of a hyperboloid or hyperbolic paraboloid
  // Two parameters.  The point may be at infinity: the lines of one direction.
  ThroughPoint,            ///< all lines through a point, where the four concur
  InPlane,                 ///< all lines in a plane, which holds the four
  ThroughPointAndInPlane,  ///< both: the four are of one pencil
  MeetingTwoLines,         ///< the four coincide by twos or by threes with two skew lines
  // Three parameters.
  MeetingOneLine,  ///< the four coincide
};

/// Number of parameters: 0 for isolated lines and None.
[[nodiscard]] int dimension(TransversalClass c);
/// Number of distinct finite lines of a class without parameters; 0 for the others.
[[nodiscard]] int isolated_lines(TransversalClass c);

/// The class of the lines that meet four lines.  Laws: any permutation of the four, and
/// exchanging the two points of any, gives the same.  Decided by the sign of
/// a^2 + b^2 + c^2 - 2ab - 2ac - 2bc for a = s12 s34, b = s13 s24, c = s14 s23, the s_ij
/// being the six side products (degree 12; the discriminant of the quadratic on any two
/// of the lines): negative None, positive Two or OneOtherAtInfinity, and where it is zero
/// the coincidences tell the rest.
[[nodiscard]] TransversalClass transversal_class(const LineThrough& l0,
                                                 const LineThrough& l1,
                                                 const LineThrough& l2,
                                                 const LineThrough& l3);

/// Where a line meets a closed segment.
enum class SegmentContact {
  None,
  End,       ///< at one of the two ends
  Interior,  ///< at a point between them
  Along,     ///< the segment lies on the line
};

/// A point rounded to doubles: each coordinate is off by at most `error` times its own
/// magnitude (and by 2^-1000, where it is as small as that).
struct RoundedPoint {
  Eigen::Vector3d point;
  double error;
};

/// A finite oriented line whose exact Pluecker coordinates lie in Q(sqrt D).  Immutable,
/// cheap to copy, may be shared between threads.
class ExactLine {
 public:
  /// Through two different points, oriented from a to b.
  [[nodiscard]] static ExactLine through(const Eigen::Vector3d& a,
                                         const Eigen::Vector3d& b);
  /// Through a point and meeting two lines (maybe at infinity).  nullopt unless there is
  /// exactly one such line: when the point lies on one of the two, or both lie in one
  /// plane with it.  Oriented as orientation() says.
  [[nodiscard]] static std::optional<ExactLine> through(const Eigen::Vector3d& v,
                                                        const LineThrough& l,
                                                        const LineThrough& m);
  /// The intersection of two planes; nullopt when they are parallel or the same.
  [[nodiscard]] static std::optional<ExactLine> in_planes(const PlaneThrough& p,
                                                          const PlaneThrough& q);

  /// This line, turned round.  Lines come oriented so that the first nonzero
  /// component of their direction is positive, except from through(a, b).
  [[nodiscard]] ExactLine reversed() const;
  /// True when the Pluecker coordinates are rational, up to a common factor.
  [[nodiscard]] bool is_rational() const;
  /// Signs of the components of the direction.
  [[nodiscard]] std::array<Sign, 3> direction_signs() const;

  /// On which side of this line m passes, as side() says of two lines by points; Zero
  /// exactly when they are coplanar.  Also the plane test: side({a, b}) is the side of
  /// the plane through this line and a on which b lies (orient3d of the two directions'
  /// points with a and b).
  [[nodiscard]] Sign side(const LineThrough& m) const;
  /// On which side of the plane abc this line's direction points: Positive to the front.
  [[nodiscard]] Sign heads(const PlaneThrough& plane) const;
  [[nodiscard]] bool passes_through(const Eigen::Vector3d& p) const;
  [[nodiscard]] bool is_parallel(const LineThrough& m) const;
  /// Whether and how it meets the closed segment from m.from to m.to.
  [[nodiscard]] SegmentContact meets(const LineThrough& m) const;

  /// Order of this line's contacts with l and m along its own orientation: Negative when
  /// it meets l first, Zero when it meets both in one point.  Requires side() Zero for
  /// both and neither parallel to this line.
  [[nodiscard]] Sign contact_order(const LineThrough& l, const LineThrough& m) const;
  /// Order of this line's contact with m and of a point of this line, likewise.
  [[nodiscard]] Sign contact_order(const LineThrough& m, const Eigen::Vector3d& p) const;

  /// The point where this line meets m.  The same requirements.
  [[nodiscard]] RoundedPoint contact(const LineThrough& m) const;
  /// The point of this line nearest to p.
  [[nodiscard]] RoundedPoint nearest(const Eigen::Vector3d& p) const;
  /// The direction, scaled so that its largest component has magnitude 1; bounded as
  /// RoundedPoint says.
  [[nodiscard]] RoundedPoint direction() const;

  struct Coordinates;  // exact; in lines/transversals.h
  explicit ExactLine(std::shared_ptr<const Coordinates> coordinates);
  [[nodiscard]] const Coordinates& coordinates() const { return *coordinates_; }

 private:
  std::shared_ptr<const Coordinates> coordinates_;
};

/// Whether both are the same line, whichever way they are oriented.
[[nodiscard]] bool same_line(const ExactLine& a, const ExactLine& b);

/// Order of a and b along an edge's line: the sign of (parameter where a meets it) -
/// (parameter where b does), 0 being edge.from and 1 edge.to.  Zero exactly when both
/// meet it in one point.  Requires that both meet it and are not parallel to it.
[[nodiscard]] Sign compare_along(const LineThrough& edge, const ExactLine& a,
                                 const ExactLine& b);
/// The same for a point of the edge's line instead of b.
[[nodiscard]] Sign compare_along(const LineThrough& edge, const ExactLine& a,
                                 const Eigen::Vector3d& p);

/// The lines that meet four lines.
struct LineTransversals {
  TransversalClass kind = TransversalClass::None;
  /// The isolated ones, finite: isolated_lines(kind) of them.  A line that meets one of
  /// the four only at infinity (is parallel to it) is among them: is_parallel() tells.
  std::vector<ExactLine> lines;
};

/// The class as transversal_class() and the isolated lines as exact values.
[[nodiscard]] LineTransversals transversals(const LineThrough& l0, const LineThrough& l1,
                                            const LineThrough& l2, const LineThrough& l3);

}  // namespace sightline
