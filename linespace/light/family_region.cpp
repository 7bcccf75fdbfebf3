#include "linespace/light/family_region.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::internal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A point of weight 1; nullopt where it may be far away.
std::optional<Point> rounded_point(const Four<Approx>& x) {
  if (!is_certain(x[3]) || std::abs(x[3].v) < 0x1p20 * x[3].e) return std::nullopt;
  return Point(x[0].v / x[3].v, x[1].v / x[3].v, x[2].v / x[3].v);
}

Box padded_box(const Point& a, const Point& b, double pad) {
  Box box;
  for (int i = 0; i < 3; ++i) {
    box.min[i] = std::min(a[i], b[i]) - pad;
    box.max[i] = std::max(a[i], b[i]) + pad;
  }
  return box;
}

// Restricts l in [from, to] to where at + rate l >= 0; false where nothing is left.
bool clip(double at, double rate, double& from, double& to) {
  if (rate > 0) {
    from = std::max(from, -at / rate);
  } else if (rate < 0) {
    to = std::min(to, -at / rate);
  } else if (at < 0) {
    return false;
  }
  return from <= to;
}

// Points P + l (Q - P), 0 <= l <= 1, of P and Q in two boxes.
bool meets_between(const Box& p, const Box& q, const Box& box) {
  double from = 0;
  double to = 1;
  for (int i = 0; i < 3; ++i) {
    if (!clip(box.max[i] - p.min[i], p.min[i] - q.min[i], from, to) ||
        !clip(p.max[i] - box.min[i], q.max[i] - p.max[i], from, to)) {
      return false;
    }
  }
  return true;
}

// Points Q + l (Q - P), l >= 0.
bool meets_beyond(const Box& p, const Box& q, const Box& box) {
  double from = 0;
  double to = kInfinity;
  for (int i = 0; i < 3; ++i) {
    if (!clip(box.max[i] - q.min[i], p.max[i] - q.min[i], from, to) ||
        !clip(q.max[i] - box.min[i], q.max[i] - p.min[i], from, to)) {
      return false;
    }
  }
  return true;
}

}  // namespace

void FamilyRegion::add(const LineFamily& family, double from, double to) {
  const auto ends = [&](double s) {
    const FamilyLine line(family, s);
    return std::array{rounded_point(line.first()), rounded_point(line.last())};
  };
  const auto at0 = ends(from);
  const auto at1 = ends(to);
  if (!at0[0] || !at0[1] || !at1[0] || !at1[1]) {
    everywhere_ = true;
    return;
  }
  // Speed only.
  const double wide = (*at1[0] - *at0[0]).norm() + (*at1[1] - *at0[1]).norm();
  const double apart = (*at0[0] + *at1[0] - *at0[1] - *at1[1]).norm() / 2;
  const int steps = wide < 0.1 * apart ? 1 : wide < 0.3 * apart ? 2 : 4;
  if (!add_steps(family, from, to, steps)) everywhere_ = true;
}

bool FamilyRegion::add_steps(const LineFamily& family, double from, double to,
                             int steps) {
  std::array<std::optional<Point>, 2> before;
  for (int k = 0; k <= steps; ++k) {
    const FamilyLine line(family, k == steps ? to : from + (to - from) * k / steps);
    const std::array at{rounded_point(line.first()), rounded_point(line.last())};
    if (!at[0] || !at[1]) return false;
    if (k > 0) {
      parts_.push_back(
          {padded_box(*before[0], *at[0], pad_), padded_box(*before[1], *at[1], pad_)});
    }
    before = at;
  }
  return true;
}

void FamilyRegion::set_plane(const Four<Approx>& plane) { plane_ = plane; }

bool FamilyRegion::meets(const Part& part, const Box& box) {
  return meets_between(part.first, part.last, box) ||
         meets_beyond(part.first, part.last, box) ||
         meets_beyond(part.last, part.first, box);
}

bool FamilyRegion::may_meet(const Box& box) const {
  if (plane_) {
    double low = (*plane_)[3].v;
    double high = low;
    double error = (*plane_)[3].e;
    double size = std::abs(low);
    for (int i = 0; i < 3; ++i) {
      const double n = (*plane_)[i].v;
      const double a = n * box.min[i];
      const double b = n * box.max[i];
      low += std::min(a, b);
      high += std::max(a, b);
      const double far = std::max(std::abs(box.min[i]), std::abs(box.max[i]));
      error += (*plane_)[i].e * far;
      size += std::abs(n) * far;
    }
    const double margin = 2 * error + 0x1p-48 * size;
    if (low > margin || high < -margin) return false;
  }
  if (everywhere_) return true;
  return std::ranges::any_of(parts_, [&](const Part& part) { return meets(part, box); });
}

}  // namespace sightline::internal
