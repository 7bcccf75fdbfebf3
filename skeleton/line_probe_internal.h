// Whether a line may touch more than what it was found by: a quick look in doubles along
// the whole maximal free segment, so that only few lines have their contacts listed.

#pragma once

#include <limits>
#include <span>
#include <vector>

#include "skeleton/generators_internal.h"
#include "skeleton/skeleton.h"

namespace sightline::internal {

/// Faces near a line, and where it may meet others: at positions (0 at its point a, 1 at
/// b) before `from` or after `to` only.
struct NearFaces {
  std::vector<int> faces;  ///< ascending
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
};

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

  /// All faces that the line through a and b may meet up to the nearest one on either
  /// side whose inside it certainly crosses beyond the segment from a to b.  The points
  /// may be off by the rounding of their coordinates.  Cost: some microseconds.
  [[nodiscard]] NearFaces faces_near(const Point& a, const Point& b);

 private:
  struct Range {  // of positions; empty if from > to
    double from, to;
  };
  // A line, each of its two points off by at most some error in each coordinate.
  class Along {
   public:
    Along(const Scene& scene, const Point& a, const Point& b, double error);
    [[nodiscard]] Range range_in(const Box& box) const;  // wide enough

   private:
    Point a_, d_, inverse_;
    double length_;
    double size_ = 0, grow_ = 0;
  };

  [[nodiscard]] bool matters(const Range& r) const;
  template <class Visit, class Leave>
  void walk(const Along& line, const Visit& visit, const Leave& leave);
  void end_at(const Range& wall);
  void name(std::span<const Generator> known);
  [[nodiscard]] bool named(int face) const;

  const Generators& g_;
  std::vector<std::int32_t> objects_, facets_;  // of the generators
  Range free_{};                                // of the line at hand
  std::vector<Range> unsure_;
  struct Found {
    int face;
    Range range;
  };
  std::vector<Found> found_;
};

}  // namespace sightline::internal
