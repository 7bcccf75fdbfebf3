// All lines that meet four of a few segments, by looking at every quadruple in exact
// arithmetic: written from the definitions below, sharing no code with the library.
//
// T(Q) is the set of lines that meet every closed segment of the quadruple Q; a line
// meets a segment that it contains.  It is a compact set of lines with finitely many
// connected components.  A line is *isolated* in T(Q) when it is such a component all by
// itself: no other line near it meets the same four segments.  That is asked of the
// segments, not of the lines that carry them: of four segments on one regulus, whose
// lines have infinitely many transversals, exactly one may pass through all four.  What
// is not isolated belongs to *families*.
//
// For a set of segments, a line counts once, however many quadruples it is isolated for,
// and is listed with all the segments it meets, which can be more than four.  It may at
// the same time lie inside a family of other quadruples.  (Not counted: a line isolated
// among those that meet all of five or more segments, but in no T(Q) of four of them.)

#pragma once

#include <compare>
#include <set>
#include <span>
#include <vector>

#include "tests/support/exact.h"

namespace sightline::testing {

/// Two different points.
struct ExactSegment {
  Vec3 a, b;
};

/// The number x + sign(w) sqrt(|w|); w is 0 where the root would be rational, so that
/// equal numbers have equal parts.
struct QuadraticNumber {
  Rational x, w;
  friend bool operator==(const QuadraticNumber&, const QuadraticNumber&) = default;
  friend bool operator<(const QuadraticNumber& a, const QuadraticNumber& b) {
    return a.x != b.x ? a.x < b.x : a.w < b.w;  // an order for sets, not by value
  }
};

/// Pluecker coordinates: direction, then moment (point x direction), divided by the first
/// of them that is not zero.  Equal lines, however oriented, compare equal.
using CanonicalLine = std::array<QuadraticNumber, 6>;

[[nodiscard]] bool meets(const CanonicalLine& line, const ExactSegment& s);

enum class NaiveFamilyKind {
  Pencil,      ///< through a point (or parallel) and in a plane
  Regulus,     ///< rulings of a quadric of one sheet
  Star,        ///< through a point
  Plane,       ///< in a plane that holds all segments
  Congruence,  ///< meeting pieces of two skew lines on which all segments lie
  Complex      ///< meeting a common piece of the one line on which all segments lie
};

struct NaiveFamily {
  /// Of the part that meets the segments: a Plane's may be 1 or 2, a Congruence's, too.
  int dimension;
  NaiveFamilyKind kind;
  friend auto operator<=>(const NaiveFamily&, const NaiveFamily&) = default;
};

struct QuadrupleTransversals {
  std::set<CanonicalLine> isolated;
  /// Kinds that occur, not connected components: each once, of the largest dimension in
  /// which it occurs.  Where one family is part of another, or joined to it, both may be
  /// listed; a Plane's of dimension 1 is a pencil.
  std::set<NaiveFamily> families;
};

/// T(Q), for two to four segments.  Cost: about 50 us.
[[nodiscard]] QuadrupleTransversals naive_quadruple(std::span<const ExactSegment> q);

struct NaiveLine {
  CanonicalLine line;
  /// Indices of all segments it meets, ascending; at least four.
  std::vector<int> segments;
};

struct NaiveTransversals {
  std::vector<NaiveLine> lines;
  /// Families of all quadruples, each (dimension, kind) once.
  std::set<NaiveFamily> families;
};

/// Cost: n^4 / 24 quadruples; 30 segments take a few seconds.
[[nodiscard]] NaiveTransversals naive_transversals(
    std::span<const ExactSegment> segments);

}  // namespace sightline::testing
