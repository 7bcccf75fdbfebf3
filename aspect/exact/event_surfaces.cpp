#include "aspect/exact/event_surfaces.h"

#include <map>

#include "linespace/numbers/rational.h"
#include "linespace/silhouettes/silhouettes.h"

namespace sightline::internal {
namespace {

// Coordinates over the first that is not 0: equal iff the vectors are parallel.  Empty
// for the null vector.
template <std::size_t n>
std::vector<Rational> up_to_scale(const std::array<Ring, n>& v, std::size_t leading) {
  std::vector<Rational> out;
  Rational first = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Rational x = rational(v[i]);
    if (first == 0 && i < leading) first = x;
    out.push_back(x);
  }
  if (first == 0) return {};
  for (Rational& x : out) x /= first;
  return out;
}

// The point in which two edges cross, inside both.
std::optional<LightPoint> crossing(const LightLine& l, const LightLine& m) {
  if (sign_between(l, m) != Sign::Zero) return std::nullopt;
  const auto xyz = [](const Four<Ring>& p) { return RingVector{p[0], p[1], p[2]}; };
  const auto minus = [](const RingVector& a, const RingVector& b) {
    return RingVector{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  };
  const RingVector a = xyz(l.ends[0]->exact), c = xyz(m.ends[0]->exact);
  const RingVector u = minus(xyz(l.ends[1]->exact), a),
                   v = minus(xyz(m.ends[1]->exact), c), n = cross(u, v);
  const Ring all = dot(n, n);
  const Ring s = dot(cross(minus(c, a), v), n), t = dot(cross(minus(c, a), u), n);
  for (const Ring& x : {s, t}) {
    if (sign_of(x) != Sign::Positive || sign_of(Ring(all - x)) != Sign::Positive)
      return std::nullopt;
  }
  return light_point(Four<Ring>{all * a[0] + s * u[0], all * a[1] + s * u[1],
                                all * a[2] + s * u[2], all});
}

// Calls with(plane) for every plane of a corner and an edge and for that of every face,
// until it returns false.
template <class With>
bool for_each_plane(const Scene& scene, With&& with) {
  std::map<int, LightPoint> corners;
  for (const Edge& e : scene.edges()) {
    if (e.kind == EdgeKind::Flat) continue;
    for (const int p : e.points) corners.emplace(p, light_point(scene.point(p)));
  }
  std::vector<LightLine> lines;
  for (const Edge& e : scene.edges()) {
    if (e.kind != EdgeKind::Flat)
      lines.push_back(light_line(corners.at(e.points[0]), corners.at(e.points[1])));
  }
  std::vector<LightPoint> points;
  for (const auto& [id, p] : corners) points.push_back(p);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (auto p = crossing(lines[i], lines[j])) points.push_back(std::move(*p));
    }
  }
  const auto is_plane = [](const LightPlane& p) {
    return !is_zero(p.exact[0]) || !is_zero(p.exact[1]) || !is_zero(p.exact[2]);
  };
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    const auto at = plane_points(scene, static_cast<int>(f));
    const LightPlane plane =
        light_plane(light_point(scene.point(at[0])), light_point(scene.point(at[1])),
                    light_point(scene.point(at[2])));
    if (is_plane(plane) && !with(plane)) return false;
  }
  for (const LightLine& line : lines) {
    for (const LightPoint& p : points) {
      const LightPlane plane = light_plane(*line.ends[0], *line.ends[1], p);
      if (is_plane(plane) && !with(plane)) return false;
    }
  }
  return true;
}

}  // namespace

std::optional<std::vector<LightPlane>> event_planes(const Scene& scene,
                                                    std::size_t most) {
  std::map<std::vector<Rational>, int> known;
  std::vector<LightPlane> out;
  const bool all = for_each_plane(scene, [&](const LightPlane& plane) {
    if (known.emplace(up_to_scale(plane.exact, 3), 0).second) out.push_back(plane);
    return out.size() <= most;
  });
  return all ? std::optional(std::move(out)) : std::nullopt;
}

std::optional<std::vector<CircleNormal>> event_circles(const Scene& scene,
                                                       std::size_t most) {
  std::map<std::vector<Rational>, int> known;
  std::vector<CircleNormal> out;
  const bool all = for_each_plane(scene, [&](const LightPlane& plane) {
    CircleNormal normal = normal_of(plane);
    if (known.emplace(up_to_scale(normal.exact, 3), 0).second)
      out.push_back(std::move(normal));
    return out.size() <= most;
  });
  return all ? std::optional(std::move(out)) : std::nullopt;
}

bool span_space(std::span<const CircleNormal> normals) {
  for (const CircleNormal& a : normals) {
    const RingVector n = cross(normals[0].exact, a.exact);
    for (const CircleNormal& b : normals) {
      if (!is_zero(dot(n, b.exact))) return true;
    }
  }
  return false;
}

}  // namespace sightline::internal
