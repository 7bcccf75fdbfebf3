#include <Eigen/Geometry>
#include <algorithm>

#include "skeleton/opposite_edges_internal.h"

namespace sightline::internal {
namespace {

// The chord of the edge on the unit sphere around the viewpoint.  A coordinate is rounded
// in the difference, thrice in the norm and in the quotient.
Box box_of_directions(const Point& at, const std::array<Point, 2>& edge) {
  const std::array<Point, 2> chord{(edge[0] - at).normalized(),
                                   (edge[1] - at).normalized()};
  Box box = box_of(chord);
  for (int i = 0; i < 3; ++i) {
    box.min[i] -= 16 * kUnitRoundoff;
    box.max[i] += 16 * kUnitRoundoff;
  }
  return box;
}

std::vector<Box> boxes_of(const Point& at, std::span<const std::array<Point, 2>> edges) {
  std::vector<Box> boxes;
  boxes.reserve(edges.size());
  for (const auto& e : edges) boxes.push_back(box_of_directions(at, e));
  return boxes;
}

// The cone opposite that of a viewpoint and an edge.
class OppositeCone {
 public:
  OppositeCone(const Point& at, const std::array<Point, 2>& edge)
      : own_(plane_from(at, edge[0], edge[1])) {
    const Point above = at + (edge[0] - at).cross(edge[1] - at);
    // Rounding may have lost which side it is on.
    const Point up = above - at;
    const std::array<double, 3> c{up[0], up[1], up[2]};
    sides_ = own_.positive_on(c, {0, 0, 0});
    if (!sides_) return;
    first_ = plane_from(at, edge[0], above);
    second_ = plane_from(at, edge[1], above);
  }

  /// False proves that no point of the box, relative to the viewpoint, is in it.  With
  /// the edge's ends u and w seen from the viewpoint, the first plane is negative at w
  /// and the second positive at u: at -a u - b w, with a and b positive, it is the other
  /// way round.
  [[nodiscard]] bool may_meet(const Box& box) const {
    const CentredBox b = centred(box);
    if (own_.negative_on(b.centre, b.half) || own_.positive_on(b.centre, b.half)) {
      return false;
    }
    return !sides_ || !(first_.negative_on(b.centre, b.half) ||
                        second_.positive_on(b.centre, b.half));
  }

 private:
  BoundedPlane own_, first_, second_;
  bool sides_;
};

}  // namespace

OppositeEdges::OppositeEdges(const Point& viewpoint,
                             std::span<const std::array<Point, 2>> edges)
    : at_(viewpoint), edges_(edges), boxes_(boxes_of(viewpoint, edges)), tree_(boxes_) {}

void OppositeEdges::above(std::size_t i, std::vector<std::uint32_t>& found) const {
  found.clear();
  const OppositeCone cone(at_, edges_[i]);
  tree_.traverse([&](const Box& box) { return cone.may_meet(box); },
                 [&](std::uint32_t j) {
                   if (j > i && cone.may_meet(boxes_[j])) found.push_back(j);
                 });
  std::sort(found.begin(), found.end());
}

}  // namespace sightline::internal
