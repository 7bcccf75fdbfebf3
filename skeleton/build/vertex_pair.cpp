#include "skeleton/build/vertex_pair.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "linespace/silhouettes/plane_values.h"
#include "linespace/silhouettes/star_turns.h"
#include "linespace/swaths/outline_stretch.h"

namespace sightline::internal {
namespace {

// A corner of the face off the line through p and q.
int off_line_point(const Scene& scene, int face, const Point& p, const Point& q) {
  for (const int c : scene.face_points(face)) {
    if (!collinear(p, q, scene.point(c))) return c;
  }
  return scene.face_points(face)[0];  // not reached: faces have area
}

bool contains(std::span<const std::int32_t> sorted, std::int32_t x) {
  return std::binary_search(sorted.begin(), sorted.end(), x);
}

}  // namespace

// On which side of the pair's plane a corner is; the edge's own ends are in it.
inline Sign VertexViewer::side_of(const Pair& pair, int corner) {
  PointSide& known = point_sides_[corner];
  if (known.pair != pair_) [[unlikely]] {
    known = {pair_, pair.plane(scene_.point(corner))};
  }
  return known.side;
}

// The face does not meet the plane of the pair.
inline bool VertexViewer::on_one_side(const Pair& pair, int face) {
  const auto corners = scene_.face_points(face);
  const Sign first = side_of(pair, corners[0]);
  if (first == Sign::Zero) return false;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    if (side_of(pair, corners[k]) != first) return false;
  }
  return true;
}

// All that may hide some of the edge, from front to back; true once all of it is hidden.
bool VertexViewer::add_blockers(Pair& pair) {
  const auto hides_all = [&](int face) {
    add_blocker(pair, face);
    if (!pair.closed.covers_all()) return false;
    occluders_.remember(face);
    return true;
  };
  return around_.between().any_of(pair.triangle, [&](std::int32_t blocker) {
    pair.lists.blockers.push_back(blocker);
    if (blocker < 0) return hides_all(~blocker);
    // A line that supports a convex solid does not meet it elsewhere.
    if (blocker == pair.edge->object || contains(own_objects_, blocker)) return false;
    const auto facing = around_.facing(blocker);
    return std::any_of(facing.begin(), facing.end(), [&](int face) {
      return !on_one_side(pair, face) && pair.triangle.may_meet(g_.face_box(face)) &&
             hides_all(face);
    });
  });
}

void VertexViewer::list_faces(Pair& pair) const {
  if (pair.listed) return;
  pair.listed = true;
  const auto add = [&](int face) {
    if (pair.triangle.may_meet(g_.face_box(face))) pair.lists.faces.push_back(face);
  };
  for (const std::int32_t blocker : pair.lists.blockers) {
    if (blocker < 0) {
      add(~blocker);
    } else {
      for (const int face : scene_.objects()[blocker].faces) add(face);
    }
  }
}

// False: no line that supports at the viewpoint and at the edge is blocked by this face.
// `own`: the face's object has the viewpoint as a corner.
bool VertexViewer::may_hide(const Pair& pair, const Face& face, bool own) const {
  // At a corner that stands alone there are its own object's faces only.
  const bool apart = star_->convex && !own;
  if (!apart && at_viewpoint(face.facet)) return false;
  const auto& at_edge = pair.lists.edge_facets;
  if (std::find(at_edge.begin(), at_edge.end(), face.facet) != at_edge.end()) {
    return false;
  }
  // A line that supports a convex solid does not meet it elsewhere.
  return !g_.convex_solid(face.object) || (face.object != pair.edge->object && !own);
}

// Fills `signs` with the sides of the pair's plane that the face's corners are on; false
// when the face does not cross that plane.  Only ends of the edge keep the sign zero.
bool VertexViewer::crosses_plane(Pair& pair, int face, std::span<Sign> signs) {
  const auto corners = scene_.face_points(face);
  bool front = false;
  bool back = false;
  bool stray = false;  // a corner other than the edge's ends lies in the plane
  for (std::size_t k = 0; k < signs.size(); ++k) {
    signs[k] = side_of(pair, corners[k]);
    front |= signs[k] == Sign::Positive;
    back |= signs[k] == Sign::Negative;
    stray |= signs[k] == Sign::Zero && corners[k] != pair.r->points[0] &&
             corners[k] != pair.r->points[1];
  }
  if (!stray) return front && back;
  pair.mild = true;
  if (front != back && !continues_across(face, signs) &&
      !stands_on_ground(pair, face, signs)) {
    return false;  // touches the plane from one side
  }
  if (!front && !back) return false;
  // A face with a corner in the plane crosses it there; one whose neighbour across a
  // side in the plane goes on beyond it hides what this side hides.
  for (Sign& s : signs) {
    if (s == Sign::Zero) s = front ? Sign::Negative : Sign::Positive;
  }
  return true;
}

// Side k of a face, which leads to the right of the edge or to its left, against the
// edge; `apart` as in may_hide.
SideAgainstEdge<Cut> VertexViewer::side_against(Pair& pair, int face, std::size_t k,
                                                bool to_right, bool apart) const {
  const auto corners = scene_.face_points(face);
  const int tail = corners[k];
  const int head = corners[k + 1 < corners.size() ? k + 1 : 0];
  for (const int c : {tail, head}) {  // the face ends in an end point of the edge
    if (c == pair.r->points[0]) return {Sign::Zero, Sign::Positive, {}};
    if (c == pair.r->points[1]) return {Sign::Negative, Sign::Zero, {}};
  }
  const int p = to_right ? head : tail;  // in front of the pair's plane
  const int q = to_right ? tail : head;  // behind it
  const PlaneSide side_plane({at_, scene_.point(p), scene_.point(q)});
  const PlaneValues on_edge = plane_values(side_plane, pair.e0, pair.e1);
  const auto& [x0, x1, s0, s1] = on_edge;
  pair.mild |= on_edge.zero_at_end();
  if (s0 != Sign::Negative || s1 != Sign::Positive) return {s0, s1, {}};
  const int edge = scene_.edge_of_side(face, static_cast<int>(k));
  Cut cut =
      make_cut(CutKind::Side, edge, {point_, std::min(p, q), std::max(p, q)}, x0, x1);
  if (edge >= 0 && !apart) {
    // A side of a face at the viewpoint: its plane is that face's.
    for (const Edge::Side& s : scene_.edges()[edge].sides) {
      const int facet = scene_.faces()[s.face].facet;
      if (!at_viewpoint(facet)) continue;
      cut.kind = CutKind::Support;
      cut.feature = facet;
    }
  }
  return {s0, s1, pair.keep(cut)};
}

// What a face hides is the part of the edge over which it is seen, as far as that is
// behind the face's plane.  LineViewer::overlap() finds the same for any eye;
// docs/point_view.md tells what else the two have in common, and why the rest is apart.
void VertexViewer::add_blocker(Pair& pair, int face) {
  const Face& f = scene_.faces()[face];
  const bool own = contains(own_objects_, f.object);
  if (!may_hide(pair, f, own)) return;
  const std::size_t n = scene_.face_points(face).size();
  std::array<Sign, 64> small;
  std::vector<Sign> large;
  if (n > small.size()) large.resize(n);
  const std::span<Sign> signs(large.empty() ? small.data() : large.data(), n);
  if (!crosses_plane(pair, face, signs)) return;
  const PlaneSide& face_plane = g_.face_plane(face);
  const Sign here = face_plane(at_);
  if (here == Sign::Zero) {
    pair.mild = true;  // seen edge-on: hides one line at most
    return;
  }
  if (here == Sign::Negative && g_.convex_solid(f.object) &&
      !boxes_meet(g_.object_box(f.object), box_of(std::span(&at_, 1)))) {
    return;  // a line comes in by a face in front, which hides no less
  }
  const PlaneValues there = plane_values(face_plane, pair.e0, pair.e1);
  const bool beyond0 = there.sign0 == -here;
  const bool beyond1 = there.sign1 == -here;
  if (!beyond0 && !beyond1) return;  // the edge is wholly in front of it
  const bool apart = star_->convex && !own;
  CutInterval hidden{start_cut(), end_cut()};
  const bool seen = narrow_to_outline(
      hidden, n, here,
      [&](std::size_t k) {
        return std::array{signs[k], signs[k + 1 < n ? k + 1 : 0]};
      },
      [&](std::size_t k, bool to_right) {
        return side_against(pair, face, k, to_right, apart);
      });
  if (!seen) return;
  // Where the face's plane separates the viewpoint from a part of the edge only.
  if (beyond0 != beyond1 && !there.zero_at_end()) {
    const Cut pierce =
        pair.keep(make_cut(CutKind::Pierce, scene_.faces()[face].facet,
                           plane_points(scene_, face), there.at0, there.at1));
    narrow_to_behind(hidden, beyond0, pierce, [&](const Cut& x, const Cut& y) {
      return compare(scene_, {pair.e0, pair.e1}, x, y) == Sign::Negative;
    });
  }
  pair.close(hidden.from, hidden.to);
}

// A side of the face lies in the plane of the pair, all else of the face on one side of
// it, and the face's neighbour across that side on the other.
bool VertexViewer::continues_across(int face, std::span<const Sign> signs) const {
  const auto corners = scene_.face_points(face);
  const std::size_t n = signs.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (signs[k] != Sign::Zero || signs[(k + 1) % n] != Sign::Zero) continue;
    const int edge = scene_.edge_of_side(face, static_cast<int>(k));
    if (edge < 0) return true;  // flat: the facet goes on
    const Scene& s = scene_;
    const auto& sides = s.edges()[edge].sides;
    const Point& p = s.point(corners[k]);
    const Point& q = s.point(corners[(k + 1) % n]);
    const Point& own = s.point(off_line_point(s, face, p, q));
    for (const Edge::Side& side : sides) {
      if (side.face == face || s.faces()[side.face].facet == s.faces()[face].facet)
        continue;
      const Point& other = s.point(off_line_point(s, side.face, p, q));
      if (orient3d(at_, p, q, own) == -orient3d(at_, p, q, other)) return true;
    }
  }
  return false;
}

// Two faces of different objects (or of one that is not convex) that lie on or touch the
// plane of the pair from opposite sides, and may touch each other: a line between them
// may be blocked though neither crosses the plane.
bool VertexViewer::touching_across(const Pair& pair) const {
  std::vector<int> above, below;
  int off_plane = -1;
  for (const int p : scene_.corners()) {
    if (pair.plane(scene_.point(p)) == Sign::Zero) continue;
    off_plane = p;
    break;
  }
  std::vector<Sign> signs;
  for (const int face : pair.lists.faces) {
    const Face& f = scene_.faces()[face];
    const auto corners = scene_.face_points(face);
    bool front = false;
    bool back = false;
    bool zero = false;
    signs.clear();
    for (const int c : corners) {
      const bool own = c == point_ || c == pair.r->points[0] || c == pair.r->points[1];
      signs.push_back(own ? Sign::Zero : pair.plane(scene_.point(c)));
      front |= signs.back() == Sign::Positive;
      back |= signs.back() == Sign::Negative;
      zero |= signs.back() == Sign::Zero;
    }
    if (!zero || (front && back)) continue;
    if (!front && !back) {
      if (!g_.solid_behind(face) || off_plane < 0) return true;
      // The solid lies behind the face.
      const Sign solid = -(g_.face_plane(face)(scene_.point(off_plane)) *
                           pair.plane(scene_.point(off_plane)));
      (solid == Sign::Positive ? above : below).push_back(face);
      continue;
    }
    if (at_viewpoint(f.facet) || continues_across(face, signs) ||
        std::find(pair.lists.edge_facets.begin(), pair.lists.edge_facets.end(),
                  f.facet) != pair.lists.edge_facets.end()) {
      continue;
    }
    (front ? above : below).push_back(face);
  }
  for (const int f : above) {
    const Box& box = g_.face_box(f);
    const int object = scene_.faces()[f].object;
    for (const int h : below) {
      if (scene_.faces()[h].object == object && g_.convex_solid(object)) continue;
      if (boxes_meet(box, g_.face_box(h))) return true;
    }
  }
  return false;
}

// For a viewpoint inside a facet of a convex solid, and the lines in that facet's plane:
// the solid blocks whatever dips below, so a face that stands on the facet with one of
// its sides blocks all lines that meet this side.
bool VertexViewer::stands_on_ground(const Pair& pair, int face,
                                    std::span<const Sign> signs) const {
  if (!star_->in_plane_only) return false;
  for (const int ground : star_->planes) {
    const int facet = scene_.faces()[ground].facet;
    if (!g_.convex_solid(scene_.facets()[facet].object)) continue;
    const PlaneSide& plane = g_.face_plane(ground);
    if (plane(pair.e0) != Sign::Zero || plane(pair.e1) != Sign::Zero) continue;
    const auto corners = scene_.face_points(face);
    bool stands = true;
    for (std::size_t k = 0; k < signs.size() && stands; ++k) {
      const Point& p = scene_.point(corners[k]);
      if (signs[k] != Sign::Zero) {
        stands = plane(p) == Sign::Positive;
        continue;
      }
      const auto& pieces = scene_.facets()[facet].faces;
      stands = std::any_of(pieces.begin(), pieces.end(), [&](int f) {
        return locate_in_plane(scene_, f, p) != PointInFace::Outside;
      });
    }
    if (stands) return true;
  }
  return false;
}

// d lies inside the cone iff it is behind all planes at once: an interval of the edge;
// -d likewise in front of all.
void VertexViewer::add_unsupported_convex(Pair& pair) {
  for (const Sign inside : {Sign::Negative, Sign::Positive}) {
    Cut from = start_cut();
    Cut to = end_cut();
    bool empty = false;
    for (const int face : star_->faces) {
      const PlaneSide& plane = g_.face_plane(face);
      const PlaneValues on_edge = plane_values(plane, pair.e0, pair.e1);
      const auto& [x0, x1, s0, s1] = on_edge;
      pair.mild |= on_edge.zero_at_end();
      if (s0 == inside && s1 == inside) continue;
      if (s0 != inside && s1 != inside) {
        empty = true;
        continue;
      }
      if (s0 == Sign::Zero || s1 == Sign::Zero) continue;  // inside up to that end
      const Cut cut = pair.keep(make_cut(CutKind::Support, scene_.faces()[face].facet,
                                         plane_points(scene_, face), x0, x1));
      const LineThrough line{pair.e0, pair.e1};
      if (s0 == inside) {
        if (compare(scene_, line, cut, to) == Sign::Negative) to = cut;
      } else if (compare(scene_, line, from, cut) == Sign::Negative) {
        from = cut;
      }
    }
    if (empty) continue;
    if (inside == Sign::Positive && g_.polygon()) {
      pair.lists.ending.push_back({from, to});  // seen from outside: the line ends here
    } else {
      pair.close(from, to);
    }
  }
}

// Between the planes of any two rays at the viewpoint the picture of the star along the
// line does not change: one cover test for each stretch.
void VertexViewer::add_unsupported_general(Pair& pair) {
  StarTurns turns(scene_, *star_, pair.e0, pair.e1);
  if (turns.degenerate()) {
    pair.degenerate = true;
    return;
  }
  pair.mild |= turns.doubled();
  for (const Cut& cut : turns.cuts()) pair.keep(cut);
  std::vector<Cut> cuts(turns.cuts().begin(), turns.cuts().end());
  cuts.push_back(end_cut());
  const LineThrough line{pair.e0, pair.e1};
  enum class Seen : std::uint8_t { Nothing, Grazes, Ends } last = Seen::Nothing;
  bool edge_on = false;  // some face is, at `from`
  Cut from = start_cut();
  for (const Cut& to : cuts) {
    if (compare(scene_, line, from, to) == Sign::Negative) {
      const bool gap = turns.leaves_gap(from);
      const bool ends = !gap && g_.polygon() && corner_drawn_between(from, to, line);
      const Seen seen = gap ? Seen::Grazes : ends ? Seen::Ends : Seen::Nothing;
      if (edge_on && seen == last && seen != Seen::Nothing)
        pair.lists.turns.push_back({from, ends});
      if (seen == Seen::Nothing) pair.close(from, to);
      if (seen == Seen::Ends) {
        if (last == Seen::Ends) {
          pair.lists.ending.back().to = to;
        } else {
          pair.lists.ending.push_back({from, to});
        }
      }
      last = seen;
      edge_on = false;
    }
    edge_on |= to.kind == CutKind::Support;
    from = to;
  }
}

}  // namespace sightline::internal
