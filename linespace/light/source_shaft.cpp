#include "linespace/light/source_shaft.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace sightline::internal {
namespace {

double most(const Point& normal, const Point& base, const Box& box) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    sum +=
        std::max(normal[i] * (box.min[i] - base[i]), normal[i] * (box.max[i] - base[i]));
  }
  return sum;
}

}  // namespace

// The normal is a cross product of differences a and b of doubles, each off by 2^-53 of
// itself, so by at most 8 * 2^-53 |a| |b|; its product with a difference as long as the
// scene adds as much.  2^-47 covers both.
SourceShaft::SourceShaft(const Point& from, const Point& to, std::span<const Point> hull,
                         double size) {
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const Point& a = hull[k];
    const Point way = hull[(k + 1) % hull.size()] - a;
    std::array<Side, 2> both;
    for (int i = 0; i < 2; ++i) {
      const Point end = (i == 0 ? from : to) - a;
      both[i] = {end.cross(way), a, 0x1p-47 * end.norm() * way.norm() * size};
    }
    sides_.push_back(both);
  }
}

bool SourceShaft::may_meet_before(const Box& box) const {
  return std::ranges::all_of(sides_, [&](const std::array<Side, 2>& both) {
    return std::ranges::any_of(
        both, [&](const Side& s) { return most(s.normal, s.base, box) >= -s.margin; });
  });
}

bool SourceShaft::may_meet_beyond(const Box& box) const {
  return std::ranges::all_of(sides_, [&](const std::array<Side, 2>& both) {
    return std::ranges::any_of(
        both, [&](const Side& s) { return most(-s.normal, s.base, box) >= -s.margin; });
  });
}

bool SourceShaft::may_meet_before(const Point& p, const Point& q) const {
  return std::ranges::all_of(sides_, [&](const std::array<Side, 2>& both) {
    return std::ranges::any_of(both, [&](const Side& s) {
      return s.normal.dot(p - s.base) >= -s.margin ||
             s.normal.dot(q - s.base) >= -s.margin;
    });
  });
}

bool SourceShaft::may_meet_beyond(const Point& p, const Point& q) const {
  return std::ranges::all_of(sides_, [&](const std::array<Side, 2>& both) {
    return std::ranges::any_of(both, [&](const Side& s) {
      return s.normal.dot(p - s.base) <= s.margin || s.normal.dot(q - s.base) <= s.margin;
    });
  });
}

}  // namespace sightline::internal
