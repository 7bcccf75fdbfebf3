#include "shadows/backprojection.h"

#include <algorithm>

#include "linespace/numbers/exact_position.h"
#include "shadows/seen/seen_measures.h"
#include "shadows/seen/seen_part.h"
#include "shadows/seen/source_scene.h"
#include "shadows/seen/source_view.h"

namespace sightline {

using namespace internal;

namespace {

ExactPosition position(const Point& p) { return {p, {}, {true, true, true}}; }

LongEigen unit(const ExactPoint& v) {
  Rational size = 0;
  for (const Rational& x : v) size = std::max(size, Rational(abs(x)));
  if (size == 0) throw InvalidInput("the normal: a vector of length 0");
  LongEigen n;
  for (int i = 0; i < 3; ++i) n[i] = long_double(v[i] / size);
  return n.normalized();
}

}  // namespace

ShadowPoint shadow_point(const Point& at) { return {position(at), std::nullopt}; }
ShadowPoint shadow_point(const Point& at, const Eigen::Vector3d& normal) {
  return {position(at), position(normal)};
}

ShadowPoint shadow_point_on(const Scene& scene, int polygon, const ExactPosition& at) {
  const auto faces = scene.faces();
  const auto face = std::ranges::find(faces, polygon, &Face::source);
  if (face == faces.end()) {
    throw InvalidInput("no polygon " + std::to_string(polygon) +
                       " that has an area; the file has " +
                       std::to_string(scene.soup().polygons.size()) + " polygons");
  }
  return shadow_point_on_face(scene, static_cast<int>(face - faces.begin()), at, true);
}

ShadowPoint shadow_point_on_face(const Scene& scene, int face, const Point& at,
                                 bool front) {
  return shadow_point_on_face(scene, face, position(at), front);
}

ShadowPoint shadow_point_on_face(const Scene& scene, int face, const ExactPosition& at,
                                 bool front) {
  const auto t = plane_points(scene, face);
  const ExactPoint a = exact_point(scene.point(t[0])), p = exact_point(at);
  ExactPoint n = exact_cross(exact_difference(exact_point(scene.point(t[1])), a),
                             exact_difference(exact_point(scene.point(t[2])), a));
  if (scene.turned(face) == front) n = {-n[0], -n[1], -n[2]};
  const Rational off = exact_dot(n, exact_difference(p, a)) / exact_dot(n, n);
  ExactPoint on = p;
  for (int i = 0; i < 3; ++i) on[i] -= off * n[i];
  return {exact_position(on), exact_position(n)};
}

struct BackprojectionIndex::Impl {
  Impl(const Scene& scene, const LightSource& light, const Request& request)
      : source(scene, light, request) {
    for (const SourcePlane& plane : source.planes())
      areas.push_back(open_area(source, plane));
  }

  SourceScene source;
  std::vector<double> areas;  // of its planes
};

BackprojectionIndex::BackprojectionIndex(const Scene& scene, const LightSource& source,
                                         const Request& request)
    : impl_(std::make_unique<Impl>(scene, source, request)) {}
BackprojectionIndex::~BackprojectionIndex() = default;
BackprojectionIndex::BackprojectionIndex(BackprojectionIndex&&) noexcept = default;

Backprojection BackprojectionIndex::from(const ShadowPoint& point,
                                         const BackprojectionOptions& options) const {
  const SourceScene& source = impl_->source;
  const Viewpoint viewpoint{Viewpoint::Kind::Eye, point.at};
  const EyeSpace eye(source.scene(), viewpoint);
  const EyeStar star(eye);
  std::optional<Horizon> horizon;
  LongEigen normal = LongEigen::Zero();
  if (point.normal) {
    const ExactPoint n = exact_point(*point.normal);
    normal = unit(n);
    horizon.emplace(eye.eye(), n);
  }

  Backprojection seen{ShadowClass::Umbra, 0, std::nullopt, std::nullopt, {}};
  double facing = 0, area = 0, factor = 0;
  std::optional<Eigen::Vector3d> gradient = Eigen::Vector3d::Zero().eval();
  bool any_seen = false, any_hidden = false;
  for (std::size_t i = 0; i < source.planes().size(); ++i) {
    const SourcePlane& plane = source.planes()[i];
    const Sign side = eye.front(plane.faces.front());
    if ((plane.fronts.front() ? side : -side) != Sign::Positive) continue;
    facing += impl_->areas[i];
    if (star.place() == EyePlace::Inside) continue;
    const SourceView view({.source = &source,
                           .plane = &plane,
                           .eye = viewpoint,
                           .horizon = horizon ? &*horizon : nullptr,
                           .star = &star,
                           .all_lines = options.boundaries || options.gradient});
    any_seen |= view.any_seen();
    any_hidden |= view.any_hidden();
    if (!view.any_seen()) continue;
    const SeenPart part = seen_part(view);
    const PlaneFrame frame(source, plane, view.eye());
    const double part_area = view.any_hidden() ? seen_area(frame, part) : impl_->areas[i];
    area += part_area;
    if (horizon) {
      const SeenFormFactor of_part =
          seen_form_factor(view, frame, part, normal, part_area);
      factor += of_part.value;
      if (!of_part.gradient) gradient.reset();
      if (gradient) *gradient += *of_part.gradient;
    }
    if (options.boundaries) {
      auto boundaries = seen_boundaries(source, plane, view, part);
      std::ranges::move(boundaries, std::back_inserter(seen.boundaries));
    }
  }
  if (any_seen) {
    seen.shadow = any_hidden ? ShadowClass::Penumbra : ShadowClass::Lit;
    seen.visible_fraction = any_hidden ? std::min(area / facing, 1.0) : 1;
  }
  if (horizon) {
    seen.form_factor = factor;
    if (options.gradient) seen.gradient = gradient;
  }
  return seen;
}

}  // namespace sightline
