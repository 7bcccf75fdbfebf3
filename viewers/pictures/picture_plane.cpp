#include "viewers/pictures/picture_plane.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sightline::viewers {
namespace {

/// Some room is left around what is seen, a share of its extent on each side.
constexpr double kMargin = 0.03;

PlaneWindow square(double half) { return {{-half, -half}, {half, half}}; }

/// With room around it; where it has no extent, that of the other axis, or 1.
PlaneWindow with_margin(const PlaneWindow& tight) {
  PlanePoint extent = tight.high - tight.low;
  const double largest = extent.maxCoeff() > 0 ? extent.maxCoeff() : 1;
  // A picture that is all but a line is drawn as a line in a square.
  for (double& e : extent) e = e > 1e-6 * largest ? e : largest;
  const PlanePoint middle = 0.5 * (tight.low + tight.high);
  const PlanePoint half = (0.5 + kMargin) * extent;
  return {middle - half, middle + half};
}

/// Half the angle by which a window opens to the left, right, top and bottom, at most.
double half_angle(const PlaneWindow& w) {
  return std::atan(std::max(w.low.cwiseAbs().maxCoeff(), w.high.cwiseAbs().maxCoeff()));
}

Point sum_of_directions(const PointView& view) {
  Point sum = Point::Zero();
  for (const MapVertex& v : view.vertices) sum += v.at;
  return sum;
}

}  // namespace

PicturePlane::PicturePlane(const PointView& view, const std::array<Point, 2>& bounds,
                           const PictureWish& wish)
    : parallel_(view.eye.kind == Viewpoint::Kind::Direction) {
  const Point& at = view.eye.at.nearest;
  if (parallel_) {
    look(-at, wish.up);
    window_ = with_margin(around(view).value_or(square(1)));
  } else if (wish.towards) {
    const Point forward = *wish.towards - at;
    if (!(forward.norm() > 0))
      throw InvalidInput("the eye is the point it looks towards");
    look(forward, wish.up);
    window_ = square(std::tan(kUsual / 2));
  } else {
    look_at_what_is_seen(view, bounds, wish);
  }
  if (!parallel_ && wish.field_of_view) {
    window_ = square(std::tan(*wish.field_of_view / 2));
  }
  if (wish.window) window_ = *wish.window;
}

void PicturePlane::look(const Point& forward, const std::optional<Point>& up) {
  // Sines below this leave no digit of the picture's right.
  constexpr double kAlong = 1e-9;
  const Point f = forward.stableNormalized();
  Point top = up ? up->stableNormalized() : Point(Point::UnitZ());
  if (!up && f.cross(top).norm() < 1e-6) top = Point::UnitY();
  if (!(f.cross(top).norm() > kAlong))
    throw InvalidInput("up is along the line of sight");
  const Point right = f.cross(top).normalized();
  axes_ = {right, right.cross(f), f};
}

void PicturePlane::look_at_what_is_seen(const PointView& view,
                                        const std::array<Point, 2>& bounds,
                                        const PictureWish& wish) {
  const Point sum = sum_of_directions(view);
  if (sum.norm() > 1e-3) {
    look(sum, wish.up);
    // Each round turns to the middle of what the last one saw.
    constexpr int kRounds = 6;
    std::optional<PlaneWindow> tight = around(view);
    for (int round = 0; round < kRounds && tight; ++round) {
      const PlanePoint middle = 0.5 * (tight->low + tight->high);
      look(axes_[2] + middle.x() * axes_[0] + middle.y() * axes_[1], wish.up);
      tight = around(view);
    }
    if (tight) window_ = with_margin(*tight);
    if (tight && half_angle(window_) < kWidest / 2) return;
  }
  const Point up = wish.up ? wish.up->stableNormalized() : Point(Point::UnitZ());
  Point forward = 0.5 * (bounds[0] + bounds[1]) - view.eye.at.nearest;
  const double size = forward.norm();
  forward -= forward.dot(up) * up;
  if (!(forward.norm() > 1e-9 * size)) forward = up.unitOrthogonal();
  look(forward, wish.up);
  window_ = square(std::tan(kUsual / 2));
}

std::optional<PlaneWindow> PicturePlane::around(const PointView& view) const {
  if (view.vertices.empty()) return std::nullopt;
  PlaneWindow tight{PlanePoint::Constant(HUGE_VAL), PlanePoint::Constant(-HUGE_VAL)};
  for (const MapVertex& v : view.vertices) {
    const Point h = homogeneous(v.at);
    if (!(h.z() > 1e-3)) return std::nullopt;
    const PlanePoint p = h.head<2>() / h.z();
    tight.low = tight.low.cwiseMin(p);
    tight.high = tight.high.cwiseMax(p);
  }
  return tight;
}

Point PicturePlane::homogeneous(const Point& at) const {
  return {at.dot(axes_[0]), at.dot(axes_[1]), parallel_ ? 1 : at.dot(axes_[2])};
}

std::array<double, 4> PicturePlane::distances(const Point& h) const {
  return {h.x() - window_.low.x() * h.z(), window_.high.x() * h.z() - h.x(),
          h.y() - window_.low.y() * h.z(), window_.high.y() * h.z() - h.y()};
}

// The four sides of the window, seen from the eye, bound a cone that lies before it, so
// that no plane of its own need cut off what is behind the eye.

std::optional<std::array<PlanePoint, 2>> PicturePlane::clipped_piece(
    const Point& from, const Point& to) const {
  const Point a = homogeneous(from), b = homogeneous(to);
  const std::array<double, 4> at_a = distances(a), at_b = distances(b);
  double first = 0, last = 1;
  for (int side = 0; side < 4; ++side) {
    const double change = at_b[side] - at_a[side];
    if (at_a[side] < 0 && at_b[side] < 0) return std::nullopt;
    if (at_a[side] < 0) first = std::max(first, -at_a[side] / change);
    if (at_b[side] < 0) last = std::min(last, -at_a[side] / change);
  }
  if (!(first < last)) return std::nullopt;
  const auto point = [&](double t) -> PlanePoint {
    const Point h = t == 0 ? a : t == 1 ? b : Point(a + t * (b - a));
    return h.head<2>() / h.z();
  };
  return std::array{point(first), point(last)};
}

std::vector<PlanePoint> PicturePlane::clipped_polygon(std::span<const Point> ats) const {
  std::vector<Point> kept;
  for (const Point& at : ats) kept.push_back(homogeneous(at));
  for (int side = 0; side < 4; ++side) {
    std::vector<Point> in;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const Point& a = kept[i];
      const Point& b = kept[(i + 1) % kept.size()];
      const double at_a = distances(a)[side], at_b = distances(b)[side];
      if (at_a >= 0) in.push_back(a);
      if ((at_a >= 0) != (at_b >= 0)) in.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    kept = std::move(in);
  }
  std::vector<PlanePoint> polygon;
  for (const Point& h : kept) {
    if (h.z() > 0) polygon.push_back(h.head<2>() / h.z());
  }
  if (polygon.size() < 3) polygon.clear();
  return polygon;
}

}  // namespace sightline::viewers
