// The lit region and what faces away, as polygons in rationals.

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "tests/shadows/mesh_proof/naive_shadow_areas.h"

namespace sightline::testing {
namespace {

using FlatPoint = std::array<Rational, 2>;
using Polygon = std::vector<FlatPoint>;  // convex, counter-clockwise

Rational turn(const FlatPoint& a, const FlatPoint& b, const FlatPoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

Polygon hull(std::vector<FlatPoint> points) {
  std::ranges::sort(points);
  points.erase(std::ranges::unique(points).begin(), points.end());
  if (points.size() < 3) return {};
  Polygon result;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = result.size();
    for (const FlatPoint& p : points) {
      while (result.size() >= start + 2 &&
             turn(result[result.size() - 2], result.back(), p) <= 0) {
        result.pop_back();
      }
      result.push_back(p);
    }
    result.pop_back();
    std::ranges::reverse(points);
  }
  return result.size() < 3 ? Polygon{} : result;
}

/// The part where a x + b y + c >= 0.
Polygon clipped(const Polygon& polygon, const std::array<Rational, 3>& line) {
  const auto value = [&](const FlatPoint& p) -> Rational {
    return line[0] * p[0] + line[1] * p[1] + line[2];
  };
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const FlatPoint &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const Rational u = value(p), v = value(q);
    if (u >= 0) result.push_back(p);
    if (u.sign() * v.sign() < 0) {
      const Rational t = u / (u - v);
      result.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])});
    }
  }
  return hull(std::move(result));
}

Rational area_of(const Polygon& polygon) {
  Rational twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const FlatPoint &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    twice += p[0] * q[1] - p[1] * q[0];
  }
  return twice / 2;
}

/// Of the union: between two neighbouring heights at which sides begin, end or cross the
/// length of a level line in the union is linear.
Rational union_area(const std::vector<Polygon>& polygons) {
  std::set<Rational> heights;
  std::vector<std::array<FlatPoint, 2>> sides;
  for (const Polygon& p : polygons) {
    for (std::size_t i = 0; i < p.size(); ++i) {
      heights.insert(p[i][1]);
      sides.push_back({p[i], p[(i + 1) % p.size()]});
    }
  }
  for (const auto& [a, b] : sides) {
    for (const auto& [c, d] : sides) {
      const Rational u = turn(a, b, c), v = turn(a, b, d);
      if (u.sign() * v.sign() >= 0) continue;
      if (turn(c, d, a).sign() * turn(c, d, b).sign() >= 0) continue;
      heights.insert(c[1] + u / (u - v) * (d[1] - c[1]));
    }
  }
  Rational sum = 0;
  for (auto low = heights.begin(); low != heights.end(); ++low) {
    const auto high = std::next(low);
    if (high == heights.end()) break;
    const Rational y = (*low + *high) / 2;
    std::vector<std::array<Rational, 2>> spans;
    for (const Polygon& p : polygons) {
      std::vector<Rational> at;
      for (std::size_t i = 0; i < p.size(); ++i) {
        const FlatPoint &a = p[i], &b = p[(i + 1) % p.size()];
        if ((a[1] > y) == (b[1] > y)) continue;
        at.push_back(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
      }
      if (at.size() == 2)
        spans.push_back({std::min(at[0], at[1]), std::max(at[0], at[1])});
    }
    std::ranges::sort(spans);
    Rational length = 0;
    std::optional<Rational> end;
    for (const auto& [from, to] : spans) {
      if (!end || from > *end) {
        length += to - from;
        end = to;
      } else if (to > *end) {
        length += to - *end;
        end = to;
      }
    }
    sum += length * (*high - *low);
  }
  return sum;
}

/// A face's plane with its two coordinates.
class Ground {
 public:
  explicit Ground(const NaiveShadowFace& face)
      : normal_(
            cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0])),
        offset_(dot(normal_, face.corners[0])) {
    for (int i = 0; i < 3; ++i) {
      if (abs(normal_[i]) > abs(normal_[w_])) w_ = i;
    }
    std::vector<FlatPoint> corners;
    for (const Vec3& c : face.corners) corners.push_back(flat(c));
    outline = hull(std::move(corners));
  }

  [[nodiscard]] Rational height(const Vec3& x) const { return dot(normal_, x) - offset_; }
  [[nodiscard]] FlatPoint flat(const Vec3& x) const {
    return {x[(w_ + 1) % 3], x[(w_ + 2) % 3]};
  }
  /// n . x - k on the plane, as a x + b y + c.
  [[nodiscard]] std::array<Rational, 3> line(const Vec3& n, const Rational& k) const {
    const int u = (w_ + 1) % 3, v = (w_ + 2) % 3;
    const Rational s = n[w_] / normal_[w_];
    return {n[u] - s * normal_[u], n[v] - s * normal_[v], s * offset_ - k};
  }
  [[nodiscard]] double factor() const {
    Rational squares = 0;
    for (int i = 0; i < 3; ++i)
      squares += normal_[i] / normal_[w_] * (normal_[i] / normal_[w_]);
    return std::sqrt(static_cast<double>(squares));
  }

  Polygon outline;

 private:
  Vec3 normal_;
  Rational offset_;
  int w_ = 2;
};

/// The part of a convex polygon at height 0 or above.
std::vector<Vec3> above(const std::vector<Vec3>& corners, const Ground& ground) {
  std::vector<Vec3> result;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const Rational u = ground.height(a), v = ground.height(b);
    if (u >= 0) result.push_back(a);
    if (u.sign() * v.sign() < 0) result.push_back(a + Rational(u / (u - v)) * (b - a));
  }
  return result;
}

std::array<Rational, 2> heights(const std::vector<Vec3>& corners, const Ground& ground) {
  std::array<Rational, 2> result{ground.height(corners[0]), ground.height(corners[0])};
  for (const Vec3& c : corners) {
    result[0] = std::min(result[0], ground.height(c));
    result[1] = std::max(result[1], ground.height(c));
  }
  return result;
}

/// From where some of the blocker is before some of the light; false: not told.
bool add_shadow(const NaiveShadowFace& light, const NaiveShadowFace& blocker,
                const Ground& ground, std::vector<FlatPoint>& points) {
  const std::vector<Vec3> part = above(blocker.corners, ground);
  if (part.empty() || heights(part, ground)[1] == 0) return true;
  const auto [light_low, light_high] = heights(light.corners, ground);
  const auto [low, high] = heights(part, ground);
  if (light_high <= low) return true;
  if (high >= light_low) return false;
  for (const Vec3& s : light.corners) {
    for (const Vec3& b : part) {
      const Rational hs = ground.height(s), hb = ground.height(b);
      points.push_back(
          ground.flat(Rational(1 / (hs - hb)) * (hs * b - Rational(hb) * s)));
    }
  }
  return true;
}

Vec3 normal_of(const NaiveShadowFace& f) {
  return cross(f.corners[1] - f.corners[0], f.corners[2] - f.corners[0]);
}

/// Clips to one side of the face's plane: 1 its front, -1 its back.
Polygon beside(const Polygon& polygon, const NaiveShadowFace& f, const Ground& ground,
               int side) {
  const Vec3 n = Rational(side) * normal_of(f);
  return clipped(polygon, ground.line(n, dot(n, f.corners[0])));
}

}  // namespace

std::optional<NaiveRationalArea> naive_lit_area(std::span<const NaiveShadowFace> faces,
                                                int face) {
  const Ground ground(faces[face]);
  std::vector<Polygon> dark;
  Polygon unseen = ground.outline;  // from where no light shows its front
  for (const NaiveShadowFace& light : faces) {
    if (!light.source) continue;
    const auto [lowest, highest] = heights(light.corners, ground);
    if (lowest == 0 && highest == 0) continue;  // shows neither side
    if (light.two_sided) {
      unseen.clear();
    } else if (!unseen.empty()) {
      unseen = beside(unseen, light, ground, -1);
    }
    const Polygon front =
        light.two_sided ? ground.outline : beside(ground.outline, light, ground, 1);
    if (front.empty()) continue;
    if (lowest < 0) {
      dark.push_back(front);
      continue;
    }
    for (int b = 0; b < static_cast<int>(faces.size()); ++b) {
      const Vec3 n = normal_of(light);
      const bool coplanar = std::ranges::all_of(faces[b].corners, [&](const Vec3& c) {
        return dot(n, c - light.corners[0]) == 0;
      });
      if (coplanar || b == face) continue;
      std::vector<FlatPoint> points;
      if (!add_shadow(light, faces[b], ground, points)) return std::nullopt;
      Polygon shadow = hull(std::move(points));
      for (std::size_t i = 0; i < ground.outline.size() && !shadow.empty(); ++i) {
        const FlatPoint &p = ground.outline[i],
                        &q = ground.outline[(i + 1) % ground.outline.size()];
        shadow = clipped(shadow, {p[1] - q[1], q[0] - p[0], p[0] * q[1] - p[1] * q[0]});
      }
      if (!light.two_sided && !shadow.empty()) shadow = beside(shadow, light, ground, 1);
      if (!shadow.empty()) dark.push_back(std::move(shadow));
    }
  }
  if (!unseen.empty()) dark.push_back(std::move(unseen));
  return NaiveRationalArea{area_of(ground.outline) - union_area(dark), ground.factor()};
}

NaiveRationalArea naive_away_area(std::span<const NaiveShadowFace> faces, int face) {
  const Ground ground(faces[face]);
  Polygon away = ground.outline;
  for (const NaiveShadowFace& light : faces) {
    if (!light.source || away.empty() || heights(light.corners, ground)[1] <= 0) continue;
    if (light.two_sided) {
      away.clear();
    } else {
      away = beside(away, light, ground, -1);
    }
  }
  return {area_of(away), ground.factor()};
}

}  // namespace sightline::testing
