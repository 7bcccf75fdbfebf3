#include "shadows/planar/arcs/arc_box.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::internal {

// The polar form c0 + c1 (u + v) / 2 + c2 u v at (from, from), (from, to) and (to, to).
std::array<std::array<BallNumber, 3>, 3> control_points(const PlaneSupport& support,
                                                        const BallNumber& from,
                                                        const BallNumber& to) {
  const BallNumber half{0.5, 0, 0};
  std::array<std::array<BallNumber, 3>, 3> points;
  for (int i = 0; i < 3; ++i) {
    const std::array<BallNumber, 3>& c = support.balls.curve[i];
    if (support.straight) {
      points[0][i] = c[0] + c[1] * from;
      points[1][i] = c[0] + c[1] * to;
      points[2][i] = points[1][i];
      continue;
    }
    points[0][i] = c[0] + from * (c[1] + from * c[2]);
    points[1][i] = c[0] + half * c[1] * (from + to) + c[2] * (from * to);
    points[2][i] = c[0] + to * (c[1] + to * c[2]);
  }
  return points;
}

namespace {

BallNumber value_at(const std::array<BallNumber, 3>& c, const BallNumber& s, int degree) {
  return degree == 1 ? c[0] + c[1] * s : c[0] + s * (c[1] + s * c[2]);
}

// How far u / w is at most from its value in the middle of s: by the mean value theorem.
double deviation(const std::array<BallNumber, 3>& u, const std::array<BallNumber, 3>& w,
                 const BallNumber& s, const DoubleRange& w_range, int degree) {
  const DoubleRange slope_range = range(value_at(slope(u, w), s, degree));
  const double steepest = std::max(std::abs(slope_range.lo), std::abs(slope_range.hi));
  const double least = std::min(std::abs(w_range.lo), std::abs(w_range.hi));
  return steepest / (least * least) * s.radius * (1 + 8 * kUnit);
}

}  // namespace

std::optional<PointRange> point_range(const PlaneSupport& support, const BallNumber& s) {
  const auto& c = support.balls.curve;
  const int degree = support.degree();
  const BallNumber middle{s.hi, s.lo, 0};
  const BallNumber w = value_at(c[2], middle, degree);
  const BallNumber all_w = value_at(c[2], s, degree);
  if (!sign_of(all_w)) return std::nullopt;
  PointRange out;
  for (const int i : {0, 1}) {
    const std::optional<DoubleRange> r =
        range_of_quotient(value_at(c[i], middle, degree), w);
    if (!r) return std::nullopt;
    DoubleRange& wider = i == 0 ? out.x : out.y;
    wider = *r;
    if (s.radius == 0) continue;
    const double d = deviation(c[i], c[2], s, range(all_w), degree);
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    wider = {std::nextafter(r->lo - d, -kInfinity), std::nextafter(r->hi + d, kInfinity)};
  }
  return out;
}

// With positive weights a curve lies in the convex hull of its control points.
std::optional<PointRange> box_of(const PlaneSupport& support, const DoubleRange& s) {
  const auto points = control_points(support, {s.lo, 0, 0}, {s.hi, 0, 0});
  std::optional<PointRange> box;
  for (int i = 0; i < (support.straight ? 2 : 3); ++i) {
    if (sign_of(points[i][2]) != Sign::Positive) return std::nullopt;
    const std::optional<DoubleRange> x = range_of_quotient(points[i][0], points[i][2]);
    const std::optional<DoubleRange> y = range_of_quotient(points[i][1], points[i][2]);
    if (!x || !y) return std::nullopt;
    if (!box) box = PointRange{*x, *y};
    box->x = {std::min(box->x.lo, x->lo), std::max(box->x.hi, x->hi)};
    box->y = {std::min(box->y.lo, y->lo), std::max(box->y.hi, y->hi)};
  }
  return box;
}

}  // namespace sightline::internal
