// Cutting a polygon of the file into exactly planar convex pieces.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "linespace/predicates.h"
#include "linespace/scene/scene.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {

// orient3d with a fourth point that stands on the plane over the first.
Sign orient2d(int axis, const Point& a, const Point& b, const Point& c) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  return orient3d({a[u], a[v], 0}, {b[u], b[v], 0}, {c[u], c[v], 0}, {a[u], a[v], 1});
}

namespace {

using Point2 = std::array<double, 2>;

Sign turn_of(const Point2& a, const Point2& b, const Point2& c) {
  return orient3d({a[0], a[1], 0}, {b[0], b[1], 0}, {c[0], c[1], 0}, {a[0], a[1], 1});
}

Point2 dropped(const Point& p, int axis) {
  return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

// Twice the area vector, rounded: only to choose a projection and to report a distance.
Point area_vector(std::span<const Point> points) {
  Point sum = Point::Zero();
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    sum += (points[i] - points[0]).cross(points[i + 1] - points[0]);
  }
  return sum;
}

double off_mean_plane(std::span<const Point> points) {
  Point centre = Point::Zero();
  for (const Point& p : points) centre += p / static_cast<double>(points.size());
  const Point normal = area_vector(points).stableNormalized();
  double most = 0;
  for (const Point& p : points) most = std::max(most, std::abs(normal.dot(p - centre)));
  return most;
}

// The polygon dropped onto a coordinate plane, `turn` being the sign of its area there.
struct Projected {
  std::vector<Point2> points;
  Sign turn;

  Sign corner(int a, int b, int c) const {
    return turn * turn_of(points[a], points[b], points[c]);
  }
};

// The coordinate planes from the largest projection to the smallest.
std::array<int, 3> axes_by_size(const Point& normal) {
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](int i, int j) {
    return std::abs(normal[i]) > std::abs(normal[j]);
  });
  return axes;
}

// Requires three points that are not collinear.  The polygon turns as its lowest corner
// does; where that corner is a spike, as the rounded area says.
Projected project(std::span<const Point> points, const std::array<Point, 3>& triangle) {
  const Point normal = area_vector(points);
  const auto axes = axes_by_size(normal);
  const int axis = *std::find_if(axes.begin(), axes.end(), [&](int k) {
    return orient2d(k, triangle[0], triangle[1], triangle[2]) != Sign::Zero;
  });
  Projected projected;
  for (const Point& p : points) projected.points.push_back(dropped(p, axis));
  const auto& q = projected.points;
  const std::size_t n = q.size();
  const std::size_t low = std::min_element(q.begin(), q.end()) - q.begin();
  projected.turn = turn_of(q[(low + n - 1) % n], q[low], q[(low + 1) % n]);
  if (projected.turn == Sign::Zero) {
    projected.turn = normal[axis] < 0 ? Sign::Negative : Sign::Positive;
  }
  return projected;
}

// Every corner turns the same way or not at all, once around in all: the sides'
// directions change between rightward and leftward (upward counts as rightward) exactly
// twice.
bool is_convex(const Projected& polygon) {
  const auto& q = polygon.points;
  const int n = static_cast<int>(q.size());
  int changes = 0;
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n, k = (i + 2) % n;
    if (polygon.corner(i, j, k) == Sign::Negative) return false;
    if ((q[i] < q[j]) != (q[j] < q[k])) ++changes;
  }
  return changes == 2;
}

bool boxes_meet(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  for (int k = 0; k < 2; ++k) {
    if (std::max(a[k], b[k]) < std::min(c[k], d[k])) return false;
    if (std::max(c[k], d[k]) < std::min(a[k], b[k])) return false;
  }
  return true;
}

// Two sides cross at a point inside both.
bool crosses_itself(const std::vector<Point2>& q) {
  const int n = static_cast<int>(q.size());
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  const auto left = [&](int i) { return std::min(q[i][0], q[(i + 1) % n][0]); };
  const auto right = [&](int i) { return std::max(q[i][0], q[(i + 1) % n][0]); };
  std::sort(order.begin(), order.end(), [&](int i, int j) { return left(i) < left(j); });
  for (int s = 0; s < n; ++s) {
    hear_stop();
    const int i = order[s];
    const Point2 &a = q[i], &b = q[(i + 1) % n];
    for (int t = s + 1; t < n && left(order[t]) <= right(i); ++t) {
      const int j = order[t];
      const Point2 &c = q[j], &d = q[(j + 1) % n];
      if (!boxes_meet(a, b, c, d)) continue;
      if (turn_of(a, b, c) * turn_of(a, b, d) == Sign::Negative &&
          turn_of(c, d, a) * turn_of(c, d, b) == Sign::Negative) {
        return true;
      }
    }
  }
  return false;
}

// Squared, rounded, the same whatever the order of the axes.
double squared_length(const Point& a, const Point& b) {
  std::array<double, 3> s;
  for (int k = 0; k < 3; ++k) s[k] = (a[k] - b[k]) * (a[k] - b[k]);
  std::sort(s.begin(), s.end());
  return s[0] + s[1] + s[2];
}

// The ring without corners at which it turns straight back: they enclose nothing.
std::vector<int> without_backtracks(std::span<const Point> vertices,
                                    std::span<const int> ring) {
  std::vector<int> kept(ring.begin(), ring.end());
  const auto turns_back = [&](int a, int b, int c) {
    const Point &p = vertices[a], &q = vertices[b], &r = vertices[c];
    if (p == q || q == r || p == r) return true;
    if (!collinear(p, q, r)) return false;
    for (int k = 0; k < 3; ++k) {
      if (p[k] != q[k]) return (q[k] > p[k]) != (r[k] > q[k]);
    }
    return true;
  };
  std::size_t settled = 0;
  for (std::size_t i = 0; kept.size() >= 3 && settled < kept.size();) {
    const std::size_t n = kept.size();
    i %= n;
    if (turns_back(kept[(i + n - 1) % n], kept[i], kept[(i + 1) % n])) {
      kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(i));
      i = (i + kept.size() - 1) % kept.size();
      settled = 0;
    } else {
      ++i;
      ++settled;
    }
  }
  return kept;
}

struct EarClipper {
  std::span<const Point> points;
  const Projected& projected;
  PolygonPieces& pieces;
  std::vector<int> prev, next;
  std::vector<std::uint8_t> cut;  // the side from here to next is a diagonal
  std::vector<std::uint8_t> ear;
  std::vector<double> length;  // of the diagonal that would clip this corner

  void run() {
    const int n = static_cast<int>(points.size());
    prev.resize(n);
    next.resize(n);
    cut.assign(n, 0);
    ear.resize(n);
    length.resize(n);
    for (int i = 0; i < n; ++i) {
      prev[i] = (i + n - 1) % n;
      next[i] = (i + 1) % n;
    }
    for (int i = 0; i < n; ++i) examine(i);
    int at = 0;
    for (int left = n; left > 3; --left) {
      hear_stop();
      int b = best(at, left);
      if (b < 0) {  // only where the polygon crosses or touches itself
        pieces.crossing = true;
        b = any_convex(at, left);
      }
      const int a = prev[b], c = next[b];
      emit(a, b, c, true);
      next[a] = c;
      prev[c] = a;
      cut[a] = 1;
      examine(a);
      examine(c);
      at = a;
    }
    emit(prev[at], at, next[at], cut[next[at]] != 0);
  }

  void emit(int a, int b, int c, bool last_is_cut) {
    if (collinear(points[a], points[b], points[c])) return;
    pieces.sizes.push_back(3);
    for (const int i : {a, b, c}) pieces.corners.push_back(i);
    for (const std::uint8_t d : {cut[a], cut[b], std::uint8_t{last_is_cut}}) {
      pieces.is_diagonal.push_back(d);
    }
  }

  void examine(int b) {
    const int a = prev[b], c = next[b];
    ear[b] = is_ear(a, b, c);
    length[b] = squared_length(points[a], points[c]);
  }

  // No other corner lies in the closed triangle, save those at its own corners.
  bool is_ear(int a, int b, int c) const {
    if (projected.corner(a, b, c) != Sign::Positive) return false;
    const auto& q = projected.points;
    Point2 low = q[a], high = q[a];
    for (const int i : {b, c}) {
      for (int k = 0; k < 2; ++k) {
        low[k] = std::min(low[k], q[i][k]);
        high[k] = std::max(high[k], q[i][k]);
      }
    }
    for (int i = next[c]; i != a; i = next[i]) {
      const Point2& p = q[i];
      if (p[0] < low[0] || p[0] > high[0] || p[1] < low[1] || p[1] > high[1]) continue;
      if (p == q[a] || p == q[b] || p == q[c]) continue;
      if (projected.corner(a, b, i) != Sign::Negative &&
          projected.corner(b, c, i) != Sign::Negative &&
          projected.corner(c, a, i) != Sign::Negative) {
        return false;
      }
    }
    return true;
  }

  // The ear with the shortest diagonal; among equals the one with the smallest ends, so
  // that the choice depends on the points only.  -1 when there is none.
  int best(int at, int left) const {
    const auto ends = [&](int b) {
      const Point &p = points[prev[b]], &q = points[next[b]];
      const std::array<double, 3> s{p.x(), p.y(), p.z()}, t{q.x(), q.y(), q.z()};
      return s < t ? std::pair(s, t) : std::pair(t, s);
    };
    int found = -1;
    for (int i = 0, b = at; i < left; ++i, b = next[b]) {
      if (!ear[b]) continue;
      if (found < 0 || length[b] < length[found]) {
        found = b;
      } else if (length[b] == length[found]) {
        if (ends(b) < ends(found)) found = b;
      }
    }
    return found;
  }

  int any_convex(int at, int left) const {
    for (int i = 0, b = at; i < left; ++i, b = next[b]) {
      if (projected.corner(prev[b], b, next[b]) == Sign::Positive) return b;
    }
    return at;
  }
};

}  // namespace

PolygonPieces cut_into_pieces(std::span<const Point> vertices,
                              std::span<const int> ring) {
  PolygonPieces pieces;
  const auto at = [&](std::size_t i) -> const Point& { return vertices[ring[i]]; };
  const std::size_t n = ring.size();
  std::size_t third = 2;
  while (third < n && collinear(at(0), at(1), at(third))) ++third;
  if (third >= n) {
    pieces.zero_area = true;
    return pieces;
  }
  if (n == 3) {
    pieces.corners.assign(ring.begin(), ring.end());
    pieces.is_diagonal.assign(3, 0);
    pieces.sizes = {3};
    return pieces;
  }
  std::vector<Point> points;
  points.reserve(n);
  for (std::size_t i = 0; i < n; ++i) points.push_back(at(i));
  const std::array<Point, 3> triangle{points[0], points[1], points[third]};
  for (const Point& p : points) {
    if (orient3d(triangle[0], triangle[1], triangle[2], p) != Sign::Zero) {
      pieces.planar = false;
    }
  }
  const Projected projected = project(points, triangle);
  pieces.convex = is_convex(projected);
  if (!pieces.planar) pieces.off_plane = off_mean_plane(points);
  if (pieces.planar && pieces.convex) {
    // Start so that the second corner is a true one: the first three give the plane.
    std::size_t start = 0;
    while (projected.corner(static_cast<int>(start), static_cast<int>((start + 1) % n),
                            static_cast<int>((start + 2) % n)) != Sign::Positive) {
      ++start;
    }
    for (std::size_t i = 0; i < n; ++i) pieces.corners.push_back(ring[(start + i) % n]);
    pieces.is_diagonal.assign(n, 0);
    pieces.sizes = {static_cast<int>(n)};
    return pieces;
  }
  if (!pieces.convex) {
    const auto shorter = without_backtracks(vertices, ring);
    if (shorter.size() < ring.size()) {
      pieces = cut_into_pieces(vertices, shorter);
      pieces.convex = false;
      return pieces;
    }
    pieces.crossing = crosses_itself(projected.points);
  }
  EarClipper{points, projected, pieces, {}, {}, {}, {}, {}}.run();
  for (int& corner : pieces.corners) corner = ring[corner];
  if (pieces.sizes.empty()) pieces.zero_area = true;
  return pieces;
}

}  // namespace sightline::internal
