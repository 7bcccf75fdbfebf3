// Where a viewpoint sees an arc's generators in line: the surface that the arc's lines
// sweep beyond an outer contact, as boxes that hug it.
//
// Notation.  N(s) is the contact that a viewing part begins at, F(s) the other outer one.
// A line of the part is X = N + l D, D = N - F, l >= 0.  Over a slice of the arc F and N
// are bilinear but for a bulge: one of them runs along its edge with t(s), a Moebius
// function, which differs from its chord by a known amount.  So the part between two
// values of l lies in the hull of four corners, grown by the bulge.
//
// Coordinates are those of a frame in which the scene fills [-1, 1]^3, and charts: chart
// 0 is this cube; chart 1 + 2 i + (negative) is what lies beyond its side, sigma X_i >= 1
// and |X_j| <= sigma X_i, in the coordinates 1, X_j, X_k by sigma X_i.  Lines are
// straight there, too, and end at 0 where they go to infinity.

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "linespace/space/box_tree.h"
#include "skeleton/end_index.h"
#include "skeleton/graph.h"

namespace sightline::internal {

/// The map into the cube: a shift, exact, and a scale; each coordinate is off by at most
/// 2^-52 of itself.
struct Frame {
  Point centre = Point::Zero();
  double scale = 1;

  explicit Frame(const Scene& scene);
  [[nodiscard]] Point operator()(const Point& p) const { return (p - centre) * scale; }
};

inline constexpr int kCharts = 7;
[[nodiscard]] constexpr int chart_of(int axis, bool negative) {
  return 1 + 2 * axis + static_cast<int>(negative);
}

struct ChartBox {
  std::int32_t chart;
  GridBox box;
  Slab slab;
};

/// Appends boxes that together contain all viewpoints at which ViewEvents may report the
/// arc.  Boxes larger than `fine` are halved, some times at most; large means the volume
/// of the box grown by kFineGrain on each axis, which is about how often a short path
/// meets it.
inline constexpr double kFineGrain = 1.0 / 128;
void viewing_boxes(const Scene& scene, const Skeleton& skeleton, const EndIndex& ends,
                   const Frame& frame, std::uint32_t arc, double fine,
                   std::vector<ChartBox>& out);

}  // namespace sightline::internal
