#include "aspect/choice/view_regions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "linespace/numbers/rational.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {

ViewSpace::ViewSpace(const Scene& scene, const ViewpointRequest& request)
    : centre_(Point::Zero()), size_(1) {
  if (request.projection == Projection::Perspective && request.bounds) {
    const auto& [low, high] = *request.bounds;
    whole_.push_back({{low[0], low[1], low[2], 1}, {high[0], high[1], high[2], 1}});
    return;
  }
  const bool eyes = request.projection == Projection::Perspective;
  if (eyes) {
    centre_ = (scene.bounds()[0] + scene.bounds()[1]) / 2;
    const double extent = (scene.bounds()[1] - scene.bounds()[0]).maxCoeff();
    size_ = std::exp2(std::ceil(std::log2(std::max(extent, 0x1p-140))));
    whole_.push_back({{-1, -1, -1, 1}, {1, 1, 1, 1}});
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      ViewRegion r{{-1, -1, -1, 0}, {1, 1, 1, eyes ? 1.0 : 0.0}};
      r.low[axis] = r.high[axis] = sign;
      whole_.push_back(r);
    }
  }
}

std::array<ViewRegion, 2> ViewSpace::halves(const ViewRegion& region) const {
  int widest = 0;
  for (int i = 1; i < 4; ++i) {
    if (region.high[i] - region.low[i] > region.high[widest] - region.low[widest])
      widest = i;
  }
  // Off the middle, where aligned scenes have their planes.
  const double at = region.low[widest] * 0.515625 + region.high[widest] * 0.484375;
  std::array<ViewRegion, 2> out{region, region};
  out[0].high[widest] = out[1].low[widest] = at;
  return out;
}

ViewSpace::Range ViewSpace::range(const ViewRegion& region, const PatchSide& side) const {
  const Eigen::Vector3d to = centre_ - side.on;
  const double constant = side.normal.dot(to);
  double least = std::min(constant * region.low[3], constant * region.high[3]);
  double most = std::max(constant * region.low[3], constant * region.high[3]);
  double error = 0;
  for (int i = 0; i < 3; ++i) {
    const double n = side.normal[i] * size_;
    least += std::min(n * region.low[i], n * region.high[i]);
    most += std::max(n * region.low[i], n * region.high[i]);
    const double x = std::max(std::abs(region.low[i]), std::abs(region.high[i]));
    error += side.slack[i] *
             (size_ * x + (std::abs(centre_[i]) + std::abs(side.on[i])) * region.high[3]);
  }
  return {least, most, kSlack * error};
}

bool ViewSpace::behind(const ViewRegion& region, const PatchSide& side) const {
  const Range r = range(region, side);
  if (r.most > r.error) return false;
  // The other way round it is never below its plane.
  return r.most < -r.error ||
         never_below(region, side.plane[0], side.plane[2], side.plane[1]);
}

bool ViewSpace::in_front(const ViewRegion& region, const PatchSide& side) const {
  const Range r = range(region, side);
  return r.least > r.error;
}

bool ViewSpace::never_below(const ViewRegion& region, const Point& a, const Point& b,
                            const Point& c) const {
  // 1. In doubles: the normal m of abc, and the least of m . (size x + (centre - a) w).
  const Eigen::Vector3d u = b - a, v = c - a, m = u.cross(v);
  const double constant = m.dot(centre_ - a);
  double least = std::min(constant * region.low[3], constant * region.high[3]);
  double error = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double n = m[i] * size_;
    least += std::min(n * region.low[i], n * region.high[i]);
    const double x = std::max(std::abs(region.low[i]), std::abs(region.high[i]));
    error += (std::abs(u[j] * v[k]) + std::abs(u[k] * v[j])) *
             (size_ * x + (std::abs(centre_[i]) + std::abs(a[i])) * region.high[3]);
  }
  error *= kSlack;
  if (least > error) return true;
  if (least < -error) return false;
  // 2. The same in rational numbers.
  const ExactPoint p = exact_point(a), q = exact_point(centre_);
  const ExactPoint n = exact_cross(exact_difference(exact_point(b), p),
                                   exact_difference(exact_point(c), p));
  const auto smaller = [](const Rational& slope, double low, double high) {
    return Rational(slope * Rational(slope < 0 ? high : low));
  };
  Rational exact =
      smaller(exact_dot(n, exact_difference(q, p)), region.low[3], region.high[3]);
  for (int i = 0; i < 3; ++i)
    exact += smaller(n[i] * Rational(size_), region.low[i], region.high[i]);
  return exact >= 0;
}

Point ViewSpace::middle(const ViewRegion& region) const {
  Point x;
  for (int i = 0; i < 3; ++i) x[i] = region.low[i] * 0.49 + region.high[i] * 0.51;
  const double w = (region.low[3] + region.high[3]) / 2;
  constexpr double kFar = 0x1p-10;  // instead of 0: only a place to look from
  return centre_ + size_ * x / std::max(w, kFar);
}

double ViewSpace::most_sine(const ViewRegion& region, const PatchSide& side) const {
  const Range r = range(region, side);
  double squared = 0;
  for (int i = 0; i < 3; ++i) {
    const double lo = region.low[i], hi = region.high[i];
    const double near = lo > 0 ? lo : hi < 0 ? -hi : 0;
    squared += near * near;
  }
  const double length = side.normal.norm() * std::sqrt(squared) * size_;
  // Two lengths, their product and a quotient: eight roundings at most.
  return std::clamp((r.most + r.error) / length * (1 + 16 * kUnit), 0.0, 1.0);
}

double ViewSpace::least_distance(const ViewRegion& region, const Point& low,
                                 const Point& high) const {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  double squared = 0;
  for (int i = 0; i < 3; ++i) {
    // x / w is least where x is, with the largest w above 0, the least one below.
    const auto over = [&](double x, bool least) {
      const double w = (x > 0) == least ? region.high[3] : region.low[3];
      if (x == 0) return 0.0;
      return w > 0 ? x / w : x > 0 ? kInfinite : -kInfinite;
    };
    const double from = centre_[i] + size_ * over(region.low[i], true);
    const double to = centre_[i] + size_ * over(region.high[i], false);
    // A quotient, a product, a sum and the difference round, each by a unit of a size
    // that is one of these.
    const auto rounding = [&](double end, double other) {
      return 8 * kUnit * (2 * std::abs(centre_[i]) + std::abs(end) + std::abs(other));
    };
    double gap = 0;
    if (std::isfinite(from)) gap = from - high[i] - rounding(from, high[i]);
    if (std::isfinite(to)) gap = std::max(gap, low[i] - to - rounding(to, low[i]));
    if (from == kInfinite || to == -kInfinite) return kInfinite;
    gap = std::max(gap, 0.0);
    squared += gap * gap;
  }
  // Three squares, two sums and a root.
  return std::sqrt(squared) * (1 - 8 * kUnit);
}

double bound_over(const ViewSpace& space, const std::vector<PatchSide>& sides,
                  const RegionBound& bound, double reached, int steps) {
  struct Open {
    double bound;
    ViewRegion region;
    std::vector<int> possible;
    bool operator<(const Open& other) const { return bound < other.bound; }
  };
  std::priority_queue<Open> open;
  const auto add = [&](const ViewRegion& region, const std::vector<int>& of) {
    std::vector<int> possible;
    for (const int s : of) {
      if (!space.behind(region, sides[s])) possible.push_back(s);
    }
    const double b = bound(region, possible);
    open.push({b, region, std::move(possible)});
  };
  std::vector<int> all(sides.size());
  for (std::size_t s = 0; s < all.size(); ++s) all[s] = static_cast<int>(s);
  for (const ViewRegion& region : space.whole()) add(region, all);
  for (int step = 0; step < steps && open.top().bound > reached; ++step) {
    hear_stop();
    const Open top = open.top();
    open.pop();
    for (const ViewRegion& half : space.halves(top.region)) add(half, top.possible);
  }
  return std::max(open.top().bound, reached);
}

double most_together(const std::vector<PatchSide>& sides,
                     const std::vector<int>& possible, const std::vector<double>& weight,
                     bool far) {
  double sum = 0;
  for (std::size_t i = 0; i < possible.size();) {
    // 1. The planes parallel to this one, and what faces against them in all.
    const int group = sides[possible[i]].group;
    std::size_t end = i;
    double along = 0, against = 0;
    for (; end < possible.size() && sides[possible[end]].group == group; ++end)
      (sides[possible[end]].along ? along : against) += weight[end];
    // 2. An eye between two planes is in front of those below it that face along, and of
    // those above it that face against.  Going up:
    double most = std::max(along, against), now = against;
    while (i < end) {
      const int rank = sides[possible[i]].rank;
      for (; i < end && sides[possible[i]].rank == rank; ++i)
        now += sides[possible[i]].along ? weight[i] : -weight[i];
      if (!far) most = std::max(most, now);
    }
    sum += most;
  }
  return sum;
}

}  // namespace sightline::internal
