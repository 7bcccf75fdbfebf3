#include "skeleton/build/degenerate_pair.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>

#include "linespace/lines/rounded_root.h"
#include "linespace/sight/line_probe.h"
#include "linespace/sight/plane_crossings.h"
#include "linespace/silhouettes/drawn.h"
#include "linespace/silhouettes/plane_values.h"
#include "linespace/space/shaft.h"
#include "linespace/work/stop_scope.h"
#include "skeleton/nodes/known_lines.h"
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

// Kind and generators of a node that was added without them.
void name_node(VertexView& view, std::uint32_t id, const NodeContacts& contacts) {
  SkeletonNode& node = view.nodes[id];
  node.kind = contacts.kind;
  node.self = contacts.self;
  node.first_generator = static_cast<std::uint32_t>(view.pool.size());
  node.generator_count = static_cast<std::uint32_t>(contacts.generators.size());
  view.pool.insert(view.pool.end(), contacts.generators.begin(),
                   contacts.generators.end());
}

}  // namespace

std::uint32_t contact_node(const Silhouettes& g, const Star& star, const Ridge& ridge,
                           std::span<const std::int32_t> meeting, const Cut& cut,
                           const std::array<bool, 2>& arc_ends, VertexView& out) {
  const Scene& scene = g.scene();
  const Point& v = scene.point(star.point);
  const LineThrough line{scene.point(ridge.points[0]), scene.point(ridge.points[1])};
  if (!g.polygon()) {
    // All its contacts are listed later (find_further_contacts), and name it.
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
  const Scene& scene = g.scene();
  const Point& v = scene.point(star.point);
  const Point& e0 = scene.point(ridge.points[0]);
  const Point& e1 = scene.point(ridge.points[1]);
  const LineThrough line{e0, e1};

  std::vector<int> all_faces(meeting.begin(), meeting.end());
  all_faces.insert(all_faces.end(), star.faces.begin(), star.faces.end());
  sort_unique(all_faces);
  std::vector<int> faces;  // of the open part at hand
  const ExactPoint from = exact_point(v);
  const ExactPoint x0 = exact_point(e0);
  const ExactPoint x1 = exact_point(e1);
  const auto point_at = [&](const Cut& c) {
    if (c.kind == CutKind::Start) return x0;
    if (c.kind == CutKind::End) return x1;
    return along(x0, x1, exact_parameter(scene, line, c));
  };
  const auto point_between = [&](const Cut& a, const Cut& b) {
    if (a.hi < b.lo) {
      const double middle = a.hi + 0.5 * (b.lo - a.hi);
      if (middle > a.hi && middle < b.lo) return along(x0, x1, Rational(middle));
    }
    const Rational s = exact_parameter(scene, line, a);
    const Rational t = exact_parameter(scene, line, b);
    return along(x0, x1, (s + t) / 2);
  };
  const auto own = g.objects_at(star.point);
  const bool self =
      own.size() == 1 && ridge.objects.size() == 1 && own[0] == ridge.objects[0];

  // Lines that end in the plane of a face that vertex and edge are both on are left out.
  const bool share_facet = g.polygon() && share(ridge.all_facets, star.facets);

  // A corner inside another face is grazed only by lines in that face's plane.
  const bool inside_face =
      g.polygon() && star.in_plane_only &&
      std::none_of(star.planes.begin(), star.planes.end(), [&](int f) {
        return g.face_plane(f)(e0) == Sign::Zero && g.face_plane(f)(e1) == Sign::Zero;
      });

  for (const CutInterval& open : closed.complement()) {
    faces = faces_towards(g, v, e0, e1, open, all_faces);
    const std::vector<Cut> cuts =
        critical_cuts(g, star, e0, e1, plane, faces, out.positions);
    std::vector<Cut> stops{open.from};
    for (const Cut& c : cuts) {
      hear_stop();
      if (compare(scene, line, open.from, c) == Sign::Negative &&
          compare(scene, line, c, open.to) == Sign::Negative) {
        stops.push_back(c);
      }
    }
    stops.push_back(open.to);
    std::optional<Cut> begin;
    std::array<bool, 2> ends{};
    std::optional<std::uint32_t> shared;  // the node at `begin`, where one arc has ended
    // Between two critical positions (`between`): whether the contacts are drawn, too.
    const auto state_at = [&](const ExactPoint& x,
                              bool between) -> std::optional<std::array<bool, 2>> {
      const LineScan scan(scene, faces, from, x);
      const auto state = open_state(g, ridge, scan);
      // Between a corner and an edge that others touch all of a segment may be inside.
      if (between && state && (star.touched || !star.convex) && g.borders_others(ridge) &&
          g.in_material(along(from, x, Rational(1, 2)))) {
        return std::nullopt;
      }
      if (!state || !((*state)[0] || (*state)[1])) {
        return inside_face ? std::nullopt : state;
      }
      if (share_facet || (inside_face && !(*state)[0])) return std::nullopt;
      if (!between) return state;
      const bool seen =
          (!(*state)[0] || star.convex || drawn_corner(g, star, Eye(x))) &&
          (!(*state)[1] || !ridge.touched || drawn_end(g, ridge, scan, true, Eye(from)));
      return seen ? state : std::nullopt;
    };
    const auto end_arc = [&](const Cut& end) {
      SkeletonArc arc;
      arc.vertex = star.point;
      arc.edge = ridge.edge;
      arc.self = self;
      arc.ends = ends;
      arc.range = rounded_range(rounded_parameter(scene, line, *begin),
                                rounded_parameter(scene, line, end));
      int k = 0;
      for (const Cut& c : {*begin, end}) {
        const ExactPoint x = point_at(c);
        const LineScan scan(scene, faces, from, x);
        arc.nodes[k] = k == 0 && shared ? *shared : add_node_at(g, v, x, scan, ends, out);
        ++k;
      }
      shared = arc.nodes[1];
      out.arcs.push_back(arc);
      out.intervals.push_back({*begin, end});
      out.special_arcs.push_back(1);
      begin.reset();
    };
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
      hear_stop_now();
      auto state = state_at(point_between(stops[i], stops[i + 1]), true);
      const bool only_ends =
          std::any_of(ending.begin(), ending.end(), [&](const CutInterval& e) {
            return compare(scene, line, stops[i], e.from) != Sign::Negative &&
                   compare(scene, line, e.to, stops[i + 1]) != Sign::Negative;
          });
      if (state && only_ends && !(*state)[0]) state.reset();
      if (begin && i > 0) {
        // The arc goes on through a critical line that is free itself.
        if (state != ends || state_at(point_at(stops[i]), false) != ends)
          end_arc(stops[i]);
      }
      if (!state) shared.reset();
      if (state && !begin) {
        begin = stops[i];
        if (!g.polygon()) shared.reset();
        ends = *state;
      }
    }
    if (begin) end_arc(stops.back());
  }
}

void find_further_contacts(const Silhouettes& g, const Star& star, LineProbe& probe,
                           KnownLines& known, VertexView& view) {
  const Scene& scene = g.scene();
  const Point& v = scene.point(star.point);
  const ExactPoint from = exact_point(v);
  std::vector<std::uint8_t> done(view.nodes.size(), 0);
  const auto may_touch_more = [&](const SkeletonNode& node, const Point& e0,
                                  const Point& e1, const Cut& cut) {
    const Point x = e0 + cut.parameter() * (e1 - e0);
    // Half the enclosure, and the roundings of a difference, a product and a sum.
    const double error =
        (0.5 * (cut.hi - cut.lo) + 4 * kUnit) * (e1 - e0).cwiseAbs().sum() +
        4 * kUnit * (e0.cwiseAbs().sum() + x.cwiseAbs().sum());
    return probe.may_touch_more(
        v, x, error, {view.pool.data() + node.first_generator, node.generator_count});
  };
  // FvE: the line leaves its face at a corner or, polygon mode, may be stopped on its way
  // along the face by what touches it.
  const auto may_end_along_face = [&](const SkeletonNode& node, const Point& e0,
                                      const Point& e1) {
    if (node.kind != NodeKind::FvE) return false;
    const PlaneSide plane({v, e0, e1});
    for (std::uint32_t k = 0; k < node.generator_count; ++k) {
      const Generator& x = view.pool[node.first_generator + k];
      if (x.kind != GeneratorKind::Face) continue;
      if (g.polygon() && g.facet_touched(x.id)) return true;
      for (const int f : scene.facets()[x.id].faces) {
        for (const int w : scene.face_points(f)) {
          if (w != star.point && plane(scene.point(w)) == Sign::Zero) return true;
        }
      }
    }
    return false;
  };
  const auto point_on = [&](std::size_t arc, const Cut& cut) {
    const Edge& edge = scene.edges()[view.arcs[arc].edge];
    const Point& e0 = scene.point(edge.points[0]);
    const Point& e1 = scene.point(edge.points[1]);
    return along(exact_point(e0), exact_point(e1), exact_parameter(scene, {e0, e1}, cut));
  };
  // `other`: the point of the arc on the other side of an EVE node, or the viewpoint.
  const auto look_at = [&](std::uint32_t id, std::size_t arc, const Cut& cut,
                           const ExactPoint* other) {
    if (done[id]) return;
    done[id] = 1;
    SkeletonNode& node = view.nodes[id];
    const Edge& edge = scene.edges()[view.arcs[arc].edge];
    const Point& e0 = scene.point(edge.points[0]);
    const Point& e1 = scene.point(edge.points[1]);
    if (!view.special[id] && !may_end_along_face(node, e0, e1) &&
        !may_touch_more(node, e0, e1, cut)) {
      return;
    }
    hear_stop_now();
    const ExactPoint x = point_on(arc, cut);
    const ExactPoint& start = other ? *other : from;
    LineQuestion question{.grazes = view.grazes[id] != 0};
    const bool named = view.special[id] != VertexView::kUnnamed;
    if (named) question.end = node.end;
    question.between = !named;
    LineContacts found = contacts_of_line(g, known, {start, x}, question);
    NodeContacts& all = found.along;
    if (!named) {
      const bool keep = all.generators.empty() || all.kind != NodeKind::Degenerate;
      name_node(view, id, keep ? found.between.value_or(NodeContacts{}) : NodeContacts{});
      node.end = found.end;
    }
    if (all.generators.empty()) return;
    if (all.kind == node.kind && all.kind != NodeKind::Degenerate) {
      if (!g.polygon() || ends_one_arc(all.kind)) return;
      const bool turned = view.pool[node.first_generator] != all.generators.front();
      node.ends = {all.ends[turned ? 1 : 0], all.ends[turned ? 0 : 1]};
      node.end = all.end;
      return;
    }
    node.kind = all.kind;
    node.self = all.self;
    if (g.polygon() && !ends_one_arc(all.kind)) {
      node.ends = all.ends;
      node.end = all.end;
    }
    node.segment = all.segment;
    view.lines[id] = std::move(all.line);
    node.first_generator = static_cast<std::uint32_t>(view.pool.size());
    node.generator_count = static_cast<std::uint32_t>(all.generators.size());
    view.pool.insert(view.pool.end(), all.generators.begin(), all.generators.end());
  };
  for (std::size_t i = 0; i < view.arcs.size(); ++i) {
    look_at(view.arcs[i].nodes[0], i, view.intervals[i].from, nullptr);
    look_at(view.arcs[i].nodes[1], i, view.intervals[i].to, nullptr);
  }
  for (const VertexView::LineUp& eve : view.line_ups) {
    // Where an outer contact ends the line it is not met from the vertex.
    const bool ends = !view.grazes[eve.node];
    const ExactPoint other = ends ? point_on(eve.other_arc, eve.other_cut) : ExactPoint{};
    look_at(eve.node, eve.arc, eve.cut, ends ? &other : nullptr);
  }
}

}  // namespace sightline::internal
