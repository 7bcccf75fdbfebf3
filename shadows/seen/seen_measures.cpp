#include "shadows/seen/seen_measures.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace sightline::internal {
namespace {

// What a sum of long doubles may be off, relatively, before an area is summed up in
// rational numbers: a tenth of the 1e-13 that are promised.
constexpr long double kAreaError = 1e-14L;

// Below this a form factor is the part's area times what its middle gives: of a part so
// small that relative error is below its extent over its distance, and the sum over its
// sides would be rounding.
constexpr double kSmallFactor = 1e-15;

}  // namespace

double seen_area(const PlaneFrame& frame, const SeenPart& part) {
  if (part.edges.empty()) return 0;
  std::vector<PlaneFrame::Placed> places;
  for (const PicturePoint& p : part.points) places.push_back(frame.place(p));
  const LongEigen origin = places[part.edges.front().from].at;
  long double twice = 0, error = 0;
  for (const SeenPart::Edge& e : part.edges) {
    const LongEigen u = places[e.from].at - origin, v = places[e.to].at - origin;
    twice += frame.normal().dot(u.cross(v));
    const long double off = places[e.from].error + places[e.to].error;
    error += 4 * off * (u.norm() + v.norm()) + 0x1p-60L * u.norm() * v.norm();
  }
  if (error < kAreaError * twice) return static_cast<double>(twice / 2);
  Rational sum = 0;
  for (const SeenPart::Edge& e : part.edges) {
    sum += exact_dot(frame.exact_normal(),
                     exact_cross(frame.exact_place(part.points[e.from]),
                                 frame.exact_place(part.points[e.to])));
  }
  const Rational squared = exact_dot(frame.exact_normal(), frame.exact_normal());
  // |n| of an n that may leave the range of doubles when squared.
  const Rational ratio = sum * sum / squared;
  return sum.sign() * std::sqrt(nearest_double(ratio)) / 2;
}

namespace {

// Of the form factor's integral over what lies on the left of an edge.  The arc runs from
// u to v; what the eye sees on the left of it lies on the right, seen from outside the
// sphere of directions.
long double lambert(const LongEigen& u, const LongEigen& v, const LongEigen& across,
                    const LongEigen& normal) {
  const long double length = across.norm();
  if (length == 0) return 0;
  return std::atan2(length, u.dot(v)) / length * normal.dot(across);
}

// The cross product of the unit vectors to two points of the picture.  From very near to
// the line through them little of it is left, and it is computed exactly.
LongEigen cross_of(const PicturePoint& p, const LongEigen& u, const PicturePoint& q,
                   const LongEigen& v) {
  constexpr long double kNearLine = 0x1p-20L;
  const LongEigen across = u.cross(v);
  if (across.norm() > kNearLine) return across;
  const ExactPoint &x = p.exact(), &y = q.exact();
  return long_eigen(exact_cross(x, y)) / (long_eigen(x).norm() * long_eigen(y).norm());
}

// With a step s of the eye the direction u of a fixed point of the edge's line, at the
// distance r, moves by -s / r across the arc, so that the integral changes by that times
// its integrand, normal . u, along the arc.  1 / r = foot . u / |foot|^2.
LongEigen arc_gradient(const LongEigen& u, const LongEigen& v, const LongEigen& outwards,
                       const LongEigen& foot, const LongEigen& normal) {
  const long double angle = std::atan2(u.cross(v).norm(), u.dot(v));
  const LongEigen w = (v - u * u.dot(v)).normalized();
  const long double s = std::sin(angle), c = std::cos(angle);
  const long double cc = (angle + s * c) / 2, ss = (angle - s * c) / 2, sc = s * s / 2;
  const long double n1 = normal.dot(u), n2 = normal.dot(w);
  const long double f1 = foot.dot(u), f2 = foot.dot(w);
  const long double integral = n1 * f1 * cc + (n1 * f2 + n2 * f1) * sc + n2 * f2 * ss;
  return -outwards * (integral / foot.squaredNorm());
}

}  // namespace

SeenFormFactor seen_form_factor(const SourceView& view, const PlaneFrame& frame,
                                const SeenPart& part, const LongEigen& normal,
                                double area) {
  const EyeSpace& eye = view.eye();
  std::vector<LongEigen> rays;  // unit vectors to the points
  for (const PicturePoint& p : part.points) {
    rays.push_back(p.error() <= 0x1p-58L
                       ? LongEigen(-long_eigen(p.vector()))
                       : LongEigen(-long_eigen(p.exact()).normalized()));
  }
  long double sum = 0;
  LongEigen gradient = LongEigen::Zero();
  std::vector<int> in_line;
  for (const SeenPart::Edge& e : part.edges) {
    const LongEigen &u = rays[e.from], &v = rays[e.to];
    const LongEigen across = cross_of(part.points[e.from], u, part.points[e.to], v);
    sum -= lambert(u, v, across, normal) / 2;
    if (std::ranges::count(e.lines, view.horizon_line()) > 0) continue;
    const bool single = std::ranges::all_of(e.lines, [&](int line) {
      return eye.scene().on_one_line(line, e.lines.front());
    });
    if (!single) in_line.push_back(e.lines.front());
    const auto [a, b] = eye.scene().lines()[e.lines.front()].ends;
    const LongEigen p = -long_eigen(eye.vector(a)), q = -long_eigen(eye.vector(b));
    LongEigen outwards = p.cross(q).normalized();
    if (!e.forward) outwards = -outwards;
    const LongEigen along = q - p;
    const LongEigen foot = p - along * (p.dot(along) / along.squaredNorm());
    gradient += arc_gradient(u, v, outwards, foot, normal);
  }
  constexpr long double kPi = std::numbers::pi_v<long double>;
  SeenFormFactor factor{static_cast<double>(sum / kPi), std::nullopt, std::move(in_line)};
  if (factor.in_line.empty()) factor.gradient = (gradient / kPi).cast<double>();
  if (std::abs(factor.value) < kSmallFactor) {
    LongEigen middle = LongEigen::Zero();
    for (const LongEigen& r : rays) middle += r;
    middle.normalize();
    const long double r = frame.distance(middle);
    factor.value =
        std::max(0.0, static_cast<double>(area * normal.dot(middle) *
                                          -frame.normal().dot(middle) / (kPi * r * r)));
  }
  return factor;
}

double open_area(const SourceScene& source, const SourcePlane& plane) {
  const Scene& scene = source.scene().scene();
  if (plane.faces.size() == 1) {
    ExactPoint twice{};
    const auto corners = scene.face_points(plane.faces.front());
    const ExactPoint a = exact_point(scene.point(corners[0]));
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const ExactPoint triangle =
          exact_cross(exact_difference(exact_point(scene.point(corners[k - 1])), a),
                      exact_difference(exact_point(scene.point(corners[k])), a));
      for (int i = 0; i < 3; ++i) twice[i] += triangle[i];
    }
    return static_cast<double>(long_eigen(twice).norm()) / 2;
  }
  // What an eye sees that nothing stands before.
  Point middle = Point::Zero();
  for (const Point& p : plane.hull) middle += p / static_cast<double>(plane.hull.size());
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double size = 0;
  for (std::size_t k = 2; k < plane.hull.size(); ++k) {
    normal += (plane.hull[k - 1] - plane.hull[0]).cross(plane.hull[k] - plane.hull[0]);
    size = std::max(size, (plane.hull[k] - plane.hull[0]).norm());
  }
  const Point apart = middle + normal.normalized() * size;
  const SourceView view(
      {.source = &source, .plane = &plane, .eye = eye_at(apart), .hide = false});
  return seen_area(PlaneFrame(source, plane, view.eye()), seen_part(view));
}

}  // namespace sightline::internal
