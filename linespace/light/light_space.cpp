#include "linespace/light/light_space.h"

#include <algorithm>
#include <map>
#include <optional>

#include "linespace/contacts/seen_along.h"
#include "linespace/sight/face_crossings.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// With the product of the denominators as weight.
Four<Ring> ring_of(const ExactPoint& p) {
  std::array<Ring, 3> num, den;
  for (int i = 0; i < 3; ++i) {
    num[i] = contacts::ring(mpq_numref(p[i].backend().data()));
    den[i] = contacts::ring(mpq_denref(p[i].backend().data()));
  }
  return {num[0] * den[1] * den[2], num[1] * den[0] * den[2], num[2] * den[0] * den[1],
          den[0] * den[1] * den[2]};
}

// Where two lines of one plane cross, each inside the other, as told by planes along a
// coordinate axis that is not in that plane.
std::optional<LightPoint> crossing(const LightLine& l, const LightLine& m) {
  for (int axis = 0; axis < 3; ++axis) {
    Point off = Point::Zero();
    off[axis] = 1;
    LightPoint direction;  // at infinity, along the axis
    direction.exact = {Ring(off[0]), Ring(off[1]), Ring(off[2]), Ring(0)};
    const Four<Ring> beside_m = plane_of(m.exact, direction.exact);
    const Ring l0 = value(beside_m, l.ends[0]->exact);
    const Ring l1 = value(beside_m, l.ends[1]->exact);
    if (is_zero(l0) && is_zero(l1)) continue;
    if (sign_of(l0) != -sign_of(l1)) return std::nullopt;
    const Four<Ring> beside_l = plane_of(l.exact, direction.exact);
    const Ring m0 = value(beside_l, m.ends[0]->exact);
    const Ring m1 = value(beside_l, m.ends[1]->exact);
    if (sign_of(m0) != -sign_of(m1) || is_zero(m0)) return std::nullopt;
    return light_point(combination(l1, l.ends[0]->exact, l0, l.ends[1]->exact));
  }
  return std::nullopt;  // on one line
}

}  // namespace

LightSpace::LightSpace(const Scene& scene, const Request& request) : scene_(scene) {
  const PrecisionScope exact(Precision::Exact);
  points_.reserve(scene.points().size());
  for (const Point& p : scene.points()) points_.push_back(light_point(p));
  size_ = (scene.bounds()[1] - scene.bounds()[0]).norm();
  for (const Point& corner : scene.bounds()) {
    size_ = std::max(size_, corner.cwiseAbs().maxCoeff());
  }
  const Silhouettes silhouettes(scene, EventMode::Solid, request);
  for (std::size_t o = 0; o < scene.objects().size(); ++o) {
    convex_.push_back(silhouettes.convex_solid(static_cast<int>(o)) ? 1 : 0);
  }
  add_faces();
  add_edges();
  find_touches();
  find_pierced();
  const FaceCrossings crossings(silhouettes);
  for (std::size_t i = 0; i < crossings.count(); ++i) {
    const FaceCrossing& c = crossings.at(static_cast<std::uint32_t>(i));
    const LightPoint& from =
        crossing_points_.emplace_back(light_point(ring_of(c.segment[0])));
    const LightPoint& to =
        crossing_points_.emplace_back(light_point(ring_of(c.segment[1])));
    lines_.push_back(light_line(from, to));
    crossings_.push_back({{c.f, c.h}, &lines_.back()});
  }
}

const LightLine* LightSpace::line_between(int p, int q) {
  const int low = std::min(p, q);
  const int high = std::max(p, q);
  const std::uint64_t key =
      static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
  const LightLine*& found = line_of_[key];
  if (found == nullptr) {
    lines_.push_back(light_line(points_[low], points_[high]));
    found = &lines_.back();
  }
  return found;
}

void LightSpace::add_faces() {
  std::vector<Box> boxes;
  for (std::size_t f = 0; f < scene_.faces().size(); ++f) {
    const auto p = scene_.face_points(static_cast<int>(f));
    LightFace& face = faces_.emplace_back();
    face.plane = light_plane(points_[p[0]], points_[p[1]], points_[p[2]]);
    std::vector<Point> corners;
    for (std::size_t k = 0; k < p.size(); ++k) {
      const int q = p[(k + 1) % p.size()];
      const bool seam = scene_.edge_of_side(static_cast<int>(f), static_cast<int>(k)) < 0;
      face.sides.push_back({line_between(p[k], q), p[k] < q, seam});
      corners.push_back(scene_.point(p[k]));
    }
    face.box = box_of(corners);
    boxes.push_back(face.box);
  }
  face_tree_ = std::make_unique<Bvh>(boxes);
}

void LightSpace::add_edges() {
  std::map<std::array<int, 2>, std::size_t> known;
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < scene_.edges().size(); ++i) {
    const Edge& e = scene_.edges()[i];
    const bool in_solid = std::ranges::all_of(
        e.sides, [&](const Edge::Side& s) { return scene_.solid_behind(s.face); });
    if (e.kind == EdgeKind::Flat || (e.kind == EdgeKind::Reflex && in_solid)) continue;
    const auto [at, fresh] = known.try_emplace({e.points[0], e.points[1]}, edges_.size());
    if (fresh) {
      LightEdge& edge = edges_.emplace_back();
      edge.line = line_between(e.points[0], e.points[1]);
      edge.edge = static_cast<int>(i);
      edge.points = e.points;
      if (e.kind == EdgeKind::Convex || e.kind == EdgeKind::Reflex) {
        edge.wedge = {e.sides[0].face, e.sides[1].face};
      }
      const Point ends[] = {scene_.point(e.points[0]), scene_.point(e.points[1])};
      boxes.push_back(box_of(ends));
    } else {
      edges_[at->second].wedge = {-1, -1};
    }
    LightEdge& edge = edges_[at->second];
    edge.objects.push_back(e.object);
    for (const Edge::Side& s : e.sides) {
      edge.facets.push_back(scene_.faces()[s.face].facet);
    }
    sort_unique(edge.objects);
    sort_unique(edge.facets);
  }
  edge_tree_ = std::make_unique<Bvh>(boxes);
}

void LightSpace::find_touches() {
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    hear_stop();
    const LightLine& l = *edges_[i].line;
    const Point ends[] = {l.ends[0]->rounded, l.ends[1]->rounded};
    const Box box = box_of(ends);
    edge_tree_->traverse(
        [&](const Box& other) { return boxes_meet(box, other); },
        [&](std::uint32_t j) {
          const auto& p = edges_[i].points;
          const auto& q = edges_[j].points;
          if (j <= i || p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1]) {
            return;
          }
          const Point others[] = {scene_.point(q[0]), scene_.point(q[1])};
          if (!boxes_meet(box, box_of(others))) return;
          if (sign_between(l, *edges_[j].line) != Sign::Zero) return;
          if (const auto x = crossing(l, *edges_[j].line)) {
            touches_.push_back({{static_cast<int>(i), static_cast<int>(j)}, *x});
          }
        });
  }
}

void LightSpace::find_pierced() {
  for (LightEdge& edge : edges_) {
    hear_stop();
    const LightLine& l = *edge.line;
    const Point ends[] = {l.ends[0]->rounded, l.ends[1]->rounded};
    const Box box = box_of(ends);
    face_tree_->traverse(
        [&](const Box& other) { return boxes_meet(box, other); },
        [&](std::uint32_t f) {
          const LightFace& face = faces_[f];
          if (!boxes_meet(box, face.box)) return;
          const Sign at0 = sign_at(face.plane, *l.ends[0]);
          if (at0 == Sign::Zero || at0 != -sign_at(face.plane, *l.ends[1])) return;
          bool left = false;
          bool right = false;
          for (const LightFace::Side& side : face.sides) {
            const Sign s = sign_between(l, *side.line);
            left = left || (side.forward ? s : -s) == Sign::Positive;
            right = right || (side.forward ? s : -s) == Sign::Negative;
          }
          if (!(left && right)) edge.pierced_by.push_back(static_cast<int>(f));
        });
  }
}

bool never_grazes(const LightSpace& space, const LightEdge& edge, const LightPoint& p0,
                  const LightPoint& p1) {
  if (edge.wedge[0] < 0) return false;
  const LightPlane& a = space.faces()[edge.wedge[0]].plane;
  const LightPlane& b = space.faces()[edge.wedge[1]].plane;
  const Sign s = sign_at(a, p0);
  return s != Sign::Zero && sign_at(b, p0) == s && sign_at(a, p1) == s &&
         sign_at(b, p1) == s;
}

}  // namespace sightline::internal
