// Whether a line may touch more than what it was found by: a quick look in doubles along
// the whole maximal free segment, so that only few lines have their contacts listed.

#pragma once

#include <span>
#include <vector>

#include "linespace/generator.h"
#include "linespace/silhouettes/silhouettes.h"

namespace sightline::internal {

/// Keeps scratch, so one per thread.
class LineProbe {
 public:
  explicit LineProbe(const Silhouettes& silhouettes) : g_(silhouettes) {}

  /// False is certain: along its maximal free segment around a and b the line touches
  /// nothing but what `known` explains.  `known` are the generators that the line was
  /// found by.  A generator on a convex object explains all of that object; one on
  /// another object explains only the facets at the generator.  a and b may be off by
  /// `error`. Requires that the segment from a to b is free.  Cost: some microseconds.
  [[nodiscard]] bool may_touch_more(const Point& a, const Point& b, double error,
                                    std::span<const Generator> known);

 private:
  void name(std::span<const Generator> known);
  [[nodiscard]] bool named(int face) const;

  const Silhouettes& g_;
  std::vector<std::int32_t> objects_, facets_;  // of the generators
};

/// Face ids, ascending, of all faces that meet the line through a and b along its maximal
/// free segment around both, and some more; a and b may be rounded.  Beyond the walls
/// that end the segment, faces are left out: in a city most of those on the line.
[[nodiscard]] std::vector<int> faces_near_free_segment(const Silhouettes& silhouettes,
                                                       const Point& a, const Point& b);

/// Face ids, ascending, of all faces that meet the whole line through a and b, and some
/// that do not; b may be rounded.
[[nodiscard]] std::vector<int> faces_near_line(const Silhouettes& silhouettes,
                                               const Point& a, const Point& b);

}  // namespace sightline::internal
