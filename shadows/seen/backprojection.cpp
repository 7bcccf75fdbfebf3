#include "shadows/backprojection.h"

#include <algorithm>
#include <deque>

#include "linespace/numbers/exact_position.h"
#include "shadows/seen/seen_boundaries.h"
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
const SourceScene& BackprojectionIndex::source_scene() const { return impl_->source; }

namespace {

// The planes through the point in which things are seen in line, by normals.
class EventPlanes {
 public:
  void add(ExactPoint normal) {
    for (const ExactPoint& n : normals_) {
      if (exact_cross(n, normal) == ExactPoint{}) return;
    }
    normals_.push_back(std::move(normal));
  }
  void add_line(const EyeSpace& eye, int line) {
    const auto [a, b] = eye.scene().lines()[line].ends;
    add(exact_cross(eye.exact_vector(a), eye.exact_vector(b)));
  }
  void add_face(const EyeSpace& eye, int face) {
    const ViewScene& scene = eye.scene();
    const auto t = plane_points(scene.scene(), face);
    const ExactPoint a = scene.exact(t[0]);
    add(exact_cross(exact_difference(scene.exact(t[1]), a),
                    exact_difference(scene.exact(t[2]), a)));
  }
  [[nodiscard]] const std::vector<ExactPoint>& normals() const { return normals_; }

 private:
  std::vector<ExactPoint> normals_;
};

// One point that asks all planes of the source.
class Asker {
 public:
  Asker(const SourceScene& source, const std::vector<double>& areas,
        const ShadowPoint& point, const BackprojectionOptions& options)
      : source_(&source),
        areas_(&areas),
        viewpoint_{Viewpoint::Kind::Eye, point.at},
        options_(options),
        eye_(source.scene(), viewpoint_),
        star_(eye_) {
    if (!point.normal) return;
    const ExactPoint n = exact_point(*point.normal);
    normal_ = unit(n);
    horizon_.emplace(eye_.eye(), n);
  }

  Backprojection ask() {
    const std::vector<SourcePlane>& planes = source_->planes();
    for (std::size_t i = 0; i < planes.size(); ++i) {
      const Sign side = eye_.front(planes[i].faces.front());
      if (side == Sign::Zero) events_.add_face(eye_, planes[i].faces.front());
      if ((planes[i].fronts.front() ? side : -side) != Sign::Positive) continue;
      facing_ += (*areas_)[i];
      if (star_.place() != EyePlace::Inside) ask_plane(planes[i], (*areas_)[i]);
    }
    seen_.boundaries = seen_boundaries(*source_, parts_);
    if (any_seen_) {
      seen_.shadow = any_hidden_ ? ShadowClass::Penumbra : ShadowClass::Lit;
      seen_.visible_fraction = any_hidden_ ? std::min(area_ / facing_, 1.0) : 1;
    }
    if (horizon_) {
      seen_.form_factor = factor_;
      if (options_.gradient) seen_.gradient = gradient_;
    }
    return std::move(seen_);
  }

  [[nodiscard]] const EventPlanes& events() const { return events_; }
  [[nodiscard]] const ExactPoint& at() const { return eye_.eye(); }

 private:
  void ask_plane(const SourcePlane& plane, double open_area) {
    const SourceView& view = views_.emplace_back(
        SourceView::Question{.source = source_,
                             .plane = &plane,
                             .eye = viewpoint_,
                             .horizon = horizon_ ? &*horizon_ : nullptr,
                             .star = &star_,
                             .all_lines = options_.boundaries || options_.gradient});
    any_seen_ |= view.any_seen();
    any_hidden_ |= view.any_hidden();
    for (const int face : view.edge_on_faces()) events_.add_face(view.eye(), face);
    if (!view.any_seen()) return;
    SeenPart part = seen_part(view);
    const PlaneFrame frame(*source_, plane, view.eye());
    const double part_area = view.any_hidden() ? seen_area(frame, part) : open_area;
    area_ += part_area;
    if (horizon_) {
      const SeenFormFactor of_part =
          seen_form_factor(view, frame, part, normal_, part_area);
      factor_ += of_part.value;
      if (!of_part.gradient) gradient_.reset();
      if (gradient_) *gradient_ += *of_part.gradient;
      for (const int line : of_part.in_line) events_.add_line(view.eye(), line);
    }
    if (options_.boundaries) parts_.push_back({&plane, &view, std::move(part)});
  }

  const SourceScene* source_;
  const std::vector<double>* areas_;
  Viewpoint viewpoint_;
  BackprojectionOptions options_;
  EyeSpace eye_;
  EyeStar star_;
  std::optional<Horizon> horizon_;
  LongEigen normal_ = LongEigen::Zero();
  Backprojection seen_{ShadowClass::Umbra, 0, std::nullopt, std::nullopt,
                       std::nullopt,       {}};
  double facing_ = 0, area_ = 0, factor_ = 0;
  std::optional<Eigen::Vector3d> gradient_ = Eigen::Vector3d::Zero().eval();
  bool any_seen_ = false, any_hidden_ = false;
  EventPlanes events_;
  std::deque<SourceView> views_;
  std::vector<SeenPlane> parts_;  // where boundaries are asked for
};

// So far beside an event's plane, relative to the light's distance, is the gradient the
// limit to all digits that are told: it changes by that share of itself, and roundings of
// coordinates, which might put other events there, are smaller.
constexpr double kBeside = 0x1p-40;
constexpr double kSameGradient = 1e-9;

}  // namespace

Backprojection BackprojectionIndex::from(const ShadowPoint& point,
                                         const BackprojectionOptions& options) const {
  Asker asker(impl_->source, impl_->areas, point, options);
  Backprojection seen = asker.ask();
  if (!options.gradient || !point.normal || asker.events().normals().empty()) return seen;
  seen.gradient.reset();
  if (asker.events().normals().size() > 1) return seen;
  // To both sides of the plane, within the surface.
  const ExactPoint &g = asker.events().normals().front(), n = exact_point(*point.normal);
  const Rational along = exact_dot(g, n) / exact_dot(n, n);
  ExactPoint way;
  for (int i = 0; i < 3; ++i) way[i] = g[i] - along * n[i];
  if (way == ExactPoint{}) return seen;
  const double distance =
      (impl_->source.planes().front().hull.front() - Point(rounded(asker.at()))).norm();
  const Rational step(kBeside * distance / rounded(way).norm());
  std::array<Eigen::Vector3d, 2> limits;
  for (const int side : {0, 1}) {
    ExactPoint beside = asker.at();
    for (int i = 0; i < 3; ++i) beside[i] += (side == 0 ? step : -step) * way[i];
    const ShadowPoint there{exact_position(beside), point.normal};
    const auto gradient =
        Asker(impl_->source, impl_->areas, there, {.gradient = true}).ask().gradient;
    if (!gradient) return seen;
    limits[side] = *gradient;
  }
  const double size = std::max(limits[0].norm(), limits[1].norm());
  if ((limits[0] - limits[1]).norm() <= kSameGradient * size) {
    seen.gradient = (limits[0] + limits[1]) / 2;
  } else {
    seen.one_sided = limits;
  }
  return seen;
}

}  // namespace sightline
