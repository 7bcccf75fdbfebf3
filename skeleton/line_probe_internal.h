// Whether a line may touch more than what it was found by: a quick look in doubles along
// the whole maximal free segment, so that only few lines have their contacts listed.

#pragma once

#include <span>
#include <vector>

#include "skeleton/generators_internal.h"
#include "skeleton/skeleton.h"

namespace sightline::internal {

/// Keeps scratch, so one per thread.
class LineProbe {
 public:
  explicit LineProbe(const Generators& generators) : g_(generators) {}

  /// False: certain that the line through a and b, each off by at most `error`, touches
  /// nothing along its maximal free segment around both but the objects of `known`, its
  /// generators, that are convex, and of others the facets at these.  Requires that the
  /// segment from a to b is free.  Cost: some microseconds.
  [[nodiscard]] bool may_touch_more(const Point& a, const Point& b, double error,
                                    std::span<const Generator> known);

 private:
  void name(std::span<const Generator> known);
  [[nodiscard]] bool named(int face) const;

  const Generators& g_;
  std::vector<std::int32_t> objects_, facets_;  // of the generators
};

/// Face ids, ascending, of all faces that meet the line through a and b along its maximal
/// free segment around both, and some more; a and b may be rounded.  Beyond the walls
/// that end the segment, faces are left out: in a city most of those on the line.
[[nodiscard]] std::vector<int> faces_near_free_segment(const Generators& generators,
                                                       const Point& a, const Point& b);

}  // namespace sightline::internal
