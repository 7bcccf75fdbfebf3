#include "tests/support/naive_free_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <set>

#include "tests/support/exact.h"

namespace sightline::testing {
namespace {

using Polygon = std::vector<Point>;
using Exact = std::vector<Vec3>;

// ---- exact: what lies where -----------------------------------------------------------

struct Plane {
  Vec3 at, normal;
  [[nodiscard]] Rational height(const Vec3& p) const { return dot(normal, p - at); }
};

Exact exact_corners(std::span<const Point> polygon) {
  Exact result;
  for (const Point& p : polygon) result.push_back(exact(p));
  return result;
}

Plane plane_of(const Exact& p) {
  for (std::size_t i = 2; i < p.size(); ++i) {
    const Vec3 normal = cross(p[1] - p[0], p[i] - p[0]);
    if (!is_zero(normal)) return {p[0], normal};
  }
  return {p[0], Vec3{}};
}

/// All of it lies in the plane.
bool flat_on(const Plane& plane, const Exact& polygon) {
  return std::ranges::all_of(polygon,
                             [&](const Vec3& p) { return plane.height(p).sign() == 0; });
}

/// The part on or before the plane; nothing where it has no point before it.
Exact before(const Plane& plane, const Exact& polygon) {
  Exact part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Rational ha = plane.height(a), hb = plane.height(b);
    if (ha >= 0) part.push_back(a);
    if (ha.sign() * hb.sign() < 0) part.push_back(a + (ha / (ha - hb)) * (b - a));
  }
  return flat_on(plane, part) ? Exact{} : part;
}

/// What of a blocker may hide something; nothing where it is too small to.
Exact hiding_part(const FreeBlocker& blocker, const Plane& of_i, const Plane& of_j) {
  const Exact corners = exact_corners(blocker.corners);
  const auto stands_on = [&](const Plane& plane) {
    return blocker.solid && flat_on(plane, corners) &&
           dot(plane.normal, plane_of(corners).normal).sign() < 0;
  };
  if (stands_on(of_i)) return before(of_j, corners);
  if (stands_on(of_j)) return before(of_i, corners);
  return before(of_j, before(of_i, corners));
}

/// All polygons in a frame whose plane z = 0 is that of `from`: the first two are `from`
/// and `to`, what follows lies between their planes.
struct Setting {
  std::vector<Polygon> polygons;
  double unit = 1;
  Point to_normal;
  std::optional<Point> up;
};

std::optional<Setting> setting(std::span<const Point> from, std::span<const Point> to,
                               std::span<const FreeBlocker> blockers,
                               const std::optional<Point>& up) {
  const Exact i = exact_corners(from), j = exact_corners(to);
  const Plane of_i = plane_of(i), of_j = plane_of(j);
  std::vector<Exact> kept{before(of_j, i), before(of_i, j)};
  if (kept[0].size() < 3 || kept[1].size() < 3) return std::nullopt;
  for (const FreeBlocker& b : blockers) {
    const Exact part = hiding_part(b, of_i, of_j);
    if (part.size() >= 3) kept.push_back(part);
  }
  const auto rounded = [](const Vec3& v) {
    return Point{v[0].convert_to<double>(), v[1].convert_to<double>(),
                 v[2].convert_to<double>()};
  };
  Setting s;
  const Point z = rounded(of_i.normal).normalized(), x = z.unitOrthogonal();
  const Point y = z.cross(x);
  const auto turned = [&](const Point& p) { return Point{x.dot(p), y.dot(p), z.dot(p)}; };
  for (const Exact& polygon : kept) {
    s.polygons.emplace_back();
    for (const Vec3& p : polygon) {
      Point q = turned(rounded(p - of_i.at));
      if (of_i.height(p).sign() == 0) q.z() = 0;
      s.polygons.back().push_back(q);
    }
  }
  double size = 0;
  for (int k = 0; k < 2; ++k) {
    for (const Point& p : s.polygons[k]) size = std::max(size, p.cwiseAbs().maxCoeff());
  }
  s.unit = size;
  for (Polygon& polygon : s.polygons) {
    for (Point& p : polygon) p /= size;
  }
  s.to_normal = turned(rounded(of_j.normal).normalized());
  if (up) s.up = turned(up->normalized());
  return s;
}

// ---- one meridian ---------------------------------------------------------------------

/// A side, over the coordinate b across the meridian: its position a along the meridian
/// and its height z are linear in b.
struct Side {
  double b0, b1;  ///< b0 < b1
  double a0, a1, z0, z1;
  std::size_t polygon;

  [[nodiscard]] double share(double b) const { return (b - b0) / (b1 - b0); }
  [[nodiscard]] double a(double b) const { return a0 + share(b) * (a1 - a0); }
  [[nodiscard]] double z(double b) const { return z0 + share(b) * (z1 - z0); }
  [[nodiscard]] bool has_end(const Point& v) const {
    return (v.y() == b0 && v.x() == a0) || (v.y() == b1 && v.x() == a1);
  }
  /// Moved into z = 0; slope is the tangent of theta.
  [[nodiscard]] double moved(double b, double slope) const { return a(b) - slope * z(b); }
};

class Meridian {
 public:
  Meridian(const Setting& setting, double phi) : count_(setting.polygons.size()) {
    const Point along{std::cos(phi), std::sin(phi), 0};
    const Point across{-along.y(), along.x(), 0};
    for (std::size_t k = 0; k < count_; ++k) {
      const Polygon& polygon = setting.polygons[k];
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double bp = across.dot(p), bq = across.dot(q);
        const double ap = along.dot(p), aq = along.dot(q);
        corners_.push_back({ap, bp, p.z()});
        if (bp < bq) sides_.push_back({bp, bq, ap, aq, p.z(), q.z(), k});
        if (bp > bq) sides_.push_back({bq, bp, aq, ap, q.z(), p.z(), k});
        if (std::abs(bp - bq) < 1e-12) along_.push_back(bp);
      }
    }
    find_range();
    find_slopes(setting, along);
  }
  /// No line of this azimuth runs from `from` to `to`.
  [[nodiscard]] bool empty() const { return !(low_ < high_) || !(least_ < most_); }
  [[nodiscard]] std::array<double, 2> slopes() const { return {least_, most_}; }

  /// The free area for that slope.
  [[nodiscard]] double area(double slope) {
    find_strips(slope);
    double sum = 0;
    for (std::size_t i = 1; i < strips_.size(); ++i) {
      const double width = strips_[i] - strips_[i - 1];
      if (width > 0) {
        sum += width * free_length(strips_[i - 1] + 0.5 * width, slope);
      }
    }
    return sum;
  }

  /// Slopes at which a corner crosses a side or three sides meet, where that can be seen.
  [[nodiscard]] std::vector<double> kinks() {
    std::vector<double> result;
    for (const Point& v : corners_) {
      for (const Side& s : sides_) {
        if (v.y() < s.b0 || v.y() > s.b1 || s.has_end(v)) continue;
        const double slope = (v.x() - s.a(v.y())) / (v.z() - s.z(v.y()));
        add_kink(slope, v.y(), v.x() - slope * v.z(), result);
      }
    }
    for (std::size_t f = 0; f < sides_.size(); ++f) {
      for (std::size_t g = f + 1; g < sides_.size(); ++g) {
        if (!overlap(sides_[f], sides_[g])) continue;
        add_meetings_along(sides_[f], sides_[g], result);
        for (std::size_t h = g + 1; h < sides_.size(); ++h) {
          if (!overlap(sides_[f], sides_[h]) || !overlap(sides_[g], sides_[h])) continue;
          if (sides_[f].polygon == sides_[h].polygon) continue;
          add_meeting(sides_[f], sides_[g], sides_[h], result);
        }
      }
    }
    return result;
  }

 private:
  static bool overlap(const Side& s, const Side& t) {
    return std::max(s.b0, t.b0) < std::min(s.b1, t.b1);
  }
  void find_range() {
    std::array<double, 2> low{1e300, 1e300}, high{-1e300, -1e300};
    for (const Side& s : sides_) {
      if (s.polygon > 1) continue;
      low[s.polygon] = std::min(low[s.polygon], s.b0);
      high[s.polygon] = std::max(high[s.polygon], s.b1);
    }
    low_ = std::max(low[0], low[1]);
    high_ = std::min(high[0], high[1]);
  }
  /// Those that meet the front of `to` and rise along `up`.
  void find_slopes(const Setting& setting, const Point& along) {
    least_ = 0;
    most_ = 1e300;
    const auto keep_positive = [&](double at_zero, double per_slope) {
      if (per_slope > 0) least_ = std::max(least_, -at_zero / per_slope);
      if (per_slope < 0) most_ = std::min(most_, -at_zero / per_slope);
      if (per_slope == 0 && at_zero <= 0) most_ = -1;
    };
    keep_positive(-setting.to_normal.z(), -setting.to_normal.dot(along));
    if (setting.up) keep_positive(setting.up->z(), setting.up->dot(along));
  }
  void find_strips(double slope) {
    strips_.assign({low_, high_});
    const auto add = [&](double b) {
      if (b > low_ && b < high_) strips_.push_back(b);
    };
    for (const Point& v : corners_) add(v.y());
    for (std::size_t f = 0; f < sides_.size(); ++f) {
      for (std::size_t g = f + 1; g < sides_.size(); ++g) {
        const Side &s = sides_[f], &t = sides_[g];
        if (s.polygon == t.polygon) continue;
        const double b0 = std::max({s.b0, t.b0, low_}),
                     b1 = std::min({s.b1, t.b1, high_});
        if (!(b0 < b1)) continue;
        const double d0 = s.moved(b0, slope) - t.moved(b0, slope);
        const double d1 = s.moved(b1, slope) - t.moved(b1, slope);
        if ((d0 < 0) != (d1 < 0)) add(b0 + d0 / (d0 - d1) * (b1 - b0));
      }
    }
    std::ranges::sort(strips_);
  }
  /// From where to where each polygon covers the line b.
  void find_covers(double b, double slope) {
    covers_.assign(count_, {1e300, -1e300});
    for (const Side& s : sides_) {
      if (b < s.b0 || b > s.b1) continue;
      const double a = s.moved(b, slope);
      covers_[s.polygon][0] = std::min(covers_[s.polygon][0], a);
      covers_[s.polygon][1] = std::max(covers_[s.polygon][1], a);
    }
  }
  [[nodiscard]] double free_length(double b, double slope) {
    find_covers(b, slope);
    double from = std::max(covers_[0][0], covers_[1][0]);
    const double to = std::min(covers_[0][1], covers_[1][1]);
    std::sort(covers_.begin() + 2, covers_.end());
    double sum = 0;
    for (std::size_t k = 2; k < count_ && from < to; ++k) {
      if (covers_[k][0] > covers_[k][1])
        break;  // this one and all others do not cover it
      if (covers_[k][0] > from) sum += std::min(covers_[k][0], to) - from;
      from = std::max(from, covers_[k][1]);
    }
    if (from < to) sum += to - from;
    return sum;
  }
  void add_kink(double slope, double b, double a, std::vector<double>& result) {
    constexpr double kSlack = 1e-9;
    if (!(slope > least_ && slope < most_)) return;
    if (b < low_ - kSlack || b > high_ + kSlack) return;
    find_covers(std::clamp(b, low_, high_), slope);
    const double slack = kSlack * (1 + slope);
    for (std::size_t k = 0; k < count_; ++k) {
      const auto& [from, to] = covers_[k];
      if (k < 2 && (a < from - slack || a > to + slack)) return;
      if (k >= 2 && a > from + slack && a < to - slack) return;
    }
    result.push_back(slope);
  }
  /// Two sides meet on a third that runs along the meridian.
  void add_meetings_along(const Side& f, const Side& g, std::vector<double>& result) {
    for (const double b : along_) {
      if (b < std::max(f.b0, g.b0) || b > std::min(f.b1, g.b1)) continue;
      const double slope = (f.a(b) - g.a(b)) / (f.z(b) - g.z(b));
      add_kink(slope, b, f.moved(b, slope), result);
    }
  }
  void add_meeting(const Side& f, const Side& g, const Side& h,
                   std::vector<double>& result) {
    // Over b the moved sides are a = A + B b with A and B linear in the slope t.  They
    // meet where (Af - Ag) (Bf - Bh) = (Af - Ah) (Bf - Bg).
    struct Line {
      double a0, a1, b0, b1;  // A = a0 + a1 t, B = b0 + b1 t
    };
    const auto line = [&](const Side& s) {
      const double w = s.b1 - s.b0;
      const double b0 = (s.a1 - s.a0) / w, b1 = -(s.z1 - s.z0) / w;
      return Line{s.a0 - b0 * s.b0, -s.z0 - b1 * s.b0, b0, b1};
    };
    const Line x = line(f), y = line(g), w = line(h);
    const Line p{x.a0 - y.a0, x.a1 - y.a1, x.b0 - y.b0, x.b1 - y.b1};
    const Line q{x.a0 - w.a0, x.a1 - w.a1, x.b0 - w.b0, x.b1 - w.b1};
    const double c0 = p.a0 * q.b0 - q.a0 * p.b0;
    const double c1 = p.a0 * q.b1 + p.a1 * q.b0 - q.a0 * p.b1 - q.a1 * p.b0;
    const double c2 = p.a1 * q.b1 - q.a1 * p.b1;
    const double d = c1 * c1 - 4 * c2 * c0;
    if (d < 0) return;
    const double r = -0.5 * (c1 + std::copysign(std::sqrt(d), c1));
    for (const double t : {r / c2, c0 / r}) {
      if (!(t > least_ && t < most_)) continue;
      const double steep = p.b0 + p.b1 * t, other = q.b0 + q.b1 * t;
      const double b = std::abs(steep) > std::abs(other) ? -(p.a0 + p.a1 * t) / steep
                                                         : -(q.a0 + q.a1 * t) / other;
      const auto on = [&](const Side& s) { return b >= s.b0 - 1e-9 && b <= s.b1 + 1e-9; };
      if (on(f) && on(g) && on(h)) add_kink(t, b, f.moved(b, t), result);
    }
  }

  std::size_t count_;
  std::vector<Point> corners_;  ///< a, b, z
  std::vector<Side> sides_;
  std::vector<double> along_;  ///< b of sides along the meridian
  double low_ = 0, high_ = 0, least_ = 0, most_ = 0;
  std::vector<double> strips_;
  std::vector<std::array<double, 2>> covers_;
};

// ---- integration ----------------------------------------------------------------------

/// Gauss' rule of eight nodes.
template <class Function>
double gauss(double from, double to, Function&& f) {
  static constexpr std::array kNodes{0.183434642495649805, 0.525532409916328986,
                                     0.796666477413626740, 0.960289856497536232};
  static constexpr std::array kWeights{0.362683783378361983, 0.313706645877887287,
                                       0.222381034453374471, 0.101228536290376259};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += kWeights[i] * (f(middle - half * kNodes[i]) + f(middle + half * kNodes[i]));
  }
  return half * sum;
}

constexpr std::array kWhole{1.0};
constexpr std::array kGraded{1.0 / 64, 1.0 / 8, 0.5, 7.0 / 8, 63.0 / 64, 1.0};

struct Halved {
  double from, to, left, right, change;
  bool operator<(const Halved& other) const { return change < other.change; }
};

/// The interval that halving changes most is halved until all changes add up to no more
/// than the tolerance.  Returns the integral and that sum.
template <class Function>
std::array<double, 2> halve(const std::vector<double>& ends,
                            std::span<const double> parts, double tolerance,
                            Function&& f) {
  std::priority_queue<Halved> queue;
  double sum = 0, change = 0;
  const auto add = [&](double from, double to, double whole) {
    const double middle = 0.5 * (from + to);
    Halved h{from, to, gauss(from, middle, f), gauss(middle, to, f), 0};
    h.change = std::abs(h.left + h.right - whole);
    sum += h.left + h.right;
    change += h.change;
    queue.push(h);
  };
  for (std::size_t i = 1; i < ends.size(); ++i) {
    // Parts that grow from both ends: what happens near a kink does not fall between
    // nodes.
    double from = ends[i - 1];
    for (const double share : parts) {
      const double to = ends[i - 1] + share * (ends[i] - ends[i - 1]);
      if (from < to) add(from, to, gauss(from, to, f));
      from = to;
    }
  }
  for (int k = 0; k < 100000 && !queue.empty() && change > tolerance; ++k) {
    const Halved h = queue.top();
    const double middle = 0.5 * (h.from + h.to);
    if (!(h.from < middle && middle < h.to)) break;
    queue.pop();
    sum -= h.left + h.right;
    change -= h.change;
    add(h.from, middle, h.left);
    add(middle, h.to, h.right);
  }
  return {sum, change};
}

/// The integral over theta of A sin(2 theta).
double over_meridian(const Setting& setting, double phi, double tolerance,
                     long long& directions) {
  Meridian meridian(setting, phi);
  if (meridian.empty()) return 0;
  std::vector<double> ends{std::atan(meridian.slopes()[0]),
                           std::atan(meridian.slopes()[1])};
  for (const double slope : meridian.kinks()) ends.push_back(std::atan(slope));
  std::ranges::sort(ends);
  // Kinks nearer to each other than some roundings are one.
  std::vector<double> apart{ends[0]};
  for (const double end : ends) {
    if (end > apart.back() + 1e-13) apart.push_back(end);
  }
  return halve(apart, kWhole, tolerance, [&](double theta) {
    ++directions;
    return meridian.area(std::tan(theta)) * std::sin(2 * theta);
  })[0];
}

/// Is the line's point in the polygon's plane inside by this much (negative: outside)?
bool in_polygon(const Polygon& polygon, const Point& normal, const Point& x,
                double margin) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point side = polygon[(i + 1) % polygon.size()] - polygon[i];
    if (normal.dot(side.cross(x - polygon[i])) < margin) return false;
  }
  return true;
}

Point normal_of(const Polygon& polygon) {
  Point normal = Point::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    normal += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return normal.normalized();
}

/// Azimuths of sides, and of free lines through two corners: the strongest kinks.
std::vector<double> azimuths(const Setting& s) {
  std::vector<double> result{-std::numbers::pi, std::numbers::pi};
  const auto add = [&](const Point& w) {
    if (w.x() != 0 || w.y() != 0) result.push_back(std::atan2(w.y(), w.x()));
  };
  std::vector<Point> corners, normals;
  std::set<std::array<double, 2>> upright;
  for (const Polygon& polygon : s.polygons) {
    normals.push_back(normal_of(polygon));
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point side = polygon[(i + 1) % polygon.size()] - polygon[i];
      add(side);
      add(-side);
      if (side.x() == 0 && side.y() == 0)
        upright.insert({polygon[i].x(), polygon[i].y()});
      corners.push_back(polygon[i]);
    }
  }
  const auto is_free = [&](const Point& v, const Point& w) {
    for (std::size_t k = 0; k < s.polygons.size(); ++k) {
      const double rise = normals[k].dot(w);
      if (rise == 0) continue;
      const Point x = v + normals[k].dot(s.polygons[k][0] - v) / rise * w;
      constexpr double kSlack = 1e-9;
      if (k < 2 && !in_polygon(s.polygons[k], normals[k], x, -kSlack)) return false;
      if (k >= 2 && in_polygon(s.polygons[k], normals[k], x, kSlack)) return false;
    }
    return true;
  };
  for (const Point& u : corners) {
    for (const Point& v : corners) {
      const Point w = v - u;
      // A corner beside an upright side passes it at all its heights at once.
      if (upright.contains({v.x(), v.y()})) {
        add(w);
        add(-w);
      }
      if (w.z() > 0 && s.to_normal.dot(w) < 0 && is_free(u, w)) add(w);
    }
  }
  std::ranges::sort(result);
  std::vector<double> apart{result[0]};
  for (const double phi : result) {
    if (phi > apart.back() + 1e-12) apart.push_back(phi);
  }
  return apart;
}

}  // namespace

FreeLines free_lines(std::span<const Point> from, std::span<const Point> to,
                     std::span<const FreeBlocker> blockers, double tolerance,
                     const std::optional<Point>& up) {
  const std::optional<Setting> s = setting(from, to, blockers, up);
  FreeLines result;
  if (!s) return result;
  const double scale = s->unit * s->unit / (2 * std::numbers::pi);
  const double wanted = tolerance / scale;
  // Meridians are found so much more exactly that phi sees no noise of theirs.
  const double each = 0.02 * wanted;
  const auto [sum, change] = halve(azimuths(*s), kGraded, wanted, [&](double phi) {
    return over_meridian(*s, phi, each, result.directions);
  });
  result.exchange = scale * sum;
  result.change = scale * change;
  return result;
}

std::vector<FreeBlocker> faces_between(std::span<const Point> from,
                                       std::span<const Point> to,
                                       std::span<const FreeBlocker> faces) {
  constexpr double kSlack = 1e-9;
  std::vector<std::array<Point, 2>> planes;  // a point and the normal away from both
  const auto add = [&](std::span<const Point> p, std::span<const Point> q) {
    for (std::size_t i = 0; i < p.size(); ++i) {
      for (const Point& v : q) {
        Point normal = (p[(i + 1) % p.size()] - p[i]).cross(v - p[i]);
        if (!(normal.norm() > kSlack)) continue;
        normal.normalize();
        double low = 0, high = 0;
        for (const auto& points : {p, q}) {
          for (const Point& x : points) {
            low = std::min(low, normal.dot(x - p[i]));
            high = std::max(high, normal.dot(x - p[i]));
          }
        }
        if (low > -kSlack) planes.push_back({p[i], -normal});
        if (high < kSlack) planes.push_back({p[i], normal});
      }
    }
  };
  add(from, to);
  add(to, from);
  std::vector<FreeBlocker> result;
  for (const FreeBlocker& face : faces) {
    const bool beside = std::ranges::any_of(planes, [&](const auto& plane) {
      return std::ranges::all_of(face.corners, [&](const Point& x) {
        return plane[1].dot(x - plane[0]) > 2 * kSlack;
      });
    });
    if (!beside) result.push_back(face);
  }
  return result;
}

}  // namespace sightline::testing
