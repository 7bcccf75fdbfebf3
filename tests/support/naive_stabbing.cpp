#include "tests/support/naive_stabbing.h"

#include <CGAL/Gmpq.h>
#include <CGAL/Sqrt_extension.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace sightline::testing {
namespace {

using Q = CGAL::Gmpq;
using X = CGAL::Sqrt_extension<Q, Q>;
template <class T>
using Vec = std::array<T, 3>;
using Row = std::array<Q, 6>;  // Pluecker coordinates of a line: direction, moment
using Line = std::array<X, 6>;

template <class T, class U>
auto cross(const Vec<T>& u, const Vec<U>& v) {
  using R = decltype(u[0] * v[0]);
  return Vec<R>{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                u[0] * v[1] - u[1] * v[0]};
}
template <class T, class U>
auto dot(const Vec<T>& u, const Vec<U>& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}
template <class T>
Vec<T> minus(const Vec<T>& u, const Vec<T>& v) {
  return {u[0] - v[0], u[1] - v[1], u[2] - v[2]};
}
Vec<Q> exact(const Eigen::Vector3d& p) { return {Q(p.x()), Q(p.y()), Q(p.z())}; }
Vec<X> extended(const Vec<Q>& p) { return {X(p[0]), X(p[1]), X(p[2])}; }
template <class T>
bool zero(const Vec<T>& v) {
  return v[0] == T(0) && v[1] == T(0) && v[2] == T(0);
}

Row joining(const Vec<Q>& p, const Vec<Q>& q) {
  const Vec<Q> d = minus(q, p), m = cross(p, q);
  return {d[0], d[1], d[2], m[0], m[1], m[2]};
}
void add_star(std::vector<Row>& rows, const Vec<Q>& p) {
  for (int k = 0; k < 3; ++k) {
    Vec<Q> q = p;
    q[k] = q[k] + Q(1);
    rows.push_back(joining(p, q));
  }
}

/// A basis of { l : the permuted inner product of l with every row is 0 }.
std::vector<Row> complement(std::vector<Row> rows) {
  std::array<int, 6> pivot_row;
  pivot_row.fill(-1);
  std::size_t rank = 0;
  for (int column = 0; column < 6; ++column) {
    std::size_t r = rank;
    while (r < rows.size() && rows[r][column] == Q(0)) ++r;
    if (r == rows.size()) continue;
    std::swap(rows[rank], rows[r]);
    const Q scale = rows[rank][column];
    for (Q& x : rows[rank]) x = x / scale;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (i == rank || rows[i][column] == Q(0)) continue;
      const Q factor = rows[i][column];
      for (int k = 0; k < 6; ++k) rows[i][k] = rows[i][k] - factor * rows[rank][k];
    }
    pivot_row[column] = static_cast<int>(rank++);
  }
  std::vector<Row> basis;
  for (int column = 0; column < 6; ++column) {
    if (pivot_row[column] >= 0) continue;
    Row v;
    v.fill(Q(0));
    v[column] = Q(1);
    for (int k = 0; k < 6; ++k) {
      if (pivot_row[k] >= 0) v[k] = -rows[pivot_row[k]][column];
    }
    // Rows multiplied (moment, direction); turn round to (direction, moment).
    basis.push_back({v[3], v[4], v[5], v[0], v[1], v[2]});
  }
  return basis;
}

Q form(const Row& a, const Row& b) {
  Q sum(0);
  for (int k = 0; k < 3; ++k) sum = sum + a[k] * b[3 + k] + a[3 + k] * b[k];
  return sum;
}

/// Isolated common transversals.
std::vector<Line> isolated(const std::vector<Row>& rows) {
  const std::vector<Row> w = complement(rows);
  std::vector<Line> out;
  const auto add = [&](const X& s, const X& t) {
    Line l;
    for (int k = 0; k < 6; ++k) l[k] = s * X(w[0][k]) + t * X(w[1][k]);
    out.push_back(l);
  };
  if (w.size() == 1 && form(w[0], w[0]) == Q(0)) {
    Line l;
    for (int k = 0; k < 6; ++k) l[k] = X(w[0][k]);
    out.push_back(l);
  }
  if (w.size() != 2) return out;
  // a s^2 + 2 b s t + c t^2 = 0
  const Q a = form(w[0], w[0]), b = form(w[0], w[1]), c = form(w[1], w[1]);
  if (a == Q(0)) {
    if (b == Q(0) && c == Q(0)) return out;
    add(X(1), X(0));
    if (b != Q(0)) add(X(-c), X(2 * b));
    return out;
  }
  const Q d = b * b - a * c;
  if (d < Q(0)) return out;
  if (d == Q(0)) {
    add(X(-b), X(a));
    return out;
  }
  add(X(-b, Q(1), d), X(a));
  add(X(-b, Q(-1), d), X(a));
  return out;
}

bool isolates(const std::vector<Row>& rows) {
  const std::vector<Row> w = complement(rows);
  if (w.size() == 1) return true;
  if (w.size() != 2) return false;
  return form(w[0], w[0]) != Q(0) || form(w[0], w[1]) != Q(0) || form(w[1], w[1]) != Q(0);
}

struct Touch {
  X at;
  bool vertex;
  int portal, index;
};
struct Meeting {
  X first, last;
  bool in_plane = false;
  bool along = false;
};

struct Scene {
  std::vector<std::vector<Vec<Q>>> portals;

  [[nodiscard]] int edges(int i) const {
    const int n = static_cast<int>(portals[i].size());
    return n < 3 ? n - 1 : n;
  }
  [[nodiscard]] const Vec<Q>& corner(int i, int k) const {
    return portals[i][static_cast<std::size_t>(k) % portals[i].size()];
  }
  [[nodiscard]] Row edge(int i, int k) const {
    return joining(corner(i, k), corner(i, k + 1));
  }
  [[nodiscard]] bool polygon(int i) const { return portals[i].size() > 2; }
  [[nodiscard]] Vec<Q> normal(int i) const {
    return cross(minus(corner(i, 1), corner(i, 0)), minus(corner(i, 2), corner(i, 0)));
  }
};

/// Position of points along the line, the foot of the perpendicular being computed first.
struct Ruler {
  Vec<X> d, m, foot;
  X square;

  explicit Ruler(const Line& l) : d{l[0], l[1], l[2]}, m{l[3], l[4], l[5]} {
    square = dot(d, d);
    foot = cross(d, m);
    for (X& x : foot) x = x / square;
  }
  [[nodiscard]] Vec<X> point(const X& t) const {
    return {foot[0] + t * d[0], foot[1] + t * d[1], foot[2] + t * d[2]};
  }
  [[nodiscard]] X parameter(const Vec<X>& p) const { return dot(p, d) / square; }
  [[nodiscard]] bool has(const Vec<X>& p) const { return zero(minus(cross(p, d), m)); }
};

/// The common point of the line and a segment when it is one; nullopt also when the
/// segment lies along the line.
std::optional<X> on_segment(const Ruler& r, const Vec<Q>& a, const Vec<Q>& b) {
  const Vec<X> ab = extended(minus(b, a));
  const Vec<X> n = cross(ab, r.d);
  const Vec<X> off = minus(r.m, cross(extended(a), r.d));
  if (zero(n) || !zero(cross(n, off))) return std::nullopt;
  if (zero(minus(r.m, cross(extended(a), r.d)))) return r.parameter(extended(a));
  int k = 0;
  while (n[k] == X(0)) ++k;
  const X s = off[k] / n[k];
  // coplanar and not parallel: off must be a multiple of n
  for (int i = 0; i < 3; ++i) {
    if (off[i] != s * n[i]) return std::nullopt;
  }
  if (s < X(0) || s > X(1)) return std::nullopt;
  Vec<X> p = extended(a);
  for (int i = 0; i < 3; ++i) p[i] = p[i] + s * ab[i];
  return r.parameter(p);
}

std::optional<Meeting> meet(const Scene& scene, int i, const Ruler& r,
                            std::vector<Touch>& touches) {
  const int corners = static_cast<int>(scene.portals[i].size());
  std::vector<X> places;
  for (int k = 0; k < corners; ++k) {
    const Vec<X> v = extended(scene.corner(i, k));
    if (!r.has(v)) continue;
    places.push_back(r.parameter(v));
    touches.push_back({places.back(), true, i, k});
  }
  const int at_corners = static_cast<int>(places.size());
  for (int k = 0; k < scene.edges(i); ++k) {
    const auto at = on_segment(r, scene.corner(i, k), scene.corner(i, k + 1));
    if (!at) continue;
    if (std::ranges::any_of(places, [&](const X& x) { return x == *at; })) continue;
    places.push_back(*at);
    touches.push_back({*at, false, i, k});
  }
  Meeting m;
  m.along = !scene.polygon(i) && at_corners == 2;
  if (scene.polygon(i)) {
    const Vec<X> n = extended(scene.normal(i));
    const X slope = dot(n, r.d);
    const X off = dot(n, extended(scene.corner(i, 0))) - dot(n, r.foot);
    m.in_plane = slope == X(0) && off == X(0);
    if (slope != X(0) && places.empty()) {
      const X t = off / slope;
      const Vec<X> p = r.point(t);
      for (int k = 0; k < corners; ++k) {
        const Vec<X> a = extended(scene.corner(i, k));
        const Vec<X> b = extended(scene.corner(i, k + 1));
        if (dot(cross(minus(b, a), minus(p, a)), n) < X(0)) return std::nullopt;
      }
      places.push_back(t);
    }
  }
  if (places.empty()) return std::nullopt;
  m.first = *std::ranges::min_element(places);
  m.last = *std::ranges::max_element(places);
  return m;
}

/// Whether the open polygons, in different planes, have a common point: their planes'
/// common line is clipped by both.
bool interiors_cross(const Scene& s, int i, int j) {
  const bool pi = s.polygon(i), pj = s.polygon(j);
  if (!pi && !pj) return false;
  if (s.portals[i].size() == 1 || s.portals[j].size() == 1) return false;
  Vec<Q> p, d;
  Q low(-1000000), high(1000000);
  const auto clip = [&](int k) {
    const Vec<Q> n = s.normal(k);
    for (int e = 0; e < s.edges(k); ++e) {
      const Vec<Q> inward = cross(n, minus(s.corner(k, e + 1), s.corner(k, e)));
      const Q at = dot(inward, minus(p, s.corner(k, e)));
      const Q slope = dot(inward, d);
      if (slope == Q(0)) {
        if (at <= Q(0)) return false;
      } else if (slope > Q(0)) {
        low = std::max(low, Q(-at / slope));
      } else {
        high = std::min(high, Q(-at / slope));
      }
    }
    return low < high;
  };
  if (!pi || !pj) {
    const int slit = pi ? j : i, poly = pi ? i : j;
    const Vec<Q> n = s.normal(poly);
    const Q a = dot(n, minus(s.corner(slit, 0), s.corner(poly, 0)));
    const Q b = dot(n, minus(s.corner(slit, 1), s.corner(poly, 0)));
    if (a * b >= Q(0)) return false;
    p = s.corner(slit, 0);
    const Vec<Q> u = minus(s.corner(slit, 1), p);
    for (int k = 0; k < 3; ++k) p[k] = p[k] + u[k] * a / (a - b);
    d = {Q(0), Q(0), Q(0)};
    return clip(poly);
  }
  const Vec<Q> n = s.normal(i), o = s.normal(j);
  d = cross(n, o);
  if (zero(d)) return false;
  const Q cn = dot(n, s.corner(i, 0)), co = dot(o, s.corner(j, 0));
  const Vec<Q> u = cross(o, d), v = cross(d, n);
  for (int k = 0; k < 3; ++k) p[k] = (cn * u[k] + co * v[k]) / dot(d, d);
  return clip(i) && clip(j);
}

std::string describe(const std::vector<std::vector<Touch>>& places) {
  std::string out;
  for (const std::vector<Touch>& place : places) {
    std::set<std::string> names;
    for (const Touch& t : place) {
      names.insert((t.vertex ? "V" : "E") + std::to_string(t.portal) + "." +
                   std::to_string(t.index));
    }
    for (const std::string& n : names) out += " " + n;
    out += ";";
  }
  return out;
}

class Enumeration {
 public:
  explicit Enumeration(const std::vector<NaivePortal>& portals) {
    for (const NaivePortal& p : portals) {
      scene_.portals.emplace_back();
      for (const Eigen::Vector3d& v : p) scene_.portals.back().push_back(exact(v));
    }
    const int n = static_cast<int>(portals.size());
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < i; ++j) {
        if (interiors_cross(scene_, i, j)) without_order_.insert({j, i});
      }
    }
  }

  std::vector<std::string> run() {
    std::vector<std::pair<int, int>> edges;
    std::vector<Vec<Q>> points;
    std::vector<std::vector<Row>> planes;
    const int n = static_cast<int>(scene_.portals.size());
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < scene_.edges(i); ++k) edges.emplace_back(i, k);
      for (const Vec<Q>& v : scene_.portals[i]) points.push_back(v);
      if (scene_.polygon(i)) {
        planes.push_back({scene_.edge(i, 0), scene_.edge(i, 1),
                          joining(scene_.corner(i, 0), scene_.corner(i, 2))});
      }
    }
    add_crossings(edges, points);
    const auto row = [&](std::size_t e) {
      return scene_.edge(edges[e].first, edges[e].second);
    };
    const auto star = [&](std::size_t p) {
      std::vector<Row> rows;
      add_star(rows, points[p]);
      return rows;
    };
    const auto both = [](std::vector<Row> a, const std::vector<Row>& b) {
      a.insert(a.end(), b.begin(), b.end());
      return a;
    };
    const std::size_t count = edges.size();
    for (std::size_t p = 0; p < points.size(); ++p) {
      for (std::size_t q = 0; q < p; ++q) {
        if (points[p] != points[q]) try_rows(both(star(p), star(q)));
      }
    }
    for (std::size_t f = 0; f < planes.size(); ++f) {
      for (std::size_t g = 0; g < f; ++g) try_rows(both(planes[f], planes[g]));
    }
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        for (std::size_t p = 0; p < points.size(); ++p) {
          try_rows(both(star(p), {row(a), row(b)}));
        }
        for (const auto& plane : planes) try_rows(both(plane, {row(a), row(b)}));
        for (std::size_t c = 0; c < b; ++c) {
          for (std::size_t d = 0; d < c; ++d) try_four(edges, {a, b, c, d});
        }
      }
      for (std::size_t p = 0; p < points.size(); ++p) {
        for (const auto& plane : planes) {
          try_rows(both(both(star(p), plane), {row(a)}));
        }
      }
    }
    std::vector<std::string> out;
    for (const auto& [text, lines] : found_) out.insert(out.end(), lines.size(), text);
    return out;
  }

 private:
  void add_crossings(const std::vector<std::pair<int, int>>& edges,
                     std::vector<Vec<Q>>& points) {
    for (const auto& [i, k] : edges) {
      for (const auto& [j, l] : edges) {
        if (j >= i) continue;
        const Row e = scene_.edge(j, l);
        Line line;
        for (int c = 0; c < 6; ++c) line[c] = X(e[c]);
        const Ruler r(line);
        const auto at = on_segment(r, scene_.corner(i, k), scene_.corner(i, k + 1));
        if (!at) continue;
        const Vec<X> p = r.point(*at);
        points.push_back({p[0].a0(), p[1].a0(), p[2].a0()});
      }
    }
    std::ranges::sort(points);
    points.erase(std::unique(points.begin(), points.end()), points.end());
  }

  void try_four(const std::vector<std::pair<int, int>>& edges,
                std::array<std::size_t, 4> four) {
    std::vector<Row> rows;
    std::set<int> portals;
    for (const std::size_t e : four) {
      rows.push_back(scene_.edge(edges[e].first, edges[e].second));
      portals.insert(edges[e].first);
    }
    // Two edges of one portal are touched in a corner or in its plane: solved elsewhere.
    if (portals.size() == 4 || scene_.portals.size() < 4) try_rows(rows);
  }

  void try_rows(const std::vector<Row>& rows) {
    for (const Line& l : isolated(rows)) {
      if (l[0] == X(0) && l[1] == X(0) && l[2] == X(0)) continue;  // at infinity
      judge(l);
    }
  }

  void judge(const Line& l) {
    const Ruler r(l);
    std::vector<Touch> touches;
    std::vector<Meeting> meetings;
    bool forward = true, backward = true;
    for (int i = 0; i < static_cast<int>(scene_.portals.size()); ++i) {
      const auto m = meet(scene_, i, r, touches);
      if (!m) return;
      for (int j = 0; j < i; ++j) {
        if (without_order_.contains({j, i})) continue;
        forward = forward && meetings[j].first <= m->last;
        backward = backward && m->first <= meetings[j].last;
      }
      meetings.push_back(*m);
    }
    if (!forward && !backward) return;
    std::ranges::stable_sort(touches,
                             [](const Touch& a, const Touch& b) { return a.at < b.at; });
    std::vector<std::vector<Touch>> places;
    for (const Touch& t : touches) {
      if (places.empty() || places.back().front().at != t.at) places.emplace_back();
      places.back().push_back(t);
    }
    std::vector<Row> rows;
    std::string letters;
    for (const auto& place : places) letters += add_rows(place, rows);
    std::string planes;
    bool along = false;
    for (std::size_t i = 0; i < meetings.size(); ++i) {
      along |= meetings[i].along;
      if (!meetings[i].in_plane) continue;
      const int p = static_cast<int>(i);
      rows.push_back(scene_.edge(p, 0));
      rows.push_back(scene_.edge(p, 1));
      rows.push_back(joining(scene_.corner(p, 0), scene_.corner(p, 2)));
      planes += " P" + std::to_string(i);
    }
    if (!isolates(rows)) return;
    const std::string kind = !planes.empty() || along               ? "in_plane"
                             : letters == "VV"                      ? "VV"
                             : letters == "EEEE"                    ? "EEEE"
                             : letters == "EVE"                     ? "EVE"
                             : letters == "VEE" || letters == "EEV" ? "VEE"
                                                                    : "degenerate";
    std::vector<std::string> texts;
    if (forward) texts.push_back(describe(places));
    std::ranges::reverse(places);
    if (backward) texts.push_back(describe(places));
    add(kind + ":" + *std::ranges::min_element(texts) + planes, l);
  }

  /// What the touched place asks of lines nearby, and its letter.
  char add_rows(const std::vector<Touch>& place, std::vector<Row>& rows) {
    std::optional<Vec<Q>> fixed;
    const auto direction = [this](const Touch& t) {
      return minus(scene_.corner(t.portal, t.index + 1),
                   scene_.corner(t.portal, t.index));
    };
    for (const Touch& t : place) {
      if (t.vertex) fixed = scene_.corner(t.portal, t.index);
      if (t.vertex || place.front().vertex) continue;
      if (!zero(cross(direction(t), direction(place.front())))) {
        const Row e = scene_.edge(t.portal, t.index);
        Line line;
        for (int c = 0; c < 6; ++c) line[c] = X(e[c]);
        const Ruler along(line);
        const Touch& o = place.front();
        const Vec<X> p = along.point(*on_segment(along, scene_.corner(o.portal, o.index),
                                                 scene_.corner(o.portal, o.index + 1)));
        fixed = Vec<Q>{p[0].a0(), p[1].a0(), p[2].a0()};
      }
    }
    if (fixed) {
      add_star(rows, *fixed);
    } else {
      rows.push_back(scene_.edge(place.front().portal, place.front().index));
    }
    return fixed ? 'V' : 'E';
  }

  /// Lines that touch the same differ, if at all, by more than rounding in small scenes.
  void add(const std::string& text, const Line& l) {
    Eigen::Matrix<double, 6, 1> c;
    for (int k = 0; k < 6; ++k) c[k] = CGAL::to_double(l[k]);
    c.normalize();
    for (const auto& other : found_[text]) {
      if ((other - c).norm() < 1e-9 || (other + c).norm() < 1e-9) return;
    }
    found_[text].push_back(c);
  }

  Scene scene_;
  std::set<std::pair<int, int>> without_order_;
  std::map<std::string, std::vector<Eigen::Matrix<double, 6, 1>>> found_;
};

}  // namespace

std::vector<std::string> naive_extremal_lines(const std::vector<NaivePortal>& portals) {
  return Enumeration(portals).run();
}

}  // namespace sightline::testing
