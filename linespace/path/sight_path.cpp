#include "linespace/path/sight_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "linespace/numbers/exact_position.h"

namespace sightline::internal {
namespace {

using Vector = Eigen::Vector3d;

// Relative error of a few dozen operations on doubles, generously.
constexpr double kRelative = 0x1p-44;

double determinant(const Vector& u, const Vector& v, const Vector& w) {
  return u.dot(v.cross(w));
}

Rational determinant(const ExactPoint& u, const ExactPoint& v, const ExactPoint& w) {
  return exact_dot(u, exact_cross(v, w));
}

// Zero iff an eye sees the three lines in one point: the determinant of the normals of
// the planes through the eye and each of them.
Rational eye_value(const ExactPoint& eye, const std::array<const PathLine*, 3>& lines) {
  std::array<ExactPoint, 3> n;
  for (int i = 0; i < 3; ++i) {
    n[i] = exact_cross(exact_difference(lines[i]->a.exact, eye),
                       exact_difference(lines[i]->b.exact, eye));
  }
  return determinant(n[0], n[1], n[2]);
}

// The same for a direction d, for which those normals are all across d: what the
// determinant is, over the weight w, for the eye d / w with w going to 0.  A line of
// direction s through a has the normal d x s + w a x s.
Rational direction_value(const ExactPoint& d,
                         const std::array<const PathLine*, 3>& lines) {
  std::array<ExactPoint, 3> s, m;
  for (int i = 0; i < 3; ++i) {
    s[i] = exact_difference(lines[i]->b.exact, lines[i]->a.exact);
    m[i] = exact_cross(lines[i]->a.exact, lines[i]->b.exact);
  }
  Rational sum = 0;
  for (int i = 0; i < 3; ++i) {
    sum += determinant(d, s[i], s[(i + 1) % 3]) * exact_dot(m[(i + 2) % 3], d);
  }
  return sum;
}

struct Bounded {
  double value, error;
};

Bounded eye_value(const Point& eye, const std::array<const PathLine*, 3>& lines,
                  double rounding) {
  std::array<Vector, 3> n;
  double product = 1, relative = kRelative;
  for (int i = 0; i < 3; ++i) {
    const Vector u = lines[i]->a.rounded - eye, v = lines[i]->b.rounded - eye;
    n[i] = u.cross(v);
    const double p = std::max(u.norm(), rounding), q = std::max(v.norm(), rounding);
    product *= p * q;
    relative += rounding / p + rounding / q;
  }
  return {determinant(n[0], n[1], n[2]), 64 * product * relative};
}

Bounded direction_value(const Point& d, const std::array<const PathLine*, 3>& lines,
                        double rounding) {
  std::array<Vector, 3> s, m;
  double product = std::max(d.squaredNorm(), rounding), relative = kRelative, reach = 0;
  const Point& origin = lines[0]->a.rounded;
  for (int i = 0; i < 3; ++i) {
    const Vector a = lines[i]->a.rounded - origin, b = lines[i]->b.rounded - origin;
    s[i] = b - a;
    m[i] = a.cross(b);
    const double length = std::max(s[i].norm(), rounding);
    product *= length;
    relative += rounding / length;
    reach = std::max({reach, a.norm(), b.norm(), rounding});
  }
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    sum += determinant(d, s[i], s[(i + 1) % 3]) * m[(i + 2) % 3].dot(d);
  }
  // Of m, of size length times reach, only the part across the line counts.
  return {sum, 64 * product * reach * (relative + rounding / reach)};
}

}  // namespace

SightPath::SightPath(Viewpoint::Kind kind, ExactPoint from, ExactPoint to, double size)
    : kind_(kind), from_(std::move(from)), to_(std::move(to)) {
  middle_ = at(Rational(1, 2));
  rounded_from_ = internal::rounded(from_);
  rounded_to_ = internal::rounded(to_);
  rounded_middle_ = internal::rounded(middle_);
  rounding_ = 0x1p-50 * size;
}

Viewpoint SightPath::eye(const Rational& u) const {
  return {kind_, exact_position(at(u))};
}

RoundedEye SightPath::rounded(double u) const {
  return {is_direction(), (1 - u) * rounded_from_ + u * rounded_to_};
}

std::optional<PathRoot> SightPath::in_plane(const PathPoint& p, const PathPoint& q,
                                            const PathPoint& r) const {
  const Vector u = q.rounded - p.rounded, v = r.rounded - p.rounded;
  const Vector n = u.cross(v);
  std::array<int, 2> sides{};
  for (int i = 0; i < 2; ++i) {
    const Point& eye = i == 0 ? rounded_from_ : rounded_to_;
    const Vector way = is_direction() ? eye : Vector(eye - p.rounded);
    const double a = std::max(u.norm(), rounding_), b = std::max(v.norm(), rounding_);
    const double c = is_direction() ? way.norm() : std::max(way.norm(), rounding_);
    const double way_error = is_direction() ? kRelative : rounding_ / c;
    const double error =
        16 * a * b * c * (kRelative + rounding_ / a + rounding_ / b + way_error);
    const double value = n.dot(way);
    sides[i] = std::abs(value) > error ? (value > 0 ? 1 : -1) : 0;
  }
  if (sides[0] * sides[1] > 0) return std::nullopt;
  const ExactPoint m =
      exact_cross(exact_difference(q.exact, p.exact), exact_difference(r.exact, p.exact));
  const auto [at0, at1] = plane_values(p.exact, m);
  return root_inside(at0, at1);
}

std::array<Rational, 2> SightPath::plane_values(const ExactPoint& p,
                                                const ExactPoint& normal) const {
  const Rational offset = is_direction() ? Rational(0) : exact_dot(normal, p);
  return {exact_dot(normal, from_) - offset, exact_dot(normal, to_) - offset};
}

bool SightPath::stays_in_plane(const PathPoint& p, const PathPoint& q,
                               const PathPoint& r) const {
  const ExactPoint m =
      exact_cross(exact_difference(q.exact, p.exact), exact_difference(r.exact, p.exact));
  const auto [at0, at1] = plane_values(p.exact, m);
  return m != ExactPoint{} && at0 == 0 && at1 == 0;
}

SightPath::Guess SightPath::guess_in_one_point(
    const std::array<const PathLine*, 3>& lines) const {
  const auto value = [&](const Point& eye) {
    return is_direction() ? direction_value(eye, lines, rounding_)
                          : eye_value(eye, lines, rounding_);
  };
  const Bounded at0 = value(rounded_from_), half = value(rounded_middle_),
                at1 = value(rounded_to_);
  const double error = 4 * (at0.error + half.error + at1.error);
  const double b0 = at0.value, b2 = at1.value;
  const double b1 = (4 * half.value - b0 - b2) / 2;
  Guess guess;
  const bool above = std::min({b0, b1, b2}) > error;
  const bool below = std::max({b0, b1, b2}) < -error;
  if (above || below) {
    guess.none = true;
    return guess;
  }
  const double a = b0 - 2 * b1 + b2, h = b1 - b0;
  const double d = h * h - a * b0;
  const double d_error = 8 * error * (std::abs(h) + std::abs(a) + std::abs(b0) + error);
  if (d < -d_error) {
    guess.none = true;
    return guess;
  }
  // A root is off by error / sqrt(d).
  if (d < 64 * d_error || error > 0x1p-28 * std::sqrt(d)) return guess;
  guess.sure = true;
  const double t = -(h + std::copysign(std::sqrt(d), h));
  constexpr double kMargin = 0x1p-26;
  for (const double u : {t / a, b0 / t}) {
    if (u > -kMargin && u < 1 + kMargin) guess.at[guess.count++] = u;
  }
  guess.none = guess.count == 0;
  return guess;
}

std::vector<PathRoot> SightPath::exact_in_one_point(
    const std::array<const PathLine*, 3>& lines) const {
  const auto value = [&](const ExactPoint& eye) {
    return is_direction() ? direction_value(eye, lines) : eye_value(eye, lines);
  };
  const Rational b0 = value(from_), b2 = value(to_);
  return roots_inside({b0, Rational((4 * value(middle_) - b0 - b2) / 2), b2});
}

}  // namespace sightline::internal
