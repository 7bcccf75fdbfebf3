#include "shadows/factors/pair_blockers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "linespace/space/shaft.h"
#include "shadows/factors/exchange_geometry.h"

namespace sightline::internal {
namespace {

PlaneSide plane_of(std::span<const Point> polygon) {
  const auto c = spanning_corners(polygon);
  return PlaneSide({c[0], c[1], c[2]});
}

std::vector<Box> boxes_of(const std::vector<PointList>& polygons) {
  std::vector<Box> boxes;
  for (const PointList& p : polygons) boxes.push_back(box_of(p));
  return boxes;
}

bool any_before(const PlaneSide& plane, const PointList& points) {
  return std::ranges::any_of(points,
                             [&](const Point& p) { return plane(p) == Sign::Positive; });
}

/// A plane through a side of one polygon and a corner of the other that has both on one
/// side: a blocker wholly on or beyond it is beside all segments but for some that touch.
struct SupportingPlane {
  PlaneSide side;
  Sign beyond;
};

void add_supporting_planes(const PointList& a, const PointList& b,
                           std::vector<SupportingPlane>& planes) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (const Point& q : b) {
      const PlaneSide plane({a[i], a[i + 1 < a.size() ? i + 1 : 0], q});
      bool before = false, behind = false;
      for (const PointList* points : {&a, &b}) {
        for (std::size_t k = 0; k < points->size() && !(before && behind); ++k) {
          const Sign s = plane((*points)[k]);
          before = before || s == Sign::Positive;
          behind = behind || s == Sign::Negative;
        }
      }
      if (before != behind) {
        planes.push_back({plane, before ? Sign::Negative : Sign::Positive});
      }
    }
  }
}

}  // namespace

std::array<PointList, 2> halves(const PointList& polygon) {
  Point low = polygon[0], high = polygon[0];
  for (const Point& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const double middle = 0.5 * (low[axis] + high[axis]);
  std::array<PointList, 2> parts;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if (a[axis] <= middle) parts[0].push_back(a);
    if (a[axis] >= middle) parts[1].push_back(a);
    if ((a[axis] < middle) != (b[axis] < middle) && a[axis] != middle &&
        b[axis] != middle) {
      const Point cut = a + (middle - a[axis]) / (b[axis] - a[axis]) * (b - a);
      parts[0].push_back(cut);
      parts[1].push_back(cut);
    }
  }
  return parts;
}

PreparedSide::PreparedSide(const FactorSide& side)
    : polygon(side.polygon),
      of(side.of),
      object(side.object),
      area(area_of(side.polygon)),
      box(box_of(side.polygon)),
      plane(plane_of(side.polygon)) {}

// The plane stays that of the side, so that nothing is rounded but corners at the cut.
PreparedSide part_of(const PreparedSide& side, PointList polygon) {
  PreparedSide part = side;
  part.area = area_of(polygon);
  part.box = box_of(polygon);
  part.polygon = std::move(polygon);
  return part;
}

bool facing(const PreparedSide& a, const PreparedSide& b) {
  return any_before(a.plane, b.polygon) && any_before(b.plane, a.polygon);
}

bool wholly_facing(const PreparedSide& a, const PreparedSide& b) {
  const auto all = [](const PlaneSide& plane, const PointList& points) {
    return std::ranges::none_of(
        points, [&](const Point& p) { return plane(p) == Sign::Negative; });
  };
  return all(a.plane, b.polygon) && all(b.plane, a.polygon);
}

PairBlockers::PairBlockers(const Scene& scene, const FactorScene& factors)
    : blockers_(factors.blockers),
      solid_faces_(factors.solid_blockers),
      solids_(scene),
      tree_(boxes_of(blockers_), 1) {
  for (const PointList& p : blockers_) planes_.push_back(plane_of(p));
  for (const int object : factors.blocker_object) {
    solid_of_.push_back(object < 0 ? -1 : solids_.of_object(object));
  }
}

void PairBlockers::between(const PreparedSide& a, const PreparedSide& b,
                           const std::vector<char>* hidden,
                           std::vector<int>& found) const {
  found.clear();
  const Shaft shaft(a.box, b.box);
  tree_.traverse(
      [&](const Box& box) { return shaft.may_meet(box); },
      [&](std::uint32_t i) {
        if (hidden != nullptr && solid_of_[i] >= 0 && (*hidden)[solid_of_[i]] != 0)
          return;
        if (any_before(a.plane, blockers_[i]) && any_before(b.plane, blockers_[i])) {
          found.push_back(static_cast<int>(i));
        }
      });
  if (found.empty()) return;
  std::vector<SupportingPlane> planes;
  add_supporting_planes(a.polygon, b.polygon, planes);
  add_supporting_planes(b.polygon, a.polygon, planes);
  std::erase_if(found, [&](int i) {
    return std::ranges::any_of(planes, [&](const SupportingPlane& plane) {
      return std::ranges::all_of(blockers_[i], [&](const Point& p) {
        const Sign s = plane.side(p);
        return s == plane.beyond || s == Sign::Zero;
      });
    });
  });
  std::ranges::sort(found);
}

// A line that leaves an object through the face comes from behind it.  It began outside
// the object, so that it has come in through another face, and began before that one.
void PairBlockers::leave_out_exits(const PreparedSide& a, std::vector<int>& found) const {
  std::erase_if(found, [&](int i) {
    return static_cast<std::size_t>(i) < solid_faces_ &&
           !any_before(planes_[i], a.polygon);
  });
}

// A convex set that meets every segment between corners of two convex sets meets all
// segments between the two: a plane that has the convex set on one side and a segment on
// the other also has on that other side a corner of either.
bool PairBlockers::hides(int blocker, const PointList& a, const PointList& b) const {
  const PlaneSide& plane = planes_[blocker];
  const PointList& p = blockers_[blocker];
  const auto side_of_all = [&](const PointList& points) {
    const Sign s = plane(points[0]);
    for (const Point& x : points) {
      if (plane(x) != s) return Sign::Zero;
    }
    return s;
  };
  const Sign sa = side_of_all(a), sb = side_of_all(b);
  if (sa == Sign::Zero || sa != -sb) return false;
  for (const Point& x : a) {
    for (const Point& y : b) {
      for (std::size_t k = 0; k < p.size(); ++k) {
        const Sign s = orient3d(x, y, p[k], p[k + 1 < p.size() ? k + 1 : 0]);
        if (s == sa) return false;
      }
    }
  }
  return true;
}

bool PairBlockers::hidden_by_solid(const PointList& a, const PointList& b) const {
  bool hidden = false;
  const Shaft shaft(box_of(a), box_of(b));
  solids_.tree().traverse([&](const Box& box) { return !hidden && shaft.may_meet(box); },
                          [&](std::uint32_t i) {
                            hidden = hidden || solids_.hides(static_cast<int>(i), a, b);
                          });
  return hidden;
}

bool PairBlockers::hidden_by_one(const PreparedSide& a, const PreparedSide& b,
                                 std::span<const int> among) const {
  return hidden_by_parts(a.polygon, b.polygon, among, 0);
}

bool PairBlockers::hidden_by_parts(const PointList& a, const PointList& b,
                                   std::span<const int> among, int cuts) const {
  if (std::ranges::any_of(among, [&](int i) { return hides(i, a, b); })) return true;
  if (solids_.size() > 0 && hidden_by_solid(a, b)) return true;
  if (cuts == 0) return false;
  // The larger one is cut, which leaves the other as a whole to be hidden.
  const bool first = area_of(a) >= area_of(b);
  const std::array<PointList, 2> parts = halves(first ? a : b);
  return std::ranges::all_of(parts, [&](const PointList& part) {
    return first ? hidden_by_parts(part, b, among, cuts - 1)
                 : hidden_by_parts(a, part, among, cuts - 1);
  });
}

}  // namespace sightline::internal
