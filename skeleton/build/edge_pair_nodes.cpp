// The nodes of EdgePairs: what the line in which an arc ends is held by.

#include <algorithm>

#include "linespace/numbers/rational.h"
#include "skeleton/build/edge_pair.h"
#include "skeleton/nodes/irrational_line.h"
#include "skeleton/nodes/node_contacts.h"

namespace sightline::internal {
namespace {

// A line by two points on the outer edges, each off by at most `error` in each
// coordinate.
struct RoundedLine {
  Point a, b;
  double error;

  // False proves that the segment between the two does not meet the box.
  [[nodiscard]] bool may_meet(const Box& box) const {
    const Point d = b - a;
    Point x, h;  // of the box: centre as seen from a, half sizes with all that is off
    for (int i = 0; i < 3; ++i) {
      const double centre = 0.5 * (box.min[i] + box.max[i]);
      x[i] = centre - a[i];
      h[i] = 0.5 * (box.max[i] - box.min[i]) + 2 * error +
             16 * kUnit * (std::abs(centre) + std::abs(a[i]) + std::abs(b[i]));
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const double di = std::abs(d[i]);
      const double dj = std::abs(d[j]);
      const double rounding = 4 * kUnit * (di * std::abs(x[j]) + dj * std::abs(x[i]));
      if (std::abs(d[i] * x[j] - d[j] * x[i]) > di * h[j] + dj * h[i] + rounding) {
        return false;
      }
    }
    return true;
  }
};

RoundedLine rounded_line(const OuterPair& o, const EeeCurve& curve, const CurveCut& cut) {
  const auto t = curve.enclose_last(cut);
  const auto slack = [](double low, double high, const Point& a, const Point& b) {
    return (0.5 * (high - low) + 4 * kUnit) * (b - a).cwiseAbs().sum() +
           8 * kUnit * (a.cwiseAbs().sum() + b.cwiseAbs().sum());
  };
  const Point& p0 = o.at(o.p[0]);
  const Point& p1 = o.at(o.p[1]);
  const Point& q0 = o.at(o.q[0]);
  const Point& q1 = o.at(o.q[1]);
  return {p0 + cut.parameter() * (p1 - p0), q0 + 0.5 * (t[0] + t[1]) * (q1 - q0),
          std::max(slack(cut.lo, cut.hi, p0, p1), slack(t[0], t[1], q0, q1))};
}

// Two different cuts are at one position.
bool coincide(const EeeCurve& curve, const CurveCut& a, const CurveCut& b) {
  return a.hi >= b.lo && a.lo <= b.hi && !a.same_as(b) &&
         curve.compare(a, b) == Sign::Zero;
}

// Where a line that meets p + s (q - p), and is not parallel to it, does so.
Rational parameter_on(const Point& p, const Point& q,
                      const std::array<ExactPoint, 2>& line) {
  const ExactPoint way = exact_difference(line[1], line[0]);
  const ExactPoint from = exact_cross(way, exact_difference(exact_point(p), line[0]));
  const ExactPoint step =
      exact_cross(way, exact_difference(exact_point(q), exact_point(p)));
  std::size_t axis = 0;
  while (axis < 2 && step[axis] == 0) ++axis;
  return quotient(Rational(-from[axis]), step[axis]);
}

}  // namespace

// Polygon mode: which outer contacts of the line at a cut are end contacts, first edge
// first.  Where one changes from a graze into an end the line lies in the plane of a
// face, which it grazes.
std::array<bool, 2> EdgePairs::ends_at(const Outer& outer, const EeeCurve& curve,
                                       const CurveCut& cut,
                                       const Stretch& stretch) const {
  const auto [first, last] = stretch.ends;
  const auto at_corner = [&](int corner) {
    return ends_at_corner(outer, curve, cut, corner, stretch.f0);
  };
  switch (cut.kind) {
    case CurveCutKind::Start:
      return {at_corner(outer.points.p[0]), last};
    case CurveCutKind::End:
      return {at_corner(outer.points.p[1]), last};
    case CurveCutKind::Far:
      return {first, at_corner(cut.feature)};
    case CurveCutKind::OnFirst:
      return {false, last};
    case CurveCutKind::OnPlane: {
      const auto& facets = g_.ridges()[outer.last].facets;
      const bool at_last = cut.feature == facets[0] || cut.feature == facets[1];
      return {first, last && !at_last};
    }
    default:
      return {first, last};
  }
}

// Whether the corner at a cut is an end contact: all its faces show their fronts to the
// other outer contact.  For corners of convex solids; contacts at others are listed.
bool EdgePairs::ends_at_corner(const Outer& outer, const EeeCurve& curve,
                               const CurveCut& cut, int corner, Sign f0) const {
  const Star& star = g_.stars()[g_.star_of_point(corner)];
  return star.convex && std::all_of(star.faces.begin(), star.faces.end(), [&](int face) {
           return side_of_corner(outer, curve, cut, face, f0) == Sign::Positive;
         });
}

// On which side of a face at the corner of a cut the line's contact with an outer edge
// is: the last edge, for a corner of the first; else the first.
Sign EdgePairs::side_of_corner(const Outer& outer, const EeeCurve& curve,
                               const CurveCut& cut, int face, Sign f0) const {
  const PlaneSide& plane = g_.face_plane(face);
  const auto& o = outer.points;
  if (cut.kind == CurveCutKind::Start || cut.kind == CurveCutKind::End) {
    const PlaneValues q = plane_values(plane, o.at(o.q[0]), o.at(o.q[1]));
    if (q.sign0 == q.sign1) return q.sign0;
    // Times F0 - F1, which has the sign of F0.
    const BoundedLinear l = curve.at_last_edge(q.at0, q.at1, plane_points(scene_, face));
    return (cut.kind == CurveCutKind::Start ? l.sign0 : l.sign1) * f0;
  }
  const PlaneValues p = plane_values(plane, o.at(o.p[0]), o.at(o.p[1]));
  if (p.sign0 == p.sign1) return p.sign0;
  if (p.sign0 == Sign::Zero) return p.sign1;
  if (p.sign1 == Sign::Zero) return p.sign0;
  CurveCut root{CurveCutKind::OnPlane,      false, scene_.faces()[face].facet,
                plane_points(scene_, face), 0,     1};
  enclose_root({p.at0.value, p.at1.value, p.at0.error, p.at1.error, p.sign0, p.sign1},
               root);
  const Sign order = curve.compare(cut, root);
  return order == Sign::Zero ? Sign::Zero : order == Sign::Negative ? p.sign0 : p.sign1;
}

// Names a node by what cuts the curve there: its kind and its generators, from the first
// edge to the last; VEE begins with its vertex.
void EdgePairs::name_by_cut(const Outer& outer, const EeeCurve& curve, int middle,
                            const CurveCut& cut, FoundNode& node) {
  const auto edge = [&](int ridge) {
    return Generator{GeneratorKind::Edge, g_.ridges()[ridge].edge};
  };
  const auto vertex = [](std::int32_t p) { return Generator{GeneratorKind::Vertex, p}; };
  const Generator first = edge(outer.first);
  const Generator between = edge(middle);
  const Generator last = edge(outer.last);
  const Generator face{GeneratorKind::Face, cut.feature};
  const auto set = [&](NodeKind kind, std::initializer_list<Generator> generators) {
    node.kind = kind;
    node.count = static_cast<std::uint8_t>(generators.size());
    std::copy(generators.begin(), generators.end(), node.generators.begin());
  };
  switch (cut.kind) {
    case CurveCutKind::Given:
      return set(NodeKind::Degenerate, {first, between, last});
    case CurveCutKind::Start:
      return set(NodeKind::VEE, {vertex(outer.points.p[0]), between, last});
    case CurveCutKind::End:
      return set(NodeKind::VEE, {vertex(outer.points.p[1]), between, last});
    case CurveCutKind::Far:
      return set(NodeKind::VEE, {vertex(cut.feature), between, first});
    case CurveCutKind::Middle:
      return set(NodeKind::EVE, {first, vertex(cut.feature), last});
    case CurveCutKind::OnFirst:
      return set(NodeKind::FEE, {face, between, last});
    case CurveCutKind::OnPlane: {
      // The plane is that of a face at the middle edge, at the last, or one that the
      // first edge enters.
      const auto& at_middle = g_.ridges()[middle].facets;
      const auto& at_last = g_.ridges()[outer.last].facets;
      if (cut.feature == at_middle[0] || cut.feature == at_middle[1]) {
        return set(NodeKind::FEE, {first, face, last});
      }
      if (cut.feature == at_last[0] || cut.feature == at_last[1]) {
        return set(NodeKind::FEE, {first, between, face});
      }
      return set(NodeKind::Pierce, {first, face, between, last});
    }
    case CurveCutKind::OnFar:
      return set(NodeKind::Pierce, {first, between, face, last});
    case CurveCutKind::Crossing: {
      const int r = carriers_.ridge[cut.feature];
      const Generator fourth =
          r >= 0 ? edge(r)
                 : Generator{GeneratorKind::Edge, carriers_.all[cut.feature].edge};
      const bool fourth_first =
          curve.order_at(cut, cut.feature, form_of(outer, cut.feature)) == Sign::Positive;
      set(NodeKind::EEEE, {first, fourth_first ? fourth : between,
                           fourth_first ? between : fourth, last});
      const bool single = is_single(outer, curve, cut.feature);
      node.rising = cut.rising && !single;
      node.elsewhere = any_touched({node.generators.data(), node.count});
    }
  }
}

// One line at most meets the curve's three edges and a fourth: two of them are coplanar.
bool EdgePairs::is_single(const Outer& outer, const EeeCurve& curve, int fourth) const {
  const auto coplanar = [&](const std::array<std::int32_t, 2>& e, int carrier) {
    const auto& g = carriers_.all[carrier].points;
    const auto& o = outer.points;
    return orient3d(o.at(e[0]), o.at(e[1]), o.at(g[0]), o.at(g[1])) == Sign::Zero;
  };
  return coplanar(outer.points.p, curve.middle()) || coplanar(outer.points.p, fourth) ||
         coplanar(outer.points.q, fourth);
}

FoundNode EdgePairs::node_at(const Outer& outer, const EeeCurve& curve, int middle,
                             const CurveCut& cut, const Stretch& stretch) {
  FoundNode node;
  node.grazes = !stretch.ends[0] && !stretch.ends[1];
  name_by_cut(outer, curve, middle, cut, node);
  const double s = cut.parameter();
  const double t = curve.last_parameter(s);
  const auto& o = outer.points;
  node.segment = {o.at(o.p[0]) + s * (o.at(o.p[1]) - o.at(o.p[0])),
                  o.at(o.q[0]) + t * (o.at(o.q[1]) - o.at(o.q[0]))};
  if (g_.polygon()) {
    node.ends = ends_at(outer, curve, cut, stretch);
    if (cut.kind == CurveCutKind::Far) std::swap(node.ends[0], node.ends[1]);
  }
  // Both outer edges may enter a face at once.
  if (node.kind == NodeKind::Pierce || may_touch_more(outer, curve, middle, cut) ||
      may_touch_beyond(outer, curve, cut, node)) {
    list_contacts(outer, curve, cut, node);
    if (!node.all.empty()) return node;
  }
  // One direction for a line, whichever way it was found; VEE begins with its vertex.
  if (node.kind != NodeKind::VEE &&
      node.generators[node.count - 1] < node.generators[0]) {
    std::reverse(node.generators.begin(), node.generators.begin() + node.count);
    std::swap(node.segment[0], node.segment[1]);
    std::swap(node.ends[0], node.ends[1]);
  }
  if (cut.kind == CurveCutKind::Far) std::swap(node.segment[0], node.segment[1]);
  for (int a = 0; a < node.count; ++a) {
    for (int b = a + 1; b < node.count; ++b) {
      node.self |=
          share(g_.objects_of(node.generators[a]), g_.objects_of(node.generators[b]));
    }
  }
  return node;
}

// Whether the line at a cut can have a contact that its kind does not name: two cuts
// coincide, another edge's line is not certainly missed, or a corner is not that of a
// convex solid that stands alone.
bool EdgePairs::may_touch_more(const Outer& outer, const EeeCurve& curve, int middle,
                               const CurveCut& cut) {
  if (cut.kind == CurveCutKind::Given) return true;
  // Where edges of touching solids cross, a line meets both at one point.
  for (const int ridge :
       {outer.first, middle, outer.last,
        cut.kind == CurveCutKind::Crossing ? carriers_.ridge[cut.feature] : -1}) {
    if (ridge >= 0 && g_.ridges()[ridge].touched_along()) return true;
  }
  if (ends_at_pierced(outer, curve, middle, cut)) return true;
  for (const Constraint& c : constraints_) {
    if (c.values.constant() && c.values.sign0 == Sign::Zero) return true;
    if (cut.kind == CurveCutKind::Start ? c.zero0
        : cut.kind == CurveCutKind::End
            ? c.zero1
            : !c.values.constant() && coincide(curve, c.cut, cut)) {
      return true;
    }
  }
  return corner_may_touch_more(outer, curve, cut) ||
         may_meet_face_corner(outer, curve, cut) ||
         may_meet_other_edge(outer, curve, middle, cut);
}

// At a cut by a corner: that corner is not that of a convex solid that stands alone, or
// the line lies in the plane of a face there.
bool EdgePairs::corner_may_touch_more(const Outer& outer, const EeeCurve& curve,
                                      const CurveCut& cut) const {
  const std::int32_t corner =
      cut.kind == CurveCutKind::Start ? outer.points.p[0]
      : cut.kind == CurveCutKind::End ? outer.points.p[1]
      : cut.kind == CurveCutKind::Far || cut.kind == CurveCutKind::Middle ? cut.feature
                                                                          : -1;
  if (corner < 0) return false;
  const Star& star = g_.stars()[g_.star_of_point(corner)];
  if (!star.convex || star.touched || star.in_plane_only) return true;
  return std::any_of(star.faces.begin(), star.faces.end(), [&](int face) {
    return side_of_corner(outer, curve, cut, face, Sign::Positive) == Sign::Zero;
  });
}

// At a cut by a face's plane: the line meets a corner of the face, or what touches it.
bool EdgePairs::may_meet_face_corner(const Outer& outer, const EeeCurve& curve,
                                     const CurveCut& cut) {
  if (cut.kind != CurveCutKind::OnFirst && cut.kind != CurveCutKind::OnPlane) {
    return false;
  }
  if (g_.facet_touched(cut.feature)) return true;
  // A corner w of the face is on the line iff it is in the plane of P(s) and the last
  // edge, or that of P(s) and the middle edge where the face is at the last one.
  const auto& at_last = g_.ridges()[outer.last].facets;
  const bool by_middle = cut.feature == at_last[0] || cut.feature == at_last[1];
  const auto& m = carriers_.all[curve.middle()].points;
  for (const int face : scene_.facets()[cut.feature].faces) {
    for (const int w : scene_.face_points(face)) {
      BoundedLinear l{};
      if (by_middle) {
        const PlaneSide plane({scene_.point(w), scene_.point(m[0]), scene_.point(m[1])});
        const auto& o = outer.points;
        l = linear(plane_values(plane, o.at(o.p[0]), o.at(o.p[1])));
      } else {
        l = beside_last(outer, w);
      }
      if (l.constant() && l.sign0 != Sign::Zero) continue;
      CurveCut at{
          by_middle ? CurveCutKind::Far : CurveCutKind::Middle, false, w, {}, 0, 1};
      if (!l.constant()) enclose_root(l, at);
      if (l.constant() || coincide(curve, at, cut)) return true;
    }
  }
  return false;
}

// Between the outer edges the line at a cut may meet an edge that it is not named by.
bool EdgePairs::may_meet_other_edge(const Outer& outer, const EeeCurve& curve, int middle,
                                    const CurveCut& cut) {
  const Ridge& r = g_.ridges()[middle];
  ++node_stamp_;
  const RoundedLine line = rounded_line(outer.points, curve, cut);
  for (const int face : others_) {
    if (!line.may_meet(g_.face_box(face)) || is_of(r, face)) continue;
    for (const auto& side : carriers_.of_face(face)) {
      if (node_stamps_[side.carrier] == node_stamp_) continue;
      node_stamps_[side.carrier] = node_stamp_;
      if (cut.kind == CurveCutKind::Crossing && cut.feature == side.carrier) continue;
      if (curve.misses(cut, form_of(outer, side.carrier))) continue;
      return true;
    }
  }
  return false;
}

// The same beyond the outer edges.
bool EdgePairs::may_touch_beyond(const Outer& outer, const EeeCurve& curve,
                                 const CurveCut& cut, const FoundNode& node) {
  const RoundedLine line = rounded_line(outer.points, curve, cut);
  return probe_.may_touch_more(line.a, line.b, line.error,
                               {node.generators.data(), node.count});
}

bool EdgePairs::any_touched(std::span<const Generator> edges) const {
  return std::ranges::any_of(edges, [&](const Generator& e) {
    const int ridge = e.id < 0 ? -1 : g_.ridge_of_edge(e.id);
    return ridge >= 0 && g_.ridges()[ridge].touched;
  });
}

// Which of two lines through four edges, as the crossings that find it say: the line by
// two points; else that one which is farther along the outer edge with the smaller
// number.  Of coplanar edges there is one line only.
bool EdgePairs::rises_at(std::span<const Generator> edges,
                         const std::optional<std::array<ExactPoint, 2>>& line,
                         bool beyond_other) const {
  std::array<int, 4> ridges{};
  for (std::size_t i = 0; i < 4; ++i) ridges[i] = g_.ridge_of_edge(edges[i].id);
  if (std::ranges::min(ridges) < 0) return false;
  const auto [first, last] = std::minmax(ridges[0], ridges[3]);
  const OuterPair pair{&scene_, g_.ridges()[first].points, g_.ridges()[last].points};
  const int middle = carriers_.of_ridge[ridges[1]];
  const int fourth = carriers_.of_ridge[ridges[2]];
  for (const int carrier : {middle, fourth}) {
    const auto& m = carriers_.all[carrier].points;
    for (const auto& e : {pair.p, pair.q}) {
      if (orient3d(pair.at(e[0]), pair.at(e[1]), pair.at(m[0]), pair.at(m[1])) ==
          Sign::Zero) {
        return false;
      }
    }
  }
  std::optional<Rational> s;
  if (line) s = parameter_on(pair.at(pair.p[0]), pair.at(pair.p[1]), *line);
  const EeeCurve curve(pair, carriers_.all, middle, pair.form(carriers_.all[middle]));
  return curve.rises_at(fourth, s, beyond_other);
}

void EdgePairs::list_contacts(const Outer& outer, const EeeCurve& curve,
                              const CurveCut& cut, FoundNode& node) {
  NodeContacts all;
  const auto points = curve.points_at(cut);
  if (points) {
    all = contacts_of_line(g_, known_, *points, {.grazes = node.grazes}).along;
  } else if (const auto line = curve.line_at(cut)) {
    const auto edge = [&](int ridge) { return g_.ridges()[ridge].edge; };
    all = contacts_along(g_, *line, {edge(outer.first), edge(outer.last)}, node.grazes);
  }
  if (all.generators.empty()) return;
  const bool nothing_new = all.kind == node.kind && all.kind != NodeKind::Degenerate;
  if (nothing_new && ends_one_arc(all.kind)) return;
  if (nothing_new && g_.polygon()) {
    const bool turned = node.generators[0] != all.generators.front();
    node.ends = {all.ends[turned ? 1 : 0], all.ends[turned ? 0 : 1]};
    node.end = all.end;
    return;
  }
  if (nothing_new && !all.end) return;
  node.kind = all.kind;
  node.self = all.self;
  node.elsewhere = all.kind == NodeKind::EEEE && any_touched(all.generators);
  if (!ends_one_arc(all.kind)) {
    node.end = all.end;
    node.ends = all.ends;
  } else if (node.generators[0] != all.generators.front()) {
    std::swap(node.ends[0], node.ends[1]);
  }
  node.rising = all.kind == NodeKind::EEEE ? rises_at(all.generators, points, all.second)
                                           : all.second;
  node.all = all.generators;
  node.line = std::move(all.line);
  node.segment = all.segment;
}

}  // namespace sightline::internal
