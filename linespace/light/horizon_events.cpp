#include "linespace/light/horizon_events.h"

#include <algorithm>
#include <deque>
#include <optional>

#include "linespace/light/family_scan.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// A point of the receiver's plane with what lies there.
struct PlanePoint {
  LightFeature name;
  LightPoint point;
};

class HorizonFinder {
 public:
  HorizonFinder(const PatchSpace& at, const HorizonPlane& horizon)
      : at_(at),
        horizon_(horizon),
        plane_(at.space.faces()[horizon.faces[0]].plane),
        scan_(at.space, at.patch, at.sides, at.faces_in_front, {}, {}) {}

  std::vector<LightTrace> find(std::span<const std::uint8_t> front,
                               std::span<const std::uint8_t> back) {
    find_points();
    for (std::size_t i = 0; i < above_.size(); ++i) {
      hear_stop();
      for (const PlanePoint& h : on_source_) add_line(h, above_[i], front, back);
      for (std::size_t j = 0; j < i; ++j) add_line(above_[j], above_[i], front, back);
    }
    return std::move(out_);
  }

 private:
  void find_points() {
    const LightSpace& space = at_.space;
    for (const int e : at_.front_edges) {
      const LightEdge& edge = space.edges()[e];
      if (const auto x = crossing(*edge.line)) {
        if (sign_at(at_.patch.plane, *x) != Sign::Positive) continue;
        above_.push_back({{LightFeature::Kind::Edge, edge.edge}, *x});
      }
    }
    for (std::size_t i = 0; i < at_.points.size(); ++i) {
      const PencilPoint& p = at_.points[i];
      if (sign_at(plane_, *p.point) != Sign::Zero) continue;
      (i < at_.own_points ? above_ : on_source_).push_back({p.name, *p.point});
    }
    for (std::size_t i = 0; i < at_.sides.size(); ++i) {
      if (const auto x = crossing(at_.sides[i])) {
        on_source_.push_back({{LightFeature::Kind::SourceSide, static_cast<int>(i)}, *x});
      }
    }
  }

  // Strictly between the ends.
  [[nodiscard]] std::optional<LightPoint> crossing(const LightLine& l) const {
    const auto& [p, q] = l.ends;
    const Sign at_p = sign_at(plane_, *p);
    if (at_p == Sign::Zero || at_p != -sign_at(plane_, *q)) return std::nullopt;
    return light_point(combination(value(plane_.exact, q->exact), p->exact,
                                   value(plane_.exact, p->exact), q->exact));
  }

  // By rounded coordinates: the line may meet the source's hull.
  [[nodiscard]] bool may_reach(const LightPoint& a, const LightPoint& b) const {
    const Approx ha = value(at_.patch.plane.near, a.near);
    const Approx hb = value(at_.patch.plane.near, b.near);
    if (!is_certain(ha - hb)) return true;
    const Point q = a.rounded + ha.v / (ha.v - hb.v) * (b.rounded - a.rounded);
    Point low = at_.patch.hull[0];
    Point high = low;
    for (const Point& p : at_.patch.hull) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    // Wide, since what is let in costs time only: a share of the hull, a share of the way
    // to q that is far above the 2^-50 of its roundings, and what the bounds on the two
    // heights leave open of q's place.
    constexpr double kOfHull = 0x1p-10, kOfWay = 0x1p-30;
    const double margin = kOfHull * (high - low).norm() +
                          kOfWay * (q - a.rounded).norm() +
                          (ha.e + hb.e) / std::abs(ha.v - hb.v) * (q - a.rounded).norm();
    return ((q - low).array() >= -margin).all() && ((q - high).array() <= margin).all();
  }

  void add_line(const PlanePoint& a, const PlanePoint& b,
                std::span<const std::uint8_t> front, std::span<const std::uint8_t> back) {
    if (!may_reach(a.point, b.point)) return;
    const LightLine both = light_line(a.point, b.point);
    if (std::ranges::all_of(both.exact, [](const Ring& x) { return is_zero(x); })) return;
    const LineFamily family(a.point, b.point, b.point);
    const FamilyContact contacts[] = {{FamilyContact::At::First},
                                      {FamilyContact::At::Last}};
    if (!scan_.reaches_freely(family, contacts)) return;
    const Four<Ring>& plane = at_.patch.plane.exact;
    const Ring high_a = value(plane, a.point.exact) * b.point.exact[3];
    const Ring high_b = value(plane, b.point.exact) * a.point.exact[3];
    const Sign order = sign_of(Ring(high_b - high_a));
    if (order == Sign::Zero) return;
    const PlanePoint& low = order == Sign::Positive ? a : b;
    const PlanePoint& high = order == Sign::Positive ? b : a;
    LightTrace trace;
    const auto is_point = [](const LightFeature& f) {
      return f.kind != LightFeature::Kind::Edge &&
             f.kind != LightFeature::Kind::SourceSide;
    };
    trace.kind =
        is_point(a.name) || is_point(b.name) ? LightEventKind::EV : LightEventKind::EEE;
    trace.patch = at_.number;
    trace.generators = {
        high.name, low.name, {LightFeature::Kind::Horizon, horizon_.facet}};
    trace.facet = horizon_.facet;
    trace.first = {high.point.exact, high.point.exact};
    trace.last = {low.point.exact, low.point.exact};
    for (const int face : horizon_.faces) {
      const auto ends = on_face(low.point.exact, high.point.exact, face);
      if (!ends) continue;
      for (const bool side : {true, false}) {
        if ((side ? front : back)[face] == 0) continue;
        LightTrace::Piece piece;
        piece.face = face;
        piece.front = side;
        piece.range = {QuadraticRoot{0, 0, 1, 0}, QuadraticRoot{1, 0, 1, 0}};
        piece.rounded = {0, 1};
        piece.ends = *ends;
        trace.pieces.push_back(std::move(piece));
      }
    }
    if (!trace.pieces.empty()) out_.push_back(std::move(trace));
  }

  // The part of the ray from `low` through `high`, beyond `high`, on a closed face.
  [[nodiscard]] std::optional<std::array<Four<Ring>, 2>> on_face(const Four<Ring>& low,
                                                                 const Four<Ring>& high,
                                                                 int face) const {
    // Points low + t (high - low): t from 1 on, between values t = num / den, den > 0,
    // where the ray enters and leaves the face's sides.  Weights are positive.
    struct Value {
      Ring num, den;
    };
    const auto less = [](const Value& x, const Value& y) {
      return sign_of(Ring(x.num * y.den - y.num * x.den)) == Sign::Negative;
    };
    Value from{1, 1};
    std::optional<Value> to;
    const LightFace& f = at_.space.faces()[face];
    const Four<Ring> up{f.plane.exact[0], f.plane.exact[1], f.plane.exact[2], Ring(0)};
    for (const LightFace::Side& side : f.sides) {
      // Through the side, across the face; positive on the inside.
      Four<Ring> wall = plane_of(side.line->exact, up);
      Ring at_low = value(wall, low) * high[3];
      Ring at_high = value(wall, high) * low[3];
      // Of a, b and the normal the plane's front is on the right.
      if (side.forward) {
        at_low = -at_low;
        at_high = -at_high;
      }
      const Ring change = at_high - at_low;
      const Sign way = sign_of(change);
      if (way == Sign::Zero) {
        if (sign_of(at_low) == Sign::Negative) return std::nullopt;
        continue;
      }
      // at_low + t change = 0.
      const Value at =
          way == Sign::Positive ? Value{-at_low, change} : Value{at_low, -change};
      if (way == Sign::Positive) {
        if (less(from, at)) from = at;
      } else if (!to || less(at, *to)) {
        to = at;
      }
    }
    if (!to || !less(from, *to)) return std::nullopt;
    const auto point = [&](const Value& t) {
      // (den - num) low + num high, both of one weight.
      const Ring a = (t.den - t.num) * high[3];
      const Ring b = t.num * low[3];
      return combination(a, low, Ring(-b), high);
    };
    return std::array{point(from), point(*to)};
  }

  const PatchSpace& at_;
  const HorizonPlane& horizon_;
  const LightPlane& plane_;
  FamilyScan scan_;
  std::vector<PlanePoint> above_, on_source_;
  std::vector<LightTrace> out_;
};

}  // namespace

std::vector<HorizonPlane> horizon_planes(const PatchSpace& at,
                                         std::span<const std::uint8_t> front,
                                         std::span<const std::uint8_t> back) {
  const Scene& scene = at.space.scene();
  std::vector<HorizonPlane> out;
  const auto add = [&](int facet, std::vector<int> faces) {
    std::erase_if(faces, [&](int f) { return front[f] == 0 && back[f] == 0; });
    if (faces.empty()) return;
    const LightPlane& plane = at.space.faces()[faces[0]].plane;
    bool before = false;
    bool behind = false;
    int on_it = 0;
    for (const Point& p : at.patch.hull) {
      const Sign s = sign_at(plane, light_point(p));
      before = before || s == Sign::Positive;
      behind = behind || s == Sign::Negative;
      on_it += s == Sign::Zero ? 1 : 0;
    }
    const bool cut = before && behind;
    const bool touched = before != behind && on_it > 1;
    if (cut || touched) out.push_back({facet, std::move(faces)});
  };
  for (std::size_t i = 0; i < scene.facets().size(); ++i) {
    const Facet& facet = scene.facets()[i];
    if (facet.planar) {
      add(static_cast<int>(i), facet.faces);
      continue;
    }
    for (const int f : facet.faces) add(static_cast<int>(i), {f});
  }
  return out;
}

std::vector<LightTrace> horizon_events(const PatchSpace& at, const HorizonPlane& horizon,
                                       std::span<const std::uint8_t> front,
                                       std::span<const std::uint8_t> back) {
  return HorizonFinder(at, horizon).find(front, back);
}

}  // namespace sightline::internal
