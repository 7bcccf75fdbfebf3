// Parts of view space, and what surely cannot be seen from anywhere in one.
//
// Eyes and directions are one thing here: (x, w) stands for the eye at centre + size x/w,
// and w = 0 for directions.  A region is a box of these four numbers.  The side of a
// plane and of a line in space on which (x, w) lies is linear in it, so that a region
// lies on one side iff its corners do.

#pragma once

#include <array>
#include <functional>
#include <vector>

#include "aspect/choice/patch_sides.h"

namespace sightline::internal {

struct ViewRegion {
  std::array<double, 4> low, high;
};

/// View space, cut into regions; subdivided further by halves.
class ViewSpace {
 public:
  ViewSpace(const Scene& scene, const ViewpointRequest& request);

  [[nodiscard]] const std::vector<ViewRegion>& whole() const { return whole_; }
  /// Two halves; the widest of its intervals is cut, off the middle.
  [[nodiscard]] std::array<ViewRegion, 2> halves(const ViewRegion& region) const;

  /// From nowhere in the region is this side's front seen: proved.
  [[nodiscard]] bool behind(const ViewRegion& region, const PatchSide& side) const;
  /// All of the region is in front of it: proved.
  [[nodiscard]] bool in_front(const ViewRegion& region, const PatchSide& side) const;
  /// Of the sine of the angle at which directions of the region look at a plane with this
  /// normal: at most this.
  [[nodiscard]] double most_sine(const ViewRegion& region, const PatchSide& side) const;
  /// Eyes of the region have a smaller distance from points of this box than this
  /// nowhere.
  [[nodiscard]] double least_distance(const ViewRegion& region, const Point& low,
                                      const Point& high) const;

  /// (b - a) x (c - a) . (eye - a), by the weight w of the eye: its least value over the
  /// region is 0 or more.  Exact.
  [[nodiscard]] bool never_below(const ViewRegion& region, const Point& a, const Point& b,
                                 const Point& c) const;
  /// Some eye well in the region; far away where w = 0.
  [[nodiscard]] Point middle(const ViewRegion& region) const;

 private:
  // The largest and the least value of a side's plane in a region, with the error.
  struct Range {
    double least, most, error;
  };
  [[nodiscard]] Range range(const ViewRegion& region, const PatchSide& side) const;

  Point centre_;
  double size_;
  std::vector<ViewRegion> whole_;
};

/// An upper bound of what views may have, over a region, from its sides that are not
/// behind (positions in the list of sides).
using RegionBound =
    std::function<double(const ViewRegion&, const std::vector<int>& possible)>;

/// The largest bound of a region, after the regions with the largest were halved `steps`
/// times, or until none exceeds `reached`, which some view has.  Throws Stopped.
[[nodiscard]] double bound_over(const ViewSpace& space,
                                const std::vector<PatchSide>& sides,
                                const RegionBound& bound, double reached, int steps);

/// The largest sum of the weights of sides of which an eye may be in front of all at
/// once, as far as parallel planes tell.  `possible`: ascending, its weights alike;
/// `far`: an eye infinitely far away.
[[nodiscard]] double most_together(const std::vector<PatchSide>& sides,
                                   const std::vector<int>& possible,
                                   const std::vector<double>& weight, bool far);

}  // namespace sightline::internal
