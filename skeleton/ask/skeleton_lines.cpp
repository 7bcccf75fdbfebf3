#include "skeleton/skeleton_lines.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "linespace/numbers/exact_position.h"
#include "linespace/sight/line_probe.h"
#include "linespace/sight/plane_crossings.h"
#include "skeleton/ask/far_pieces.h"
#include "skeleton/build/degenerate_pair.h"
#include "skeleton/nodes/irrational_line.h"
#include "skeleton/nodes/node_contacts.h"
#include "skeleton/nodes/node_line.h"

namespace sightline {
namespace {

using internal::along;
using internal::ExactPoint;
using internal::LineScan;
using internal::Rational;
using internal::rounded;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The free segment through positions 0 and 1, which is free itself but for the contacts
// at 0 and at 1 where `ends` says that it ends there.
FreeSegment free_segment(const internal::Silhouettes& g, const LineScan& scan,
                         const std::array<bool, 2>& ends = {}) {
  FreeSegment out{-kInfinity, kInfinity, {}, {}, {}};
  const auto add = [&](int c) {
    out.contacts.push_back({scan.from(c).convert_to<double>(),
                            scan.to(c).convert_to<double>(), false, scan.touches(c)});
  };
  int low = -1;  // first contact from position 0 on
  while (low + 1 < scan.size() && scan.to(low + 1) < 0) ++low;
  // Downwards from the contact at 0.
  std::vector<int> before;
  for (int c = low + 1; c >= 0; --c) {
    if (c >= scan.size() || scan.from(c) > 0) continue;
    const bool through = scan.to(c) >= 0;
    if (through && ends[0]) {
      out.contacts.push_back({0, 0, true, scan.touches(c)});
      out.from = 0;
      out.from_faces = scan.faces_at(c, 0);
      break;
    }
    if (through) {
      const auto t = scan.from(c) < 0 ? blocked_beyond(g, scan, c, 0, -1) : std::nullopt;
      if (t) {
        out.from = t->convert_to<double>();
        out.from_faces = scan.faces_at(c, *t);
        break;
      }
      continue;
    }
    if (const auto t = blocked_beyond(g, scan, c, 0, -1)) {
      out.from = t->convert_to<double>();
      out.from_faces = scan.faces_at(c, *t);
      if (*t < scan.to(c)) before.push_back(c);  // along a wall to the foot of another
      break;
    }
    before.push_back(c);
  }
  for (auto c = before.rbegin(); c != before.rend(); ++c) add(*c);
  for (int c = low + 1; c < scan.size(); ++c) {
    if (ends[0] && scan.from(c) <= 0 && scan.to(c) <= 0) continue;
    if (ends[1] && scan.from(c) <= 1 && scan.to(c) >= 1) {
      out.contacts.push_back({1, 1, true, scan.touches(c)});
      out.to = 1;
      out.to_faces = scan.faces_at(c, 1);
      break;
    }
    if (scan.from(c) <= 1) {
      add(c);
      const auto t = scan.to(c) > 1 ? blocked_beyond(g, scan, c, 1, 1) : std::nullopt;
      if (t) {
        out.to = t->convert_to<double>();
        out.to_faces = scan.faces_at(c, *t);
        break;
      }
      continue;
    }
    if (const auto t = blocked_beyond(g, scan, c, 1, 1)) {
      out.to = t->convert_to<double>();
      out.to_faces = scan.faces_at(c, *t);
      if (scan.from(c) < *t) add(c);
      break;
    }
    add(c);
  }
  return out;
}

}  // namespace

struct SkeletonLines::Impl {
  // Arcs of polygon mode may have reflex edges, which generate nothing in solid mode.
  Impl(const Scene& s, const Request& request)
      : scene(s),
        silhouettes(s, EventMode::Polygon, request),
        carriers(silhouettes),
        crossings(silhouettes),
        far(silhouettes, carriers, crossings) {}

  [[nodiscard]] FreeSegment line(const ExactPoint& a, const ExactPoint& b,
                                 const std::array<bool, 2>& ends) const {
    const auto faces = faces_near_line(silhouettes, rounded(a), rounded(b));
    return free_segment(silhouettes, LineScan(scene, faces, a, b), ends);
  }
  [[nodiscard]] ExactPoint point(int id) const {
    return internal::exact_point(scene.point(id));
  }
  // Where the plane crosses the edge's line; nullopt when they are parallel.
  [[nodiscard]] std::optional<ExactPoint> crossing(int edge, const ExactPoint& a,
                                                   const ExactPoint& b,
                                                   const ExactPoint& c) const {
    const ExactPoint e0 = point(scene.edges()[edge].points[0]);
    const ExactPoint e1 = point(scene.edges()[edge].points[1]);
    const Rational x = internal::exact_orient(a, b, c, e0);
    const Rational y = internal::exact_orient(a, b, c, e1);
    if (x == y) return std::nullopt;
    return along(e0, e1, x / (x - y));
  }

  // Positions 0 and 1 of an arc's line.
  [[nodiscard]] std::optional<std::array<ExactPoint, 2>> points(const SkeletonArc& arc,
                                                                double s) const {
    if (arc.is_ev()) {
      return std::array<ExactPoint, 2>{point(arc.vertex()), on_edge(arc.edge(), s)};
    }
    // On the last edge: where the plane of the point on the first one and of the middle
    // edge crosses it.
    const auto& [first, second, last] = arc.edges();
    const ExactPoint p = on_edge(first, s);
    const auto& middle = scene.edges()[second].points;
    const auto q = crossing(last, p, point(middle[0]), point(middle[1]));
    if (!q) return std::nullopt;
    return std::array<ExactPoint, 2>{p, *q};
  }
  [[nodiscard]] ExactPoint on_edge(int edge, double s) const {
    const auto& ends = scene.edges()[edge].points;
    return along(point(ends[0]), point(ends[1]), Rational(s));
  }

  // The rational line of a node through two points, from its first contact on.
  [[nodiscard]] std::optional<FreeSegment> node_line(const std::array<ExactPoint, 2>& at,
                                                     const SkeletonNode& node) const {
    const auto& [a, b] = at;
    const auto faces = faces_near_line(silhouettes, node.segment[0], node.segment[1]);
    const auto outer = outer_positions(LineScan(scene, faces, a, b), at, node);
    if (outer[0] == outer[1]) return std::nullopt;
    const LineScan scan(scene, faces, along(a, b, outer[0]), along(a, b, outer[1]));
    std::array<bool, 2> ends = node.ends;
    const bool told = ends[0] || ends[1];
    if (node.end && (!told || node.kind == NodeKind::Degenerate)) {
      const auto blocked = blocked_ends(silhouettes, scan);
      if (!blocked) return std::nullopt;
      ends = *blocked;
    }
    return free_segment(silhouettes, scan, ends);
  }

  // The node's outermost contacts are rounded: of all positions at which a face begins or
  // ends, the nearest.
  [[nodiscard]] static std::array<Rational, 2> outer_positions(
      const LineScan& scan, const std::array<ExactPoint, 2>& at,
      const SkeletonNode& node) {
    std::array<Rational, 2> out;
    for (int k = 0; k < 2; ++k) {
      const ExactPoint near = internal::exact_point(node.segment[k]);
      Rational over = 0;
      Rational under = 0;
      for (int i = 0; i < 3; ++i) {
        const Rational way = at[1][i] - at[0][i];
        over += (near[i] - at[0][i]) * way;
        under += way * way;
      }
      const Rational position = over / under;
      std::optional<Rational> least;
      for (int c = 0; c < scan.size(); ++c) {
        for (const Rational& t : scan.instants(c)) {
          const Rational off = abs(t - position);
          if (least && off >= *least) continue;
          least = off;
          out[k] = t;
        }
      }
    }
    return out;
  }

  // Where lines of an EV arc meet two faces in one point at which these cross, or pass an
  // end of a crossing in their plane.
  template <class InWedge>
  void add_crossings(const InWedge& in_wedge, const SkeletonArc& arc, int off_plane,
                     std::deque<Rational>& positions,
                     std::vector<internal::Cut>& cuts) const {
    if (crossings.empty() || off_plane < 0) return;
    const ExactPoint v = point(arc.vertex());
    const ExactPoint e0 = point(scene.edges()[arc.edge()].points[0]);
    const ExactPoint e1 = point(scene.edges()[arc.edge()].points[1]);
    const ExactPoint off = point(off_plane);
    const std::size_t known = cuts.size();
    const auto add_towards = [&](const ExactPoint& at) {
      auto s = internal::parameter_towards(v, at, off, e0, e1);
      if (!s) return;
      positions.push_back(std::move(*s));
      cuts.push_back(internal::exact_cut(positions.back()));
    };
    crossings.tree().traverse(in_wedge, [&](std::uint32_t item) {
      const auto& [a, b] = crossings.at(item).segment;
      const Rational x = internal::exact_orient(v, e0, e1, a);
      const Rational y = internal::exact_orient(v, e0, e1, b);
      if (x.sign() * y.sign() < 0) add_towards(along(a, b, x / (x - y)));
      if (x == 0) add_towards(a);
      if (y == 0) add_towards(b);
    });
    if (cuts.size() == known) return;
    std::ranges::sort(cuts, {}, [](const internal::Cut& c) { return c.parameter(); });
  }

  const Scene& scene;
  internal::Silhouettes silhouettes;
  internal::Carriers carriers;
  internal::FaceCrossings crossings;
  internal::FarPieces far;
};

SkeletonLines::SkeletonLines(const Scene& scene, const Request& request)
    : impl_(std::make_unique<Impl>(scene, request)) {}
SkeletonLines::~SkeletonLines() = default;
SkeletonLines::SkeletonLines(SkeletonLines&&) noexcept = default;

std::optional<FreeSegment> SkeletonLines::line(const SkeletonArc& arc, double s) const {
  const auto at = impl_->points(arc, s);
  if (!at) return std::nullopt;
  return impl_->line((*at)[0], (*at)[1], arc.ends);
}

namespace {

std::array<ExactPosition, 2> positions(const std::array<ExactPoint, 2>& points) {
  return {internal::exact_position(points[0]), internal::exact_position(points[1])};
}

}  // namespace

std::optional<std::array<ExactPosition, 2>> SkeletonLines::points(const SkeletonArc& arc,
                                                                  double s) const {
  const auto at = impl_->points(arc, s);
  if (!at) return std::nullopt;
  return positions(*at);
}

std::optional<std::array<ExactPosition, 2>> SkeletonLines::points(
    const Skeleton& skeleton, const SkeletonNode& node) const {
  const auto found = internal::line_of_node(impl_->scene, skeleton, node);
  if (!found || found->irrational) return std::nullopt;
  return positions(found->points);
}

std::vector<SkeletonLines::Piece> SkeletonLines::pieces(const SkeletonArc& arc) const {
  return arc.is_ev() ? ev_pieces(arc) : eee_pieces(arc);
}

std::vector<SkeletonLines::Piece> SkeletonLines::ev_pieces(const SkeletonArc& arc) const {
  const Scene& scene = impl_->scene;
  const auto& g = impl_->silhouettes;
  const Edge& edge = scene.edges()[arc.edge()];
  const Point& v = scene.point(arc.vertex());
  const Point& e0 = scene.point(edge.points[0]);
  const Point& e1 = scene.point(edge.points[1]);
  const PlaneSide plane({v, e0, e1});
  const auto point_at = [&](double s) { return Point(e0 + s * (e1 - e0)); };
  // Everything between the two end lines, ahead and behind: faces on both sides of, or
  // in, the plane whose boxes are not wholly outside the double wedge.
  const internal::BoundedPlane first =
      internal::plane_from(v, point_at(arc.range[0]), v + (e1 - e0).cross(e0 - v).eval());
  const internal::BoundedPlane second =
      internal::plane_from(v, point_at(arc.range[1]), v + (e1 - e0).cross(e0 - v).eval());
  const auto in_wedge = [&](const internal::Box& box) {
    const auto b = internal::centred(box);
    const std::array<double, 3> c{b.centre[0] - v[0], b.centre[1] - v[1],
                                  b.centre[2] - v[2]};
    const bool left = first.negative_on(c, b.half) && second.negative_on(c, b.half);
    const bool right = first.positive_on(c, b.half) && second.positive_on(c, b.half);
    return !left && !right;
  };
  std::vector<int> faces;
  g.face_tree().traverse(in_wedge, [&](std::uint32_t item) {
    const int f = static_cast<int>(item);
    bool front = false;
    bool back = false;
    for (const int p : scene.face_points(f)) {
      const Sign s = plane(scene.point(p));
      front |= s != Sign::Negative;
      back |= s != Sign::Positive;
    }
    if (front && back) faces.push_back(f);
  });
  std::sort(faces.begin(), faces.end());
  std::deque<Rational> positions;
  auto cuts = critical_cuts(g, g.stars()[g.star_of_point(arc.vertex())], e0, e1, plane,
                            faces, positions);
  impl_->add_crossings(in_wedge, arc, internal::corner_off(scene, faces, plane),
                       positions, cuts);
  // Rounded positions are within 8 units of the last place of 1 of the exact ones (see
  // make_cut): two that are closer than twice that may be one.
  constexpr double kSame = 16 * std::numeric_limits<double>::epsilon();
  std::vector<double> stops{arc.range[0]};
  for (const auto& cut : cuts) {
    const double s = cut.parameter();
    if (s > stops.back() + kSame && s < arc.range[1] - kSame) stops.push_back(s);
  }
  stops.push_back(arc.range[1]);
  const ExactPoint eye = internal::exact_point(v);
  const ExactPoint x0 = internal::exact_point(e0);
  const ExactPoint x1 = internal::exact_point(e1);
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const double middle = stops[i] + 0.5 * (stops[i + 1] - stops[i]);
    if (!(middle > stops[i] && middle < stops[i + 1])) continue;
    Piece piece{
        {stops[i], stops[i + 1]},
        free_segment(g, LineScan(scene, faces, eye, along(x0, x1, Rational(middle))),
                     arc.ends)};
    if (!pieces.empty() && pieces.back().line.from_faces == piece.line.from_faces &&
        pieces.back().line.to_faces == piece.line.to_faces) {
      pieces.back().range[1] = stops[i + 1];
      continue;
    }
    pieces.push_back(std::move(piece));
  }
  if (!pieces.empty()) pieces.back().range[1] = arc.range[1];
  return pieces;
}

namespace {

// Pieces judged line by line: joins them where both far ends are the same.
void append(std::vector<SkeletonLines::Piece>& pieces, SkeletonLines::Piece piece) {
  if (!pieces.empty() && pieces.back().line.from_faces == piece.line.from_faces &&
      pieces.back().line.to_faces == piece.line.to_faces) {
    pieces.back().range[1] = piece.range[1];
    return;
  }
  pieces.push_back(std::move(piece));
}

std::vector<SkeletonLines::EndPiece> ends_of(
    const std::vector<internal::FarPiece>& found,
    const std::array<std::vector<int>, 2>& at_contacts) {
  std::vector<SkeletonLines::EndPiece> out;
  for (const auto& piece : found) {
    SkeletonLines::EndPiece& end = out.emplace_back();
    end.range = piece.range;
    end.bounds_all = piece.bounds_all;
    end.faces = at_contacts;
    for (int i = 0; i < 2; ++i) {
      if (piece.faces[i] >= 0) end.faces[i].push_back(piece.faces[i]);
    }
  }
  return out;
}

std::vector<SkeletonLines::EndPiece> ends_of(
    const std::vector<SkeletonLines::Piece>& pieces) {
  std::vector<SkeletonLines::EndPiece> out;
  for (const auto& piece : pieces) {
    out.push_back({piece.range, {piece.line.from_faces, piece.line.to_faces}});
  }
  return out;
}

}  // namespace

std::vector<SkeletonLines::Piece> SkeletonLines::eee_pieces(
    const SkeletonArc& arc) const {
  std::vector<double> stops;
  if (const auto found = impl_->far.of(arc)) {
    for (const auto& piece : *found) stops.push_back(piece.range[0]);
    stops.push_back(arc.range[1]);
  } else {
    stops = impl_->far.stops(arc);
  }
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const double middle = stops[i] + 0.5 * (stops[i + 1] - stops[i]);
    if (!(middle > stops[i] && middle < stops[i + 1])) continue;
    auto free = line(arc, middle);
    if (free) append(pieces, {{stops[i], stops[i + 1]}, std::move(*free)});
  }
  return pieces;
}

std::vector<SkeletonLines::EndPiece> SkeletonLines::ends(const SkeletonArc& arc) const {
  const auto found = impl_->far.of(arc);
  return found ? ends_of(*found, impl_->far.end_faces(arc)) : ends_of(pieces(arc));
}

std::optional<FreeSegment> SkeletonLines::line(const Skeleton& skeleton,
                                               const SkeletonNode& node) const {
  const auto found = internal::line_of_node(impl_->scene, skeleton, node);
  if (!found) return std::nullopt;
  if (found->irrational) {
    const auto generators = skeleton.generators(node);
    return free_segment(impl_->silhouettes, *found->irrational,
                        {generators.front().id, generators.back().id});
  }
  return impl_->node_line(found->points, node);
}

}  // namespace sightline
