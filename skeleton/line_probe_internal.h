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
  struct Range {
    double from, to;
  };
  std::vector<Range> unsure_;  // positions: 0 at a, 1 at b; empty if from > to
};

}  // namespace sightline::internal
