#include "tests/support/naive_polygon_visibility.h"

#include <CGAL/Interval_nt.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "tests/support/generators.h"

namespace sightline::testing {
namespace {

using Integer = boost::multiprecision::number<boost::multiprecision::gmp_int,
                                              boost::multiprecision::et_off>;
using Interval = CGAL::Interval_nt<false>;
using Polygon = std::vector<Vec3>;

// ---- Polygons -------------------------------------------------------------------------

struct Plane {
  Vec3 n;
  Rational c;
  [[nodiscard]] Rational at(const Vec3& x) const { return dot(n, x) - c; }
};

/// The normal about which the polygon turns counter-clockwise; zero if it has no area.
Vec3 normal_of(const Polygon& polygon) {
  Vec3 n{0, 0, 0};
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    n = n + cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  }
  return n;
}
Plane plane_of(const Polygon& polygon) {
  const Vec3 n = normal_of(polygon);
  return {n, dot(n, polygon[0])};
}

/// Without repeated points and corners of 180 degrees; empty if it has no area.
Polygon simplified(const std::vector<Point>& points) {
  Polygon polygon;
  for (const Point& p : points) polygon.push_back(exact(p));
  const Plane plane = plane_of(polygon);
  if (is_zero(plane.n)) return {};
  for (const Vec3& p : polygon) {
    if (plane.at(p) != 0) throw std::invalid_argument("polygon is not planar");
  }
  polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
  while (polygon.front() == polygon.back()) polygon.pop_back();
  Polygon result;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 before = polygon[i] - polygon[(i + n - 1) % n];
    const Vec3 after = polygon[(i + 1) % n] - polygon[i];
    const int turn = sgn(dot(plane.n, cross(before, after)));
    if (turn < 0) throw std::invalid_argument("polygon is not convex");
    if (turn > 0) result.push_back(polygon[i]);
  }
  return result;
}

/// What of the polygon has plane.at(x) * side >= 0; empty if that has no area.
Polygon clipped(const Polygon& polygon, const Plane& plane, int side) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& p = polygon[i];
    const Vec3& q = polygon[(i + 1) % polygon.size()];
    const Rational at_p = Rational(side) * plane.at(p);
    const Rational at_q = Rational(side) * plane.at(q);
    if (at_p >= 0) result.push_back(p);
    if (at_p.sign() * at_q.sign() < 0) {
      result.push_back(p + (at_p / (at_p - at_q)) * (q - p));
    }
  }
  if (result.size() < 3 || is_zero(normal_of(result))) return {};
  return result;
}

/// The plane through an edge, perpendicular to the polygon, positive inside.
Plane fence(const Polygon& polygon, const Vec3& normal, std::size_t edge) {
  const Vec3& p = polygon[edge];
  const Vec3 n = cross(normal, polygon[(edge + 1) % polygon.size()] - p);
  return {n, dot(n, p)};
}

bool boxes_overlap(const Polygon& p, const Polygon& q) {
  for (int k = 0; k < 3; ++k) {
    const auto less = [k](const Vec3& x, const Vec3& y) { return x[k] < y[k]; };
    const auto [p_min, p_max] = std::minmax_element(p.begin(), p.end(), less);
    const auto [q_min, q_max] = std::minmax_element(q.begin(), q.end(), less);
    if ((*p_max)[k] < (*q_min)[k] || (*q_max)[k] < (*p_min)[k]) return false;
  }
  return true;
}
/// Whether all points have plane.at(x) * side > 0, or >= 0.
bool beyond(const Plane& plane, int side, const Polygon& polygon, bool strictly) {
  return std::ranges::all_of(polygon, [&](const Vec3& x) {
    const int s = side * sgn(plane.at(x));
    return s > 0 || (s == 0 && !strictly);
  });
}

/// Parts of the polygon, together all of it but a null set, none of which an occluder
/// meets in its interior or crosses, and each on one side of the other polygon's plane.
std::vector<Polygon> parts_of(const Polygon& polygon, const Plane& other,
                              const std::vector<Polygon>& occluders) {
  std::vector<Polygon> parts;
  const auto add = [](std::vector<Polygon>& to, Polygon p) {
    if (!p.empty()) to.push_back(std::move(p));
  };
  if (beyond(other, 1, polygon, false)) {
    parts.push_back(polygon);
  } else {
    for (const int side : {-1, 1}) add(parts, clipped(polygon, other, side));
  }
  const Plane own = plane_of(polygon);
  for (const Polygon& occluder : occluders) {
    const Plane plane = plane_of(occluder);
    const bool coplanar =
        beyond(own, 1, occluder, false) && beyond(own, -1, occluder, false);
    std::vector<Polygon> next;
    for (Polygon& part : parts) {
      if (coplanar) {
        // Outside the first fence; inside that and outside the second; and so on.
        Polygon rest = part;
        for (std::size_t i = 0; i < occluder.size() && !rest.empty(); ++i) {
          const Plane f = fence(occluder, plane.n, i);
          add(next, clipped(rest, f, -1));
          rest = clipped(rest, f, 1);
        }
      } else if (!boxes_overlap(part, occluder) || beyond(own, 1, occluder, true) ||
                 beyond(own, -1, occluder, true)) {
        next.push_back(std::move(part));
      } else {
        for (const int side : {-1, 1}) add(next, clipped(part, plane, side));
      }
    }
    parts = std::move(next);
  }
  return parts;
}

// ---- Segments -------------------------------------------------------------------------

bool on_segment(const Vec3& x, const Vec3& p, const Vec3& q) {
  return is_zero(cross(x - p, x - q)) && dot(x - p, x - q) <= 0;
}

bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& x, const Vec3& y) {
  if (on_segment(x, p, q) || on_segment(y, p, q) || on_segment(p, x, y) ||
      on_segment(q, x, y)) {
    return true;
  }
  // Else they meet, if at all, inside both: coplanar, and each separates the other's
  // ends.
  const Vec3 n = cross(q - p, y - x);
  if (is_zero(n) || dot(n, x - p) != 0) return false;
  const auto separates = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return sgn(dot(n, cross(b - a, c - a))) * sgn(dot(n, cross(b - a, d - a))) < 0;
  };
  return separates(p, q, x, y) && separates(x, y, p, q);
}

/// Whether the closed segment meets the closed convex polygon, which may be degenerate.
bool segment_meets(const Vec3& p, const Vec3& q, const Polygon& polygon) {
  const Plane plane = plane_of(polygon);
  if (is_zero(plane.n)) {
    const auto [x, y] = std::minmax_element(polygon.begin(), polygon.end());
    return segments_meet(p, q, *x, *y);  // on one line, lexicographic order is the line's
  }
  const Rational at_p = plane.at(p), at_q = plane.at(q);
  if (at_p.sign() * at_q.sign() > 0) return false;
  // The parameters from lo to hi are in the plane; those inside all fences remain.
  Rational lo = 0, hi = 1;
  if (at_p != at_q) lo = hi = at_p / (at_p - at_q);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Plane f = fence(polygon, plane.n, i);
    const Rational start = f.at(p), slope = f.at(q) - start;
    if (slope == 0) {
      if (start < 0) return false;
    } else if (slope > 0) {
      lo = std::max(lo, Rational(-start / slope));
    } else {
      hi = std::min(hi, Rational(-start / slope));
    }
  }
  return lo <= hi;
}

bool strictly_inside(const Vec3& p, const Polygon& polygon) {
  const Plane plane = plane_of(polygon);
  if (is_zero(plane.n) || plane.at(p) != 0) return false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (polygon[i] == polygon[(i + 1) % polygon.size()]) continue;
    if (fence(polygon, plane.n, i).at(p) <= 0) return false;
  }
  return true;
}

Polygon exact_polygon(const std::vector<Point>& points) {
  Polygon result;
  for (const Point& p : points) result.push_back(exact(p));
  return result;
}

/// An instance in rationals, for checking many segments.
struct ExactInstance {
  Polygon a, b;
  std::vector<Polygon> occluders;
  explicit ExactInstance(const VisibilityInstance& instance)
      : a(exact_polygon(instance.a)), b(exact_polygon(instance.b)) {
    for (const auto& o : instance.occluders) occluders.push_back(exact_polygon(o));
  }
  [[nodiscard]] bool is_free(const Vec3& p, const Vec3& q) const {
    return strictly_inside(p, a) && strictly_inside(q, b) &&
           std::ranges::none_of(occluders,
                                [&](const Polygon& o) { return segment_meets(p, q, o); });
  }
};

std::optional<ExactWitness> random_witness(const ExactInstance& instance, Random& random,
                                           int n) {
  // Positive weights that sum to 1.
  const auto inside = [&](const Polygon& polygon) {
    Vec3 sum{0, 0, 0};
    Rational total = 0;
    for (const Vec3& x : polygon) {
      const int u = random.integer(1, 1 << 10);
      const Rational weight = random.one_in(2) ? u : u * (u / 16 + 1);
      sum = sum + weight * x;
      total += weight;
    }
    return Rational(1 / total) * sum;
  };
  for (int i = 0; i < n; ++i) {
    const Vec3 p = inside(instance.a), q = inside(instance.b);
    if (instance.is_free(p, q)) return ExactWitness{p, q};
  }
  return std::nullopt;
}

// ---- Lines ----------------------------------------------------------------------------

/// Direction and moment of a line, or a linear function of these.
template <class N>
using Six = std::array<N, 6>;

template <class N>
N apply(const Six<N>& function, const Six<N>& line) {
  N sum = function[0] * line[0];
  for (int i = 1; i < 6; ++i) sum += function[i] * line[i];
  return sum;
}

template <class N>
struct Kernel {
  Six<N> u, v;
};

/// The functions' common zeros, if these are of dimension 2.  Fraction-free elimination
/// (Bareiss): every entry is a minor, so every division is exact.
std::optional<Kernel<Integer>> kernel_of(std::array<Six<Integer>, 4> rows) {
  std::array<int, 4> pivots{};
  Integer previous = 1;
  for (int k = 0; k < 4; ++k) {
    int row = k, column = 0;
    for (row = k; row < 4; ++row) {
      for (column = 0; column < 6 && rows[row][column] == 0; ++column) {
      }
      if (column < 6) break;
    }
    if (row == 4) return std::nullopt;
    std::swap(rows[k], rows[row]);
    pivots[k] = column;
    const Integer pivot = rows[k][column];
    for (int i = 0; i < 4; ++i) {
      if (i == k) continue;
      const Integer factor = rows[i][column];
      for (int j = 0; j < 6; ++j) {
        rows[i][j] = (pivot * rows[i][j] - factor * rows[k][j]) / previous;
      }
    }
    previous = pivot;
  }
  Kernel<Integer> result{};
  bool first = true;
  for (int free = 0; free < 6; ++free) {
    if (std::ranges::find(pivots, free) != pivots.end()) continue;
    Six<Integer>& x = first ? result.u : result.v;
    first = false;
    x[free] = previous;
    for (int k = 0; k < 4; ++k) x[pivots[k]] = -rows[k][free];
  }
  return result;
}

/// The same in intervals; nullopt when a pivot may be zero.
std::optional<Kernel<Interval>> kernel_of(std::array<Six<Interval>, 4> rows) {
  std::array<int, 4> pivots{};
  for (int k = 0; k < 4; ++k) {
    int row = k, column = 0;
    double best = 0;
    for (int i = k; i < 4; ++i) {
      for (int j = 0; j < 6; ++j) {
        const double size = std::max(rows[i][j].inf(), -rows[i][j].sup());
        if (size > best) {
          best = size;
          row = i;
          column = j;
        }
      }
    }
    if (best == 0) return std::nullopt;
    std::swap(rows[k], rows[row]);
    pivots[k] = column;
    const Interval pivot = rows[k][column];
    for (Interval& x : rows[k]) x /= pivot;
    for (int i = 0; i < 4; ++i) {
      if (i == k) continue;
      const Interval factor = rows[i][column];
      for (int j = 0; j < 6; ++j) rows[i][j] -= factor * rows[k][j];
      rows[i][column] = 0;
    }
  }
  Kernel<Interval> result{};
  bool first = true;
  for (int free = 0; free < 6; ++free) {
    if (std::ranges::find(pivots, free) != pivots.end()) continue;
    Six<Interval>& x = first ? result.u : result.v;
    first = false;
    x.fill(0);
    x[free] = 1;
    for (int k = 0; k < 4; ++k) x[pivots[k]] = -rows[k][free];
  }
  return result;
}

/// direction . moment: zero for lines.  And its polar form, doubled.
template <class N>
N klein(const Six<N>& x) {
  return x[0] * x[3] + x[1] * x[4] + x[2] * x[5];
}
template <class N>
N klein(const Six<N>& x, const Six<N>& y) {
  return x[0] * y[3] + x[1] * y[4] + x[2] * y[5] + y[0] * x[3] + y[1] * x[4] +
         y[2] * x[5];
}

/// The line plain + root * sqrt(d).
struct SurdLine {
  Six<Integer> plain, root;
  Integer d;
};

int sign_at(const Six<Integer>& function, const SurdLine& line) {
  const Integer a = apply(function, line.plain);
  if (line.d == 0) return a.sign();
  const Integer b = apply(function, line.root);
  if (a.sign() == b.sign() || b == 0) return a.sign();
  if (a == 0) return b.sign();
  return a.sign() * Integer(a * a - b * b * line.d).sign();
}
/// 0 stands for unknown.
int sign_at(const Six<Interval>& function, const Six<Interval>& line) {
  const Interval x = apply(function, line);
  return x.inf() > 0 ? 1 : x.sup() < 0 ? -1 : 0;
}

/// Both lines that meet four lines; none where these are infinitely many or not real.
std::vector<SurdLine> transversals(const std::array<Six<Integer>, 4>& rows) {
  const auto kernel = kernel_of(rows);
  if (!kernel) return {};
  Six<Integer> u = kernel->u, v = kernel->v;
  if (klein(v) == 0) std::swap(u, v);
  // u + t v is a line where uu + uv t + vv t^2 = 0.
  const Integer uu = klein(u), vv = klein(v), uv = klein(u, v);
  if (vv == 0) {
    if (uv == 0) return {};
    return {SurdLine{u, {}, 0}, SurdLine{v, {}, 0}};
  }
  const Integer d = uv * uv - 4 * uu * vv;
  if (d < 0) return {};
  std::vector<SurdLine> result(2);
  for (int i = 0; i < 6; ++i) {
    result[0].plain[i] = 2 * vv * u[i] - uv * v[i];
    result[0].root[i] = v[i];
    result[1].plain[i] = result[0].plain[i];
    result[1].root[i] = -v[i];
  }
  result[0].d = result[1].d = d;
  return result;
}

/// The same in intervals; nullopt when the lines may be infinitely many.
std::optional<std::vector<Six<Interval>>> transversals(
    const std::array<Six<Interval>, 4>& rows) {
  const auto kernel = kernel_of(rows);
  if (!kernel) return std::nullopt;
  Six<Interval> u = kernel->u, v = kernel->v;
  const auto certain = [](const Interval& x) { return std::max(x.inf(), -x.sup()); };
  if (certain(klein(v)) < certain(klein(u))) std::swap(u, v);
  if (certain(klein(v)) <= 0) {
    for (int i = 0; i < 6; ++i) v[i] += u[i];
  }
  const Interval uu = klein(u), vv = klein(v), uv = klein(u, v);
  if (certain(vv) <= 0) return std::nullopt;
  const Interval d = uv * uv - Interval(4) * uu * vv;
  if (d.sup() < 0) return std::vector<Six<Interval>>{};
  std::vector<Six<Interval>> result(2);  // which the true ones, if any, are in
  const Interval root = CGAL::sqrt(Interval(std::max(0.0, d.inf()), d.sup()));
  for (int i = 0; i < 6; ++i) {
    const Interval plain = Interval(2) * vv * u[i] - uv * v[i];
    result[0][i] = plain + root * v[i];
    result[1][i] = plain - root * v[i];
  }
  return result;
}

/// A linear function of lines in both kinds of numbers.
struct Function {
  Six<Integer> exact;
  Six<Interval> interval;
};
const Six<Integer>& of_kind(const Function& f, const SurdLine&) { return f.exact; }
const Six<Interval>& of_kind(const Function& f, const Six<Interval>&) {
  return f.interval;
}

/// Times a positive number that makes all integers.
Six<Integer> integral(const Six<Rational>& x) {
  Integer scale = 1;
  for (const Rational& r : x) scale = lcm(scale, Integer(denominator(r)));
  Six<Integer> result;
  for (int i = 0; i < 6; ++i) {
    result[i] = Integer(numerator(x[i])) * (scale / Integer(denominator(x[i])));
  }
  return result;
}
Interval interval_of(const Rational& x) {
  // Conversion truncates or rounds: off by less than two units in the last place.
  const double d = x.convert_to<double>();
  return Interval(d) * Interval(1 - 0x1p-50, 1 + 0x1p-50) + Interval(-0x1p-900, 0x1p-900);
}
Function function_of(const Six<Rational>& x) {
  Function f{integral(x), {}};
  for (int i = 0; i < 6; ++i) f.interval[i] = interval_of(x[i]);
  return f;
}

Six<Rational> line_through(const Vec3& p, const Vec3& q) {
  const Vec3 d = q - p, m = cross(p, d);
  return {d[0], d[1], d[2], m[0], m[1], m[2]};
}
/// Zero for lines that meet pq; of one sign for lines that pass pq on one side.
Six<Rational> side_of(const Vec3& p, const Vec3& q) {
  const Six<Rational> l = line_through(p, q);
  return {l[3], l[4], l[5], l[0], l[1], l[2]};
}

// ---- The decision for polygons that avoid each other ----------------------------------

/// Vertices moved in the polygon's plane away from its middle (or towards it, inwards) by
/// between 1 and 2 times 2^-120 of their distance.
Polygon moved(const Polygon& polygon, int outwards, Random& random) {
  Vec3 middle{0, 0, 0};
  for (const Vec3& x : polygon) middle = middle + x;
  middle = Rational(Rational(1) / static_cast<int>(polygon.size())) * middle;
  const Rational unit = outwards * Rational(1) / Rational(Integer(1) << (120 + 16));
  Polygon result;
  for (const Vec3& x : polygon) {
    const Rational factor = unit * random.integer(1 << 16, 2 << 16);
    result.push_back(x + factor * (x - middle));
  }
  return result;
}

class Search {
 public:
  /// a and b have been cut so that occluders avoid them and each avoids the other's
  /// plane.
  Search(const ExactInstance& original, const Polygon& a, const Polygon& b,
         const std::vector<Polygon>& occluders, Random& random, NaiveVisibility& result)
      : original_(original), a_(a), b_(b), random_(random), result_(result) {
    a_plane_ = plane_of(a);
    b_plane_ = plane_of(b);
    const Vec3 &n = a_plane_.n, &k = b_plane_.n;
    a_speed_ = function_of({n[0], n[1], n[2], 0, 0, 0});
    b_speed_ = function_of({k[0], k[1], k[2], 0, 0, 0});
    ends_[0] = add(moved(a, -1, random));
    ends_[1] = add(moved(b, -1, random));
    const int side_of_b = beyond(a_plane_, 1, b, false) ? 1 : -1;
    const int side_of_a = beyond(b_plane_, 1, a, false) ? 1 : -1;
    for (const Polygon& o : occluders) {
      if (beyond(a_plane_, -side_of_b, o, false)) continue;  // behind a
      if (beyond(b_plane_, -side_of_a, o, false)) continue;
      const Polygon p = moved(o, 1, random);
      Blocker blocker{add(p), plane_of(p), {}, {}};
      blocker.at_a = height(blocker.plane, a_plane_);
      blocker.at_b = height(blocker.plane, b_plane_);
      blockers_.push_back(std::move(blocker));
    }
  }

  /// Fills in the witness, if there is one.  Undecided as soon as a line looks free and
  /// cannot be used.
  NaiveAnswer run() {
    const NaiveAnswer by_points = try_points();
    if (by_points != NaiveAnswer::Hidden) return by_points;
    const int n = static_cast<int>(edges_.size());
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        for (int k = j + 1; k < n; ++k) {
          for (int l = k + 1; l < n; ++l) {
            const NaiveAnswer answer = try_quadruple({i, j, k, l});
            if (answer != NaiveAnswer::Hidden) return answer;
          }
        }
      }
    }
    return NaiveAnswer::Hidden;
  }

 private:
  struct Edge {
    Vec3 p, q;
    Function side;
    int polygon;  // the number of its first edge
  };
  struct Range {
    int begin, end;  // of edges_
  };
  struct Blocker {
    Range edges;
    Plane plane;
    /// Height above the plane of the line's point in the plane of a, times a_speed_.
    Function at_a, at_b;
  };

  Range add(const Polygon& polygon) {
    const int begin = static_cast<int>(edges_.size());
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      edges_.push_back({p, q, function_of(side_of(p, q)), begin});
    }
    return {begin, static_cast<int>(edges_.size())};
  }

  /// A line (d, m) meets the plane n x = c in (n x m + c d) / (n d).
  static Function height(const Plane& above, const Plane& in) {
    const Vec3 of_d = in.c * above.n - above.c * in.n;
    const Vec3 of_m = cross(above.n, in.n);
    return function_of({of_d[0], of_d[1], of_d[2], of_m[0], of_m[1], of_m[2]});
  }

  /// Signs of the line against a polygon's edges: +-1 when all are known and equal, that
  /// is, when it crosses the interior; 2 when two differ for sure; else 0.
  template <class L>
  int passes(const Range& range, const L& line) const {
    bool negative = false, positive = false, unknown = false;
    for (int e = range.begin; e < range.end; ++e) {
      const int s = sign_at(of_kind(edges_[e].side, line), line);
      negative |= s < 0;
      positive |= s > 0;
      unknown |= s == 0;
      if (negative && positive) return 2;
    }
    return unknown ? 0 : negative ? -1 : 1;
  }

  /// Whether the line misses a or b or crosses an occluder's interior between them: for
  /// sure in intervals; exactly, in exact numbers.
  template <class L>
  bool refused(const L& line) const {
    if (passes(ends_[0], line) == 2 || passes(ends_[1], line) == 2) return true;
    const int a_speed = sign_at(of_kind(a_speed_, line), line);
    const int b_speed = sign_at(of_kind(b_speed_, line), line);
    return std::ranges::any_of(blockers_, [&](const Blocker& o) {
      const int crossing = passes(o.edges, line);
      if (crossing == 0 || crossing == 2) return false;
      return a_speed * sign_at(of_kind(o.at_a, line), line) * b_speed *
                 sign_at(of_kind(o.at_b, line), line) <
             0;
    });
  }

  NaiveAnswer try_quadruple(const std::array<int, 4>& q) {
    // Three edges of one polygon: only pencils in its plane.
    if (edges_[q[0]].polygon == edges_[q[2]].polygon ||
        edges_[q[1]].polygon == edges_[q[3]].polygon) {
      return NaiveAnswer::Hidden;
    }
    ++result_.quadruples;
    std::array<Six<Interval>, 4> intervals;
    for (int i = 0; i < 4; ++i) intervals[i] = edges_[q[i]].side.interval;
    if (const auto lines = transversals(intervals)) {
      const auto refused_surely = [&](const Six<Interval>& l) { return refused(l); };
      if (std::ranges::all_of(*lines, refused_surely)) return NaiveAnswer::Hidden;
    }
    ++result_.exact_quadruples;
    std::array<Six<Integer>, 4> rows;
    for (int i = 0; i < 4; ++i) rows[i] = edges_[q[i]].side.exact;
    for (const SurdLine& line : transversals(rows)) {
      const NaiveAnswer answer = try_line(line);
      if (answer != NaiveAnswer::Hidden) return answer;
    }
    return NaiveAnswer::Hidden;
  }

  /// Lines through two vertices or crossings of coplanar edges, and lines through one of
  /// these, in the plane of a blocker that contains it, through an edge.
  NaiveAnswer try_points() {
    std::vector<Vec3> points;
    for (const Edge& e : edges_) points.push_back(e.p);
    for (std::size_t i = 0; i < blockers_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        add_crossings(blockers_[i], blockers_[j], points);
    }
    const auto try_join = [&](const Vec3& p, const Vec3& q) {
      if (p == q) return NaiveAnswer::Hidden;
      return try_line({integral(line_through(p, q)), {}, 0});
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const NaiveAnswer answer = try_join(points[i], points[j]);
        if (answer != NaiveAnswer::Hidden) return answer;
      }
    }
    for (const Blocker& o : blockers_) {
      for (const Edge& e : edges_) {
        const Rational at_p = o.plane.at(e.p), at_q = o.plane.at(e.q);
        if (at_p == at_q) continue;
        const Vec3 x = e.p + Rational(at_p / (at_p - at_q)) * (e.q - e.p);
        for (const Vec3& p : points) {
          if (o.plane.at(p) != 0) continue;
          const NaiveAnswer answer = try_join(p, x);
          if (answer != NaiveAnswer::Hidden) return answer;
        }
      }
    }
    return NaiveAnswer::Hidden;
  }

  void add_crossings(const Blocker& o, const Blocker& k,
                     std::vector<Vec3>& points) const {
    for (int e = k.edges.begin; e < k.edges.end; ++e) {
      if (o.plane.at(edges_[e].p) != 0) return;
    }
    for (int i = o.edges.begin; i < o.edges.end; ++i) {
      for (int j = k.edges.begin; j < k.edges.end; ++j) {
        const Edge &e = edges_[i], &f = edges_[j];
        const Plane through_e{cross(o.plane.n, e.q - e.p),
                              dot(cross(o.plane.n, e.q - e.p), e.p)};
        const Rational at_p = through_e.at(f.p), at_q = through_e.at(f.q);
        if (at_p == at_q) continue;
        points.push_back(f.p + Rational(at_p / (at_p - at_q)) * (f.q - f.p));
      }
    }
  }

  /// Where the line, its root rounded, meets the plane: a point exactly in the plane.
  static std::optional<Vec3> rounded_point(const SurdLine& line, const Plane& plane) {
    constexpr int kBits = 2000;
    const Rational root = Rational(Integer(sqrt(Integer(line.d << (2 * kBits))))) /
                          Rational(Integer(1) << kBits);
    Six<Rational> l;
    for (int i = 0; i < 6; ++i) {
      l[i] = Rational(line.plain[i]) + Rational(line.root[i]) * root;
    }
    const Vec3 d{l[0], l[1], l[2]}, m{l[3], l[4], l[5]};
    const Rational speed = dot(plane.n, d);
    if (speed == 0) return std::nullopt;
    return Rational(1 / speed) * (cross(plane.n, m) + plane.c * d);
  }

  /// A point of the polygon's plane within about 2^-300 of x, moved by noise.
  static Vec3 near_point(const Vec3& x, const Polygon& polygon,
                         const std::array<Rational, 2>& noise) {
    const Vec3 u = polygon[1] - polygon[0], v = polygon[2] - polygon[0];
    const Vec3 n = cross(u, v), w = x - polygon[0];
    const Rational nn = dot(n, n);
    const auto rounded = [](const Rational& r) {
      const Integer scale = Integer(1) << 300;
      return Rational(Integer(numerator(r)) * scale / Integer(denominator(r))) /
             Rational(scale);
    };
    const Rational s = rounded(dot(n, cross(w, v)) / nn) + noise[0];
    const Rational t = rounded(dot(n, cross(u, w)) / nn) + noise[1];
    return polygon[0] + s * u + t * v;
  }

  NaiveAnswer try_line(const SurdLine& line) {
    if (refused(line)) return NaiveAnswer::Hidden;
    const auto p = rounded_point(line, a_plane_), q = rounded_point(line, b_plane_);
    if (!p || !q) return NaiveAnswer::Hidden;  // parallel to a or b, which it cannot be
    // The line is at least about 2^-120 away from whatever it does not lie in the plane
    // of; from those planes it is tilted by much less.
    const auto noise = [&](int i) {
      const auto one = [&] {
        return i == 0 ? Rational(0)
                      : Rational(random_.integer(-(1 << 20), 1 << 20)) /
                            Rational(Integer(1) << 200);
      };
      return std::array<Rational, 2>{one(), one()};
    };
    for (int i = 0; i < 64; ++i) {
      const Vec3 from = near_point(*p, a_, noise(i)), to = near_point(*q, b_, noise(i));
      if (!original_.is_free(from, to)) continue;
      result_.witness = {from, to};
      return NaiveAnswer::Visible;
    }
    return NaiveAnswer::Undecided;
  }

  const ExactInstance& original_;
  const Polygon &a_, &b_;
  Random& random_;
  NaiveVisibility& result_;
  Plane a_plane_, b_plane_;
  Function a_speed_, b_speed_;
  std::vector<Edge> edges_;
  std::array<Range, 2> ends_;
  std::vector<Blocker> blockers_;
};

// ---- The decision in a plane ----------------------------------------------------------

/// What an occluder leaves in the plane: itself, two ends, or nothing that matters.
Polygon trace_of(const Polygon& occluder, const Plane& plane) {
  if (beyond(plane, 1, occluder, false) && beyond(plane, -1, occluder, false)) {
    return occluder;
  }
  Polygon ends;
  for (std::size_t i = 0; i < occluder.size(); ++i) {
    const Vec3& p = occluder[i];
    const Vec3& q = occluder[(i + 1) % occluder.size()];
    const Rational at_p = plane.at(p), at_q = plane.at(q);
    if (at_p == 0) ends.push_back(p);
    if (at_p.sign() * at_q.sign() < 0) {
      ends.push_back(p + Rational(at_p / (at_p - at_q)) * (q - p));
    }
  }
  return ends.size() == 2 ? ends : Polygon{};
}

/// a and b are parts of one plane that no blocker meets but in their boundaries.
class PlanarSearch {
 public:
  PlanarSearch(const ExactInstance& original, const Polygon& a, const Polygon& b,
               const std::vector<Polygon>& blockers, Random& random,
               NaiveVisibility& result)
      : original_(original),
        normal_(normal_of(a)),
        whole_a_(a),
        whole_b_(b),
        a_(moved(a, -1, random)),
        b_(moved(b, -1, random)),
        random_(random),
        result_(result) {
    for (const Polygon& o : blockers) blockers_.push_back(moved(o, 1, random));
  }

  NaiveAnswer run() {
    Polygon common = whole_a_;
    for (std::size_t i = 0; i < whole_b_.size() && !common.empty(); ++i) {
      common = clipped(common, fence(whole_b_, normal_of(whole_b_), i), 1);
    }
    if (!common.empty()) {
      const Vec3 middle = middle_of(common);
      return tried(middle, Rational(1, 2) * (middle + common[0]));
    }
    Polygon points = a_;
    points.insert(points.end(), b_.begin(), b_.end());
    for (const Polygon& o : blockers_) points.insert(points.end(), o.begin(), o.end());
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (points[i] == points[j]) continue;
        const NaiveAnswer answer = try_line(points[j], points[i]);
        if (answer != NaiveAnswer::Hidden) return answer;
      }
    }
    return NaiveAnswer::Hidden;
  }

 private:
  static Vec3 middle_of(const Polygon& polygon) {
    Vec3 sum{0, 0, 0};
    for (const Vec3& x : polygon) sum = sum + x;
    return Rational(1, static_cast<int>(polygon.size())) * sum;
  }

  NaiveAnswer tried(const Vec3& p, const Vec3& q) {
    if (!original_.is_free(p, q)) return NaiveAnswer::Undecided;
    result_.witness = {p, q};
    return NaiveAnswer::Visible;
  }

  /// The middle of what of the polygon (or segment) is on the line; crossed: the line
  /// has some of it on either side.
  struct Meeting {
    Vec3 middle;
    bool crossed;
  };
  std::optional<Meeting> meeting(const Plane& line, const Polygon& polygon) const {
    Polygon on_line;
    bool left = false, right = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3& p = polygon[i];
      const Vec3& q = polygon[(i + 1) % polygon.size()];
      const Rational at_p = line.at(p), at_q = line.at(q);
      left |= at_p > 0;
      right |= at_p < 0;
      if (at_p == 0) on_line.push_back(p);
      if (at_p.sign() * at_q.sign() < 0) {
        on_line.push_back(p + Rational(at_p / (at_p - at_q)) * (q - p));
      }
    }
    if (on_line.empty()) return std::nullopt;
    return Meeting{middle_of(on_line), left && right};
  }

  NaiveAnswer try_line(const Vec3& x, const Vec3& y) {
    const Vec3 across = cross(normal_, y - x);
    const Plane line{across, dot(across, x)};
    const auto at_a = meeting(line, a_), at_b = meeting(line, b_);
    if (!at_a || !at_b) return NaiveAnswer::Hidden;
    for (const Polygon& o : blockers_) {
      const auto at_o = meeting(line, o);
      if (at_o && at_o->crossed &&
          dot(at_o->middle - at_a->middle, at_o->middle - at_b->middle) < 0) {
        return NaiveAnswer::Hidden;
      }
    }
    // Along a trace, the line must be tilted.
    NaiveAnswer answer = tried(at_a->middle, at_b->middle);
    for (int i = 0; i < 64 && answer == NaiveAnswer::Undecided; ++i) {
      const auto shift = [&] {
        return Rational(random_.integer(-(1 << 20), 1 << 20)) /
               Rational(Integer(1) << 200);
      };
      answer = tried(at_a->middle + shift() * across, at_b->middle + shift() * across);
    }
    return answer;
  }

  const ExactInstance& original_;
  Vec3 normal_;
  const Polygon &whole_a_, &whole_b_;
  Polygon a_, b_;
  std::vector<Polygon> blockers_;
  Random& random_;
  NaiveVisibility& result_;
};

}  // namespace

bool is_free(const VisibilityInstance& instance, const Vec3& p, const Vec3& q) {
  return ExactInstance(instance).is_free(p, q);
}

std::optional<ExactWitness> find_free_segment(const VisibilityInstance& instance,
                                              std::uint64_t seed, int n) {
  Random random(seed);
  return random_witness(ExactInstance(instance), random, n);
}

NaiveVisibility naive_visibility(const VisibilityInstance& instance) {
  const CGAL::Protect_FPU_rounding<true> upward;
  const ExactInstance original(instance);
  Random random(1);
  NaiveVisibility result{NaiveAnswer::Hidden, std::nullopt};
  const Polygon a = simplified(instance.a), b = simplified(instance.b);
  if (a.empty() || b.empty()) throw std::invalid_argument("a polygon without area");
  if ((result.witness = random_witness(original, random, 20))) {
    result.answer = NaiveAnswer::Visible;
    return result;
  }
  std::vector<Polygon> occluders;  // those without area block only a null set
  for (const auto& points : instance.occluders) {
    Polygon o = simplified(points);
    if (!o.empty()) occluders.push_back(std::move(o));
  }
  const Plane a_plane = plane_of(a), b_plane = plane_of(b);
  const bool planar = beyond(a_plane, 1, b, false) && beyond(a_plane, -1, b, false);
  std::vector<Polygon> traces;
  for (const Polygon& o : occluders) {
    Polygon trace = trace_of(o, a_plane);
    if (!trace.empty()) traces.push_back(std::move(trace));
  }
  const std::vector<Polygon> b_parts = parts_of(b, a_plane, occluders);
  for (const Polygon& a_part : parts_of(a, b_plane, occluders)) {
    for (const Polygon& b_part : b_parts) {
      const NaiveAnswer answer =
          planar ? PlanarSearch(original, a_part, b_part, traces, random, result).run()
                 : Search(original, a_part, b_part, occluders, random, result).run();
      if (answer == NaiveAnswer::Visible) {
        result.answer = answer;
        return result;
      }
      if (answer == NaiveAnswer::Undecided) result.answer = answer;
    }
  }
  return result;
}

}  // namespace sightline::testing
