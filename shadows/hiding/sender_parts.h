// What a side that sends out cannot see, in groups: whole convex objects hidden by
// others.  Pairs with them need not be looked at, and they need not be looked at as
// blockers either, since a line that meets one has met something else before.

#pragma once

#include <vector>

#include "shadows/factors/pair_blockers.h"
#include "shadows/hiding/convex_solids.h"

namespace sightline::internal {

/// A side, or a part of one.
struct SenderPart {
  PreparedSide side;
  /// By solid: surely nothing of it is seen from the part.
  std::vector<char> hidden;

  [[nodiscard]] bool hides(int solid) const { return solid >= 0 && hidden[solid] != 0; }
};

/// Keeps a reference to the solids.  Immutable.
class SenderParts {
 public:
  explicit SenderParts(const ConvexSolids& solids);

  /// Beside solids, so that of() may cut it.
  [[nodiscard]] bool is_large(const PreparedSide& side) const;
  /// A side that sees many solids and is large beside them is cut in halves, again and
  /// again: each part sees few.  Cost: for each part and each solid that the whole part
  /// before it may see, those that may stand between.
  [[nodiscard]] std::vector<SenderPart> of(const PreparedSide& side) const;

 private:
  // More solids than this make a crowd, in which an integral takes milliseconds.
  static constexpr int kCrowd = 24;

  void find_hidden(SenderPart& part) const;
  [[nodiscard]] bool is_hidden(const PreparedSide& from, int solid) const;
  [[nodiscard]] bool hidden_by_parts(const PointList& from, const Box& box,
                                     std::vector<int> among, int cuts) const;

  const ConvexSolids& solids_;
  double mean_size_ = 0;  // of solids: diagonals of their boxes, scene units
};

}  // namespace sightline::internal
