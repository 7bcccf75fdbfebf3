#include "skeleton/build/degenerate_pair.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "linespace/lines/rounded_root.h"
#include "linespace/silhouettes/drawn.h"
#include "linespace/space/shaft.h"
#include "linespace/work/stop_scope.h"
#include "skeleton/nodes/node_contacts.h"

namespace sightline::internal {
namespace {

// `arc_ends`: of the arc that ends there, for a line that is blocked in between.
std::uint32_t add_node_at(const Silhouettes& g, const Point& v, const ExactPoint& x,
                          const LineScan& scan, const std::array<bool, 2>& arc_ends,
                          VertexView& out) {
  const NodeContacts c = contacts_between(g, scan);
  const bool told = c.ends[0] || c.ends[1];
  const std::uint32_t node =
      out.add_node(c.kind, c.self, c.end, c.generators, {v, rounded(x)},
                   (c.end && !told) || ends_one_arc(c.kind) ? arc_ends : c.ends);
  out.special[node] = 1;
  return node;
}

// Which ends of the line [0, 1] to a point of the ridge are end contacts; nullopt when it
// is not free.
std::optional<std::array<bool, 2>> open_state(const Silhouettes& g, const Ridge& ridge,
                                              const LineScan& scan) {
  if (!g.polygon()) {
    return is_free(g, scan) ? std::optional(std::array<bool, 2>{}) : std::nullopt;
  }
  const auto ends = blocked_ends(g, scan);
  if (ends && !((*ends)[1] ? ridge.can_end() : ridge.can_graze())) return std::nullopt;
  return ends;
}

// Those of the faces whose boxes may meet a segment from v to that part of the edge.
std::vector<int> faces_towards(const Silhouettes& g, const Point& v, const Point& e0,
                               const Point& e1, const CutInterval& part,
                               std::span<const int> faces) {
  const Point d = e1 - e0;
  Shaft::Pad pad;
  // A difference, a product and a sum are rounded, each by half a unit of its last place.
  for (int i = 0; i < 3; ++i) pad[i] = 4 * kUnit * (std::abs(e0[i]) + std::abs(d[i]));
  const Shaft hull(e0 + part.from.lo * d, e0 + part.to.hi * d, v, v, pad);
  std::vector<int> found;
  for (const int f : faces) {
    if (hull.may_meet(g.face_box(f))) found.push_back(f);
  }
  return found;
}

// Which ends of a line from the vertex to the ridge are end contacts.
using Ends = std::array<bool, 2>;

// The arcs of one vertex and one ridge, found by the contacts of single lines.  A *stop*
// is a cut of the edge at which the contacts of the line through it can change; between
// two stops one line speaks for all.
class DegenerateArcs {
 public:
  // `meeting`: all faces that meet the triangle between vertex and ridge.
  DegenerateArcs(const Silhouettes& g, const Star& star, const Ridge& ridge,
                 std::span<const std::int32_t> meeting, VertexView& out);

  // Adds the arcs in an open part of the edge.
  void add_arcs(const CutInterval& open, const PlaneSide& plane,
                std::span<const CutInterval> ending);

 private:
  [[nodiscard]] ExactPoint point_at(const Cut& c) const;
  [[nodiscard]] ExactPoint point_between(const Cut& a, const Cut& b) const;
  [[nodiscard]] std::vector<Cut> stops_in(const CutInterval& open,
                                          const PlaneSide& plane) const;
  [[nodiscard]] std::optional<Ends> state_at(const ExactPoint& x, bool between) const;
  [[nodiscard]] bool only_ends(const Cut& a, const Cut& b,
                               std::span<const CutInterval> ending) const;
  void end_arc(const Cut& end);

  const Silhouettes& g_;
  const Scene& scene_;
  const Star& star_;
  const Ridge& ridge_;
  VertexView& out_;
  const Point& v_;
  const Point& e0_;
  const Point& e1_;
  const LineThrough line_;
  const ExactPoint from_;  // the vertex
  const ExactPoint x0_, x1_;
  std::vector<int> all_faces_;
  std::vector<int> faces_;  // of the open part at hand
  bool self_ = false;
  bool share_facet_ = false;
  bool inside_face_ = false;

  // The arc at hand.
  std::optional<Cut> begin_;
  Ends ends_{};
  std::optional<std::uint32_t> shared_;  // the node at begin_, where one arc has ended
};

DegenerateArcs::DegenerateArcs(const Silhouettes& g, const Star& star, const Ridge& ridge,
                               std::span<const std::int32_t> meeting, VertexView& out)
    : g_(g),
      scene_(g.scene()),
      star_(star),
      ridge_(ridge),
      out_(out),
      v_(scene_.point(star.point)),
      e0_(scene_.point(ridge.points[0])),
      e1_(scene_.point(ridge.points[1])),
      line_{e0_, e1_},
      from_(exact_point(v_)),
      x0_(exact_point(e0_)),
      x1_(exact_point(e1_)),
      all_faces_(meeting.begin(), meeting.end()) {
  all_faces_.insert(all_faces_.end(), star.faces.begin(), star.faces.end());
  sort_unique(all_faces_);
  const auto own = g.objects_at(star.point);
  self_ = own.size() == 1 && ridge.objects.size() == 1 && own[0] == ridge.objects[0];
  // Lines that end in the plane of a face that vertex and edge are both on are left out.
  share_facet_ = g.polygon() && share(ridge.all_facets, star.facets);
  // A corner inside another face is grazed only by lines in that face's plane.
  inside_face_ =
      g.polygon() && star.in_plane_only &&
      std::none_of(star.planes.begin(), star.planes.end(), [&](int f) {
        return g.face_plane(f)(e0_) == Sign::Zero && g.face_plane(f)(e1_) == Sign::Zero;
      });
}

ExactPoint DegenerateArcs::point_at(const Cut& c) const {
  if (c.kind == CutKind::Start) return x0_;
  if (c.kind == CutKind::End) return x1_;
  return along(x0_, x1_, exact_parameter(scene_, line_, c));
}

// A point of the edge strictly between two cuts: in short numbers where doubles tell the
// cuts apart.
ExactPoint DegenerateArcs::point_between(const Cut& a, const Cut& b) const {
  if (a.hi < b.lo) {
    const double middle = a.hi + 0.5 * (b.lo - a.hi);
    if (middle > a.hi && middle < b.lo) return along(x0_, x1_, Rational(middle));
  }
  const Rational s = exact_parameter(scene_, line_, a);
  const Rational t = exact_parameter(scene_, line_, b);
  return along(x0_, x1_, (s + t) / 2);
}

// The ends of the open part and all stops between them, in order.
std::vector<Cut> DegenerateArcs::stops_in(const CutInterval& open,
                                          const PlaneSide& plane) const {
  const std::vector<Cut> cuts =
      critical_cuts(g_, star_, e0_, e1_, plane, faces_, out_.positions);
  std::vector<Cut> stops{open.from};
  for (const Cut& c : cuts) {
    hear_stop();
    if (compare(scene_, line_, open.from, c) == Sign::Negative &&
        compare(scene_, line_, c, open.to) == Sign::Negative) {
      stops.push_back(c);
    }
  }
  stops.push_back(open.to);
  return stops;
}

// Which ends of the line to the point x of the edge are end contacts; nullopt when the
// line is none of an arc.  `between`: x is no stop, and the contacts must be drawn, too.
std::optional<Ends> DegenerateArcs::state_at(const ExactPoint& x, bool between) const {
  const LineScan scan(scene_, faces_, from_, x);
  const auto state = open_state(g_, ridge_, scan);
  // Between a corner and an edge that others touch all of a segment may be inside.
  if (between && state && (star_.touched || !star_.convex) && g_.borders_others(ridge_) &&
      g_.in_material(along(from_, x, Rational(1, 2)))) {
    return std::nullopt;
  }
  if (!state || !((*state)[0] || (*state)[1])) {
    return inside_face_ ? std::nullopt : state;
  }
  if (share_facet_ || (inside_face_ && !(*state)[0])) return std::nullopt;
  if (!between) return state;
  const bool seen =
      (!(*state)[0] || star_.convex || drawn_corner(g_, star_, Eye(x))) &&
      (!(*state)[1] || !ridge_.touched || drawn_end(g_, ridge_, scan, true, Eye(from_)));
  return seen ? state : std::nullopt;
}

// From a to b the viewpoint can only be an end contact.
bool DegenerateArcs::only_ends(const Cut& a, const Cut& b,
                               std::span<const CutInterval> ending) const {
  return std::any_of(ending.begin(), ending.end(), [&](const CutInterval& e) {
    return compare(scene_, line_, a, e.from) != Sign::Negative &&
           compare(scene_, line_, e.to, b) != Sign::Negative;
  });
}

// Adds the arc from begin_ to `end`, with its nodes.
void DegenerateArcs::end_arc(const Cut& end) {
  SkeletonArc arc = SkeletonArc::ev(star_.point, ridge_.edge);
  arc.self = self_;
  arc.ends = ends_;
  arc.range = rounded_range(rounded_parameter(scene_, line_, *begin_),
                            rounded_parameter(scene_, line_, end));
  int k = 0;
  for (const Cut& c : {*begin_, end}) {
    const ExactPoint x = point_at(c);
    const LineScan scan(scene_, faces_, from_, x);
    arc.nodes[k] =
        k == 0 && shared_ ? *shared_ : add_node_at(g_, v_, x, scan, ends_, out_);
    ++k;
  }
  shared_ = arc.nodes[1];
  out_.arcs.push_back(arc);
  out_.intervals.push_back({*begin_, end});
  out_.special_arcs.push_back(1);
  begin_.reset();
}

void DegenerateArcs::add_arcs(const CutInterval& open, const PlaneSide& plane,
                              std::span<const CutInterval> ending) {
  faces_ = faces_towards(g_, v_, e0_, e1_, open, all_faces_);
  const std::vector<Cut> stops = stops_in(open, plane);
  begin_.reset();
  ends_ = {};
  shared_.reset();
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    hear_stop_now();
    auto state = state_at(point_between(stops[i], stops[i + 1]), true);
    const bool ends_only = only_ends(stops[i], stops[i + 1], ending);
    if (state && ends_only && !(*state)[0]) state.reset();
    if (begin_ && i > 0) {
      // The arc goes on through a critical line that is free itself.
      if (state != ends_ || state_at(point_at(stops[i]), false) != ends_)
        end_arc(stops[i]);
    }
    if (!state) shared_.reset();
    if (state && !begin_) {
      begin_ = stops[i];
      if (!g_.polygon()) shared_.reset();
      ends_ = *state;
    }
  }
  if (begin_) end_arc(stops.back());
}

}  // namespace

std::uint32_t contact_node(const Silhouettes& g, const Star& star, const Ridge& ridge,
                           std::span<const std::int32_t> meeting, const Cut& cut,
                           const std::array<bool, 2>& arc_ends, VertexView& out) {
  const Scene& scene = g.scene();
  const Point& v = scene.point(star.point);
  const LineThrough line{scene.point(ridge.points[0]), scene.point(ridge.points[1])};
  if (!g.polygon()) {
    // All its contacts are listed later (find_further_contacts()), and name it.
    const Point x = line.from + cut.parameter() * (line.to - line.from);
    const std::uint32_t node =
        out.add_node(NodeKind::Degenerate, false, false, {}, {v, x}, arc_ends);
    out.special[node] = VertexView::kUnnamed;
    return node;
  }
  std::vector<int> faces(meeting.begin(), meeting.end());
  faces.insert(faces.end(), star.faces.begin(), star.faces.end());
  const int far = cut.kind == CutKind::Start ? ridge.points[0]
                  : cut.kind == CutKind::End ? ridge.points[1]
                                             : -1;
  if (far >= 0) {
    const auto& there = g.stars()[g.star_of_point(far)].faces;
    faces.insert(faces.end(), there.begin(), there.end());
  }
  sort_unique(faces);
  const ExactPoint x0 = exact_point(scene.point(ridge.points[0]));
  const ExactPoint x1 = exact_point(scene.point(ridge.points[1]));
  const ExactPoint x = along(x0, x1, exact_parameter(scene, line, cut));
  return add_node_at(g, v, x, LineScan(scene, faces, exact_point(v), x), arc_ends, out);
}

void add_degenerate_pair(const Silhouettes& g, const Star& star, const Ridge& ridge,
                         const PlaneSide& plane, const CutUnion& closed,
                         std::span<const CutInterval> ending,
                         std::span<const std::int32_t> meeting, VertexView& out) {
  DegenerateArcs arcs(g, star, ridge, meeting, out);
  for (const CutInterval& open : closed.complement()) arcs.add_arcs(open, plane, ending);
}

}  // namespace sightline::internal
