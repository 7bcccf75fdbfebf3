#include "tests/support/naive_transversals.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

namespace sightline::testing {
namespace {

// Numbers a + b sqrt(root) with one root per line.
struct Surd {
  Rational a = 0, b = 0, root = 0;

  friend Rational common_root(const Surd& x, const Surd& y) {
    return x.b != 0 ? x.root : y.root;
  }
  friend Surd operator+(const Surd& x, const Surd& y) {
    return {x.a + y.a, x.b + y.b, common_root(x, y)};
  }
  friend Surd operator-(const Surd& x, const Surd& y) {
    return {x.a - y.a, x.b - y.b, common_root(x, y)};
  }
  friend Surd operator*(const Surd& x, const Surd& y) {
    const Rational root = common_root(x, y);
    return {x.a * y.a + x.b * y.b * root, x.a * y.b + x.b * y.a, root};
  }
  friend Surd inverse(const Surd& x) {
    const Rational norm = x.a * x.a - x.b * x.b * x.root;
    return {x.a / norm, -x.b / norm, x.root};
  }
  friend int sgn(const Surd& x) {
    const int a = x.a.sign(), b = x.root == 0 ? 0 : x.b.sign();
    if (b == 0 || a == b) return a;
    if (a == 0) return b;
    return a * Rational(x.a * x.a - x.b * x.b * x.root).sign();
  }
};

std::optional<Rational> rational_root(const Rational& x) {
  using boost::multiprecision::mpz_int;
  const mpz_int p = numerator(x), q = denominator(x);
  const mpz_int r = sqrt(p), s = sqrt(q);
  if (r * r != p || s * s != q) return std::nullopt;
  return Rational(r) / Rational(s);
}

/// A line by direction and moment (x times direction, for any x on it).
template <class T>
struct Pluecker {
  Vec<T> d, m;
};
using Line = Pluecker<Rational>;

Line line_of(const ExactSegment& s) {
  const Vec3 d = s.b - s.a;
  return {d, cross(s.a, d)};
}
Rational side(const Line& k, const Line& l) { return dot(k.d, l.m) + dot(l.d, k.m); }
bool same_line(const Line& k, const Line& l) {
  return is_zero(cross(k.d, l.d)) && is_zero(k.d[0] * l.m - l.d[0] * k.m) &&
         is_zero(k.d[1] * l.m - l.d[1] * k.m) && is_zero(k.d[2] * l.m - l.d[2] * k.m);
}
Line combination(const Rational& x, const Line& u, const Rational& y, const Line& v) {
  return {x * u.d + y * v.d, x * u.m + y * v.m};
}

Pluecker<Surd> with_surds(const Line& l) {
  const auto lift = [](const Vec3& v) {
    return Vec<Surd>{Surd{v[0]}, Surd{v[1]}, Surd{v[2]}};
  };
  return {lift(l.d), lift(l.m)};
}

/// Zero exactly when x is on the line; linear along a segment.
template <class T>
Vec<T> off_line(const Vec<T>& x, const Pluecker<T>& l) {
  return cross(x, l.d) - l.m;
}

/// Whether the line meets the closed segment: some point between a and b has off_line
/// zero, that is, the values at a and b are antiparallel or one of them is zero.
bool meets(const Line& l, const ExactSegment& s) {
  if (is_zero(l.d)) return false;  // at infinity
  const Vec3 a = off_line(s.a, l), b = off_line(s.b, l);
  return is_zero(cross(a, b)) && sgn(dot(a, b)) <= 0;
}
bool meets(const Pluecker<Surd>& l, const ExactSegment& s) {
  const auto lift = [](const Vec3& v) {
    return Vec<Surd>{Surd{v[0]}, Surd{v[1]}, Surd{v[2]}};
  };
  if (is_zero(l.d)) return false;
  const Vec<Surd> a = off_line(lift(s.a), l), b = off_line(lift(s.b), l);
  return is_zero(cross(a, b)) && sgn(dot(a, b)) <= 0;
}
template <class L>
bool meets_all(const L& l, std::span<const ExactSegment> q) {
  return std::ranges::all_of(q, [&](const ExactSegment& s) { return meets(l, s); });
}

CanonicalLine canonical(const Pluecker<Surd>& l) {
  std::array<Surd, 6> x = {l.d[0], l.d[1], l.d[2], l.m[0], l.m[1], l.m[2]};
  const auto first = std::ranges::find_if(x, [](const Surd& v) { return sgn(v) != 0; });
  const Surd scale = inverse(*first);
  CanonicalLine result;
  for (int i = 0; i < 6; ++i) {
    const Surd v = x[i] * scale;
    const Rational square = v.b * v.b * v.root;
    if (const auto root = rational_root(square)) {
      result[i] = {v.a + Rational(v.b.sign()) * *root, 0};
    } else {
      result[i] = {v.a, Rational(v.b.sign()) * square};
    }
  }
  return result;
}
CanonicalLine canonical(const Line& l) { return canonical(with_surds(l)); }

/// A point or, with w = 0, a direction.
struct Homogeneous {
  Vec3 x;
  Rational w;
};
Line join(const Homogeneous& p, const Vec3& q) {
  const Vec3 d = p.w * q - p.x;
  return {d, cross(q, d)};
}

/// A plane n x = c.
struct PlaneOf {
  Vec3 n;
  Rational c;
};

/// Rows (m, d): the lines l with all side(l, row) = 0 are the kernel.
struct Elimination {
  std::vector<int> independent;  ///< indices of rows
  std::vector<Line> kernel;
};
Elimination eliminate(std::span<const Line> lines) {
  Elimination result;
  std::vector<std::array<Rational, 6>> rows;  // reduced, pivot 1
  std::vector<int> pivots;
  for (int i = 0; i < static_cast<int>(lines.size()); ++i) {
    const Line& l = lines[i];
    std::array<Rational, 6> row = {l.m[0], l.m[1], l.m[2], l.d[0], l.d[1], l.d[2]};
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const Rational f = row[pivots[k]];
      for (int j = 0; j < 6; ++j) row[j] -= f * rows[k][j];
    }
    const auto pivot = std::ranges::find_if(row, [](const auto& x) { return x != 0; });
    if (pivot == row.end()) continue;
    const int column = static_cast<int>(pivot - row.begin());
    const Rational f = *pivot;
    for (Rational& x : row) x /= f;
    for (auto& other : rows) {
      const Rational g = other[column];
      for (int j = 0; j < 6; ++j) other[j] -= g * row[j];
    }
    rows.push_back(row);
    pivots.push_back(column);
    result.independent.push_back(i);
  }
  for (int free = 0; free < 6; ++free) {
    if (std::ranges::find(pivots, free) != pivots.end()) continue;
    std::array<Rational, 6> x{};
    x[free] = 1;
    for (std::size_t k = 0; k < rows.size(); ++k) x[pivots[k]] = -rows[k][free];
    result.kernel.push_back({{x[0], x[1], x[2]}, {x[3], x[4], x[5]}});
  }
  return result;
}

/// One irreducible component of the transversals of the *lines* of Q, and what of it
/// meets the segments.
struct Component {
  /// Members that are isolated within this component.
  std::vector<Line> candidates;
  /// Whether a member of T(Q) lies in this component and is not isolated there.
  std::function<bool(const Line&)> in_family = [](const Line&) { return false; };
  std::optional<NaiveFamily> family;
};

/// A one-parameter family: line(t) for t in [-inf, inf], which stand for the same line.
/// Critical are all t at which the line passes an end of a segment.
Component curve(NaiveFamilyKind kind, std::span<const ExactSegment> q,
                std::vector<Rational> critical,
                const std::function<Line(const Rational&)>& line_at,
                const Line& at_infinity,
                const std::function<std::optional<Rational>(const Line&)>& parameter) {
  std::ranges::sort(critical);
  critical.erase(std::unique(critical.begin(), critical.end()), critical.end());
  // Gap i lies before critical[i]; gap 0 and the last are separated by infinity.
  std::vector<bool> gap;
  const auto member = [&](const Rational& t) { return meets_all(line_at(t), q); };
  if (critical.empty()) critical.push_back(0);
  gap.push_back(member(critical.front() - 1));
  for (std::size_t i = 1; i < critical.size(); ++i) {
    gap.push_back(member((critical[i - 1] + critical[i]) / 2));
  }
  gap.push_back(member(critical.back() + 1));
  Component result;
  const bool any = std::ranges::find(gap, true) != gap.end();
  if (any) result.family = NaiveFamily{1, kind};
  for (std::size_t i = 0; i < critical.size(); ++i) {
    if (!gap[i] && !gap[i + 1] && member(critical[i])) {
      result.candidates.push_back(line_at(critical[i]));
    }
  }
  if (!gap.front() && !gap.back() && meets_all(at_infinity, q)) {
    result.candidates.push_back(at_infinity);
  }
  result.in_family = [=](const Line& l) {
    if (same_line(l, at_infinity)) return gap.front() || gap.back();
    const std::optional<Rational> t = parameter(l);
    if (!t) return false;
    const auto i = std::ranges::lower_bound(critical, *t) - critical.begin();
    const bool at = i < static_cast<std::ptrdiff_t>(critical.size()) && critical[i] == *t;
    return gap[i] || (at && gap[i + 1]);
  };
  return result;
}

/// t with x + t y = 0, if there is exactly one.
std::optional<Rational> common_zero(const Vec3& x, const Vec3& y) {
  if (is_zero(y) || !is_zero(cross(x, y))) return std::nullopt;
  const int i = y[0] != 0 ? 0 : y[1] != 0 ? 1 : 2;
  return -x[i] / y[i];
}

/// The pencil of u + t v; v for t = infinity.
Component pencil(const Line& u, const Line& v, std::span<const ExactSegment> q) {
  std::vector<Rational> critical;
  for (const ExactSegment& s : q) {
    for (const Vec3& e : {s.a, s.b}) {
      if (const auto t = common_zero(off_line(e, u), off_line(e, v))) {
        critical.push_back(*t);
      }
    }
  }
  return curve(
      NaiveFamilyKind::Pencil, q, critical,
      [=](const Rational& t) { return combination(1, u, t, v); }, v,
      [=](const Line& l) -> std::optional<Rational> {
        // u + t v proportional to l: all two-by-two determinants with l vanish.
        const auto entry = [](const Line& k, int i) {
          return i < 3 ? k.d[i] : k.m[i - 3];
        };
        for (int i = 0; i < 6; ++i) {
          for (int j = 0; j < i; ++j) {
            const Rational of_v = entry(v, i) * entry(l, j) - entry(v, j) * entry(l, i);
            const Rational of_u = entry(u, i) * entry(l, j) - entry(u, j) * entry(l, i);
            if (of_v == 0) continue;
            const Rational t = -of_u / of_v;
            if (same_line(combination(1, u, t, v), l)) return t;
            return std::nullopt;
          }
        }
        return std::nullopt;
      });
}

/// The lines that meet three skew lines a, b, c, by the point a0 + t (a1 - a0).
Component regulus(const ExactSegment& a, const Line& b, const Line& c,
                  std::span<const ExactSegment> q) {
  const Line la = line_of(a);
  const auto normal = [](const Vec3& p, const Line& l) { return cross(p, l.d) - l.m; };
  const auto line_at = [=](const Rational& t) {
    const Vec3 p = a.a + t * la.d;
    const Vec3 d = cross(normal(p, b), normal(p, c));
    return Line{d, cross(p, d)};
  };
  const auto parameter_on_a = [=](const Vec3& p) -> std::optional<Rational> {
    return common_zero(a.a - p, la.d);
  };
  std::vector<Rational> critical;
  for (const ExactSegment& s : q) {
    for (const Vec3& e : {s.a, s.b}) {
      if (is_zero(off_line(e, la))) {
        critical.push_back(*parameter_on_a(e));
        continue;
      }
      // The ruling through e lies in its plane with b or, if e is on b, with c.
      const Vec3 n = is_zero(off_line(e, b)) ? normal(e, c) : normal(e, b);
      const Rational slope = dot(n, la.d);
      if (slope != 0) critical.push_back(dot(n, e - a.a) / slope);
    }
  }
  // The ruling for t = infinity does not meet the segment a; any line at infinity will
  // do.
  const Line none{{0, 0, 0}, {1, 0, 0}};
  return curve(NaiveFamilyKind::Regulus, q, critical, line_at, none,
               [=](const Line& l) -> std::optional<Rational> {
                 const Vec3 x = cross(a.a, l.d) - l.m, y = cross(la.d, l.d);
                 const auto t = common_zero(x, y);
                 if (t && same_line(line_at(*t), l)) return t;
                 return std::nullopt;
               });
}

/// All lines through p.  The lines of all segments pass through p.
Component star(const Homogeneous& p, std::span<const ExactSegment> q) {
  Component result;
  if (p.w == 0) return result;  // only the segments' own lines, which differ
  const Vec3 x = (1 / p.w) * p.x;
  const auto has_x = [&](const ExactSegment& s) {
    const Vec3 u = s.a - x, v = s.b - x;
    return sgn(dot(u, v)) <= 0;
  };
  if (std::ranges::all_of(q, has_x)) {
    result.family = NaiveFamily{2, NaiveFamilyKind::Star};
    result.in_family = [=](const Line& l) { return is_zero(off_line(x, l)); };
    return result;
  }
  for (const ExactSegment& s : q) {
    if (meets_all(line_of(s), q)) result.candidates.push_back(line_of(s));
  }
  return result;
}

/// How the lines of the plane near l that meet all segments fill the plane's lines: 0
/// only l itself, 1 or 2 the dimension.  Nearby lines leave l by a linear function of the
/// position x along it; an end of a segment on l allows one sign of that function there
/// and a segment inside l two different ones at its ends.
int dimension_near(const Line& l, const PlaneOf& plane, std::span<const ExactSegment> q) {
  struct Condition {
    Rational x, y;
    int sign;  // of the function at x; 0: different signs at x and y
  };
  std::vector<Condition> conditions;
  std::vector<Rational> roots;
  for (const ExactSegment& s : q) {
    const int a = sgn(dot(off_line(s.a, l), plane.n));
    const int b = sgn(dot(off_line(s.b, l), plane.n));
    if (a != 0 && b != 0) continue;
    if (a == 0) roots.push_back(dot(l.d, s.a));
    if (b == 0) roots.push_back(dot(l.d, s.b));
    conditions.push_back({dot(l.d, a == 0 ? s.a : s.b), dot(l.d, s.b), a + b});
  }
  if (conditions.empty()) return 2;
  std::ranges::sort(roots);
  const std::size_t n = roots.size();
  for (std::size_t i = 1; i < n; ++i) roots.push_back((roots[i - 1] + roots[i]) / 2);
  roots.push_back(roots[0] - 1);
  roots.push_back(roots[n - 1] + 1);
  int best = 0;
  for (const Rational& root : roots) {
    for (const int orientation : {-1, 1}) {
      bool weak = true, strict = true;
      for (const Condition& c : conditions) {
        const int at_x = orientation * sgn(c.x - root);
        const int at_y = orientation * sgn(c.y - root);
        const int value = c.sign != 0 ? c.sign * at_x : -at_x * at_y;
        weak &= value >= 0;
        strict &= value > 0;
      }
      if (strict) return 2;
      if (weak) best = 1;
    }
  }
  return best;
}

/// All lines in a plane that holds all segments.
Component in_plane(const PlaneOf& plane, std::span<const ExactSegment> q) {
  std::vector<Vec3> ends;
  for (const ExactSegment& s : q) {
    ends.push_back(s.a);
    ends.push_back(s.b);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  Component result;
  int dimension = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Line l = line_of({ends[i], ends[j]});
      if (!meets_all(l, q)) continue;
      const int here = dimension_near(l, plane, q);
      dimension = std::max(dimension, here);
      if (here == 0) result.candidates.push_back(l);
    }
  }
  if (dimension > 0) result.family = NaiveFamily{dimension, NaiveFamilyKind::Plane};
  const std::vector<ExactSegment> copy(q.begin(), q.end());
  result.in_family = [=](const Line& l) {
    // The point (d x m) / dd of the line l is in the plane.
    return dot(l.d, plane.n) == 0 &&
           dot(plane.n, cross(l.d, l.m)) == plane.c * dot(l.d, l.d) &&
           meets_all(l, copy) && dimension_near(l, plane, copy) > 0;
  };
  return result;
}

/// The common piece of all segments of q that lie on l.
std::optional<ExactSegment> common_piece(const Line& l, std::span<const ExactSegment> q) {
  std::optional<ExactSegment> piece;
  const auto later = [&](const Vec3& x, const Vec3& y) {
    return dot(l.d, x) > dot(l.d, y);
  };
  for (const ExactSegment& s : q) {
    if (!same_line(line_of(s), l)) continue;
    const bool forward = later(s.b, s.a);
    const Vec3& lo = forward ? s.a : s.b;
    const Vec3& hi = forward ? s.b : s.a;
    if (!piece) piece = ExactSegment{lo, hi};
    if (later(lo, piece->a)) piece->a = lo;
    if (later(piece->b, hi)) piece->b = hi;
  }
  if (!piece || later(piece->a, piece->b)) return std::nullopt;
  return piece;
}

Component congruence(const Line& a, const Line& b, std::span<const ExactSegment> q) {
  const auto on_a = common_piece(a, q), on_b = common_piece(b, q);
  Component result;
  if (!on_a || !on_b) return result;
  const int dimension = (on_a->a != on_a->b) + (on_b->a != on_b->b);
  if (dimension == 0) {
    result.candidates.push_back(line_of({on_a->a, on_b->a}));
  } else {
    result.family = NaiveFamily{dimension, NaiveFamilyKind::Congruence};
  }
  return result;
}

Component complex(const Line& a, std::span<const ExactSegment> q) {
  const auto piece = common_piece(a, q);
  Component result;
  if (!piece) {
    result.candidates.push_back(a);
  } else if (piece->a == piece->b) {
    result.family = NaiveFamily{2, NaiveFamilyKind::Star};
  } else {
    result.family = NaiveFamily{3, NaiveFamilyKind::Complex};
  }
  return result;
}

/// Where two different coplanar lines meet.
Homogeneous intersection(const ExactSegment& a, const ExactSegment& b) {
  const Vec3 d = a.b - a.a, e = b.b - b.a;
  if (is_zero(cross(d, e))) return {d, 0};
  const Rational s = *common_zero(cross(a.a - b.a, e), cross(d, e));
  return {a.a + s * d, 1};
}
/// The plane of two different coplanar lines.
PlaneOf plane_of(const ExactSegment& a, const ExactSegment& b) {
  Vec3 n = cross(a.b - a.a, b.b - b.a);
  if (is_zero(n)) n = cross(a.b - a.a, b.a - a.a);
  return {n, dot(n, a.a)};
}
bool contains(const PlaneOf& plane, const ExactSegment& s) {
  return dot(plane.n, s.a) == plane.c && dot(plane.n, s.b) == plane.c;
}

/// Two different lines among those that join p to the points.
Component pencil_through(const Homogeneous& p, std::initializer_list<Vec3> points,
                         std::span<const ExactSegment> q) {
  std::optional<Line> first;
  for (const Vec3& x : points) {
    const Line l = join(p, x);
    if (is_zero(l.d)) continue;
    if (!first) {
      first = l;
    } else if (!same_line(*first, l)) {
      return pencil(*first, l, q);
    }
  }
  throw std::logic_error("no pencil");
}

/// Components for three independent lines (the fourth depends on them).
std::vector<Component> components_of_three(ExactSegment a, ExactSegment b, ExactSegment c,
                                           std::span<const ExactSegment> q) {
  const auto meet = [](const ExactSegment& x, const ExactSegment& y) {
    return side(line_of(x), line_of(y)) == 0;
  };
  const int pairs = meet(a, b) + meet(b, c) + meet(c, a);
  if (pairs == 0) return {regulus(a, line_of(b), line_of(c), q)};
  if (!meet(a, b)) std::swap(meet(b, c) ? a : b, c);
  const Homogeneous p = intersection(a, b);
  const PlaneOf plane = plane_of(a, b);
  if (pairs == 3) {
    if (contains(plane, c)) return {in_plane(plane, q)};
    return {star(p, q)};
  }
  const Vec3 d = c.b - c.a;
  const Rational slope = dot(plane.n, d);
  const Homogeneous on_plane =
      slope == 0 ? Homogeneous{d, 0}
                 : Homogeneous{c.a + ((plane.c - dot(plane.n, c.a)) / slope) * d, 1};
  return {pencil_through(p, {c.a, c.b}, q),
          pencil_through(on_plane, {a.a, a.b, b.a, b.b}, q)};
}

/// A line's numbers as Surds; the roots of a canonical line have rational ratios.
Pluecker<Surd> with_surds(const CanonicalLine& line) {
  Rational root = 0;
  for (const QuadraticNumber& x : line) {
    if (x.w != 0) root = abs(x.w);
  }
  std::array<Surd, 6> s;
  for (int i = 0; i < 6; ++i) {
    s[i].a = line[i].x;
    if (line[i].w == 0) continue;
    s[i].b = Rational(line[i].w.sign()) * *rational_root(abs(line[i].w) / root);
    s[i].root = root;
  }
  return {{s[0], s[1], s[2]}, {s[3], s[4], s[5]}};
}

}  // namespace

bool meets(const CanonicalLine& line, const ExactSegment& s) {
  return meets(with_surds(line), s);
}

QuadrupleTransversals naive_quadruple(std::span<const ExactSegment> q) {
  std::vector<Line> lines;
  for (const ExactSegment& s : q) lines.push_back(line_of(s));
  const auto [independent, kernel] = eliminate(lines);
  QuadrupleTransversals result;
  std::vector<Component> components;
  if (independent.size() == 4) {
    // The null vectors u + t v, or v, of the kernel.
    Line u = kernel[0], v = kernel[1];
    if (dot(v.d, v.m) == 0) std::swap(u, v);
    const Rational uu = dot(u.d, u.m), vv = dot(v.d, v.m), uv = side(u, v) / 2;
    if (uu == 0 && vv == 0 && uv == 0) {
      components.push_back(pencil(u, v, q));
    } else if (vv == 0) {  // then uu == 0, too
      for (const Line& l : {u, v}) {
        if (meets_all(l, q)) result.isolated.insert(canonical(l));
      }
    } else {
      const Rational discriminant = uv * uv - uu * vv;
      if (discriminant < 0) return result;
      const auto root = rational_root(discriminant);
      const Pluecker<Surd> su = with_surds(u), sv = with_surds(v);
      for (const int sign : {-1, 1}) {
        const Rational factor = Rational(sign) / vv;
        const Surd t =
            root ? Surd{-uv / vv + factor * *root} : Surd{-uv / vv, factor, discriminant};
        const Pluecker<Surd> l{su.d + t * sv.d, su.m + t * sv.m};
        if (meets_all(l, q)) result.isolated.insert(canonical(l));
      }
    }
  } else if (independent.size() == 3) {
    components =
        components_of_three(q[independent[0]], q[independent[1]], q[independent[2]], q);
  } else if (independent.size() == 2) {
    const ExactSegment &a = q[independent[0]], &b = q[independent[1]];
    if (side(line_of(a), line_of(b)) != 0) {
      components.push_back(congruence(line_of(a), line_of(b), q));
    } else {
      components.push_back(star(intersection(a, b), q));
      components.push_back(in_plane(plane_of(a, b), q));
    }
  } else {
    components.push_back(complex(lines[0], q));
  }
  for (const Component& c : components) {
    if (c.family) result.families.insert(*c.family);
    for (const Line& l : c.candidates) {
      if (std::ranges::none_of(components,
                               [&](const Component& o) { return o.in_family(l); })) {
        result.isolated.insert(canonical(l));
      }
    }
  }
  return result;
}

NaiveTransversals naive_transversals(std::span<const ExactSegment> segments) {
  const int n = static_cast<int>(segments.size());
  std::map<CanonicalLine, std::set<int>> found;
  NaiveTransversals result;
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        for (int l = k + 1; l < n; ++l) {
          const std::array q = {segments[i], segments[j], segments[k], segments[l]};
          const QuadrupleTransversals t = naive_quadruple(q);
          result.families.insert(t.families.begin(), t.families.end());
          for (const CanonicalLine& line : t.isolated) found[line].insert({i, j, k, l});
        }
      }
    }
  }
  for (auto& [line, met] : found) {
    for (int i = 0; i < n; ++i) {
      if (!met.contains(i) && meets(line, segments[i])) met.insert(i);
    }
    result.lines.push_back({line, {met.begin(), met.end()}});
  }
  return result;
}

}  // namespace sightline::testing
