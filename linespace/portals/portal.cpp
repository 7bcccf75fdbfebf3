#include "linespace/portals/portal.h"

#include <algorithm>
#include <array>
#include <string>

#include "linespace/scene.h"

namespace sightline::internal {
namespace {

using internal::cross;
using internal::dot;

RingVector difference(const HomogeneousPoint& p, const HomogeneousPoint& q) {
  RingVector out;
  for (int i = 0; i < 3; ++i) out[i] = p.x[i] * q.w - q.x[i] * p.w;
  return out;
}

bool all_zero(const RingVector& v) {
  return is_zero(v[0]) && is_zero(v[1]) && is_zero(v[2]);
}

ExactLine line_from(const RingVector& d, const RingVector& m) {
  ExactLine::Coordinates c;
  Sign first = Sign::Zero;
  for (int i = 0; i < 3 && first == Sign::Zero; ++i) first = sign_of(d[i]);
  for (int i = 0; i < 3; ++i) {
    c.d[i] = Surd{first == Sign::Negative ? Ring(-d[i]) : d[i], 0};
    c.m[i] = Surd{first == Sign::Negative ? Ring(-m[i]) : m[i], 0};
  }
  c.rounded = scaled<6>({c.d[0], c.d[1], c.d[2], c.m[0], c.m[1], c.m[2]}, c.radicand);
  return ExactLine(std::make_shared<const ExactLine::Coordinates>(std::move(c)));
}

// ---- making a portal ------------------------------------------------------------------

[[noreturn]] void refuse(int index, const std::string& why) {
  throw InvalidInput("portal " + std::to_string(index) + ": " + why);
}

struct NamedCorners {
  std::vector<Point> corners;
  std::vector<int> names;

  void drop(std::size_t i) {
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
    names.erase(names.begin() + static_cast<std::ptrdiff_t>(i));
  }
};

void drop_repeated(NamedCorners& c) {
  for (std::size_t i = 0; i < c.corners.size() && c.corners.size() > 1;) {
    const std::size_t next = (i + 1) % c.corners.size();
    if (c.corners[i] == c.corners[next]) {
      c.drop(next == 0 ? i : next);
    } else {
      ++i;
    }
  }
}

bool lexicographically_less(const Point& p, const Point& q) {
  return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
}

/// All corners on one line: what is left is the two outermost, in the order given.
bool reduce_to_slit(NamedCorners& c) {
  for (std::size_t i = 2; i < c.corners.size(); ++i) {
    if (!collinear(c.corners[0], c.corners[1], c.corners[i])) return false;
  }
  const auto [low, high] =
      std::minmax_element(c.corners.begin(), c.corners.end(), lexicographically_less);
  std::size_t i = static_cast<std::size_t>(low - c.corners.begin());
  std::size_t j = static_cast<std::size_t>(high - c.corners.begin());
  if (i > j) std::swap(i, j);
  c = {{c.corners[i], c.corners[j]}, {c.names[i], c.names[j]}};
  return true;
}

/// Corners inside a straight edge.  A corner at which the boundary turns back stays, and
/// is refused as not convex.
void drop_flat(NamedCorners& c) {
  for (std::size_t i = 0; i < c.corners.size() && c.corners.size() > 3;) {
    const std::size_t n = c.corners.size();
    const Point& before = c.corners[(i + n - 1) % n];
    const Point& here = c.corners[i];
    const Point& after = c.corners[(i + 1) % n];
    const bool between =
        lexicographically_less(before, here) == lexicographically_less(here, after);
    if (between && collinear(before, here, after)) {
      c.drop(i);
    } else {
      ++i;
    }
  }
}

/// Every corner strictly on the inner side of every edge, as seen along the sum of the
/// corners' cross products (twice the vector area).
bool convex(const std::vector<Point>& corners) {
  const std::size_t n = corners.size();
  RingVector area{Ring(0), Ring(0), Ring(0)};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const RingVector part = cross(ring_difference(corners[i], corners[0]),
                                  ring_difference(corners[i + 1], corners[0]));
    for (int k = 0; k < 3; ++k) area[k] = area[k] + part[k];
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    const RingVector inward = cross(area, ring_difference(corners[next], corners[i]));
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i || j == next) continue;
      if (sign_of(dot(inward, ring_difference(corners[j], corners[i]))) !=
          Sign::Positive) {
        return false;
      }
    }
  }
  return true;
}

// ---- places ---------------------------------------------------------------------------

int axis_of(const ExactLine::Coordinates& c) {
  for (int i = 0; i < 2; ++i) {
    if (!is_zero(c.d[i], c.radicand)) return i;
  }
  return 2;
}

/// A coordinate of a point of the line, numerator over denominator, as a place.
Place place(const ExactLine::Coordinates& c, int axis, Surd num, Surd den) {
  const Sign along = sign_of(c.d[axis], c.radicand);
  const Sign down = sign_of(den, c.radicand);
  if (along * down == Sign::Negative) num = -num;
  if (down == Sign::Negative) den = -den;
  return {std::move(num), std::move(den)};
}

Place place_of_point(const ExactLine::Coordinates& c, const Point& p) {
  const int i = axis_of(c);
  return place(c, i, Surd{Ring(p[i]), 0}, Surd{Ring(1), 0});
}

/// Where a line meets an edge's line, in one plane with it and not parallel.
Place place_on_edge(const ExactLine::Coordinates& c, const LineThrough& e) {
  // A point X is on the line iff X x d - m = 0; along e this vector keeps its direction.
  const RingVector along = ring_difference(e.to, e.from);
  const SurdVector slope = cross(along, c.d);
  for (int k = 0; k < 3; ++k) {
    if (is_zero(slope[k], c.radicand)) continue;
    const Surd at_from = cross(ring_point(e.from), c.d)[k] - c.m[k];
    const int i = axis_of(c);
    return place(c, i, slope[k] * Ring(e.from[i]) - at_from * along[i], slope[k]);
  }
  return {};
}

/// Where a line crosses a polygon's plane: X (n . d) = n x m + offset d.
Place place_in_plane(const ExactLine::Coordinates& c, const Portal& p) {
  const int i = axis_of(c);
  return place(c, i, cross(p.normal, c.m)[i] + c.d[i] * p.offset, dot(c.d, p.normal));
}

/// For a line in a planar polygon's plane: the sides of the line its corners lie on.
std::vector<Sign> sides_in_plane(const ExactLine& line, const Portal& p) {
  const ExactLine::Coordinates& c = line.coordinates();
  std::vector<Sign> signs;
  for (const Point& v : p.corners) {
    const SurdVector off = cross(ring_point(v), c.d);
    const SurdVector u{off[0] - c.m[0], off[1] - c.m[1], off[2] - c.m[2]};
    signs.push_back(sign_of(dot(u, p.normal), c.radicand));
  }
  return signs;
}

struct Sides {
  bool positive = false;
  bool negative = false;
  int zeros = 0;
};

Sides sides(const ExactLine& line, const Portal& p) {
  Sides s;
  for (const LineThrough& e : p.edges) {
    const Sign sign = line.side(e);
    s.positive |= sign == Sign::Positive;
    s.negative |= sign == Sign::Negative;
    s.zeros += sign == Sign::Zero;
    if (s.positive && s.negative && p.planar) break;
  }
  return s;
}

/// Of a polygon that is not quite planar: the line crosses the planes at all corners in
/// the same direction.
bool heads_through(const ExactLine& line, const Portal& p) {
  const int n = p.corner_count();
  Sign common = Sign::Zero;
  for (int i = 0; i < n; ++i) {
    const Sign s =
        line.heads({p.corners[(i + n - 1) % n], p.corners[i], p.corners[(i + 1) % n]});
    if (s == Sign::Zero || (i > 0 && s != common)) return false;
    common = s;
  }
  return true;
}

std::vector<int> corners_on(const ExactLine& line, const Portal& p) {
  std::vector<int> out;
  for (int i = 0; i < p.corner_count(); ++i) {
    if (line.passes_through(p.corners[i])) out.push_back(i);
  }
  return out;
}

bool meets_polygon(const ExactLine& line, const Portal& p) {
  const Sides s = sides(line, p);
  // A line through two corners is in one plane with three edges at least.
  if (!p.planar && s.zeros > 2 && corners_on(line, p).size() > 1) return true;
  if (s.positive && s.negative) return false;
  if (!p.planar) return heads_through(line, p);
  if (s.positive || s.negative) return true;
  const std::vector<Sign> in_plane = sides_in_plane(line, p);
  const auto all = [&in_plane](Sign sign) {
    return std::ranges::all_of(in_plane, [sign](Sign x) { return x == sign; });
  };
  return !all(Sign::Positive) && !all(Sign::Negative);
}

void set_range(Meeting& m, const Ring& radicand) {
  m.first = m.last = m.touches.front().at;
  for (const PortalTouch& t : m.touches) {
    if (compare(t.at, m.first, radicand) == Sign::Negative) m.first = t.at;
    if (compare(t.at, m.last, radicand) == Sign::Positive) m.last = t.at;
  }
}

PortalTouch touch_corner(const ExactLine& line, const Portal& p, int portal, int i) {
  return {{PortalGenerator::Kind::Vertex, portal, i},
          place_of_point(line.coordinates(), p.corners[i])};
}
PortalTouch touch_edge(const ExactLine& line, const Portal& p, int portal, int i) {
  return {{PortalGenerator::Kind::Edge, portal, i},
          place_on_edge(line.coordinates(), p.edges[i])};
}

Meeting meeting_in_plane(const ExactLine& line, const Portal& p, int index) {
  const std::vector<Sign> s = sides_in_plane(line, p);
  const int n = p.corner_count();
  Meeting m;
  m.in_plane = true;
  for (int i = 0; i < n; ++i) {
    if (s[i] == Sign::Zero) m.touches.push_back(touch_corner(line, p, index, i));
    if (s[i] * s[(i + 1) % n] == Sign::Negative) {
      m.touches.push_back(touch_edge(line, p, index, i));
    }
  }
  set_range(m, line.coordinates().radicand);
  return m;
}

Meeting meeting_across(const ExactLine& line, const Portal& p, int index) {
  const int n = p.corner_count();
  std::vector<int> zeros;
  for (int i = 0; i < n; ++i) {
    if (line.side(p.edges[i]) == Sign::Zero) zeros.push_back(i);
  }
  Meeting m;
  if (zeros.size() == 2) {
    // Neighbours, and the corner between them begins the second one.
    const int i = (zeros[0] + 1) % n == zeros[1] ? zeros[1] : zeros[0];
    m.touches.push_back(touch_corner(line, p, index, i));
  } else if (zeros.size() == 1) {
    m.touches.push_back(touch_edge(line, p, index, zeros[0]));
  } else {
    m.first = m.last = place_in_plane(line.coordinates(), p);
    return m;
  }
  m.first = m.last = m.touches.front().at;
  return m;
}

Meeting meeting_with_slit(const ExactLine& line, const Portal& p, int index) {
  Meeting m;
  const SegmentContact contact = line.meets(p.edges[0]);
  m.along = contact == SegmentContact::Along;
  if (contact == SegmentContact::Interior) {
    m.touches.push_back(touch_edge(line, p, index, 0));
  } else {
    for (int i = 0; i < 2; ++i) {
      if (m.along || line.passes_through(p.corners[i])) {
        m.touches.push_back(touch_corner(line, p, index, i));
      }
    }
  }
  set_range(m, line.coordinates().radicand);
  return m;
}

}  // namespace

HomogeneousPoint homogeneous(const Point& p) { return {ring_point(p), 1}; }

bool precedes(const HomogeneousPoint& p, const HomogeneousPoint& q) {
  for (int i = 0; i < 3; ++i) {
    const Sign s = sign_of(Ring(p.x[i] * q.w - q.x[i] * p.w));
    if (s != Sign::Zero) return s == Sign::Negative;
  }
  return false;
}

Portal make_portal(std::span<const Point> given, int index) {
  NamedCorners c;
  for (std::size_t i = 0; i < given.size(); ++i) {
    for (const double x : given[i]) {
      if (!is_admissible(x)) {
        refuse(index, "corner " + std::to_string(i) +
                          " has a coordinate that is not finite or out of range");
      }
    }
    c.corners.push_back(given[i]);
    c.names.push_back(static_cast<int>(i));
  }
  if (given.empty()) refuse(index, "no corners");
  drop_repeated(c);
  Portal p;
  if (c.corners.size() == 1) {
    p.shape = Portal::Shape::Point;
  } else if (c.corners.size() == 2 || reduce_to_slit(c)) {
    p.shape = Portal::Shape::Slit;
    p.edges.push_back({c.corners[0], c.corners[1]});
  } else {
    p.shape = Portal::Shape::Polygon;
    drop_flat(c);
    if (!convex(c.corners)) refuse(index, "not convex");
    const std::size_t n = c.corners.size();
    for (std::size_t i = 0; i < n; ++i) {
      p.edges.push_back({c.corners[i], c.corners[(i + 1) % n]});
      p.planar = p.planar && orient3d(c.corners[0], c.corners[1], c.corners[2],
                                      c.corners[i]) == Sign::Zero;
    }
    p.normal = cross(ring_difference(c.corners[1], c.corners[0]),
                     ring_difference(c.corners[2], c.corners[0]));
    p.offset = dot(p.normal, ring_point(c.corners[0]));
  }
  p.corners = std::move(c.corners);
  p.names = std::move(c.names);
  return p;
}

Sign compare(const Place& a, const Place& b, const Ring& radicand) {
  return sign_of(product(a.num, b.den, radicand) - product(b.num, a.den, radicand),
                 radicand);
}

Place place_of_point(const ExactLine& line, const Point& p) {
  return place_of_point(line.coordinates(), p);
}

bool meets(const ExactLine& line, const Portal& portal) {
  switch (portal.shape) {
    case Portal::Shape::Point:
      return line.passes_through(portal.corners[0]);
    case Portal::Shape::Slit:
      return line.meets(portal.edges[0]) != SegmentContact::None;
    case Portal::Shape::Polygon:
      return meets_polygon(line, portal);
  }
  return false;
}

Meeting meeting(const ExactLine& line, const Portal& portal, int index) {
  switch (portal.shape) {
    case Portal::Shape::Point: {
      Meeting m;
      m.touches.push_back(touch_corner(line, portal, index, 0));
      set_range(m, line.coordinates().radicand);
      return m;
    }
    case Portal::Shape::Slit:
      return meeting_with_slit(line, portal, index);
    case Portal::Shape::Polygon:
      break;
  }
  const Sides s = sides(line, portal);
  if (!portal.planar) {
    const std::vector<int> on =
        s.zeros > 2 ? corners_on(line, portal) : std::vector<int>();
    if (on.size() < 2) return meeting_across(line, portal, index);
    Meeting m;
    m.in_plane = true;
    for (const int i : on) m.touches.push_back(touch_corner(line, portal, index, i));
    set_range(m, line.coordinates().radicand);
    return m;
  }
  if (s.positive || s.negative) return meeting_across(line, portal, index);
  return meeting_in_plane(line, portal, index);
}

bool crosses_interior(const ExactLine& line, const Portal& portal) {
  if (portal.shape != Portal::Shape::Polygon) return false;
  Sign common = Sign::Zero;
  for (std::size_t i = 0; i < portal.edges.size(); ++i) {
    const Sign s = line.side(portal.edges[i]);
    if (s == Sign::Zero || (i > 0 && s != common)) return false;
    common = s;
  }
  return portal.planar || heads_through(line, portal);
}

ExactLine line_through(const HomogeneousPoint& p, const HomogeneousPoint& q) {
  return line_from(difference(q, p), cross(p.x, q.x));
}

namespace {

/// Of the plane of a point and a line; zero when the point is on the line.
RingVector normal_of(const HomogeneousPoint& p, const LineThrough& line) {
  return cross(difference(homogeneous(line.from), p),
               difference(homogeneous(line.to), p));
}

/// The line through p in two planes with these normals.
std::optional<ExactLine> line_in_planes(const HomogeneousPoint& p, const RingVector& n,
                                        const RingVector& o) {
  RingVector d = cross(n, o);
  if (all_zero(d)) return std::nullopt;
  const RingVector moment = cross(p.x, d);
  for (Ring& x : d) x = x * p.w;
  return line_from(d, moment);
}

}  // namespace

std::optional<ExactLine> line_through(const HomogeneousPoint& p, const LineThrough& l,
                                      const LineThrough& m) {
  return line_in_planes(p, normal_of(p, l), normal_of(p, m));
}

std::optional<ExactLine> line_in_plane(const HomogeneousPoint& p, const LineThrough& l,
                                       const Portal& polygon) {
  if (side_of_plane(polygon, p) != Sign::Zero) return std::nullopt;
  return line_in_planes(p, normal_of(p, l), polygon.normal);
}

bool lies_on(const HomogeneousPoint& p, const LineThrough& edge) {
  return all_zero(normal_of(p, edge));
}

bool in_plane_of(const HomogeneousPoint& p, const HomogeneousPoint& point,
                 const LineThrough& edge) {
  return is_zero(dot(normal_of(point, edge), difference(p, point)));
}

Sign side_of_plane(const Portal& polygon, const HomogeneousPoint& p) {
  return sign_of(Ring(dot(polygon.normal, p.x) - polygon.offset * p.w));
}

std::optional<HomogeneousPoint> crossing(const LineThrough& edge,
                                         const PlaneThrough& plane) {
  const Sign s = orient3d(plane.a, plane.b, plane.c, edge.from);
  if (s * orient3d(plane.a, plane.b, plane.c, edge.to) != Sign::Negative) {
    return std::nullopt;
  }
  return line_crossing(edge, plane);
}

std::optional<HomogeneousPoint> line_crossing(const LineThrough& edge,
                                              const PlaneThrough& plane) {
  const RingVector normal =
      cross(ring_difference(plane.b, plane.a), ring_difference(plane.c, plane.a));
  const RingVector along = ring_difference(edge.to, edge.from);
  const Ring slope = dot(normal, along);
  if (is_zero(slope)) return std::nullopt;
  // edge.from - along * height / slope
  const Ring height = dot(normal, ring_difference(edge.from, plane.a));
  HomogeneousPoint p{{}, slope};
  for (int i = 0; i < 3; ++i) p.x[i] = Ring(edge.from[i]) * slope - along[i] * height;
  if (sign_of(p.w) == Sign::Negative) {
    p.w = -p.w;
    for (Ring& x : p.x) x = -x;
  }
  return p;
}

std::optional<HomogeneousPoint> crossing(const LineThrough& e, const LineThrough& f) {
  if (side(e, f) != Sign::Zero) return std::nullopt;
  const RingVector u = ring_difference(e.to, e.from);
  const RingVector v = ring_difference(f.to, f.from);
  const RingVector n = cross(u, v);
  if (all_zero(n)) return std::nullopt;
  // e.from + s u with s = ((f.from - e.from) x v) . n / n^2, f.from + t v likewise.
  const RingVector between = ring_difference(f.from, e.from);
  const Ring den = dot(n, n);
  const Ring s = dot(cross(between, v), n);
  const Ring t = dot(cross(between, u), n);
  for (const Ring& x : {s, t}) {
    if (sign_of(x) == Sign::Negative || sign_of(Ring(den - x)) == Sign::Negative) {
      return std::nullopt;
    }
  }
  HomogeneousPoint p{{}, den};
  for (int i = 0; i < 3; ++i) p.x[i] = Ring(e.from[i]) * den + u[i] * s;
  return p;
}

bool plane_meets(const Portal& polygon, const Portal& portal) {
  const PlaneSide plane(polygon.plane());
  const Sign first = plane(portal.corners[0]);
  return first == Sign::Zero || std::ranges::any_of(portal.corners, [&](const Point& v) {
           return plane(v) != first;
         });
}

namespace {

struct Range {
  HomogeneousPoint low, high;
};

Sign compare_points(const RingVector& direction, const HomogeneousPoint& p,
                    const HomogeneousPoint& q) {
  return sign_of(Ring(dot(direction, p.x) * q.w - dot(direction, q.x) * p.w));
}

/// Where a portal with corners strictly on both sides of a plane is cut by it.
std::optional<Range> cut(const Portal& portal, const Portal& by,
                         const RingVector& direction) {
  const PlaneSide plane(by.plane());
  std::vector<HomogeneousPoint> points;
  Sides s;
  for (const Point& v : portal.corners) {
    const Sign sign = plane(v);
    s.positive |= sign == Sign::Positive;
    s.negative |= sign == Sign::Negative;
    if (sign == Sign::Zero) points.push_back(homogeneous(v));
  }
  if (!s.positive || !s.negative) return std::nullopt;
  for (const LineThrough& e : portal.edges) {
    if (auto p = crossing(e, by.plane())) points.push_back(*std::move(p));
  }
  Range r{points.front(), points.front()};
  for (const HomogeneousPoint& p : points) {
    if (compare_points(direction, p, r.low) == Sign::Negative) r.low = p;
    if (compare_points(direction, p, r.high) == Sign::Positive) r.high = p;
  }
  return r;
}

bool pierces(const Portal& slit, const Portal& polygon) {
  const auto p = crossing(slit.edges[0], polygon.plane());
  if (!p) return false;
  Sign common = Sign::Zero;
  for (const LineThrough& e : polygon.edges) {
    const RingVector inward = cross(polygon.normal, ring_difference(e.to, e.from));
    const Sign s = sign_of(dot(inward, difference(*p, homogeneous(e.from))));
    if (s == Sign::Zero || (common != Sign::Zero && s != common)) return false;
    common = s;
  }
  return true;
}

}  // namespace

bool touch(const Portal& a, const Portal& b) {
  // One of the two has an edge, or is a point, that meets the other.
  const auto meets_segment = [](const Point& p, const Point& q, const Portal& portal) {
    const ExactLine line = ExactLine::through(p, p == q ? Point(p + Point::UnitX()) : q);
    if (!meets(line, portal)) return false;
    const Meeting m = meeting(line, portal, 0);
    return compare(place_of_point(line, p), m.last, 0) != Sign::Positive &&
           compare(m.first, place_of_point(line, q), 0) != Sign::Positive;
  };
  const auto one_way = [&](const Portal& from, const Portal& to) {
    if (from.edges.empty()) return meets_segment(from.corners[0], from.corners[0], to);
    return std::ranges::any_of(from.edges, [&](const LineThrough& e) {
      return meets_segment(e.from, e.to, to);
    });
  };
  return one_way(a, b) || one_way(b, a);
}

bool interiors_cross(const Portal& a, const Portal& b) {
  using Shape = Portal::Shape;
  if (a.shape == Shape::Slit && b.shape == Shape::Polygon) return pierces(a, b);
  if (b.shape == Shape::Slit && a.shape == Shape::Polygon) return pierces(b, a);
  if (a.shape != Shape::Polygon || b.shape != Shape::Polygon) return false;
  const RingVector direction = cross(a.normal, b.normal);
  const auto ra = cut(a, b, direction);
  if (!ra) return false;
  const auto rb = cut(b, a, direction);
  return rb && compare_points(direction, ra->low, rb->high) == Sign::Negative &&
         compare_points(direction, rb->low, ra->high) == Sign::Negative;
}

Point rounded(const HomogeneousPoint& p) {
  Point out;
  for (int i = 0; i < 3; ++i) {
    out[i] = is_zero(p.x[i]) ? 0 : quotient(Surd{p.x[i], 0}, Surd{p.w, 0}, 0);
  }
  return out;
}

namespace {

/// The coordinates at a place, each over its own denominator.
struct PlaceCoordinates {
  SurdVector num, den;
};
PlaceCoordinates coordinates(const ExactLine::Coordinates& c, const Place& place) {
  const int i = axis_of(c);
  const int j = (i + 1) % 3;
  const int k = (i + 2) % 3;
  const Ring& r = c.radicand;
  const Surd num = sign_of(c.d[i], r) == Sign::Negative ? -place.num : place.num;
  // X x d = m:  m_k = x_i d_j - x_j d_i and m_j = x_k d_i - x_i d_k.
  PlaceCoordinates out;
  out.num[i] = num;
  out.den[i] = place.den;
  out.num[j] = product(num, c.d[j], r) - product(c.m[k], place.den, r);
  out.num[k] = product(num, c.d[k], r) + product(c.m[j], place.den, r);
  out.den[j] = out.den[k] = product(place.den, c.d[i], r);
  return out;
}

}  // namespace

HomogeneousPoint exact_place(const ExactLine& line, const Place& place) {
  const ExactLine::Coordinates& c = line.coordinates();
  const PlaceCoordinates at = coordinates(c, place);
  const int i = axis_of(c);
  const Ring& w = at.den[(i + 1) % 3].a;
  HomogeneousPoint p{{at.num[0].a, at.num[1].a, at.num[2].a}, w};
  p.x[i] = p.x[i] * c.d[i].a;  // the others' denominator has this factor
  if (sign_of(w) == Sign::Negative) {
    p.w = -p.w;
    for (Ring& x : p.x) x = -x;
  }
  return p;
}

Point rounded_place(const ExactLine& line, const Place& place) {
  const Ring& r = line.coordinates().radicand;
  const PlaceCoordinates at = coordinates(line.coordinates(), place);
  Point out;
  for (int i = 0; i < 3; ++i) {
    out[i] = is_zero(at.num[i], r) ? 0 : quotient(at.num[i], at.den[i], r);
  }
  return out;
}

}  // namespace sightline::internal
