#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>

#include "tests/shadows/mesh_proof/naive_shadow_areas.h"

namespace sightline::testing {
namespace {

Point rounded(const Vec3& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]),
          static_cast<double>(v[2])};
}

Vec3 normal_of(const NaiveShadowFace& f) {
  return cross(f.corners[1] - f.corners[0], f.corners[2] - f.corners[0]);
}

struct Segment {
  Point a, b;
};

/// Whether the ray from p towards q meets a segment, within roundings.
bool meets(const Point& p, const Point& way, const Segment& s) {
  // p + t way = a + u (b - a) by least squares.
  const Point d = s.b - s.a, r = s.a - p;
  const double ww = way.dot(way), wd = way.dot(d), dd = d.dot(d);
  const double det = ww * dd - wd * wd;
  if (det < 1e-24 * ww * dd) return true;  // along it
  const double t = (r.dot(way) * dd - r.dot(d) * wd) / det;
  const double u = (r.dot(way) * wd - r.dot(d) * ww) / det;
  return t > -1e-9 && u > -1e-9 && u < 1 + 1e-9;
}

/// Where a scan line may change its class.
class ScanLine {
 public:
  ScanLine(std::span<const NaiveShadowFace> faces, const NaiveShadow& naive, int face)
      : faces_(faces), naive_(naive) {
    normal_ = normal_of(faces[face]);
    offset_ = dot(normal_, faces[face].corners[0]);
    for (int i = 0; i < 3; ++i) {
      if (abs(normal_[i]) > abs(normal_[w_])) w_ = i;
    }
    for (const Vec3& c : faces[face].corners) {
      outline_.emplace_back(static_cast<double>(c[(w_ + 1) % 3]),
                            static_cast<double>(c[(w_ + 2) % 3]));
    }
    find_elements();
  }

  [[nodiscard]] const std::vector<Eigen::Vector2d>& outline() const { return outline_; }
  [[nodiscard]] double factor() const {
    const Point n = rounded(normal_);
    return n.norm() / std::abs(n[w_]);
  }

  /// Lengths by class.
  [[nodiscard]] std::array<double, 3> lengths(double y, NaiveShadowAreas& counts) const {
    const auto [low, high] = range(y);
    std::vector<double> at{low, high};
    add_places(y, low, high, at);
    std::ranges::sort(at);
    std::array<double, 3> result{};
    ++counts.scan_lines;
    int light = 0;
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
      if (at[i + 1] - at[i] > 1e-11 * (high - low)) {
        ++counts.asked;
        light = static_cast<int>(
            naive_.at(lift(0.5 * (at[i] + at[i + 1]), y), normal_).light);
      }
      result[light] += at[i + 1] - at[i];
    }
    return result;
  }

 private:
  void find_elements() {
    std::set<std::array<double, 3>> points;
    std::set<std::array<double, 6>> edges;
    const auto key = [](const Point& p) { return std::array{p[0], p[1], p[2]}; };
    for (const NaiveShadowFace& f : faces_) {
      for (std::size_t i = 0; i < f.corners.size(); ++i) {
        auto a = key(rounded(f.corners[i]));
        auto b = key(rounded(f.corners[(i + 1) % f.corners.size()]));
        points.insert(a);
        if (b < a) std::swap(a, b);
        edges.insert({a[0], a[1], a[2], b[0], b[1], b[2]});
      }
      if (f.source) sources_.push_back(&f);
    }
    for (const auto& e : edges)
      edges_.push_back({{e[0], e[1], e[2]}, {e[3], e[4], e[5]}});
    for (const auto& p : points) points_.emplace_back(p[0], p[1], p[2]);
    add_pierced_points();
  }

  /// Where edges pass through faces: silhouettes end there.
  void add_pierced_points() {
    for (const NaiveShadowFace& f : faces_) {
      const Point n = rounded(normal_of(f)).normalized(), c = rounded(f.corners[0]);
      for (const Segment& e : edges_) {
        const double a = n.dot(e.a - c), b = n.dot(e.b - c);
        if (std::abs(a) < 1e-12 || std::abs(b) < 1e-12 || (a > 0) == (b > 0)) continue;
        const Point x = e.a + a / (a - b) * (e.b - e.a);
        if (on(f, x)) points_.push_back(x);
      }
    }
  }

  [[nodiscard]] static bool on(const NaiveShadowFace& f, const Point& x) {
    const Point n = rounded(normal_of(f));
    for (std::size_t i = 0; i < f.corners.size(); ++i) {
      const Point a = rounded(f.corners[i]);
      const Point b = rounded(f.corners[(i + 1) % f.corners.size()]);
      const Point across = n.cross(b - a);
      if (across.dot(x - a) < -1e-9 * across.norm() * (b - a).norm()) return false;
    }
    return true;
  }

  [[nodiscard]] Vec3 lift(double x, double y) const {
    Vec3 p;
    const int u = (w_ + 1) % 3, v = (w_ + 2) % 3;
    p[u] = x;
    p[v] = y;
    p[w_] = (offset_ - normal_[u] * p[u] - normal_[v] * p[v]) / normal_[w_];
    return p;
  }

  [[nodiscard]] std::array<double, 2> range(double y) const {
    double low = 1e300, high = -1e300;
    for (std::size_t i = 0; i < outline_.size(); ++i) {
      const auto &a = outline_[i], &b = outline_[(i + 1) % outline_.size()];
      if ((a[1] > y) == (b[1] > y)) continue;
      const double x = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
      low = std::min(low, x);
      high = std::max(high, x);
    }
    return {low, std::max(low, high)};
  }

  /// The ray from p reaches a source.
  [[nodiscard]] bool lit_way(const Point& p, const Point& way) const {
    return std::ranges::any_of(sources_, [&](const NaiveShadowFace* f) {
      const Point n = rounded(normal_of(*f));
      const double along = n.dot(way), height = n.dot(rounded(f->corners[0]) - p);
      if (along == 0) return true;
      const double t = height / along;
      return t > 0 && on(*f, p + t * way);
    });
  }

  void add_places(double y, double low, double high, std::vector<double>& at) const {
    const Point p0 = rounded(lift(low, y)), p1 = rounded(lift(high, y));
    const auto point = [&](double t) -> Point { return p0 + t * (p1 - p0); };
    const auto keep = [&](double t) {
      if (t > 0 && t < 1) at.push_back(low + t * (high - low));
    };
    for (const NaiveShadowFace& f : faces_) {
      const Point n = rounded(normal_of(f)), c = rounded(f.corners[0]);
      const double a = n.dot(p0 - c), b = n.dot(p1 - c);
      if (a != b) keep(a / (a - b));
    }
    for (const Segment& e : edges_) {
      for (const Point& v : points_) {
        const Point n = (e.b - e.a).cross(v - e.a);
        const double a = n.dot(p0 - e.a), b = n.dot(p1 - e.a);
        if ((a > 0) == (b > 0)) continue;
        const double t = a / (a - b);
        const Point p = point(t), way = v - p;
        if (way.norm() < 1e-12 || (meets(p, way, e) && lit_way(p, way))) keep(t);
      }
    }
    add_quadrics(point, keep);
  }

  /// Lines through p and three edges: the planes through p and each have one in common.
  void add_quadrics(const std::function<Point(double)>& point,
                    const std::function<void(double)>& keep) const {
    const std::size_t n = edges_.size();
    const std::array<Point, 3> p{point(0), point(0.5), point(1)};
    std::vector<std::array<Point, 3>> plane(n);
    for (std::size_t i = 0; i < n; ++i) {
      for (int k = 0; k < 3; ++k)
        plane[i][k] = (edges_[i].a - p[k]).cross(edges_[i].b - p[k]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        std::array<Point, 3> way;
        for (int k = 0; k < 3; ++k) way[k] = plane[i][k].cross(plane[j][k]);
        for (std::size_t l = 0; l < j; ++l) {
          std::array<double, 3> f;
          for (int k = 0; k < 3; ++k) f[k] = way[k].dot(plane[l][k]);
          for (const double t : roots(f)) add_regulus(point(t), t, {i, j, l}, keep);
        }
      }
    }
  }

  /// Of the quadratic with these values at 0, 1/2 and 1, those between 0 and 1.
  [[nodiscard]] static std::vector<double> roots(const std::array<double, 3>& f) {
    const double c = f[0], a = 2 * (f[0] - 2 * f[1] + f[2]), b = f[2] - f[0] - a;
    std::vector<double> result;
    const double d = b * b - 4 * a * c;
    if (d < 0) return result;
    const double q = -0.5 * (b + std::copysign(std::sqrt(d), b));
    for (const double t : {q / a, c / q}) {
      if (t > 0 && t < 1) result.push_back(t);
    }
    return result;
  }

  void add_regulus(const Point& p, double t, const std::array<std::size_t, 3>& three,
                   const std::function<void(double)>& keep) const {
    std::array<Point, 3> planes;
    for (int k = 0; k < 3; ++k)
      planes[k] = (edges_[three[k]].a - p).cross(edges_[three[k]].b - p);
    Point way = Point::Zero();
    for (int k = 0; k < 3; ++k) {
      const Point w = planes[k].normalized().cross(planes[(k + 1) % 3].normalized());
      if (w.norm() > way.norm()) way = w;
    }
    if (way.norm() < 1e-9) return;
    for (const Point& w : {way, Point(-way)}) {
      const bool all = std::ranges::all_of(
          three, [&](std::size_t e) { return meets(p, w, edges_[e]); });
      if (all && lit_way(p, w)) keep(t);
    }
  }

  std::span<const NaiveShadowFace> faces_;
  const NaiveShadow& naive_;
  Vec3 normal_;
  Rational offset_;
  int w_ = 2;
  std::vector<Eigen::Vector2d> outline_;
  std::vector<Segment> edges_;
  std::vector<Point> points_;
  std::vector<const NaiveShadowFace*> sources_;
};

/// Gauss and Legendre's rule on (-1, 1).
struct Rule {
  std::vector<double> at, weight;
};
Rule gauss(int n) {
  Rule rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(M_PI * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int step = 0; step < 50; ++step) {
      double p = 1, q = 0;
      for (int k = 0; k < n; ++k) {
        const double r = q;
        q = p;
        p = ((2 * k + 1) * x * q - k * r) / (k + 1);
      }
      slope = n * (x * p - q) / (x * x - 1);
      x -= p / slope;
    }
    rule.at.push_back(x);
    rule.weight.push_back(2 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

class Integral {
 public:
  Integral(const ScanLine& line, double off, NaiveShadowAreas& counts)
      : line_(line), off_(off), counts_(counts) {}

  /// Straight boundaries need two nodes; for others the ends of the panel may be square
  /// roots, which the substitution y = a + (b - a) s^2 (3 - 2 s) takes away.
  [[nodiscard]] std::array<double, 3> over(double a, double b, int depth) const {
    const auto linear = apply(rules_[0], a, b, false);
    const auto more = apply(rules_[1], a, b, false);
    if (near(linear, more)) return more;
    const auto low = apply(rules_[2], a, b, true), high = apply(rules_[3], a, b, true);
    if (near(low, high) || depth == 0) return high;
    const double middle = 0.5 * (a + b);
    std::array<double, 3> sum = over(a, middle, depth - 1);
    const std::array<double, 3> rest = over(middle, b, depth - 1);
    for (int i = 0; i < 3; ++i) sum[i] += rest[i];
    return sum;
  }

 private:
  [[nodiscard]] bool near(const std::array<double, 3>& x,
                          const std::array<double, 3>& y) const {
    for (int i = 0; i < 3; ++i) {
      if (std::abs(x[i] - y[i]) > off_) return false;
    }
    return true;
  }
  [[nodiscard]] std::array<double, 3> apply(const Rule& rule, double a, double b,
                                            bool bent) const {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < rule.at.size(); ++i) {
      const double s = 0.5 * (1 + rule.at[i]);
      const double y = bent ? a + (b - a) * s * s * (3 - 2 * s) : a + (b - a) * s;
      const double slope = bent ? 6 * s * (1 - s) : 1;
      const auto lengths = line_.lengths(y, counts_);
      for (int k = 0; k < 3; ++k)
        sum[k] += 0.5 * (b - a) * rule.weight[i] * slope * lengths[k];
    }
    return sum;
  }

  const ScanLine& line_;
  double off_;
  NaiveShadowAreas& counts_;
  std::array<Rule, 4> rules_{gauss(2), gauss(3), gauss(10), gauss(14)};
};

}  // namespace

NaiveShadowAreas naive_shadow_areas(std::span<const NaiveShadowFace> faces,
                                    const NaiveShadow& naive, int face,
                                    std::vector<double> panel_ends, double off) {
  const ScanLine line(faces, naive, face);
  double area = 0;
  const auto& outline = line.outline();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto &a = outline[i], &b = outline[(i + 1) % outline.size()];
    panel_ends.push_back(a[1]);
    area += 0.5 * std::abs(a[0] * b[1] - a[1] * b[0]);
  }
  std::ranges::sort(panel_ends);
  NaiveShadowAreas result;
  const Integral integral(line, off * area, result);
  std::array<double, 3> sum{};
  const double height = panel_ends.back() - panel_ends.front();
  double from = panel_ends.front();
  for (const double to : panel_ends) {
    if (to - from < 1e-12 * height) continue;
    const auto part = integral.over(from, to, 12);
    for (int i = 0; i < 3; ++i) sum[i] += part[i];
    from = to;
  }
  result.umbra = sum[0] * line.factor();
  result.penumbra = sum[1] * line.factor();
  result.lit = sum[2] * line.factor();
  return result;
}

}  // namespace sightline::testing
