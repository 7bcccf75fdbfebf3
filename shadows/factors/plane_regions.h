// Convex regions of a plane, cut by lines: what of a surface is left when shadows are
// taken away.

#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace sightline::internal {

struct FlatPoint {
  double x, y;
};

/// The points with a x + b y + c >= 0.
struct HalfPlane {
  double a, b, c;
  [[nodiscard]] double at(const FlatPoint& p) const { return a * p.x + b * p.y + c; }
  [[nodiscard]] HalfPlane complement() const { return {-a, -b, -c}; }
};

using PlanePolygon = std::vector<FlatPoint>;

/// Appends the part of a convex polygon in the half-plane; nothing where the polygon has
/// no point strictly inside.
inline void append_clipped(std::span<const FlatPoint> polygon, const HalfPlane& half,
                           PlanePolygon& out) {
  const std::size_t n = polygon.size();
  bool any = false;
  for (const FlatPoint& p : polygon) any = any || half.at(p) > 0;
  if (!any) return;
  double height = half.at(polygon[n - 1]);
  FlatPoint previous = polygon[n - 1];
  for (const FlatPoint& p : polygon) {
    const double h = half.at(p);
    if ((height > 0 && h < 0) || (height < 0 && h > 0)) {
      const double w = height / (height - h);
      out.push_back(
          {previous.x + w * (p.x - previous.x), previous.y + w * (p.y - previous.y)});
    }
    if (h >= 0) out.push_back(p);
    previous = p;
    height = h;
  }
}

/// Disjoint convex polygons; a scratch of storage that is used again and again.
class PlaneRegions {
 public:
  void assign(std::span<const FlatPoint> polygon) {
    points_.assign(polygon.begin(), polygon.end());
    ends_.assign(1, points_.size());
  }
  void clear() {
    points_.clear();
    ends_.clear();
  }
  [[nodiscard]] bool empty() const { return ends_.empty(); }
  [[nodiscard]] std::size_t size() const { return ends_.size(); }
  [[nodiscard]] std::span<const FlatPoint> operator[](std::size_t i) const {
    const std::size_t first = i == 0 ? 0 : ends_[i - 1];
    return std::span(points_).subspan(first, ends_[i] - first);
  }

  /// What lies in the half-plane remains.
  void keep(const HalfPlane& half);
  /// What lies in all of these half-planes goes.
  void remove(std::span<const HalfPlane> all);

 private:
  void push(std::span<const FlatPoint> polygon) {
    next_points_.insert(next_points_.end(), polygon.begin(), polygon.end());
    next_ends_.push_back(next_points_.size());
  }
  void finish() {
    std::swap(points_, next_points_);
    std::swap(ends_, next_ends_);
  }
  bool cut(std::span<const FlatPoint> polygon, std::span<const HalfPlane> all);

  std::vector<FlatPoint> points_, next_points_, inside_, clipped_;
  std::vector<std::size_t> ends_, next_ends_;
};

inline void PlaneRegions::keep(const HalfPlane& half) {
  next_points_.clear();
  next_ends_.clear();
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t before = next_points_.size();
    append_clipped((*this)[i], half, next_points_);
    if (next_points_.size() > before) next_ends_.push_back(next_points_.size());
  }
  finish();
}

/// No point of the polygon is strictly inside all half-planes, as one of them alone
/// shows.
inline bool surely_outside(std::span<const FlatPoint> polygon,
                           std::span<const HalfPlane> all) {
  for (const HalfPlane& half : all) {
    bool outside = true;
    for (const FlatPoint& p : polygon) outside = outside && half.at(p) <= 0;
    if (outside) return true;
  }
  return false;
}

// Pushes what of the polygon is outside some half-plane; false if that is all of it.
inline bool PlaneRegions::cut(std::span<const FlatPoint> polygon,
                              std::span<const HalfPlane> all) {
  const std::size_t points = next_points_.size(), ends = next_ends_.size();
  inside_.assign(polygon.begin(), polygon.end());
  for (const HalfPlane& half : all) {
    const std::size_t before = next_points_.size();
    append_clipped(inside_, half.complement(), next_points_);
    if (next_points_.size() > before) next_ends_.push_back(next_points_.size());
    clipped_.clear();
    append_clipped(inside_, half, clipped_);
    std::swap(inside_, clipped_);
    if (inside_.empty()) {
      next_points_.resize(points);
      next_ends_.resize(ends);
      return false;
    }
  }
  return true;
}

inline void PlaneRegions::remove(std::span<const HalfPlane> all) {
  bool touched = false;
  for (std::size_t i = 0; i < size() && !touched; ++i) {
    touched = !surely_outside((*this)[i], all);
  }
  if (!touched) return;
  next_points_.clear();
  next_ends_.clear();
  for (std::size_t i = 0; i < size(); ++i) {
    const auto polygon = (*this)[i];
    if (surely_outside(polygon, all) || !cut(polygon, all)) push(polygon);
  }
  finish();
}

/// Twice the area, counter-clockwise positive.
[[nodiscard]] inline double doubled_area(std::span<const FlatPoint> polygon) {
  double sum = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const FlatPoint &o = polygon[0], &a = polygon[i - 1], &b = polygon[i];
    sum += (a.x - o.x) * (b.y - o.y) - (b.x - o.x) * (a.y - o.y);
  }
  return sum;
}

}  // namespace sightline::internal
