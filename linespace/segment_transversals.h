// All lines that meet four of n segments and lines: isolated ones, each with every
// element it meets, and families.
//
// Definitions.  The elements are closed segments and unbounded lines.  For four elements
// Q let T(Q) be the set of lines that meet all four (a line through a common point of two
// of them meets both there).  T(Q) has finitely many connected components: at most 4 for
// four segments (Broennimann et al. 2005).
// - A line is *isolated* if it is a component of T(Q) by itself, for some Q.  It is
//   reported once, with all elements that it meets.
// - A *family* is a component of T(Q), for some Q, that holds more than one line.  Equal
//   sets of lines are one family, reported once, with all elements that every line of it
//   meets.  Its dimension is that of its largest part.
// A line may be isolated for one Q and lie in a family of another.  For unbounded
// elements components are told apart projectively, with contacts at infinity counted, so
// that a family is not cut in two where one of its lines is parallel to an element; but
// an isolated line must meet its four at finite points. Nothing depends on the order of
// the elements, on their orientation, or on threads. docs/transversals.md tells how it is
// found and what it costs.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "linespace/request.h"
#include "linespace/transversals.h"

namespace sightline {

/// What the lines of a family are, told by its largest parts.
enum class FamilyKind {
  // One dimension.
  Pencil,         ///< lines through a point, in a plane
  JoinedPencils,  ///< several such, joined by common lines
  Regulus,        ///< rulings of a hyperboloid or hyperbolic paraboloid
  // Two dimensions.
  Star,        ///< all lines through a point
  Plane,       ///< lines in a plane
  StarPlane,   ///< all lines through a point, and lines in a plane through it
  Congruence,  ///< lines that meet a segment on each of two skew lines
  // Three dimensions.
  Complex,  ///< all lines that meet a segment (common to elements on one line)
};
[[nodiscard]] std::string_view family_name(FamilyKind kind);

struct TransversalFamily {
  FamilyKind kind;
  int dimension;
  std::vector<int> elements;  ///< that all its lines meet, ascending
  /// One of its lines.
  ExactLine sample;
};

/// An isolated line, as found from four of its elements.  SegmentTransversals tells what
/// it meets and where it runs.
struct IsolatedTransversal {
  std::array<int, 4> generators;  ///< for which it is isolated, ascending
  /// Parameters of its contacts with the first two (0 at `from`, 1 at `to`), rounded;
  /// when exact < 0.
  std::array<double, 2> at;
  /// In SegmentTransversals::exact_lines; -1 for a line that meets just its generators,
  /// in their interiors, which doubles with bounds could prove.
  int exact;
};

struct SegmentTransversals {
  std::vector<IsolatedTransversal> lines;
  std::vector<TransversalFamily> families;
  /// Number of isolated lines; lines.size() unless only counted.
  std::uint64_t line_count = 0;
  bool complete = true;
  StageCounts predicates;
  std::vector<LineThrough> elements;  ///< that were asked for

  struct Settled {
    ExactLine line;
    std::vector<int> elements;  ///< that it meets, ascending
  };
  std::vector<Settled> exact_lines;  ///< those that doubles could not settle

  /// Line i as an exact value.
  [[nodiscard]] ExactLine exact(std::size_t i) const;
  /// The elements that line i meets, ascending.
  [[nodiscard]] std::span<const int> contacts_of(std::size_t i) const {
    const IsolatedTransversal& line = lines[i];
    if (line.exact < 0) return line.generators;
    return exact_lines[static_cast<std::size_t>(line.exact)].elements;
  }
};

struct TransversalRequest : Request {
  /// Do not keep the lines, only count them.
  bool only_count = false;
};

/// Elements are numbered segments first, then lines.  Requires admissible coordinates and
/// two different points each; throws InvalidInput that names the element otherwise.
/// Cost: for segments in general position, time in proportion to the triples plus the
/// quadruples of which every three can be met; about 50 times more for what is
/// degenerate.
[[nodiscard]] SegmentTransversals transversals_of_segments(
    std::span<const LineThrough> segments, std::span<const LineThrough> lines = {},
    const TransversalRequest& request = {});

}  // namespace sightline
