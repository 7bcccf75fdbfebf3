#include "linespace/light/event_finder.h"

#include <algorithm>

#include "linespace/light/source_shaft.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {

std::vector<LightTrace> EventFinder::of_point(const PencilPoint& p, bool on_source) {
  out_.clear();
  if (on_source) {
    for (const int e : at_.front_edges) {
      if (sight_.sees_source(e)) add_pencil(p, segment(e));
    }
    return std::move(out_);
  }
  if (!sight_.sees_source(*p.point)) return {};
  const Point& v = p.point->rounded;
  const SourceShaft shaft(v, v, at_.patch.hull, space_.size());
  std::vector<int> edges;
  space_.edge_tree().traverse(
      [&](const Box& box) {
        return shaft.may_meet_before(box) || shaft.may_meet_beyond(box);
      },
      [&](std::uint32_t e) {
        const LightLine& l = *space_.edges()[e].line;
        const Point& q0 = l.ends[0]->rounded;
        const Point& q1 = l.ends[1]->rounded;
        if (sight_.sees_source(static_cast<int>(e)) &&
            (shaft.may_meet_before(q0, q1) || shaft.may_meet_beyond(q0, q1))) {
          edges.push_back(static_cast<int>(e));
        }
      });
  std::ranges::sort(edges);
  for (const int e : edges) add_pencil(p, segment(e));
  for (std::size_t i = 0; i < at_.sides.size(); ++i) add_pencil(p, source_side(i));
  return std::move(out_);
}

bool EventFinder::share_convex(const std::vector<int>& x,
                               const std::vector<int>& y) const {
  return std::ranges::any_of(x, [&](int o) {
    return space_.convex_solid(o) && std::ranges::binary_search(y, o);
  });
}

bool EventFinder::crosses_source(const Four<Approx>& plane) const {
  bool front = false;
  bool behind = false;
  for (const Four<Approx>& h : at_.hull) {
    const Approx v = value(plane, h);
    front = front || !(v.v < -v.e);
    behind = behind || !(v.v > v.e);
  }
  return front && behind;
}

void EventFinder::add_pencil(const PencilPoint& p, const AnySegment& e) {
  hear_stop();
  if (e.edge >= 0) {
    const LightEdge& edge = space_.edges()[e.edge];
    if (never_grazes(space_, edge, *p.point, *p.point)) return;
    if (share_convex(p.objects, edge.objects) && !share(p.facets, edge.facets)) return;
  }
  const Four<Approx> plane = plane_of(e.line->near, p.point->near);
  if (!crosses_source(plane) || is_on_line(*p.point, *e.line)) return;
  if (e.edge >= 0 && !sight_.may_see(*p.point, e.edge)) return;
  ++families_;
  const LineFamily family(*p.point, *e.line->ends[0], *e.line->ends[1]);
  const FamilyContact contacts[] = {
      {FamilyContact::At::First},
      {FamilyContact::At::Last, nullptr, {}, moving(e)},
  };
  if (scan_.scan(family, contacts, -1, &plane).empty()) return;
  LightTrace trace;
  trace.kind = LightEventKind::EV;
  name_pencil(p, e, trace);
  keep(family, std::move(trace));
}

// Face or EE where an edge at the point lies in the plane of the pencil, else EV.
void EventFinder::name_pencil(const PencilPoint& p, const AnySegment& e,
                              LightTrace& trace) const {
  trace.generators = {p.name, e.name};
  const LightPlane plane{plane_of(e.line->near, p.point->near),
                         plane_of(e.line->exact, p.point->exact)};
  const auto in_plane = [&](const LightLine& l) {
    return sign_at(plane, *l.ends[0]) == Sign::Zero &&
           sign_at(plane, *l.ends[1]) == Sign::Zero;
  };
  const auto consider = [&](const AnySegment& s) {
    if (s.line == e.line || !in_plane(*s.line)) return;
    // An edge that no line of the pencil grazes is not seen along another one.
    if (s.edge >= 0 &&
        never_grazes(space_, space_.edges()[s.edge], *e.line->ends[0], *e.line->ends[1]))
      return;
    const int facet = common_facet(s, e);
    if (trace.kind == LightEventKind::Face ||
        (trace.kind == LightEventKind::EE && facet < 0))
      return;
    trace.kind = facet < 0 ? LightEventKind::EE : LightEventKind::Face;
    trace.facet = facet;
    trace.in_line = {s.name, e.name};
  };
  for (const int i : p.edges) consider(segment(i));
  for (const int i : p.sides) consider(source_side(static_cast<std::size_t>(i)));
}

int EventFinder::common_facet(const AnySegment& a, const AnySegment& b) const {
  if (a.edge < 0 || b.edge < 0) return -1;
  for (const int f : space_.edges()[a.edge].facets) {
    if (std::ranges::binary_search(space_.edges()[b.edge].facets, f)) return f;
  }
  return -1;
}

std::vector<LightTrace> EventFinder::of_edge(int edge) {
  out_.clear();
  const AnySegment a = segment(edge);
  const std::vector<int>& nearer = sight_.nearer(edge);
  for (const int m : nearer) {
    hear_stop();
    const AnySegment middle = segment(m);
    const bool in_plane = sign_between(*a.line, *middle.line) == Sign::Zero;
    // Those nearer to the source than both; pairs that may be met in either order once.
    for (const int b : sight_.nearer(m)) {
      if (!std::ranges::binary_search(nearer, b)) continue;
      if (b < m && std::ranges::binary_search(sight_.nearer(b), m)) continue;
      visit_pair(a, middle, segment(b), in_plane);
    }
    for (std::size_t j = 0; j < at_.sides.size(); ++j) {
      visit_pair(a, middle, source_side(j), in_plane);
    }
  }
  return std::move(out_);
}

void EventFinder::visit_pair(const AnySegment& a, const AnySegment& m,
                             const AnySegment& b, bool am) {
  const bool ab = sign_between(*a.line, *b.line) == Sign::Zero;
  if (am && ab) return;
  const bool mb = sign_between(*m.line, *b.line) == Sign::Zero;
  if (static_cast<int>(am) + static_cast<int>(ab) + static_cast<int>(mb) > 1) return;
  if (am) return add_in_plane(a, a, m, b);
  if (ab) return add_in_plane(a, a, b, m);
  if (mb) return add_in_plane(a, m, b, a);
  add_regulus(a, m, b);
}

void EventFinder::add_regulus(const AnySegment& a, const AnySegment& m,
                              const AnySegment& b) {
  // Two edges of a facet that rounding has bent may cross in a view, though.
  const auto convex = [&](const AnySegment& x, const AnySegment& y) {
    return x.edge >= 0 && y.edge >= 0 && common_facet(x, y) < 0 &&
           share_convex(space_.edges()[x.edge].objects, space_.edges()[y.edge].objects);
  };
  if (convex(a, m) || convex(a, b) || convex(m, b)) return;
  // The plane of each edge and a point of another separates the third one's ends for
  // some of those points.
  const auto apart = [](const LightLine& x, const LightLine& y, const LightLine& z) {
    bool front = false;
    bool behind = false;
    for (const LightPoint* p : y.ends) {
      const Four<Approx> plane = plane_of(x.near, p->near);
      for (const LightPoint* q : z.ends) {
        const Approx v = value(plane, q->near);
        front = front || !(v.v < -v.e);
        behind = behind || !(v.v > v.e);
      }
    }
    return front && behind;
  };
  if (!apart(*m.line, *a.line, *b.line) || !apart(*b.line, *a.line, *m.line) ||
      !apart(*a.line, *m.line, *b.line)) {
    return;
  }
  ++families_;
  const LineFamily family(*a.line, *m.line, *b.line);
  const LightLine to_m0 = light_line(*b.line->ends[0], *m.line->ends[0]);
  const LightLine to_m1 = light_line(*b.line->ends[0], *m.line->ends[1]);
  const LightLine to_b0 = light_line(*m.line->ends[0], *b.line->ends[0]);
  const LightLine to_b1 = light_line(*m.line->ends[0], *b.line->ends[1]);
  const FamilyContact contacts[] = {
      {FamilyContact::At::First, nullptr, {}, moving(a)},
      {FamilyContact::At::OnEdge, m.line, {&to_m0, &to_m1}, moving(m)},
      {FamilyContact::At::OnEdge, b.line, {&to_b0, &to_b1}, moving(b)},
  };
  if (scan_.scan(family, contacts, 0, nullptr).empty()) return;
  LightTrace trace;
  trace.kind = LightEventKind::EEE;
  trace.generators = {a.name, m.name, b.name};
  trace.straight = false;
  keep(family, std::move(trace));
}

// Lines in the plane of e and f through where `across` passes it.
void EventFinder::add_in_plane(const AnySegment& a, const AnySegment& e,
                               const AnySegment& f, const AnySegment& across) {
  const int facet = common_facet(e, f);
  if (facet < 0 && e.edge >= 0 && f.edge >= 0 &&
      share_convex(space_.edges()[e.edge].objects, space_.edges()[f.edge].objects)) {
    return;
  }
  const LightPoint& off =
      is_on_line(*f.line->ends[0], *e.line) ? *f.line->ends[1] : *f.line->ends[0];
  const LightPlane plane{plane_of(e.line->near, off.near),
                         plane_of(e.line->exact, off.exact)};
  if (!crosses_source(plane.near) || is_on_line(off, *e.line)) return;
  const auto& [c0, c1] = across.line->ends;
  const Sign at0 = sign_at(plane, *c0);
  if (at0 == Sign::Zero || at0 != -sign_at(plane, *c1)) return;
  const LightPoint x = light_point(combination(value(plane.exact, c1->exact), c0->exact,
                                               value(plane.exact, c0->exact), c1->exact));
  if (is_on_line(x, *e.line)) return;
  // A direction off the plane tells sides within it.
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(plane.near[i].v) > std::abs(plane.near[axis].v)) axis = i;
  }
  LightPoint up;
  for (int i = 0; i < 4; ++i) {
    up.near[i] = {i == axis ? 1.0 : 0.0, 0};
    up.exact[i] = Ring(i == axis ? 1 : 0);
  }
  const LightLine to_f0 = light_line(up, *f.line->ends[0]);
  const LightLine to_f1 = light_line(up, *f.line->ends[1]);
  ++families_;
  const LineFamily family(x, *e.line->ends[0], *e.line->ends[1]);
  const FamilyContact contacts[] = {
      {FamilyContact::At::First},
      {FamilyContact::At::Last, nullptr, {}, moving(e)},
      {FamilyContact::At::OnEdge, f.line, {&to_f0, &to_f1}, moving(f)},
  };
  const int farthest = across.line == a.line ? 0 : e.line == a.line ? 1 : 2;
  if (scan_.scan(family, contacts, farthest, &plane.near).empty()) return;
  LightTrace trace;
  trace.kind = facet < 0 ? LightEventKind::EE : LightEventKind::Face;
  trace.generators = {across.name, e.name, f.name};
  trace.in_line = {e.name, f.name};
  trace.facet = facet;
  keep(family, std::move(trace));
}

namespace {

// The points where the lines at two positions of a pencil meet a plane.
std::array<Four<Ring>, 2> ends_on(const LineFamily& family, const LightPlane& plane,
                                  const std::array<QuadraticRoot, 2>& range) {
  const LineFamily::Ends& ends = family.exact_ends();
  std::array<Four<Ring>, 2> out;
  for (int i = 0; i < 2; ++i) {
    // Rational: a / c.
    const QuadraticRoot& s = range[i];
    const Four<Ring> y = combination(Ring(s.c - s.a), ends.y[0], Ring(-s.a), ends.y[1]);
    const Four<Ring>& x = ends.x[0];
    out[i] = combination(value(plane.exact, y), x, value(plane.exact, x), y);
  }
  return out;
}

}  // namespace

void EventFinder::keep(const LineFamily& family, LightTrace trace) {
  const LineFamily::Ends& ends = family.exact_ends();
  trace.patch = at_.number;
  trace.first = ends.x;
  trace.last = ends.y;
  for (const ScannedPiece& piece : scan_.pieces()) {
    LightTrace::Piece out;
    out.face = piece.face;
    out.front = piece.front;
    out.range = {family.exact(piece.from), family.exact(piece.to)};
    out.causes = {piece.from.cause, piece.to.cause};
    for (int i = 0; i < 2; ++i) out.rounded[i] = out.range[i].rounded();
    if (trace.straight) {
      out.ends = ends_on(family, space_.faces()[piece.face].plane, out.range);
    }
    trace.pieces.push_back(std::move(out));
  }
  out_.push_back(std::move(trace));
}

}  // namespace sightline::internal
