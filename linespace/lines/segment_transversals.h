// Lines that meet a few segments exactly, whatever their position: what
// segment_transversals.cpp asks where its doubles are not sure.

#pragma once

#include <array>
#include <span>
#include <vector>

#include "linespace/numbers/surd.h"
#include "linespace/segment_transversals.h"

namespace sightline::internal {

/// A closed segment, or the whole line through its two points.
struct Element {
  LineThrough line;
  bool bounded = true;
};

/// Consecutive lines of a one-parameter family: its ends, and one between them.
using LineArc = std::array<ExactLine, 3>;

/// A family as a set of lines.
struct ExactFamily {
  FamilyKind kind;
  int dimension;
  /// Lines at the ends of its bounding arcs, without repeats; with `points` they tell it
  /// from other families of its kind.
  std::vector<ExactLine> corners;
  /// Star: the point; Complex: the two ends of the segment; homogeneous.
  std::vector<std::array<Ring, 4>> points;
  /// The whole family if it has one dimension, its boundary in a plane if it has two; the
  /// corners of a congruence stand for it.
  std::vector<LineArc> arcs;
  /// A line of its largest part.
  std::vector<ExactLine> samples;
  /// The four it was found from.
  std::vector<Element> elements;
};

/// The connected components of T(Q).
struct FourComponents {
  std::vector<ExactLine> isolated;
  std::vector<ExactFamily> families;
};

using FourElements = std::array<Element, 4>;
[[nodiscard]] FourComponents components_of(const FourElements& elements);

/// Whether every line of the family meets an element.
[[nodiscard]] bool all_meet(const ExactFamily& family, const Element& element);

/// Whether a line has a finite common point with an element.
[[nodiscard]] bool meets(const ExactLine& line, const Element& element);

/// Whether two families are the same set of lines.
[[nodiscard]] bool same_family(const ExactFamily& a, const ExactFamily& b);

}  // namespace sightline::internal
