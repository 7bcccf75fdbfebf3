#include "skeleton/build/part.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "linespace/numbers/rational.h"
#include "linespace/space/shaft.h"
#include "skeleton/request.h"

namespace sightline::internal {
namespace {

using Bits = std::vector<std::uint8_t>;

Rational squared(const Rational& x) { return x * x; }

Rational squared_distance(const Point& p, const Point& q) {
  Rational sum = 0;
  for (int i = 0; i < 3; ++i) sum += squared(Rational(p[i]) - Rational(q[i]));
  return sum;
}

// |pq| < length.  In doubles the difference, its square and two sums are rounded: five
// factors (1 + u) on terms of one sign, one more for the length's square.
bool shorter(const Point& p, const Point& q, double length) {
  const double here = (p - q).squaredNorm();
  const double there = length * length;
  constexpr double slack = 16 * kUnit;
  if (here < there * (1 - slack)) return true;
  if (here > there * (1 + slack)) return false;
  return squared_distance(p, q) < squared(Rational(length));
}

bool in_box(const std::array<Point, 2>& box, const Point& p) {
  return (p.array() >= box[0].array()).all() && (p.array() <= box[1].array()).all();
}

// Some point of the closed segment pq is no farther than the radius from the centre.
bool within(const Ball& ball, const Point& p, const Point& q) {
  for (int i = 0; i < 3; ++i) {
    // Rounding is monotone: what exceeds the radius rounded exceeds it exactly.
    if (std::min(p[i], q[i]) - ball.centre[i] > ball.radius) return false;
    if (ball.centre[i] - std::max(p[i], q[i]) > ball.radius) return false;
  }
  const Rational reach = squared(Rational(ball.radius));
  const Rational to_p = squared_distance(ball.centre, p);
  if (to_p <= reach) return true;
  if (squared_distance(ball.centre, q) <= reach) return true;
  Rational along = 0;
  for (int i = 0; i < 3; ++i) {
    along +=
        (Rational(ball.centre[i]) - Rational(p[i])) * (Rational(q[i]) - Rational(p[i]));
  }
  const Rational length = squared_distance(p, q);
  if (along <= 0 || along >= length) return false;
  return (to_p - reach) * length <= squared(along);
}

bool any_of(std::span<const std::int32_t> objects, const std::vector<int>& wanted) {
  return std::any_of(objects.begin(), objects.end(), [&](int o) {
    return std::find(wanted.begin(), wanted.end(), o) != wanted.end();
  });
}

// All edges that end at the corner are shorter: vacuous for none, and then no feature.
bool small_corner(const Scene& scene, int point, double length) {
  const auto edges = scene.edges_at(point);
  return !edges.empty() && std::all_of(edges.begin(), edges.end(), [&](int e) {
    const auto& p = scene.edges()[e].points;
    return shorter(scene.point(p[0]), scene.point(p[1]), length);
  });
}

// Sets that a star and a ridge belong to: on objects, inside boxes.
class Membership {
 public:
  explicit Membership(const Silhouettes& g) : g_(g) {}
  [[nodiscard]] bool star_on(int star, const std::vector<int>& objects) const {
    return objects.empty() || any_of(g_.objects_at(g_.stars()[star].point), objects);
  }
  [[nodiscard]] bool ridge_on(int ridge, const std::vector<int>& objects) const {
    return objects.empty() || any_of(g_.ridges()[ridge].objects, objects);
  }
  [[nodiscard]] bool star_in(int star, const std::array<Point, 2>& box) const {
    return in_box(box, g_.scene().point(g_.stars()[star].point));
  }
  [[nodiscard]] bool ridge_in(int ridge, const std::array<Point, 2>& box) const {
    const auto& p = g_.ridges()[ridge].points;
    return in_box(box, g_.scene().point(p[0])) && in_box(box, g_.scene().point(p[1]));
  }

 private:
  const Silhouettes& g_;
};

// What is on a source: all of it when the request names none.
class Sources {
 public:
  Sources(const Silhouettes& g, const SkeletonRequest& request)
      : g_(g), objects_(request.part.through_objects), any_(asked(request)) {
    const Scene& scene = g.scene();
    if (request.part.through_faces.empty()) return;
    faces_.resize(scene.faces().size());
    facets_.resize(scene.facets().size());
    points_.resize(scene.points().size());
    for (const int f : request.part.through_faces) {
      faces_[f] = facets_[scene.faces()[f].facet] = 1;
      for (const int p : scene.face_points(f)) points_[p] = 1;
    }
  }
  [[nodiscard]] static bool asked(const SkeletonRequest& request) {
    return !request.part.through_objects.empty() || !request.part.through_faces.empty();
  }
  [[nodiscard]] bool has_star(int star) const {
    const int p = g_.stars()[star].point;
    return !any_ || (!points_.empty() && points_[p] != 0) ||
           any_of(g_.objects_at(p), objects_);
  }
  [[nodiscard]] bool has_ridge(int ridge) const {
    const Ridge& r = g_.ridges()[ridge];
    if (!any_ || any_of(r.objects, objects_)) return true;
    // Coinciding edges of several objects have neighbouring numbers.
    const auto& edges = g_.scene().edges();
    for (auto e = static_cast<std::size_t>(r.edge);
         !facets_.empty() && e < edges.size() && edges[e].points == r.points; ++e) {
      for (const Edge::Side& side : edges[e].sides) {
        if (facets_[g_.scene().faces()[side.face].facet] != 0) return true;
      }
    }
    return false;
  }
  [[nodiscard]] bool has_facet(int facet) const {
    const std::span<const std::int32_t> object(&g_.scene().facets()[facet].object, 1);
    return !any_ || (!facets_.empty() && facets_[facet] != 0) || any_of(object, objects_);
  }
  /// By face, those of the objects included.
  [[nodiscard]] Bits faces() const {
    const auto all = g_.scene().faces();
    Bits out(all.size(), 0);
    for (std::size_t f = 0; f < all.size(); ++f) {
      const std::span<const std::int32_t> object(&all[f].object, 1);
      out[f] = (!faces_.empty() && faces_[f] != 0) || any_of(object, objects_);
    }
    return out;
  }

 private:
  const Silhouettes& g_;
  const std::vector<int>& objects_;
  bool any_;
  Bits faces_, facets_, points_;
};

// "One here, the other there" for objects and for boxes at once: the four ways to hand
// out two roles twice, one bit each.  A generator with both roles of a way in one order
// offers that bit; what it wants is the way with both roles exchanged.
struct Roles {
  bool objects[2], boxes[2];
  [[nodiscard]] std::uint8_t offers() const {
    return static_cast<std::uint8_t>(
        (objects[0] && boxes[0]) | (objects[0] && boxes[1]) << 1 |
        (objects[1] && boxes[0]) << 2 | (objects[1] && boxes[1]) << 3);
  }
  [[nodiscard]] std::uint8_t wants() const {
    return static_cast<std::uint8_t>(
        (objects[1] && boxes[1]) | (objects[1] && boxes[0]) << 1 |
        (objects[0] && boxes[1]) << 2 | (objects[0] && boxes[0]) << 3);
  }
};

Roles ridge_roles(const Membership& m, int ridge, const SkeletonRequest& request) {
  Roles roles{};
  for (int k = 0; k < 2; ++k) {
    roles.objects[k] = m.ridge_on(ridge, request.part.outer_objects[k]);
    roles.boxes[k] = !request.part.between_boxes ||
                     m.ridge_in(ridge, (*request.part.between_boxes)[k]);
  }
  return roles;
}

Roles star_roles(const Membership& m, int star, const SkeletonRequest& request) {
  Roles roles{};
  for (int k = 0; k < 2; ++k) {
    roles.objects[k] = m.star_on(star, request.part.outer_objects[k]);
    roles.boxes[k] =
        !request.part.between_boxes || m.star_in(star, (*request.part.between_boxes)[k]);
  }
  return roles;
}

Bits bits_below(const Bvh& tree, const Bits& items) {
  Bits below(tree.nodes().size(), 0);
  // Children have higher numbers than their parent.
  for (std::size_t i = below.size(); i-- > 0;) {
    const Bvh::Node& node = tree.node(static_cast<std::uint32_t>(i));
    if (node.count == 0) {
      below[i] = below[node.first] | below[node.first + 1];
      continue;
    }
    for (std::uint32_t k = 0; k < node.count; ++k) {
      below[i] |= items[tree.items()[node.first + k]];
    }
  }
  return below;
}

bool kept(const Bits& flags, std::size_t i) { return flags.empty() || flags[i] != 0; }

std::vector<Point> corners_of(const Scene& scene, const Bits& faces) {
  std::vector<Point> points;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f] == 0) continue;
    for (const int p : scene.face_points(static_cast<int>(f))) {
      points.push_back(scene.point(p));
    }
  }
  return points;
}

Box united(const Box& a, const Box& b) {
  Box both;
  for (int k = 0; k < 3; ++k) {
    both.min[k] = std::min(a.min[k], b.min[k]);
    both.max[k] = std::max(a.max[k], b.max[k]);
  }
  return both;
}

void add_source(const Silhouettes& g, const Sources& sources, EvPart& part) {
  for (std::size_t i = 0; i < g.stars().size(); ++i) {
    part.source_stars.push_back(sources.has_star(static_cast<int>(i)));
  }
  for (std::size_t i = 0; i < g.ridges().size(); ++i) {
    part.source_ridges.push_back(sources.has_ridge(static_cast<int>(i)));
  }
  part.source_faces = sources.faces();
  const std::vector<Point> points = corners_of(g.scene(), part.source_faces);
  if (!points.empty()) part.source_box = box_of(points);
}

bool one_sided(const SkeletonRequest& request) {
  return request.part.outer_objects[0].empty() && request.part.outer_objects[1].empty() &&
         !request.part.between_boxes;
}

}  // namespace

KeptGenerators kept_generators(const Silhouettes& g, const SkeletonRequest& request) {
  KeptGenerators out;
  if (!request.part.region && !request.part.near && !(request.part.feature_size > 0))
    return out;
  const Scene& scene = g.scene();
  const Membership m(g);
  for (std::size_t i = 0; i < g.ridges().size(); ++i) {
    const Point& p = scene.point(g.ridges()[i].points[0]);
    const Point& q = scene.point(g.ridges()[i].points[1]);
    out.ridges.push_back(
        (!request.part.region || m.ridge_in(static_cast<int>(i), *request.part.region)) &&
        (!request.part.near || within(*request.part.near, p, q)) &&
        !(request.part.feature_size > 0 && shorter(p, q, request.part.feature_size)));
  }
  for (std::size_t i = 0; i < g.stars().size(); ++i) {
    const int point = g.stars()[i].point;
    const Point& p = scene.point(point);
    out.stars.push_back((!request.part.region || in_box(*request.part.region, p)) &&
                        (!request.part.near || within(*request.part.near, p, p)) &&
                        !(request.part.feature_size > 0 &&
                          small_corner(scene, point, request.part.feature_size)));
  }
  return out;
}

Simplified simplified_by(const Scene& scene, double feature_size) {
  Simplified out;
  out.feature_size = feature_size;
  if (!(feature_size > 0)) return out;
  for (std::size_t e = 0; e < scene.edges().size(); ++e) {
    const auto& p = scene.edges()[e].points;
    if (shorter(scene.point(p[0]), scene.point(p[1]), feature_size)) {
      out.edges.push_back(static_cast<std::int32_t>(e));
    }
  }
  for (const int p : scene.corners()) {
    if (small_corner(scene, p, feature_size)) out.vertices.push_back(p);
  }
  for (std::size_t o = 0; o < scene.objects().size(); ++o) {
    std::vector<Point> points;
    for (const int f : scene.objects()[o].faces) {
      for (const int p : scene.face_points(f)) points.push_back(scene.point(p));
    }
    if (points.empty()) continue;
    const Box box = box_of(points);
    if (shorter({box.min[0], box.min[1], box.min[2]},
                {box.max[0], box.max[1], box.max[2]}, feature_size)) {
      out.objects.push_back(static_cast<std::int32_t>(o));
    }
  }
  return out;
}

bool any_ends_on(const std::vector<SkeletonLines::EndPiece>& pieces, const Bits& faces) {
  return std::any_of(pieces.begin(), pieces.end(), [&](const auto& piece) {
    return std::any_of(piece.faces.begin(), piece.faces.end(), [&](const auto& end) {
      return std::any_of(end.begin(), end.end(), [&](int f) { return faces[f] != 0; });
    });
  });
}

EvPart ev_part(const Silhouettes& g, const SkeletonRequest& request) {
  EvPart part;
  const KeptGenerators keep = kept_generators(g, request);
  const bool through = Sources::asked(request);
  if (keep.ridges.empty() && request.part.vertex_objects.empty() &&
      request.part.edge_objects.empty() && one_sided(request) && !through) {
    return part;
  }
  const Membership m(g);
  const Sources sources(g, request);
  part.by_lines = through && request.part.through_far_ends;
  // The upper four bits are for pairs of which the edge is on a source, the lower four
  // for those of which the vertex is.
  for (std::size_t i = 0; i < g.ridges().size(); ++i) {
    const int r = static_cast<int>(i);
    std::uint8_t bits = 0;
    if (kept(keep.ridges, i) && m.ridge_on(r, request.part.edge_objects)) {
      bits = ridge_roles(m, r, request).offers();
      if (through && sources.has_ridge(r)) bits |= static_cast<std::uint8_t>(bits << 4);
    }
    part.ridges.push_back(bits);
  }
  for (std::size_t i = 0; i < g.stars().size(); ++i) {
    const int s = static_cast<int>(i);
    std::uint8_t bits = 0;
    if (kept(keep.stars, i) && m.star_on(s, request.part.vertex_objects)) {
      const std::uint8_t wants = star_roles(m, s, request).wants();
      if (!through || part.by_lines || sources.has_star(s)) bits |= wants;
      if (through) bits |= static_cast<std::uint8_t>(wants << 4);
    }
    part.stars.push_back(bits);
  }
  part.below = bits_below(g.ridge_tree(), part.ridges);
  if (part.by_lines) add_source(g, sources, part);
  return part;
}

bool wedge_may_meet(const Point& v, const Point& e0, const Point& e1, const Box& box) {
  const CentredBox b = centred(box);
  const std::array<double, 3> c{b.centre[0] - v[0], b.centre[1] - v[1],
                                b.centre[2] - v[2]};
  const BoundedPlane own = plane_from(v, e0, e1);
  if (own.negative_on(c, b.half) || own.positive_on(c, b.half)) return false;
  // Two planes through v that bound the double wedge; any third point of theirs will do.
  const Point out = v + (e1 - e0).cross(e0 - v).eval();
  const BoundedPlane first = plane_from(v, e0, out);
  const BoundedPlane second = plane_from(v, e1, out);
  return !(first.negative_on(c, b.half) && second.negative_on(c, b.half)) &&
         !(first.positive_on(c, b.half) && second.positive_on(c, b.half));
}

std::vector<int> asked_stars(const Silhouettes& g, const EvPart& part) {
  std::vector<int> stars;
  for (std::size_t i = 0; i < g.stars().size(); ++i) {
    const std::uint8_t wanted = part.wanted(static_cast<int>(i));
    if (part.stars.empty() || (!part.below.empty() && part.has_below(0, wanted))) {
      stars.push_back(static_cast<int>(i));
    }
  }
  return stars;
}

EeePart eee_part(const Silhouettes& g, const SkeletonRequest& request) {
  EeePart part;
  part.kept = kept_generators(g, request).ridges;
  const Membership m(g);
  const std::size_t count = g.ridges().size();
  if (!part.kept.empty() || !one_sided(request)) {
    for (std::size_t i = 0; i < count; ++i) {
      const bool here = kept(part.kept, i);
      const Roles roles = ridge_roles(m, static_cast<int>(i), request);
      part.offers.push_back(here ? roles.offers() : 0);
      part.wants.push_back(here ? roles.wants() : 0);
    }
    part.below = bits_below(g.ridge_tree(), part.offers);
  }
  if (Sources::asked(request)) {
    const Sources sources(g, request);
    std::vector<Point> points;
    for (std::size_t i = 0; i < count; ++i) {
      const bool on = kept(part.kept, i) && sources.has_ridge(static_cast<int>(i));
      part.through.push_back(on);
      if (!on) continue;
      for (const int p : g.ridges()[i].points) points.push_back(g.scene().point(p));
    }
    part.through_below = bits_below(g.ridge_tree(), part.through);
    part.by_lines = request.part.through_far_ends;
    if (part.by_lines) {
      part.source_faces = sources.faces();
      points = corners_of(g.scene(), part.source_faces);
    }
    if (points.empty()) {
      part.offers = part.wants = Bits(count, 0);
      part.below = bits_below(g.ridge_tree(), part.offers);
    } else {
      part.through_box = box_of(points);
    }
  }
  return part;
}

bool EeePart::may_pair(int i, const Box& box, std::uint32_t node,
                       const Box& node_box) const {
  if (!below.empty() && (wants[i] & below[node]) == 0) return false;
  if (goes_through(i) || through_below[node] != 0) return true;
  // A middle edge meets the hull of the two boxes.
  return boxes_meet(united(box, node_box), through_box) || may_reach(box, node_box);
}

// The nearer of the two is met on the way from the farther one to the source.
bool EeePart::may_reach(const Box& a, const Box& b) const {
  return by_lines &&
         (boxes_meet(united(a, through_box), b) || boxes_meet(united(b, through_box), a));
}

FacetPart facet_part(const Silhouettes& g, const SkeletonRequest& request) {
  FacetPart part;
  const Scene& scene = g.scene();
  const bool through = Sources::asked(request);
  const Sources sources(g, request);
  for (const Facet& facet : scene.facets()) {
    const auto every_corner_in = [&](const std::array<Point, 2>& box) {
      return std::all_of(facet.faces.begin(), facet.faces.end(), [&](int f) {
        const auto corners = scene.face_points(f);
        return std::all_of(corners.begin(), corners.end(),
                           [&](int p) { return in_box(box, scene.point(p)); });
      });
    };
    const auto some_side = [&](const auto& has) {
      return std::any_of(facet.faces.begin(), facet.faces.end(), [&](int f) {
        const auto corners = scene.face_points(f);
        for (std::size_t k = 0; k < corners.size(); ++k) {
          const int edge = scene.edge_of_side(f, static_cast<int>(k));
          if (edge < 0) continue;
          const auto& p = scene.edges()[edge].points;
          if (has(scene.point(p[0]), scene.point(p[1]))) return true;
        }
        return false;
      });
    };
    const std::span<const std::int32_t> object(&facet.object, 1);
    const auto on = [&](const std::vector<int>& objects) {
      return objects.empty() || any_of(object, objects);
    };
    const bool here =
        (!request.part.region || every_corner_in(*request.part.region)) &&
        (!request.part.near || some_side([&](const Point& p, const Point& q) {
          return within(*request.part.near, p, q);
        })) &&
        (!(request.part.feature_size > 0) ||
         some_side([&](const Point& p, const Point& q) {
           return !shorter(p, q, request.part.feature_size);
         }));
    Roles roles{};
    for (int k = 0; k < 2; ++k) {
      roles.objects[k] = on(request.part.outer_objects[k]);
      roles.boxes[k] = !request.part.between_boxes ||
                       every_corner_in((*request.part.between_boxes)[k]);
    }
    std::uint8_t offers = here ? roles.offers() : 0;
    std::uint8_t wants = here ? roles.wants() : 0;
    // As for EV: one of the two on a source, in the upper or the lower four bits.
    if (through) {
      if (sources.has_facet(static_cast<int>(part.offers.size()))) {
        offers |= static_cast<std::uint8_t>(offers << 4);
        wants |= static_cast<std::uint8_t>(wants << 4);
      } else {
        wants = static_cast<std::uint8_t>(wants << 4);
      }
    }
    part.offers.push_back(offers);
    part.wants.push_back(wants);
  }
  return part;
}

std::vector<int> asked_ridges(const Silhouettes& g, const EeePart& part) {
  std::vector<int> ridges;
  for (std::size_t i = 0; i < g.ridges().size(); ++i) {
    if (part.offers.empty() || (part.wants[i] & part.below[0]) != 0) {
      ridges.push_back(static_cast<int>(i));
    }
  }
  return ridges;
}

}  // namespace sightline::internal
