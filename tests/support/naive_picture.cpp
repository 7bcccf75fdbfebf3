#include "tests/support/naive_picture.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace sightline::testing {
namespace {

std::vector<Vec3> corners_of(const Scene& scene, int face) {
  std::vector<Vec3> result;
  for (const int p : scene.face_points(face)) result.push_back(exact(scene.point(p)));
  return result;
}

Vec3 normal_of(const std::vector<Vec3>& corners) {
  return cross(corners[1] - corners[0], corners[2] - corners[0]);
}

struct PictureFace {
  int face;
  Cone cone;
};

/// Faces of one plane, which do not hide one another.
struct Layer {
  Vec3 nearness;
  std::vector<PictureFace> faces;
};

/// nullopt for a face edge-on.
std::optional<std::pair<Cone, Vec3>> face_in_picture(const Lens& lens,
                                                     const std::vector<Vec3>& corners) {
  std::vector<Vec3> v;
  std::vector<Ray> rays;
  for (const Vec3& p : corners) {
    v.push_back(lens.picture(p));
    if (is_zero(v.back())) return std::nullopt;
    rays.emplace_back(v.back());
  }
  const Rational det = dot(v[0], cross(v[1], v[2]));
  if (det.sign() == 0) return std::nullopt;
  // The linear function that is the nearness at three corners.
  const Vec3 sum = lens.nearness(corners[0]) * cross(v[1], v[2]) +
                   lens.nearness(corners[1]) * cross(v[2], v[0]) +
                   lens.nearness(corners[2]) * cross(v[0], v[1]);
  return std::pair{cone_of(std::move(rays)).value(), Rational(1 / det) * sum};
}

std::vector<Layer> layers_of(const Scene& scene, const Lens& lens,
                             const std::optional<Vec3>& point) {
  std::map<std::array<Rational, 3>, Layer> layers;
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    if (point && !face_holds(scene, f, *point)) continue;
    const auto seen = face_in_picture(lens, corners_of(scene, f));
    if (!seen) continue;
    Layer& layer = layers[seen->second];
    layer.nearness = seen->second;
    layer.faces.push_back({f, seen->first});
  }
  std::vector<Layer> result;
  for (auto& [key, layer] : layers) result.push_back(std::move(layer));
  return result;
}

/// Takes the convex set away from all cells.
void take_away(std::vector<PictureCell>& cells, const std::vector<Ray>& half_spaces) {
  std::vector<PictureCell> left;
  for (PictureCell& cell : cells) {
    Cut parts = cut(cell.cone, half_spaces);
    for (Cone& part : parts.outside) {
      left.push_back(cell);
      left.back().cone = std::move(part);
    }
  }
  cells = std::move(left);
}

/// The union of a layer's faces as disjoint cells, each with all faces that cover it.
std::vector<PictureCell> overlay(const Layer& layer) {
  std::vector<PictureCell> cells;
  for (const PictureFace& face : layer.faces) {
    std::vector<PictureCell> fresh{{face.cone, {face.face}, layer.nearness}};
    std::vector<PictureCell> next;
    for (const PictureCell& cell : cells) {
      Cut parts = cut(cell.cone, face.cone.sides);
      for (Cone& part : parts.outside) {
        next.push_back(cell);
        next.back().cone = std::move(part);
      }
      if (!parts.inside) continue;
      next.push_back(cell);
      next.back().cone = std::move(*parts.inside);
      next.back().faces.push_back(face.face);
      take_away(fresh, cell.cone.sides);
    }
    cells = std::move(next);
    cells.insert(cells.end(), fresh.begin(), fresh.end());
  }
  return cells;
}

std::vector<Cone> everything(const Scene& scene, const Lens& lens) {
  std::vector<Cone> result;
  if (!lens.is_direction()) {
    for (int octant = 0; octant < 8; ++octant) {
      std::vector<Ray> rays;
      for (int i = 0; i < 3; ++i) {
        Vec3 axis{};
        axis[i] = (octant >> i & 1) != 0 ? 1 : -1;
        rays.emplace_back(axis);
      }
      result.push_back(cone_of(std::move(rays)).value());
    }
    return result;
  }
  // A square around all pictures, with a margin of the same size.
  Rational size = 1;
  for (const Point& p : scene.points()) {
    const Vec3 v = lens.picture(exact(p));
    for (int i = 0; i < 2; ++i) size = std::max(size, Rational(abs(v[i])));
  }
  size *= 2;
  std::vector<Ray> rays;
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    rays.emplace_back(Vec3{Rational(x * size), Rational(y * size), 1});
  }
  result.push_back(cone_of(std::move(rays)).value());
  return result;
}

/// The rays that run into a solid on whose surface the eye lies, as disjoint cones.
std::vector<Cone> blocked_rays(const Scene& scene, const Lens& lens) {
  std::vector<Ray> planes;
  bool on_scene = false;
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    if (lens.is_direction() || !face_holds(scene, f, lens.at())) continue;
    on_scene = true;
    planes.emplace_back(normal_of(corners_of(scene, f)));
  }
  if (!on_scene) return {};
  std::vector<Cone> cones = everything(scene, lens);
  for (const Ray& plane : planes) {
    std::vector<Cone> next;
    for (const Cone& cone : cones) {
      for (const Ray& half : {plane, -plane}) {
        if (std::optional<Cone> part = clip(cone, half)) next.push_back(*part);
      }
    }
    cones = std::move(next);
  }
  std::vector<Cone> result;
  for (const Cone& cone : cones) {
    std::optional<std::vector<int>> solids;
    std::vector<Ray> rays = cone.corners;
    while (!solids) {
      const Ray along = between(rays);
      solids = material(scene, lens.at(), along.rational());
      rays.push_back(between({along, cone.corners[rays.size() % 3]}));
    }
    if (!solids->empty()) result.push_back(cone);
  }
  return result;
}

bool on_border(const Cone& cone, const Cone& all) {
  return std::ranges::any_of(cone.sides, [&](const Ray& s) {
    return std::ranges::find(all.sides, s) != all.sides.end();
  });
}

}  // namespace

Lens::Lens(const NaiveEye& eye)
    : direction_(eye.kind == Viewpoint::Kind::Direction), at_(eye.at) {
  if (!direction_) return;
  while (drop_ < 3 && at_[drop_].sign() == 0) ++drop_;
  if (drop_ == 3) throw std::invalid_argument("a direction of length 0");
}

Rational Lens::nearness(const Vec3& point) const {
  return direction_ ? Rational(point[drop_] / at_[drop_]) : Rational(1);
}

Vec3 Lens::picture(const Vec3& point) const {
  if (!direction_) return point - at_;
  const Vec3 moved = point - nearness(point) * at_;
  return {moved[(drop_ + 1) % 3], moved[(drop_ + 2) % 3], 1};
}

Vec3 Lens::in_space(const Ray& ray, const Vec3& nearness) const {
  const Vec3 v = ray.rational();
  const Rational value = dot(nearness, v);
  if (!direction_) return at_ + Rational(1 / value) * v;
  Vec3 flat{};
  flat[(drop_ + 1) % 3] = v[0] / v[2];
  flat[(drop_ + 2) % 3] = v[1] / v[2];
  return flat + Rational(value / v[2]) * at_;
}

Rational Lens::scaled_area(const Cone& cone) const {
  Rational twice = 0;
  const std::size_t n = cone.corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 a = cone.corners[i].rational(), b = cone.corners[(i + 1) % n].rational();
    twice += (a[0] * b[1] - a[1] * b[0]) / (a[2] * b[2]);
  }
  return abs(twice) * abs(at_[drop_]) / 2;
}

double Lens::length() const {
  // Scaled, so that squares neither overflow nor vanish.
  Rational longest = 0;
  for (const Rational& x : at_) longest = std::max(longest, Rational(abs(x)));
  const Vec3 v = Rational(1 / longest) * at_;
  return std::sqrt(static_cast<double>(dot(v, v))) * static_cast<double>(longest);
}

Picture picture(const Scene& scene, const Lens& lens, const std::optional<Vec3>& point) {
  const std::vector<Layer> layers = layers_of(scene, lens, point);
  const std::vector<Cone> all = everything(scene, lens);
  const std::vector<Cone> blocked = blocked_rays(scene, lens);
  Picture result;
  // Every layer loses what a face of another layer hides.
  for (const Layer& layer : layers) {
    std::vector<PictureCell> cells = overlay(layer);
    for (const Layer& other : layers) {
      if (&other == &layer) continue;
      for (const PictureFace& face : other.faces) {
        std::vector<Ray> nearer{Ray(other.nearness - layer.nearness)};
        nearer.insert(nearer.end(), face.cone.sides.begin(), face.cone.sides.end());
        take_away(cells, nearer);
      }
    }
    result.cells.insert(result.cells.end(), cells.begin(), cells.end());
  }
  std::vector<PictureCell> background;
  for (const Cone& cone : all) background.push_back({cone, {}, {}});
  for (const Layer& layer : layers) {
    for (const PictureFace& face : layer.faces) take_away(background, face.cone.sides);
  }
  result.cells.insert(result.cells.end(), background.begin(), background.end());
  for (const Cone& cone : blocked) take_away(result.cells, cone.sides);
  for (const Cone& cone : blocked) result.cells.push_back({cone, {}, {}, true});
  if (lens.is_direction()) {
    for (PictureCell& cell : result.cells) cell.infinite = on_border(cell.cone, all[0]);
  }
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    const std::vector<Vec3> corners = corners_of(scene, f);
    const Vec3 sight = lens.is_direction() ? lens.at() : lens.at() - corners[0];
    result.front.push_back(dot(normal_of(corners), sight).sign() > 0 ? 1 : 0);
  }
  return result;
}

Ray face_normal(const Scene& scene, int face) {
  const auto p = scene.face_points(face);
  const Vec3 a = exact(scene.point(p[0]));
  return Ray(cross(exact(scene.point(p[1])) - a, exact(scene.point(p[2])) - a));
}
bool is_sheet(const Scene& scene, int face) {
  return !scene.objects()[scene.faces()[face].object].closed;
}

bool segment_holds(const Vec3& a, const Vec3& b, const Vec3& point) {
  return is_zero(cross(b - a, point - a)) && dot(b - a, point - a).sign() >= 0 &&
         dot(a - b, point - b).sign() >= 0;
}

bool face_holds(const Scene& scene, int face, const Vec3& point) {
  const std::vector<Vec3> corners = corners_of(scene, face);
  const Vec3 normal = normal_of(corners);
  if (dot(normal, point - corners[0]).sign() != 0) return false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& a = corners[i];
    const Vec3& b = corners[(i + 1) % corners.size()];
    if (dot(normal, cross(b - a, point - a)).sign() < 0) return false;
  }
  return true;
}

std::optional<std::vector<int>> material(const Scene& scene, const Vec3& origin,
                                         const Vec3& along) {
  // How often the ray leaves an object more than it enters it, with the sides of the
  // file: 1 in its material, 0 outside, less in the air of a room.
  std::vector<int> leaves(scene.objects().size(), 0);
  for (int f = 0; f < static_cast<int>(scene.faces().size()); ++f) {
    const std::vector<Vec3> corners = corners_of(scene, f);
    const Vec3 normal = normal_of(corners);
    const Rational ahead = dot(normal, corners[0] - origin);
    const Rational slope = dot(normal, along);
    if (slope.sign() == 0) {
      if (ahead.sign() == 0) return std::nullopt;
      continue;
    }
    if (ahead.sign() * slope.sign() <= 0) continue;
    const Vec3 hit = origin + Rational(ahead / slope) * along;
    bool outside = false, on_line = false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3& a = corners[i];
      const Vec3& b = corners[(i + 1) % corners.size()];
      const int s = dot(normal, cross(b - a, hit - a)).sign();
      outside = outside || s < 0;
      on_line = on_line || s == 0;
    }
    if (outside) continue;
    if (on_line) return std::nullopt;
    leaves[scene.faces()[f].object] += scene.turned(f) ? -slope.sign() : slope.sign();
  }
  std::vector<int> result;
  for (int o = 0; o < static_cast<int>(scene.objects().size()); ++o) {
    int net = leaves[o];
    for (const Scene::Hollow& hollow : scene.hollows()) {
      if (hollow.around == o) net += leaves[hollow.object];
    }
    if (scene.objects()[o].closed && net > 0) result.push_back(o);
  }
  return result;
}

}  // namespace sightline::testing
