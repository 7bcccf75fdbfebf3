// The contacts of one exact line as a node sees them: which generators it touches, in
// order, and the kind that these make.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "linespace/contacts/contact.h"
#include "linespace/lines/line_name.h"
#include "linespace/sight/free_segment.h"
#include "linespace/silhouettes/silhouettes.h"
#include "skeleton/graph.h"

namespace sightline::internal {

/// Kinds of lines that touch no more than the other lines of an arc, and in which that
/// one arc ends.  Which of their contacts are end contacts, the arc says.
[[nodiscard]] inline bool ends_one_arc(NodeKind kind) {
  return kind == NodeKind::Pierce || kind == NodeKind::Saddle;
}

/// A node as its contacts make it.
struct NodeContacts {
  NodeKind kind = NodeKind::Degenerate;
  bool self = false;
  bool end = false;  ///< some contact blocks the segment
  /// Whether the contact at position 0, that at 1 blocks the segment; of
  /// contacts_along(): the first and the last of the contacts listed.
  std::array<bool, 2> ends{};
  std::vector<Generator> generators;  ///< in order along the line
  bool turned = false;                ///< listed against the line's direction
  /// Both directions of the line list the same: `segment` has that of the line.
  bool both_ways = false;
  /// Of the two irrational lines through the same edges this is the second.
  bool second = false;
  /// Of a rational line that is Degenerate, of contacts_along(): tells it from others
  /// that make the same contacts, as lines of a pencil may; else empty.
  LineName line;
  /// The outermost contacts, rounded, in the order of `generators`; of contacts_along().
  std::array<Point, 2> segment{Point::Zero(), Point::Zero()};
  /// Solid mode, of contacts_along() of a Degenerate line: a part of the line, by
  /// positions, all of whose contacts graze, so that other segments on it have the same
  /// contacts along their maximal free segment; none where one of its contacts blocks,
  /// or `both_ways`.
  std::optional<std::array<Rational, 2>> free_part;
};

/// The node that these contacts make.  The contacts are given in order along the line;
/// the node lists its generators from the end with the smaller ones.
[[nodiscard]] NodeContacts node_along(
    const Silhouettes& silhouettes, const std::vector<std::vector<Generator>>& contacts);

/// Of the contacts that meet the closed segment [0, 1] of the line.
[[nodiscard]] NodeContacts contacts_between(const Silhouettes& silhouettes,
                                            const LineScan& scan);

/// Of those along the whole maximal free segment around [0, 1] of the scan's line, given
/// by its points at 0 and 1; listed from the end with the smaller generators.  `end`
/// says that the line may end at 0 or 1.  Polygon mode: `grazes` says that an arc of
/// solid mode ends there, and then the contacts are those of solid mode; else those at
/// which the free segment ends are among them, where they are corners or edges.  `name`:
/// of the line, where it is known.
[[nodiscard]] NodeContacts contacts_along(const Silhouettes& silhouettes,
                                          const LineScan& scan,
                                          const std::array<ExactPoint, 2>& line, bool end,
                                          bool grazes, const LineName* name = nullptr);

class KnownLines;

struct LineQuestion {
  bool grazes = true;  ///< as for contacts_along()
  /// Whether the line may end at 0 or 1; nullopt: as contacts_between() says.
  std::optional<bool> end = {};
  /// contacts_between() is wanted where `along` is not Degenerate.
  bool between = false;
};
struct LineContacts {
  NodeContacts along;
  std::optional<NodeContacts> between;
  bool end = false;  ///< as told, or as contacts_between() says
};

/// contacts_along() of the line through two points, unless it is known.
[[nodiscard]] LineContacts contacts_of_line(const Silhouettes& silhouettes,
                                            KnownLines& known,
                                            const std::array<ExactPoint, 2>& line,
                                            const LineQuestion& question);

}  // namespace sightline::internal
