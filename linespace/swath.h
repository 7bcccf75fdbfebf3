// A swath: the lines of a one-parameter set, through a vertex and an edge or through
// three edges.  What an arc of the visibility skeleton is a part of.
//
//   const auto swath = Swath::through(edge, middle, last);  // nullopt: no such set
//   for (const Swath::Position& s : swath->meeting(fourth).at) ...  // exact positions
//   const Swath::Trace shadow = swath->trace(floor);  // the curve it marks on a plane
//   for (const auto& [p, q] : swath->rungs({0, 1}, 1e-3)) ...       // a strip to draw
//
// Notation.  The line at position s joins X(s) on the first generator to Y(s) on the
// last, points with weights, both linear in s, 0 <= s <= 1:
//   vertex v and edge e0 e1:  X = v,  Y = (1-s) e0 + s e1;
//   edges p0 p1, m0 m1, q0 q1:  X = (1-s) p0 + s p1,  Y = F0 q1 - F1 q0 of weight F0 -
//   F1,
//     F_b(s) = orient3d(X(s), q_b, m0, m1), for this is where X's line through the middle
//     edge meets the last one.
// So the line meets a fourth one where a polynomial of degree two in s vanishes, X or Y
// lies in a plane where one of degree one does, and what the line marks on a plane is a
// quotient of polynomials of degree two: a segment for a vertex and an edge, an arc of a
// conic for three edges.
//
// Teller 1992 calls the surface a swath, Durand, Drettakis and Puech 1997 the set of
// lines a critical line set.

#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "linespace/predicates.h"
#include "linespace/scene.h"

namespace sightline {

/// Immutable; cheap to copy; safe to share between threads.
class Swath {
 public:
  /// The lines through a vertex and the points of an edge: a part of a pencil.  nullopt
  /// when the vertex lies on the edge's line.
  [[nodiscard]] static std::optional<Swath> through(const Point& vertex,
                                                    const LineThrough& edge);
  /// The lines through three edges, whose positions are told on the first: rulings of a
  /// quadric, or pencils where two of the edges' lines meet.  nullopt where all lines
  /// between the first and the last edge meet the middle one's line: then they are no set
  /// of one parameter.
  [[nodiscard]] static std::optional<Swath> through(const LineThrough& first,
                                                    const LineThrough& middle,
                                                    const LineThrough& last);

  /// A position s, exact: a rational number, or one with a square root.
  class Position {
   public:
    /// The position that a double is.  Requires a finite one.
    explicit Position(double s);
    /// Rounded, off by at most 2^-48 of itself.
    [[nodiscard]] double value() const { return value_; }
    /// The sign of a - b, exact.
    [[nodiscard]] static Sign compare(const Position& a, const Position& b);

   private:
    friend class Swath;
    struct Exact;  // swaths/swath.cpp
    explicit Position(std::shared_ptr<const Exact> exact);
    std::shared_ptr<const Exact> exact_;
    double value_ = 0;
  };

  /// Positions in [0, 1], ascending, where something happens; `always`: at all of them.
  struct Positions {
    bool always = false;
    std::vector<Position> at;
  };
  /// Where the line meets another, or is parallel to it: at most two positions.
  [[nodiscard]] Positions meeting(const LineThrough& line) const;
  /// Where the point on the first, on the last generator lies in a plane: at most one.
  [[nodiscard]] Positions first_in(const PlaneThrough& plane) const;
  [[nodiscard]] Positions last_in(const PlaneThrough& plane) const;

  /// The curve that the lines mark on a plane: points (x, y, z) / w, each of the four a
  /// polynomial c0 + c1 s + c2 s^2 whose coefficients are correct to 2^-49 of themselves
  /// before a common scale.  The curve of a vertex and an edge is
  /// straight.
  struct Trace {
    std::array<std::array<double, 3>, 4> coefficients;
    /// True for lines through three edges: their curve is a conic, straight only by
    /// chance.
    bool curved;
    /// Not finite where the line is parallel to the plane.
    [[nodiscard]] Point at(double s) const;
  };
  [[nodiscard]] Trace trace(const PlaneThrough& plane) const;

  /// X(s) and Y(s), rounded, Y moved onto the last edge where it lies beyond its ends.
  [[nodiscard]] std::array<Point, 2> line(double s) const;
  /// The position t of Y(s) on the last edge, rounded and moved likewise.
  [[nodiscard]] double last_parameter(double s) const;

  /// Lines in order of s from range[0] to range[1], both included, such that the triangle
  /// strip X0 Y0 X1 Y1 ... over them is nowhere farther than `deviation` (scene units)
  /// from the surface they span, nor the surface from the strip, rounding aside.
  ///
  /// Why: let neighbouring lines be P0Q0 and P1Q1.  Between them a point of the surface
  /// is (1-u) ((1-a) P0 + a P1) + u ((1-b) Q0 + b Q1), as P and Q move on straight edges,
  /// and b is a Moebius function of a that fixes 0 and 1: b = a / (a + k (1-a)).  The
  /// weights of P0 and Q1 are (1-u)(1-a) and u b; with m the smaller one, moving the
  /// point by m (P1 - P0 + Q0 - Q1) makes it zero and puts the point on triangle P0 Q0 P1
  /// or P1 Q0 Q1.  For given a, m is largest where both weights are equal, 1 / (1/b +
  /// 1/(1-a)), and over a that is at most 1 / (2 (1 + sqrt k)), reached at a = 1 -
  /// 1 / (1 + sqrt k).  So the deviation is at most |(P1-P0) - (Q1-Q0)| / (2 (1 + sqrt
  /// k)), and halves with the step in s.
  [[nodiscard]] std::vector<std::array<Point, 2>> rungs(std::array<double, 2> range,
                                                        double deviation) const;

  /// The volume, in cubic scene units, of the tetrahedron between the lines at the ends
  /// of a range: how much the surface bends, 0 where it is flat.
  [[nodiscard]] double spanned_volume(std::array<double, 2> range) const;

 private:
  struct Impl;
  explicit Swath(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  std::shared_ptr<const Impl> impl_;
};

}  // namespace sightline
