#include "skeleton/view_events.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>

#include "linespace/lines/transversals.h"
#include "linespace/sight/line_probe.h"
#include "linespace/swaths/edge_cuts.h"
#include "linespace/swaths/edge_on_view.h"
#include "linespace/swaths/eee_curve.h"
#include "linespace/transversals.h"
#include "skeleton/ask/arc_index.h"
#include "skeleton/ask/far_pieces.h"
#include "skeleton/build/edge_pair.h"
#include "skeleton/nodes/node_contacts.h"
#include "skeleton/nodes/node_line.h"

namespace sightline {
namespace {

using internal::along;
using internal::exact_cross;
using internal::exact_difference;
using internal::exact_orient;
using internal::exact_point;
using internal::ExactPoint;
using internal::free_between;
using internal::LineScan;
using internal::Rational;
using internal::Ring;
using internal::rounded;
using internal::Surd;

// Whether something is so, or has to be asked exactly.
enum class Answer : std::uint8_t { No, Yes, Unknown };

// Sign of the plane at the point where the line meets m: m.from + w (m.to - m.from) with
// w as that of exact_line.cpp.  Requires that they meet and are not parallel.
Sign plane_sign_at(const ExactLine& line, const LineThrough& m,
                   const PlaneThrough& plane) {
  const auto& c = line.coordinates();
  const auto dir = internal::ring_difference(m.to, m.from);
  const auto from = internal::ring_point(m.from);
  const Ring a0 = internal::ring_orient3d(plane.a, plane.b, plane.c, m.from);
  const Ring a1 = internal::ring_orient3d(plane.a, plane.b, plane.c, m.to);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const Surd den = c.d[k] * dir[j] - c.d[j] * dir[k];
    const Sign sign_den = sign_of(den, c.radicand);
    if (sign_den == Sign::Zero) continue;
    const Surd num = c.m[i] - (c.d[k] * from[j] - c.d[j] * from[k]);
    return sign_of(den * a0 + num * Ring(a1 - a0), c.radicand) * sign_den;
  }
  return Sign::Zero;
}

struct Enclosure {
  double lo, hi;
};

// The parameter on the edge of a point of it known to within `error` of each coordinate's
// magnitude.
Enclosure parameter_of(const LineThrough& edge, const RoundedPoint& at) {
  const Point d = edge.to - edge.from;
  const double s = (at.point - edge.from).dot(d) / d.squaredNorm();
  // The point is off by `error` of its size in each coordinate; the differences and the
  // quotient round by less than 16 units of the last place of the sizes involved.
  const double size = at.point.cwiseAbs().maxCoeff() + edge.from.cwiseAbs().maxCoeff() +
                      edge.to.cwiseAbs().maxCoeff();
  const double error = 4 * (at.error + 16 * internal::kUnit) * size / d.norm() +
                       32 * internal::kUnit * std::abs(s);
  return {s - error, s + error};
}

Answer inside(const Enclosure& s, const std::array<double, 2>& range) {
  if (s.lo > range[0] + kRangeError && s.hi < range[1] - kRangeError) return Answer::Yes;
  if (s.hi < range[0] - kRangeError || s.lo > range[1] + kRangeError) return Answer::No;
  return Answer::Unknown;
}

struct Found {
  ViewEvent event;
  Enclosure u;
  // What decides the order exactly: a plane that crosses the path, or a line.
  PlaneThrough plane;
  std::optional<ExactLine> line;
};

}  // namespace

struct ViewEvents::Impl {
  Impl(const Scene& s, const Skeleton& k, const EndIndex& e, const Request& request)
      : scene(s),
        skeleton(k),
        ends(e),
        silhouettes(s, k.events, request),
        carriers(silhouettes) {}

  struct Path {
    Point a, b;
    [[nodiscard]] LineThrough line() const { return {a, b}; }
    [[nodiscard]] Point at(double u) const { return a + u * (b - a); }
  };

  [[nodiscard]] std::array<Point, 2> edge(int id) const {
    const auto& p = scene.edges()[id].points;
    return {scene.point(p[0]), scene.point(p[1])};
  }
  [[nodiscard]] PlaneThrough facet_plane(int facet) const {
    return internal::face_plane_through(scene, scene.facets()[facet].faces.front());
  }

  // The facet that ends the arc's line at s on one side; nullopt where that is not
  // certain.
  [[nodiscard]] std::optional<std::int32_t> end_facet(std::uint32_t arc,
                                                      const Enclosure& s,
                                                      int side) const {
    const auto pieces = ends.pieces(arc);
    if (pieces.empty()) return std::nullopt;
    std::size_t k = 0;
    while (k + 1 < pieces.size() && pieces[k + 1].from < s.lo) ++k;
    const bool near_start = k > 0 && s.lo - pieces[k].from < internal::kShortestPiece;
    const bool near_end =
        k + 1 < pieces.size() && pieces[k + 1].from - s.hi < internal::kShortestPiece;
    if (near_start || near_end) return std::nullopt;
    const std::int32_t facet = pieces[k].facets[side];
    if (facet != kOutside && !scene.facets()[facet].planar) return std::nullopt;
    return facet;
  }

  // Whether a viewpoint whose path has these signs at its ends is on the side `near` of
  // the plane, or on it; `at_viewpoint` is asked where the ends differ.
  template <class SignAt>
  static Answer before(Sign near, Sign at_a, Sign at_b, SignAt&& at_viewpoint) {
    if (near == Sign::Zero) return Answer::Unknown;
    if (at_a == at_b && at_a != Sign::Zero) {
      return at_a == near ? Answer::Yes : Answer::No;
    }
    return at_viewpoint() == -near ? Answer::No : Answer::Yes;
  }

  // ---- EV -----------------------------------------------------------------------------

  void cross_ev(const Path& path, std::uint32_t id, std::vector<Found>& out) const {
    const SkeletonArc& arc = skeleton.arcs[id];
    const Point& v = scene.point(arc.vertex());
    const auto& ids = scene.edges()[arc.edge()].points;
    const Point& e0 = scene.point(ids[0]);
    const Point& e1 = scene.point(ids[1]);
    const auto& [a, b] = path;
    const Sign at_a = orient3d(v, e0, e1, a);
    if (at_a == Sign::Zero || orient3d(v, e0, e1, b) != -at_a) return;
    const Sign at_0 = orient3d(v, a, b, e0);
    if (at_0 == Sign::Zero || orient3d(v, a, b, e1) != -at_0) return;
    // With 0 < u, s < 1: the plane of the edge and a has x on b's side; the plane of v, a
    // and e0 has x on b's side and e(s) on e1's.
    const auto apart = [](Sign x, Sign y) { return x != Sign::Zero && x == -y; };
    int side;
    if (apart(orient3d(e0, e1, a, b), orient3d(e0, e1, a, v))) {
      side = 1;
    } else if (apart(orient3d(v, a, e0, b), orient3d(v, a, e0, e1))) {
      side = 0;
    } else {
      return;
    }
    if (arc.ends[side]) return;  // the line ends before it comes to the viewpoint
    const internal::Cut s =
        internal::make_cut(internal::CutKind::Side, -1, {}, orient3d_value(v, a, b, e0),
                           orient3d_value(v, a, b, e1));
    const Enclosure at{s.lo, s.hi};
    Answer answer = inside(at, arc.range);
    if (answer == Answer::No) return;
    const PlaneThrough plane{v, e0, e1};
    if (answer == Answer::Yes) answer = reaches(path, id, plane, at, side);
    if (answer == Answer::Unknown) answer = reaches_exactly(path, arc, side);
    if (answer == Answer::No) return;
    const internal::Cut u =
        internal::make_cut(internal::CutKind::Side, -1, {}, orient3d_value(v, e0, e1, a),
                           orient3d_value(v, e0, e1, b));
    out.push_back({{EventKind::EV, id, static_cast<std::uint8_t>(side), false,
                    u.parameter(), path.at(u.parameter())},
                   {u.lo, u.hi},
                   plane,
                   std::nullopt});
  }

  [[nodiscard]] Answer reaches(const Path& path, std::uint32_t id,
                               const PlaneThrough& plane, const Enclosure& s,
                               int side) const {
    const auto facet = end_facet(id, s, side);
    if (!facet) return Answer::Unknown;
    if (*facet == kOutside) return Answer::Yes;
    const PlaneThrough end = facet_plane(*facet);
    const PlaneSide wall(end);
    const Sign at_a = wall(path.a);
    const Sign at_b = wall(path.b);
    return before(wall(plane.a), at_a, at_b, [&] {
      const Sign order = compare_crossings(path.line(), plane, end);
      return order == Sign::Zero ? Sign::Zero : order == Sign::Negative ? at_a : at_b;
    });
  }

  [[nodiscard]] Answer reaches_exactly(const Path& path, const SkeletonArc& arc,
                                       int side) const {
    const auto e = edge(arc.edge());
    const ExactPoint v = exact_point(scene.point(arc.vertex()));
    const ExactPoint e0 = exact_point(e[0]);
    const ExactPoint e1 = exact_point(e[1]);
    const ExactPoint a = exact_point(path.a);
    const ExactPoint b = exact_point(path.b);
    const auto root = [](const Rational& x, const Rational& y) {
      return Rational(x / (x - y));
    };
    const Rational s = root(exact_orient(v, a, b, e0), exact_orient(v, a, b, e1));
    const double rounded_s = s.convert_to<double>();
    if (inside({rounded_s, rounded_s}, arc.range) == Answer::No) return Answer::No;
    const ExactPoint x =
        along(a, b, root(exact_orient(v, e0, e1, a), exact_orient(v, e0, e1, b)));
    // As SkeletonLines has it: between the contacts, and from the nearer one on.
    const ExactPoint contact = along(e0, e1, s);
    const auto scan = [&](const ExactPoint& p, const ExactPoint& q) {
      return LineScan(scene, faces_near_line(silhouettes, rounded(p), rounded(q)), p, q);
    };
    const LineScan between = scan(v, contact);
    const bool as_arc = arc.ends == std::array<bool, 2>{}
                            ? is_free(silhouettes, between)
                            : blocked_ends(silhouettes, between) == arc.ends;
    const bool free =
        as_arc && free_between(silhouettes, scan(side == 1 ? contact : v, x));
    return free ? Answer::Yes : Answer::No;
  }

  // ---- EEE ----------------------------------------------------------------------------

  struct Triple {
    std::array<LineThrough, 3> lines;
    std::array<const internal::Ridge*, 3> ridges;
    std::array<bool, 3> ends;  // that is an end contact
  };

  void cross_eee(const Path& path, std::uint32_t id, std::vector<Found>& out) const {
    const SkeletonArc& arc = skeleton.arcs[id];
    const auto& first = scene.edges()[arc.edges()[0]].points;
    const auto& last = scene.edges()[arc.edges()[2]].points;
    const internal::OuterPair pair{&scene, {first[0], first[1]}, {last[0], last[1]}};
    const internal::BoundedForm by_path = form_of(pair, path);
    if (one_sign(by_path)) return;
    const int middle = carriers.of_ridge[silhouettes.ridge_of_edge(arc.edges()[1])];
    const internal::EeeCurve curve(pair, carriers.all, middle,
                                   pair.form(carriers.all[middle]));
    internal::CurveCut all;
    all.lo = std::max(0.0, arc.range[0] - 2 * kRangeError);
    all.hi = std::min(1.0, arc.range[1] + 2 * kRangeError);
    if (curve.misses(all, by_path)) return;
    Triple triple{{}, {}, {arc.ends[0], false, arc.ends[1]}};
    for (int i = 0; i < 3; ++i) {
      const auto e = edge(arc.edges()[i]);
      triple.lines[i] = {e[0], e[1]};
      triple.ridges[i] = &silhouettes.ridges()[silhouettes.ridge_of_edge(arc.edges()[i])];
    }
    const auto found =
        transversals(triple.lines[0], triple.lines[1], triple.lines[2], path.line());
    for (const ExactLine& line : found.lines) cross_line(path, id, triple, line, out);
  }

  [[nodiscard]] static internal::BoundedForm form_of(const internal::OuterPair& pair,
                                                     const Path& path) {
    internal::BoundedForm out{};
    for (int i = 0; i < 2; ++i) {
      const PlaneSide plane({pair.at(pair.p[i]), path.a, path.b});
      for (int j = 0; j < 2; ++j) {
        const BoundedValue v = plane.value(pair.at(pair.q[j]));
        out.f[i][j] = v.value;
        out.zero[i][j] = v.error == 0;
        out.error = std::max(out.error, v.error);
        out.largest = std::max(out.largest, std::abs(v.value));
      }
    }
    return out;
  }
  [[nodiscard]] static bool one_sign(const internal::BoundedForm& f) {
    const double low =
        std::min(std::min(f.f[0][0], f.f[0][1]), std::min(f.f[1][0], f.f[1][1]));
    const double high =
        std::max(std::max(f.f[0][0], f.f[0][1]), std::max(f.f[1][0], f.f[1][1]));
    return low > f.error || high < -f.error;
  }

  void cross_line(const Path& path, std::uint32_t id, const Triple& triple,
                  const ExactLine& line, std::vector<Found>& out) const {
    const SkeletonArc& arc = skeleton.arcs[id];
    const LineThrough way = path.line();
    if (line.meets(way) != SegmentContact::Interior) return;
    for (const LineThrough& e : triple.lines) {
      if (line.meets(e) != SegmentContact::Interior) return;
    }
    const auto& [p, m, q] = triple.lines;
    const Sign forward = line.contact_order(p, m);
    if (forward == Sign::Zero || line.contact_order(m, q) != forward) return;
    int side;
    if (line.contact_order(q, way) == forward) {
      side = 1;
    } else if (line.contact_order(way, p) == forward) {
      side = 0;
    } else {
      return;
    }
    if (arc.ends[side]) return;  // the line ends before it comes to the viewpoint
    const Enclosure s = parameter_of(p, line.contact(p));
    Answer answer = inside(s, arc.range);
    if (answer == Answer::No) return;
    if (answer == Answer::Yes) answer = reaches(path, id, triple, line, s, side);
    if (answer == Answer::Unknown) answer = reaches_exactly(path, triple, line, side);
    if (answer == Answer::No) return;
    const RoundedPoint x = line.contact(way);
    const Enclosure u = parameter_of(way, x);
    out.push_back({{EventKind::EEE, id, static_cast<std::uint8_t>(side), false,
                    0.5 * (u.lo + u.hi), x.point},
                   u,
                   {},
                   line});
  }

  [[nodiscard]] Answer reaches(const Path& path, std::uint32_t id, const Triple& triple,
                               const ExactLine& line, const Enclosure& s,
                               int side) const {
    const auto facet = end_facet(id, s, side);
    if (!facet) return Answer::Unknown;
    if (*facet == kOutside) return Answer::Yes;
    const PlaneThrough end = facet_plane(*facet);
    const PlaneSide wall(end);
    return before(plane_sign_at(line, triple.lines[0], end), wall(path.a), wall(path.b),
                  [&] { return plane_sign_at(line, path.line(), end); });
  }

  // A rational line may lie in faces and meet corners: the contacts of its parts say, as
  // for EV.
  [[nodiscard]] Answer reaches_by_contacts(const Path& path, const Triple& triple,
                                           const ExactLine& line, int side) const {
    const std::array<ExactPoint, 2> at = internal::points_of(line);
    const ExactPoint way = exact_difference(at[1], at[0]);
    const auto point_on = [&](const LineThrough& m) {
      const ExactPoint from = exact_point(m.from);
      const ExactPoint along_m = exact_difference(exact_point(m.to), from);
      const ExactPoint turn = exact_cross(way, along_m);
      const ExactPoint off = exact_cross(exact_difference(from, at[0]), along_m);
      int k = 0;
      while (turn[k] == 0) ++k;  // not parallel
      return along(at[0], at[1], off[k] / turn[k]);
    };
    const auto scan = [&](const ExactPoint& p, const ExactPoint& q) {
      return LineScan(scene, faces_near_line(silhouettes, rounded(p), rounded(q)), p, q);
    };
    const ExactPoint first = point_on(triple.lines[0]);
    const ExactPoint last = point_on(triple.lines[2]);
    const LineScan between = scan(first, last);
    const std::array<bool, 2> outer{triple.ends[0], triple.ends[2]};
    const bool as_arc = outer == std::array<bool, 2>{}
                            ? is_free(silhouettes, between)
                            : blocked_ends(silhouettes, between) == outer;
    const ExactPoint x = point_on(path.line());
    const bool free =
        as_arc && free_between(silhouettes, scan(side == 1 ? last : first, x));
    return free ? Answer::Yes : Answer::No;
  }

  // The line grazes or ends at the three edges as those of the arc do, and crosses no
  // face's inside on its way.
  [[nodiscard]] Answer reaches_exactly(const Path& path, const Triple& triple,
                                       const ExactLine& line, int side) const {
    if (line.is_rational()) return reaches_by_contacts(path, triple, line, side);
    for (int i = 0; i < 3; ++i) {
      const internal::Ridge* r = triple.ridges[i];
      // Of an edge with a ridge for each of its gaps the right one is not known here.
      if (triple.ends[i] && scene.edges()[r->edge].sides.size() > 2) continue;
      const auto plane = [&](int k) {
        return PlaneThrough{scene.point(r->points[1 - k]), scene.point(r->points[k]),
                            scene.point(r->thirds[k])};
      };
      const Sign heading = line.heads(plane(0));
      const bool through = heading != Sign::Zero && heading == line.heads(plane(1));
      if (through != triple.ends[i]) return Answer::No;
    }
    const LineThrough& far = triple.lines[side == 1 ? 0 : 2];
    const auto faces = faces_near_line(silhouettes, line.contact(far).point,
                                       line.contact(path.line()).point);
    for (const int f : faces) {
      const PlaneThrough plane = internal::face_plane_through(scene, f);
      if (!passes_inside(line, f)) continue;
      const Sign at_contact = plane_sign_at(line, far, plane);
      const Sign at_viewpoint = plane_sign_at(line, path.line(), plane);
      if (at_contact != Sign::Zero && at_contact == -at_viewpoint) return Answer::No;
    }
    return Answer::Yes;
  }

  [[nodiscard]] bool passes_inside(const ExactLine& line, int face) const {
    const auto corners = scene.face_points(face);
    Sign all = Sign::Zero;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Sign s = line.side(
          {scene.point(corners[k]), scene.point(corners[(k + 1) % corners.size()])});
      if (s == Sign::Zero || s == -all) return false;
      all = s;
    }
    return true;
  }

  // ---- F ------------------------------------------------------------------------------

  void cross_facets(const Path& path, std::vector<Found>& out) const {
    const std::vector<std::uint8_t> pierced = pierced_facets(path);
    for (std::size_t i = 0; i < scene.facets().size(); ++i) {
      if (pierced[i] != 0) continue;
      const PlaneSide& side = silhouettes.face_plane(scene.facets()[i].faces.front());
      const Sign at_a = side(path.a);
      if (at_a == Sign::Zero || side(path.b) != -at_a) continue;
      const PlaneThrough plane = facet_plane(static_cast<int>(i));
      if (!internal::sees_edge_on(silhouettes, static_cast<int>(i), plane, path.a,
                                  path.b)) {
        continue;
      }
      const internal::Cut u = internal::make_cut(internal::CutKind::Side, -1, {},
                                                 side.value(path.a), side.value(path.b));
      out.push_back({{EventKind::F, static_cast<std::uint32_t>(i), 0, false,
                      u.parameter(), path.at(u.parameter())},
                     {u.lo, u.hi},
                     plane,
                     std::nullopt});
    }
  }

  // Those that the path itself meets.
  [[nodiscard]] std::vector<std::uint8_t> pierced_facets(const Path& path) const {
    std::vector<std::uint8_t> out(scene.facets().size(), 0);
    const LineScan scan(scene, faces_near_line(silhouettes, path.a, path.b), path.a,
                        path.b);
    for (int c = 0; c < scan.size(); ++c) {
      if (scan.to(c) < 0 || scan.from(c) > 1) continue;
      for (const Touch& touch : scan.touches(c)) {
        if (touch.kind != TouchKind::EdgeOn) out[scene.faces()[touch.face].facet] = 1;
      }
    }
    return out;
  }

  // ---- Order --------------------------------------------------------------------------

  [[nodiscard]] static Sign compare(const Path& path, const Found& x, const Found& y) {
    if (x.u.hi < y.u.lo) return Sign::Negative;
    if (x.u.lo > y.u.hi) return Sign::Positive;
    if (x.line && y.line) return compare_along(path.line(), *x.line, *y.line);
    if (!x.line && !y.line) return compare_crossings(path.line(), x.plane, y.plane);
    if (!x.line) return -compare(path, y, x);
    // Whether the line meets the path before the plane does.
    return plane_sign_at(*x.line, path.line(), y.plane) * PlaneSide(y.plane)(path.b);
  }

  // ---- All of a path ------------------------------------------------------------------

  [[nodiscard]] static Path path_between(const Point& a, const Point& b) {
    for (const Point& p : {a, b}) {
      if (!std::all_of(p.begin(), p.end(), is_admissible)) {
        throw InvalidInput("a viewpoint's coordinate is not usable");
      }
    }
    if (a == b) throw InvalidInput("the path's two ends are the same point");
    return {a, b};
  }

  [[nodiscard]] const internal::ArcIndex& arc_index() const {
    std::call_once(index_once, [&] { index.emplace(scene, skeleton, ends); });
    return *index;
  }

  void cross_arcs(const Path& path, std::span<const std::uint32_t> arcs,
                  std::vector<Found>& out) const {
    for (const std::uint32_t arc : arcs) {
      if (skeleton.arcs[arc].is_ev()) {
        cross_ev(path, arc, out);
      } else {
        cross_eee(path, arc, out);
      }
    }
  }

  [[nodiscard]] static std::vector<ViewEvent> in_order(const Path& path,
                                                       std::vector<Found> found) {
    std::sort(found.begin(), found.end(), [&](const Found& x, const Found& y) {
      const Sign order = compare(path, x, y);
      if (order != Sign::Zero) return order == Sign::Negative;
      return std::pair(x.event.kind, x.event.id) < std::pair(y.event.kind, y.event.id);
    });
    std::vector<ViewEvent> events;
    for (std::size_t i = 0; i < found.size(); ++i) {
      events.push_back(found[i].event);
      events.back().tie = i > 0 && compare(path, found[i - 1], found[i]) == Sign::Zero;
    }
    return events;
  }

  const Scene& scene;
  const Skeleton& skeleton;
  const EndIndex& ends;
  internal::Silhouettes silhouettes;
  internal::Carriers carriers;
  mutable std::once_flag index_once;
  mutable std::optional<internal::ArcIndex> index;
};

ViewEvents::ViewEvents(const Scene& scene, const Skeleton& skeleton, const EndIndex& ends,
                       const Request& request)
    : impl_(std::make_unique<Impl>(scene, skeleton, ends, request)) {}
ViewEvents::~ViewEvents() = default;
ViewEvents::ViewEvents(ViewEvents&&) noexcept = default;

std::vector<ViewEvent> ViewEvents::crossed(const Point& a, const Point& b) const {
  const Impl::Path path = Impl::path_between(a, b);
  std::vector<Found> found;
  auto near = impl_->arc_index().near(a, b);
  if (!near) {
    near.emplace(impl_->skeleton.arcs.size());
    std::iota(near->begin(), near->end(), 0U);
  }
  impl_->cross_arcs(path, *near, found);
  impl_->cross_facets(path, found);
  return Impl::in_order(path, std::move(found));
}

std::vector<ViewEvent> ViewEvents::crossed(const Point& a, const Point& b,
                                           std::span<const std::uint32_t> arcs) const {
  const Impl::Path path = Impl::path_between(a, b);
  std::vector<Found> found;
  impl_->cross_arcs(path, arcs, found);
  return Impl::in_order(path, std::move(found));
}

std::size_t ViewEvents::index_bytes() const { return impl_->arc_index().bytes(); }

std::vector<ViewEvent> ViewEvents::separating(const Point& a, const Point& b) const {
  std::vector<ViewEvent> events = crossed(a, b);
  std::map<std::pair<EventKind, std::uint32_t>, int> times;
  for (const ViewEvent& e : events) ++times[{e.kind, e.id}];
  // Of a curved event crossed twice nothing is left.
  std::erase_if(events, [&](const ViewEvent& e) {
    return times[{e.kind, e.id}] % 2 == 0;
  });
  return events;
}

}  // namespace sightline
