#include "shadows/volumes/shadow_planes.h"

#include <algorithm>
#include <map>
#include <optional>

#include "linespace/predicates.h"

namespace sightline::internal {
namespace {

using Corner = ConvexBody::Corner;

// In front of the plane: nowhere, somewhere; behind it likewise.
struct Sides {
  bool front = false, behind = false;
};

Sides sides_of(const PlaneSide& plane, const ConvexBody& body) {
  Sides sides;
  for (const Corner& c : body.corners) {
    const Sign s = plane(c.at);
    sides.front |= s == Sign::Positive;
    sides.behind |= s == Sign::Negative;
    if (sides.front && sides.behind) break;
  }
  return sides;
}

// Behind the plane through three points, the first nonzero number of whose normal is 1 or
// -1: so equal half-spaces have equal numbers.
HalfSpace behind(const Point& a, const Point& b, const Point& c) {
  const ExactPoint p = exact_point(a);
  HalfSpace half{exact_cross(exact_difference(exact_point(b), p),
                             exact_difference(exact_point(c), p)),
                 0};
  Rational size = 0;
  for (const Rational& x : half.normal) {
    if (size == 0) size = abs(x);
  }
  for (Rational& x : half.normal) x /= size;
  half.offset = exact_dot(half.normal, p);
  return half;
}

class PlaneList {
 public:
  void add(const HalfSpace& half, ShadowSideKind kind, std::string generator,
           bool open = false) {
    const auto [at, fresh] = known_.try_emplace(std::pair(half.normal, half.offset),
                                                static_cast<int>(planes_.size()));
    if (fresh) planes_.push_back({half, kind, {}, false});
    ShadowPlane& plane = planes_[at->second];
    plane.kind = std::min(plane.kind, kind);
    plane.open |= open;
    if (std::ranges::find(plane.generators, generator) == plane.generators.end())
      plane.generators.push_back(std::move(generator));
  }
  std::vector<ShadowPlane> take() { return std::move(planes_); }

 private:
  std::map<std::pair<ExactPoint, Rational>, int> known_;
  std::vector<ShadowPlane> planes_;
};

std::string told(const ConvexBody& body, const ConvexBody::Side& side) {
  if (side.edge >= 0) return "edge " + std::to_string(side.edge);
  return "side " + std::to_string(body.corners[side.ends[0]].point) + "-" +
         std::to_string(body.corners[side.ends[1]].point);
}

// The point is in the closed solid.
bool contains(const ConvexBody& solid, const Point& p) {
  for (const ConvexBody::Plane& plane : solid.planes) {
    const auto& [a, b, c] = plane.points;
    if (orient3d(a, b, c, p) == Sign::Positive) return false;
  }
  if (!solid.flat) return true;
  const auto& [a, b, c] = solid.planes.front().points;
  const Point off = point_off_plane(a, b, c);
  const Sign inner = orient3d(a, b, off, c);
  return std::ranges::all_of(solid.sides, [&](const ConvexBody::Side& side) {
    const Point &q = solid.corners[side.ends[0]].at, &r = solid.corners[side.ends[1]].at;
    return orient3d(q, r, off, p) != -inner;
  });
}

// The corners of a source that are no points of the solid.  Those that are ask nothing of
// a point of the umbra: the solid is pressed against the source there.
ConvexBody without_touching(ConvexBody source, const ConvexBody& solid) {
  std::erase_if(source.corners, [&](const Corner& c) { return contains(solid, c.at); });
  source.sides.clear();
  return source;
}

// Facets of the solid that some corner of the source is in front of or in the plane of;
// `all`: that each is.
void add_facets(const ConvexBody& source, const ConvexBody& solid, bool all,
                PlaneList& list) {
  for (const ConvexBody::Plane& plane : solid.planes) {
    const auto& [a, b, c] = plane.points;
    const PlaneSide side({a, b, c});
    bool any_front = false, any_on = false, any_behind = false;
    for (const Corner& s : source.corners) {
      const Sign sign = side(s.at);
      any_front |= sign == Sign::Positive;
      any_on |= sign == Sign::Zero;
      any_behind |= sign == Sign::Negative;
    }
    if (all ? any_behind : !(any_front || any_on)) continue;
    list.add(behind(a, b, c), ShadowSideKind::Facet,
             "facet " + std::to_string(plane.facet), any_front);
  }
}

// Planes through a corner of the source and a side of the solid that have the solid on
// one side, and, if `apart`, the source on the other.
void add_source_corners(const ConvexBody& source, const ConvexBody& solid, bool apart,
                        PlaneList& list) {
  for (const Corner& s : source.corners) {
    for (const ConvexBody::Side& side : solid.sides) {
      Point a = solid.corners[side.ends[0]].at, b = solid.corners[side.ends[1]].at;
      if (collinear(s.at, a, b)) continue;
      const PlaneSide plane({s.at, a, b});
      const Sides its = sides_of(plane, solid);
      if (its.front && its.behind) continue;
      bool turn = its.front;
      if (apart) {
        const Sides of_source = sides_of(plane, source);
        if (of_source.front && of_source.behind) continue;
        if ((its.front && of_source.front) || (its.behind && of_source.behind)) continue;
        if (!its.front && !its.behind) turn = of_source.behind;
      }
      if (turn) std::swap(a, b);
      list.add(behind(s.at, a, b), ShadowSideKind::SourceCorner,
               "source vertex " + std::to_string(s.point) + ", " + told(solid, side));
    }
  }
}

// Planes through a side of the source and a corner of the solid that have the two on
// different sides.
void add_source_edges(const ConvexBody& source, const ConvexBody& solid,
                      PlaneList& list) {
  for (const ConvexBody::Side& side : source.sides) {
    const Corner &p = source.corners[side.ends[0]], &q = source.corners[side.ends[1]];
    for (const Corner& w : solid.corners) {
      if (collinear(p.at, q.at, w.at)) continue;
      const PlaneSide plane({p.at, q.at, w.at});
      const Sides its = sides_of(plane, solid);
      if (its.front && its.behind) continue;
      const Sides of_source = sides_of(plane, source);
      if (of_source.front && of_source.behind) continue;
      if ((its.front && of_source.front) || (its.behind && of_source.behind)) continue;
      const bool turn = its.front || of_source.behind;
      list.add(turn ? behind(q.at, p.at, w.at) : behind(p.at, q.at, w.at),
               ShadowSideKind::SourceEdge,
               "source side " + std::to_string(p.point) + "-" + std::to_string(q.point) +
                   ", vertex " + std::to_string(w.point));
    }
  }
}

}  // namespace

std::vector<ShadowPlane> umbra_planes(const ConvexBody& source, const ConvexBody& solid) {
  PlaneList list;
  const ConvexBody apart = without_touching(source, solid);
  add_facets(apart, solid, false, list);
  // Where all of the source is in the plane of a facet and shines away from the solid.
  add_facets(source, solid, true, list);
  add_source_corners(apart, solid, false, list);
  return list.take();
}

std::vector<ShadowPlane> shadow_planes(const ConvexBody& source,
                                       const ConvexBody& solid) {
  PlaneList list;
  add_facets(source, solid, true, list);
  add_source_corners(source, solid, true, list);
  add_source_edges(source, solid, list);
  return list.take();
}

std::vector<ShadowPlane> body_planes(const ConvexBody& body, ShadowSideKind kind) {
  PlaneList list;
  for (const ConvexBody::Plane& plane : body.planes) {
    const auto& [a, b, c] = plane.points;
    list.add(behind(a, b, c), kind, "facet " + std::to_string(plane.facet));
  }
  return list.take();
}

}  // namespace sightline::internal
