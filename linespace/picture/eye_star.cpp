#include "linespace/picture/eye_star.h"

#include <algorithm>

namespace sightline::internal {
namespace {

ExactPoint normal_of(const ViewScene& scene, int face) {
  const auto t = plane_points(scene.scene(), face);
  return exact_cross(exact_difference(scene.exact(t[1]), scene.exact(t[0])),
                     exact_difference(scene.exact(t[2]), scene.exact(t[0])));
}

// x lies on the closed segment from p to q.
bool on_segment(const ExactPoint& p, const ExactPoint& q, const ExactPoint& x) {
  const ExactPoint u = exact_difference(p, x), v = exact_difference(q, x);
  return exact_cross(u, v) == ExactPoint{} && exact_dot(u, v) <= 0;
}

}  // namespace

EyeStar::EyeStar(const EyeSpace& eye) : eye_(&eye) {
  if (eye.is_direction()) return;
  find_faces();
  find_place();
}

bool EyeStar::holds(int face) const {
  const ViewScene& scene = eye_->scene();
  if (eye_->front(face) != Sign::Zero || scene.corners(face).empty()) return false;
  const ExactPoint normal = normal_of(scene, face);
  const auto corners = scene.corners(face);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const ExactPoint p = scene.exact(corners[k]);
    const ExactPoint q = scene.exact(corners[(k + 1) % corners.size()]);
    const ExactPoint across =
        exact_cross(exact_difference(q, p), exact_difference(eye_->eye(), p));
    if (exact_dot(normal, across) < 0) return false;
  }
  return true;
}

void EyeStar::find_faces() {
  const ViewScene& scene = eye_->scene();
  const Point& e = eye_->rounded_eye();
  const double slack = eye_->is_double() ? 0 : 4 * kUnit * e.cwiseAbs().maxCoeff();
  const auto may_hold = [&](const Box& box) {
    for (int i = 0; i < 3; ++i) {
      if (e[i] < box.min[i] - slack || e[i] > box.max[i] + slack) return false;
    }
    return true;
  };
  scene.silhouettes().face_tree().traverse(may_hold, [&](std::uint32_t item) {
    const int face = static_cast<int>(item);
    if (may_hold(scene.silhouettes().face_box(face)) && holds(face))
      faces_.push_back(face);
  });
  std::ranges::sort(faces_);
  for (const int f : faces_) {
    normals_.push_back(normal_of(scene, f));
    // A plane facet goes on where its faces meet; a bent one has lines there.
    const Facet& facet = scene.scene().facets()[scene.scene().faces()[f].facet];
    const std::span<const int> around =
        facet.planar ? std::span(facet.faces) : std::span(&f, 1);
    for (const int g : around) {
      const int sides = static_cast<int>(scene.corners(g).size());
      for (int k = 0; k < sides; ++k) {
        if (const int line = scene.line_of_side(g, k); line >= 0) sides_.push_back(line);
      }
    }
  }
  std::ranges::sort(sides_);
  sides_.erase(std::ranges::unique(sides_).begin(), sides_.end());
}

void EyeStar::find_place() {
  const ViewScene& scene = eye_->scene();
  if (faces_.empty()) {
    ids_ = scene.material_at(eye_->eye());
    if (!ids_.empty()) place_ = EyePlace::Inside;
    return;
  }
  for (const int f : faces_) {
    for (const int p : scene.corners(f)) {
      if (scene.exact(p) != eye_->eye() ||
          !std::ranges::binary_search(scene.scene().corners(), p)) {
        continue;
      }
      place_ = EyePlace::Corner;
      ids_ = {p};
      return;
    }
  }
  for (const int line : sides_) {
    const auto [a, b] = scene.lines()[line].ends;
    if (scene.lines()[line].name.edge >= 0 &&
        on_segment(scene.exact(a), scene.exact(b), eye_->eye())) {
      ids_.push_back(scene.lines()[line].name.edge);
    }
  }
  place_ = ids_.empty() ? EyePlace::Facet : EyePlace::Edge;
  if (ids_.empty()) {
    for (const int f : faces_) ids_.push_back(scene.scene().faces()[f].facet);
  }
  std::ranges::sort(ids_);
  ids_.erase(std::ranges::unique(ids_).begin(), ids_.end());
}

bool EyeStar::bounds(int line) const { return std::ranges::binary_search(sides_, line); }

bool EyeStar::blocked(const ExactPoint& way, const ExactPoint& beside) const {
  if (faces_.empty()) return false;
  // A step beside the way that changes no sign but those that are 0 on it.
  std::vector<int> signs;
  Rational step = 1;
  for (const ExactPoint& n : normals_) {
    const Rational along = exact_dot(n, way), off = exact_dot(n, beside);
    signs.push_back(along != 0 ? along.sign() : off.sign());
    if (along != 0 && off != 0) step = std::min(step, Rational(abs(along / off) / 2));
  }
  const auto [it, is_new] = known_.emplace(std::move(signs), false);
  if (is_new) {
    ExactPoint ray = way;
    for (int i = 0; i < 3; ++i) ray[i] += step * beside[i];
    it->second = into_material(ray);
  }
  return it->second;
}

bool EyeStar::into_material(const ExactPoint& way) const {
  const ViewScene& scene = eye_->scene();
  // Halfway to where the ray next passes the plane of a face that it may meet.
  Rational nearest = 1;
  const Point w = rounded(way);
  const Point& e = eye_->rounded_eye();
  const double size = w.cwiseAbs().maxCoeff();
  const double slack = 0x1p-40 * (size + e.cwiseAbs().maxCoeff());
  const auto may_meet = [&](const Box& box) {
    for (int i = 0; i < 3; ++i) {
      if (box.max[i] < std::min(e[i], e[i] + w[i]) - slack ||
          box.min[i] > std::max(e[i], e[i] + w[i]) + slack) {
        return false;
      }
    }
    return true;
  };
  scene.silhouettes().face_tree().traverse(may_meet, [&](std::uint32_t item) {
    const int face = static_cast<int>(item);
    const Rational at_eye = scene.exact_plane_value(face, eye_->eye());
    ExactPoint there = eye_->eye();
    for (int i = 0; i < 3; ++i) there[i] += way[i];
    const Rational at_end = scene.exact_plane_value(face, there);
    if (at_eye == 0 || at_eye == at_end) return;
    const Rational t = at_eye / (at_eye - at_end);
    if (t > 0) nearest = std::min(nearest, t);
  });
  ExactPoint p = eye_->eye();
  for (int i = 0; i < 3; ++i) p[i] += way[i] * nearest / 2;
  return !scene.material_at(p).empty();
}

}  // namespace sightline::internal
