#include "skeleton/build/vertex_view.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "linespace/lines/rounded_root.h"
#include "linespace/silhouettes/drawn.h"
#include "linespace/silhouettes/plane_values.h"
#include "linespace/space/opposite_edges.h"
#include "linespace/work/stop_scope.h"
#include "skeleton/build/degenerate_pair.h"
#include "skeleton/build/further_contacts.h"
#include "skeleton/build/vertex_pair.h"
#include "skeleton/nodes/node_contacts.h"

namespace sightline::internal {
namespace {

std::array<double, 3> relative(const Point& p, const Point& origin) {
  return {p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
}

}  // namespace

std::uint32_t VertexView::add_node(NodeKind kind, bool self, bool end,
                                   std::span<const Generator> generators,
                                   const std::array<Point, 2>& segment,
                                   const std::array<bool, 2>& ends) {
  SkeletonNode node;
  node.kind = kind;
  node.self = self;
  node.end = end || ends[0] || ends[1];
  node.ends = ends;
  node.first_generator = static_cast<std::uint32_t>(pool.size());
  node.generator_count = static_cast<std::uint32_t>(generators.size());
  node.segment = segment;
  pool.insert(pool.end(), generators.begin(), generators.end());
  nodes.push_back(node);
  special.push_back(kind == NodeKind::Degenerate);
  lines.emplace_back();
  return static_cast<std::uint32_t>(nodes.size() - 1);
}

// By edge, then along it.
void VertexView::sort_arcs() {
  std::vector<std::uint32_t> order(arcs.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const SkeletonArc& a = arcs[i];
    const SkeletonArc& b = arcs[j];
    if (a.edge() != b.edge()) return a.edge() < b.edge();
    if (a.range[0] != b.range[0]) return a.range[0] < b.range[0];
    return i < j;
  });
  std::vector<SkeletonArc> sorted_arcs;
  std::vector<CutInterval> sorted_intervals;
  std::vector<std::uint8_t> sorted_special;
  for (const auto i : order) {
    sorted_arcs.push_back(arcs[i]);
    sorted_special.push_back(special_arcs[i]);
    sorted_intervals.push_back(intervals[i]);
  }
  arcs = std::move(sorted_arcs);
  intervals = std::move(sorted_intervals);
  special_arcs = std::move(sorted_special);
}

void VertexView::find_grazes() {
  grazes.assign(nodes.size(), 0);
  const auto ends = [](const SkeletonArc& arc) { return arc.ends[0] || arc.ends[1]; };
  for (const SkeletonArc& arc : arcs) {
    if (ends(arc)) continue;
    for (const std::uint32_t n : arc.nodes) grazes[n] = 1;
  }
  for (const LineUp& eve : line_ups) {
    grazes[eve.node] = !ends(arcs[eve.arc]) && !ends(arcs[eve.other_arc]);
  }
}

void VertexView::keep_arcs(const std::vector<std::uint8_t>& flags) {
  std::vector<SkeletonArc> kept;
  std::vector<CutInterval> kept_intervals;
  std::vector<std::uint8_t> kept_special;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    if (flags[i] == 0) continue;
    kept.push_back(arcs[i]);
    kept_intervals.push_back(intervals[i]);
    kept_special.push_back(special_arcs[i]);
  }
  if (kept.size() == arcs.size()) return;
  arcs = std::move(kept);
  intervals = std::move(kept_intervals);
  special_arcs = std::move(kept_special);
  constexpr auto kUnused = static_cast<std::uint32_t>(-1);
  std::vector<std::uint32_t> renamed(nodes.size(), kUnused);
  std::vector<SkeletonNode> used;
  std::vector<std::uint8_t> used_special;
  std::vector<LineName> used_lines;
  for (SkeletonArc& arc : arcs) {
    for (std::uint32_t& n : arc.nodes) {
      if (renamed[n] == kUnused) {
        renamed[n] = static_cast<std::uint32_t>(used.size());
        used.push_back(nodes[n]);
        used_special.push_back(special[n]);
        used_lines.push_back(std::move(lines[n]));
      }
      n = renamed[n];
    }
  }
  nodes = std::move(used);
  special = std::move(used_special);
  lines = std::move(used_lines);
}

// Angular cover test: seen along the line every sector is a convex cone of the plane; the
// cones leave a gap iff the counter-clockwise side of some ray is covered by none.
StarContact star_contact(const Scene& scene, const Star& star, const Point& x) {
  const Point& v = scene.point(star.point);
  const std::size_t n = star.rays.size();
  std::vector<std::int8_t> turn(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const Sign s = orient3d(v, scene.point(star.rays[i]), scene.point(star.rays[j]), x);
      turn[i * n + j] = static_cast<std::int8_t>(s);
      turn[j * n + i] = static_cast<std::int8_t>(-s);
    }
  }
  for (const auto& sector : star.sectors) {
    if (turn[sector.from * n + sector.to] == 0) return StarContact::Degenerate;
  }
  // Two rays may look alike along the line; equal or opposite is told apart by any third.
  const auto same = [&](std::size_t i, std::size_t j) {
    if (i == j) return true;
    if (turn[i * n + j] != 0) return false;
    for (std::size_t k = 0; k < n; ++k) {
      if (turn[i * n + k] != 0) return turn[i * n + k] == turn[j * n + k];
    }
    return true;
  };
  for (std::size_t k = 0; k < n; ++k) {
    bool covered = false;
    for (const auto& sector : star.sectors) {
      std::size_t a = sector.from;
      std::size_t b = sector.to;
      if (turn[a * n + b] < 0) std::swap(a, b);
      if (same(a, k) || (turn[a * n + k] > 0 && turn[k * n + b] > 0)) {
        covered = true;
        break;
      }
    }
    if (!covered) return StarContact::Grazes;
  }
  if (star.sectors.empty()) return StarContact::Grazes;
  // Between rays that only look alike a line may pass, to second order.
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      if (same(i, j)) return StarContact::Degenerate;
    }
  }
  return StarContact::Blocked;
}

VertexViewer::VertexViewer(const Silhouettes& silhouettes, const EvPart& part,
                           const SkeletonLines* lines, double feature_size,
                           Surroundings& around, KnownLines& known)
    : g_(silhouettes),
      scene_(silhouettes.scene()),
      part_(part),
      lines_(lines),
      feature_size_(feature_size),
      occluders_(silhouettes),
      probe_(silhouettes),
      around_(around),
      known_(known),
      lists_(std::make_unique<PairLists>()),
      point_sides_(scene_.points().size()) {}

VertexViewer::~VertexViewer() = default;

void VertexViewer::begin(int star) {
  out_ = {};
  star_id_ = star;
  wanted_ = part_.wanted(star);
  star_ = &g_.stars()[star];
  point_ = star_->point;
  at_ = scene_.point(point_);
  own_facets_.clear();
  for (const int f : star_->faces) own_facets_.push_back(scene_.faces()[f].facet);
  sort_unique(own_facets_);
  const auto objects = g_.objects_at(point_);
  own_objects_.assign(objects.begin(), objects.end());
  occluders_.begin(std::span(&at_, 1), own_objects_, own_facets_);
  star_planes_.clear();
  if (star_->convex) {
    for (const int f : star_->faces) {
      const auto [a, b, c] = face_plane_through(scene_, f);
      star_planes_.push_back(plane_seen_from(at_, a, b, c));
    }
  }
}

bool VertexViewer::at_viewpoint(int facet) const {
  return std::binary_search(own_facets_.begin(), own_facets_.end(), facet);
}

bool VertexViewer::hidden(const Box& box) {
  // Lines into the viewpoint's own solid, forwards or backwards, support nothing.
  if (star_->convex) {
    const CentredBox b = centred(box);
    const auto centre = relative({b.centre[0], b.centre[1], b.centre[2]}, at_);
    const auto inside = [&](const BoundedPlane& p) {
      return p.negative_on(centre, b.half);
    };
    const auto beyond = [&](const BoundedPlane& p) {
      return p.positive_on(centre, b.half);
    };
    if (std::all_of(star_planes_.begin(), star_planes_.end(), inside)) return true;
    if (!g_.polygon() && std::all_of(star_planes_.begin(), star_planes_.end(), beyond)) {
      return true;  // in polygon mode: ends there
    }
  }
  return occluders_.hider(box) >= 0;
}

bool VertexViewer::may_view(std::uint32_t node) {
  return part_.has_below(node, wanted_) &&
         (star_->in_plane_only || !hidden(g_.ridge_tree().node(node).box));
}

void VertexViewer::view_group(std::uint32_t group) {
  const Bvh& tree = g_.ridge_tree();
  occluders_.look_at(tree.node(group).box);
  std::uint32_t stack[128];
  int top = 0;
  stack[top++] = group;
  while (top > 0) {
    const std::uint32_t at = stack[--top];
    if (at != group && !may_view(at)) continue;
    const Bvh::Node& node = tree.node(at);
    if (node.count == 0) {
      stack[top++] = node.first + 1;
      stack[top++] = node.first;
      continue;
    }
    hear_stop();
    for (std::uint32_t i = 0; i < node.count; ++i) {
      if (g_.ridge_sides(node.first + i).never_touched_from(at_)) continue;
      view_ridge(static_cast<int>(tree.items()[node.first + i]), out_);
    }
  }
  occluders_.look_away();
}

VertexView VertexViewer::finish() {
  VertexView out = std::move(out_);
  out.sort_arcs();
  if (feature_size_ > 0) drop_short_arcs(out);
  if (part_.by_lines) drop_arcs_off_source(out);
  add_line_ups(out);
  out.find_grazes();
  find_further_contacts(g_, *star_, probe_, known_, out);
  out.line_ups = {};
  out.special = {};
  out.special_arcs = {};
  out.intervals = {};
  out.positions = {};
  return out;
}

void VertexViewer::drop_short_arcs(VertexView& out) {
  std::vector<std::uint8_t> kept;
  for (const SkeletonArc& arc : out.arcs) {
    const auto& p = scene_.edges()[arc.edge()].points;
    const double whole = (scene_.point(p[1]) - scene_.point(p[0])).norm();
    kept.push_back((arc.range[1] - arc.range[0]) * whole >= feature_size_);
    if (kept.back() == 0) out.short_arcs.push_back({arc.vertex(), arc.edge(), arc.range});
  }
  out.keep_arcs(kept);
}

// Neither generator is on the source: some line of the arc must end there.
void VertexViewer::drop_arcs_off_source(VertexView& out) {
  std::vector<std::uint8_t> kept;
  for (const SkeletonArc& arc : out.arcs) {
    kept.push_back(part_.on_source(star_id_, g_.ridge_of_edge(arc.edge())) ||
                   any_ends_on(lines_->ends(arc), part_.source_faces));
  }
  out.keep_arcs(kept);
}

// Finds all arcs of the viewpoint with one ridge.
void VertexViewer::view_ridge(int ridge, VertexView& out) {
  // 1. What is not asked for.  Where only lines from a source are, they lie in the wedge
  // of the viewpoint and the edge, beyond either.
  if (!part_.has(ridge, wanted_)) return;
  const Ridge& r = g_.ridges()[ridge];
  if (part_.by_lines && !part_.on_source(star_id_, ridge)) {
    const auto& p = r.points;
    if (!wedge_may_meet(at_, scene_.point(p[0]), scene_.point(p[1]), part_.source_box)) {
      return;
    }
  }
  // 2. What is no silhouette from here, by the sides of its two faces' planes that the
  // viewpoint is on; then what is hidden as a whole.
  if (r.points[0] == point_ || r.points[1] == point_) return;
  const Sign a = r.a(at_);
  const Sign b = r.b(at_);
  const EdgeContact contact = r.contact(a, b);
  if (contact == EdgeContact::None || !may_see(r)) return;

  // 3. The pair: both ends of the edge are known to lie in its plane.
  hear_stop_now();
  lists_->clear();
  ++pair_;
  for (const int end : r.points) point_sides_[end] = {pair_, Sign::Zero};
  const Point& e0 = scene_.point(r.points[0]);
  const Point& e1 = scene_.point(r.points[1]);
  Pair pair{&r,
            &scene_.edges()[r.edge],
            e0,
            e1,
            PlaneSide({at_, e0, e1}),
            Shaft(at_, e0, e1),
            CutUnion(scene_, {e0, e1}),
            *lists_};
  for (const Edge::Side& side : pair.edge->sides) {
    pair.lists.edge_facets.push_back(scene_.faces()[side.face].facet);
  }
  // 4. What is known of it at once.  A viewpoint in the plane of a face at the edge
  // leaves only the contacts at the ends of arcs to be listed (mild); other solids at the
  // edge, or a viewpoint inside of a face, may change all of an arc (degenerate).
  pair.mild = a == Sign::Zero || b == Sign::Zero;
  pair.degenerate =
      r.touched_along() || (r.touched && g_.polygon()) || star_->in_plane_only;
  pair.edge_ends = contact == EdgeContact::End;
  pair.share_facet = g_.polygon() && share(r.all_facets, star_->facets);
  // Those that end there are left out.
  if (pair.share_facet && ((pair.edge_ends && !r.any_side) || !r.can_graze())) return;
  // 5. The parts of the edge that are seen.  Whether signs alone tell their ends shows
  // only now: where other faces pierce the edge inside a part, or touch the pair's plane
  // from both sides, they do not.
  auto open = open_parts(pair);
  if (open.empty()) return;
  if (pierced_inside(pair, open) || changes_at_turn(pair, open)) pair.degenerate = true;
  if (pair.mild || pair.degenerate) list_faces(pair);
  pair.degenerate = pair.degenerate || (pair.mild && touching_across(pair));
  // 6. The arcs: by single exact lines, or as the cuts tell.
  if (pair.degenerate) {
    add_degenerate_pair(g_, *star_, r, pair.plane, pair.closed, pair.lists.ending,
                        pair.lists.faces, out);
    return;
  }
  if (!pair.lists.ending.empty()) split_at_ends(pair, open);
  add_arcs(pair, open, out);
}

// False proves that no line from the viewpoint to the ridge is one of an arc.
bool VertexViewer::may_see(const Ridge& r) {
  const Point& e0 = scene_.point(r.points[0]);
  const Point& e1 = scene_.point(r.points[1]);
  if (star_->in_plane_only) {
    const bool in_plane =
        std::any_of(star_->planes.begin(), star_->planes.end(), [&](int f) {
          return g_.face_plane(f)(e0) == Sign::Zero && g_.face_plane(f)(e1) == Sign::Zero;
        });
    if (!in_plane && !g_.polygon()) return false;
  } else if (occluders_.hider(e0, e1) >= 0) {
    return false;
  }
  const bool own_solid = std::all_of(r.objects.begin(), r.objects.end(), [&](int o) {
    return g_.convex_solid(o) &&
           std::binary_search(own_objects_.begin(), own_objects_.end(), o);
  });
  if (own_solid) return false;
  return !collinear(at_, e0, e1);  // along the edge: no family of lines
}

// The parts of the edge that are not hidden and that the viewpoint supports.
std::vector<CutInterval> VertexViewer::open_parts(Pair& pair) {
  if (star_->convex) add_unsupported_convex(pair);
  if (pair.closed.covers_all() || add_blockers(pair)) return {};
  auto open = pair.closed.complement();
  if (open.empty() || star_->convex || pair.degenerate) return open;
  add_unsupported_general(pair);
  return pair.closed.complement();
}

// An arc for each open part, with the nodes at its ends.
void VertexViewer::add_arcs(Pair& pair, std::span<const CutInterval> open,
                            VertexView& out) {
  const LineThrough line{pair.e0, pair.e1};
  const bool mild = pair.mild || !ends_are_simple(pair, open);
  if (mild) list_faces(pair);
  const bool self = own_objects_ == pair.r->objects && own_objects_.size() == 1;
  for (std::size_t k = 0; k < open.size(); ++k) {
    const CutInterval& i = open[k];
    SkeletonArc arc = SkeletonArc::ev(point_, pair.r->edge);
    arc.self = self;
    arc.ends = {!pair.lists.piece_ends.empty() && pair.lists.piece_ends[k] != 0,
                pair.edge_ends};
    arc.range = rounded_range(rounded_parameter(scene_, line, i.from),
                              rounded_parameter(scene_, line, i.to));
    if (pair.share_facet && arc.ends[0]) continue;
    // Where the kind of contact changes, one line ends two arcs.
    const bool goes_on = k > 0 && !pair.share_facet && !pair.lists.piece_ends.empty() &&
                         compare(scene_, line, open[k - 1].to, i.from) == Sign::Zero;
    const std::uint32_t first =
        goes_on ? out.arcs.back().nodes[1] : node_at(pair, i.from, arc.ends, mild, out);
    arc.nodes = {first, node_at(pair, i.to, arc.ends, mild, out)};
    out.arcs.push_back(arc);
    out.intervals.push_back(i);
    out.special_arcs.push_back(mild);
  }
}

// The node at a cut that ends an arc: named by the cut alone where that is certain, else
// by its contacts.
std::uint32_t VertexViewer::node_at(Pair& pair, const Cut& cut,
                                    const std::array<bool, 2>& ends, bool mild,
                                    VertexView& out) const {
  // Where the edge enters a face, a corner that is one cone touches nothing else.
  const bool simple =
      !is_pierced_at(pair, cut) || (star_->convex && cut.kind == CutKind::Pierce);
  if (!mild && simple) {
    if (const auto found = end_node(pair, cut, ends, out)) return *found;
  }
  if (g_.polygon()) list_faces(pair);
  return contact_node(g_, *star_, *pair.r, pair.lists.faces, cut, ends, out);
}

// Polygon mode: cuts the open parts where the viewpoint turns from a graze into an end
// contact.
void VertexViewer::split_at_ends(Pair& pair, std::vector<CutInterval>& open) const {
  const LineThrough line{pair.e0, pair.e1};
  const auto before = [&](const Cut& x, const Cut& y) {
    return compare(scene_, line, x, y) == Sign::Negative;
  };
  std::vector<CutInterval> pieces;
  for (const CutInterval& i : open) {
    Cut at = i.from;
    for (const CutInterval& e : pair.lists.ending) {  // in order, apart
      const Cut& from = before(at, e.from) ? e.from : at;
      const Cut& to = before(e.to, i.to) ? e.to : i.to;
      if (!before(from, to)) continue;
      if (before(at, from)) {
        pieces.push_back({at, from});
        pair.lists.piece_ends.push_back(0);
      }
      pieces.push_back({from, to});
      pair.lists.piece_ends.push_back(1);
      at = to;
    }
    if (!before(at, i.to)) continue;
    pieces.push_back({at, i.to});
    pair.lists.piece_ends.push_back(0);
  }
  open = std::move(pieces);
}

// In the plane of a face of the star a line may graze between lines that end, or end
// between lines that graze.
bool VertexViewer::changes_at_turn(const Pair& pair,
                                   std::span<const CutInterval> open) const {
  const LineThrough line{pair.e0, pair.e1};
  const auto before = [&](const Cut& x, const Cut& y) {
    return compare(scene_, line, x, y) == Sign::Negative;
  };
  return std::ranges::any_of(pair.lists.turns, [&](const PairLists::Turn& turn) {
    const bool inside = std::ranges::any_of(open, [&](const CutInterval& i) {
      return before(i.from, turn.at) && before(turn.at, i.to);
    });
    if (!inside) return false;
    const ExactPoint from = exact_point(at_);
    const ExactPoint to = along(exact_point(pair.e0), exact_point(pair.e1),
                                exact_parameter(scene_, line, turn.at));
    const auto ends = blocked_ends(g_, LineScan(scene_, star_->faces, from, to));
    return !ends || (*ends)[0] != turn.ends;
  });
}

bool VertexViewer::corner_drawn_between(const Cut& from, const Cut& to,
                                        const LineThrough& edge) const {
  const Rational s = exact_parameter(scene_, edge, from);
  const Rational t = exact_parameter(scene_, edge, to);
  const ExactPoint x = along(exact_point(edge.from), exact_point(edge.to), (s + t) / 2);
  return drawn_corner(g_, *star_, Eye(x));
}

// No two different cuts coincide at an end of an arc, and none is of an unknown feature.
bool VertexViewer::ends_are_simple(const Pair& pair,
                                   std::span<const CutInterval> open) const {
  const LineThrough line{pair.e0, pair.e1};
  const auto simple = [&](const Cut& end) {
    if (end.kind == CutKind::Start || end.kind == CutKind::End) return true;
    if (end.kind == CutKind::Side && end.feature < 0) return false;
    return std::none_of(pair.lists.cuts.begin(), pair.lists.cuts.end(),
                        [&](const Cut& other) {
                          if (other.hi < end.lo || other.lo > end.hi) return false;
                          if (other.plane == end.plane && other.exact == end.exact)
                            return false;
                          if (other.kind == end.kind && other.feature == end.feature)
                            return false;
                          return compare(scene_, line, other, end) == Sign::Zero;
                        });
  };
  return std::all_of(open.begin(), open.end(), [&](const CutInterval& i) {
    return simple(i.from) && simple(i.to);
  });
}

// Lists where foreign faces meet the edge; true where that is inside an open part, or
// where a buried stretch may be seen from a corner on the same solid.
bool VertexViewer::pierced_inside(Pair& pair, std::span<const CutInterval> open) const {
  const LineThrough line{pair.e0, pair.e1};
  const auto before = [&](const Cut& a, const Cut& b) {
    return compare(scene_, line, a, b) == Sign::Negative;
  };
  for (const int face : pair.r->pierced_by) {
    const PlaneValues v = plane_values(g_.face_plane(face), pair.e0, pair.e1);
    pair.lists.pierced.push_back(make_cut(CutKind::Pierce, scene_.faces()[face].facet,
                                          plane_points(scene_, face), v.at0, v.at1));
  }
  if (star_->touched && !pair.r->buried.empty()) return true;
  return std::any_of(
      pair.lists.pierced.begin(), pair.lists.pierced.end(), [&](const Cut& at) {
        return std::any_of(open.begin(), open.end(), [&](const CutInterval& i) {
          return before(i.from, at) && before(at, i.to);
        });
      });
}

bool VertexViewer::is_pierced_at(const Pair& pair, const Cut& cut) const {
  return std::any_of(pair.lists.pierced.begin(), pair.lists.pierced.end(),
                     [&](const Cut& at) {
                       return compare(scene_, {pair.e0, pair.e1}, at, cut) == Sign::Zero;
                     });
}

std::optional<std::uint32_t> VertexViewer::end_node(const Pair& pair, const Cut& cut,
                                                    const std::array<bool, 2>& ends,
                                                    VertexView& out) const {
  const Generator vertex{GeneratorKind::Vertex, point_};
  const Generator edge{GeneratorKind::Edge, pair.r->edge};
  const auto alone = [](std::span<const std::int32_t> a,
                        std::span<const std::int32_t> b) {
    return a.size() == 1 && b.size() == 1 && a[0] == b[0];
  };
  // `self`: two of the line's contacts are on one object, and on no other.
  const bool arc_self = alone(own_objects_, pair.r->objects);
  // VV: the arc ends in an end of the edge.  Each of the two corners is grazed or, in
  // polygon mode, an end contact; a line in the plane of a face at one is left to
  // contact_node().
  if (cut.kind == CutKind::Start || cut.kind == CutKind::End) {
    const int far = pair.r->points[cut.kind == CutKind::End];
    const Star& star = g_.stars()[g_.star_of_point(far)];
    const StarContact there = star_contact(scene_, star, at_);
    const StarContact here = star_contact(scene_, *star_, scene_.point(far));
    const auto objects = g_.objects_at(far);
    const bool self = alone(own_objects_, objects);
    const Generator generators[] = {vertex, {GeneratorKind::Vertex, far}};
    if (there == StarContact::Degenerate || here == StarContact::Degenerate)
      return std::nullopt;
    const std::array<bool, 2> blocked{here == StarContact::Blocked,
                                      there == StarContact::Blocked};
    return out.add_node(NodeKind::VV, self, blocked[0] || blocked[1], generators,
                        {at_, scene_.point(far)},
                        g_.polygon() ? blocked : std::array<bool, 2>{});
  }
  // Other ends are inside the edge: what cuts it there is the third generator.
  const Point hit = pair.e0 + cut.parameter() * (pair.e1 - pair.e0);
  switch (cut.kind) {
    // VEE: the line grazes a blocker's side on its way.  The side may be an edge of the
    // viewpoint's own object, or of the far edge's: then the event is of one object.
    case CutKind::Side: {
      const Generator side = g_.named(cut.feature);
      const Generator generators[] = {vertex, side, edge};
      const auto objects = g_.objects_of(side);
      const bool self =
          arc_self || alone(own_objects_, objects) || alone(objects, pair.r->objects);
      return out.add_node(NodeKind::VEE, self, false, generators, {at_, hit}, ends);
    }
    // FvE: beyond the plane of a face here the viewpoint does not support any more.
    case CutKind::Support: {
      const Generator generators[] = {vertex, {GeneratorKind::Face, cut.feature}, edge};
      // In the plane of a face at the viewpoint: grazed there.
      return out.add_node(NodeKind::FvE, arc_self, false, generators, {at_, hit},
                          {false, ends[1]});
    }
    // Two edges of the viewpoint's own corner line up: nothing else is met.
    case CutKind::Saddle: {
      const Generator generators[] = {vertex, edge};
      return out.add_node(NodeKind::Saddle, arc_self, false, generators, {at_, hit},
                          ends);
    }
    // Pierce: the edge enters a face there, so that what is beyond is hidden.
    default: {
      const Generator generators[] = {vertex, {GeneratorKind::Face, cut.feature}, edge};
      return out.add_node(NodeKind::Pierce, arc_self, false, generators, {at_, hit},
                          ends);
    }
  }
}

// EVE: two arcs of this vertex in opposite directions that lie on one line.
void VertexViewer::add_line_ups(VertexView& out) {
  std::vector<std::array<Point, 2>> edges;
  for (const SkeletonArc& a : out.arcs) {
    const auto& p = scene_.edges()[a.edge()].points;
    edges.push_back({scene_.point(p[0]), scene_.point(p[1])});
  }
  for (const auto& [i, j] : opposite_edges(at_, edges)) {
    const SkeletonArc a = out.arcs[i];
    const SkeletonArc b = out.arcs[j];
    // With an end contact at the viewpoint, no line goes on.
    if (b.edge() == a.edge() || a.ends[0] || b.ends[0]) continue;
    const Edge& e = scene_.edges()[a.edge()];
    const Edge& f = scene_.edges()[b.edge()];
    const auto& [e0, e1] = edges[i];
    const auto& [f0, f1] = edges[j];
    const PlaneSide plane_e({at_, e0, e1});
    const Sign s0 = plane_e(f0);
    const Sign s1 = plane_e(f1);
    if (s0 == s1 || s0 == Sign::Zero || s1 == Sign::Zero) continue;
    const PlaneSide plane_f({at_, f0, f1});
    const Sign t0 = plane_f(e0);
    const Sign t1 = plane_f(e1);
    if (t0 == t1 || t0 == Sign::Zero || t1 == Sign::Zero) continue;
    // The common line of the two planes meets both edges.  The crossing of f, from
    // front to back of e's plane, is to the right of the ray to e0 iff it lies behind.
    if ((s0 == Sign::Positive ? t0 : -t0) != Sign::Positive) continue;
    const Cut on_e = line_up_cut({e0, e1}, plane_f, f.points);
    const Cut on_f = line_up_cut({f0, f1}, plane_e, e.points);
    if (!inside_arc({e0, e1}, out.intervals[i], on_e)) continue;
    if (!inside_arc({f0, f1}, out.intervals[j], on_f)) continue;
    const Generator generators[] = {{GeneratorKind::Edge, a.edge()},
                                    {GeneratorKind::Vertex, point_},
                                    {GeneratorKind::Edge, b.edge()}};
    const bool self = a.self || b.self || e.object == f.object;
    const std::uint32_t node = out.add_node(
        NodeKind::EVE, self, false, generators,
        {e0 + on_e.parameter() * (e1 - e0), f0 + on_f.parameter() * (f1 - f0)},
        {a.ends[1], b.ends[1]});
    out.special[node] = out.special_arcs[i] != 0 || out.special_arcs[j] != 0;
    out.line_ups.push_back({node, i, on_e, j, on_f});
  }
}

// Where the plane of the viewpoint and points q crosses the edge.
Cut VertexViewer::line_up_cut(const LineThrough& edge, const PlaneSide& plane,
                              const std::array<std::int32_t, 2>& q) const {
  return make_cut(CutKind::Side, -1, {point_, std::min(q[0], q[1]), std::max(q[0], q[1])},
                  plane.value(edge.from), plane.value(edge.to));
}

bool VertexViewer::inside_arc(const LineThrough& edge, const CutInterval& arc,
                              const Cut& cut) const {
  return compare(scene_, edge, arc.from, cut) == Sign::Negative &&
         compare(scene_, edge, cut, arc.to) == Sign::Negative;
}

}  // namespace sightline::internal
