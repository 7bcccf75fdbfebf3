#include "viewers/clip.h"

#include <algorithm>
#include <utility>

namespace sightline::viewers {
namespace {

/// Darker than anything lit, as on an architect's section.
constexpr Colour kCutColour{0.33F, 0.34F, 0.38F};

/// Where the segment from a to b, with ends on different sides of the plane, crosses it.
Point crossing(const Point& a, const Point& b, int axis, double at) {
  return a + (at - a[axis]) / (b[axis] - a[axis]) * (b - a);
}

/// The part of the polygon where sign * (coordinate - at) >= 0.
std::vector<Point> clip_at_plane(std::span<const Point> polygon, int axis, double at,
                                 double sign) {
  std::vector<Point> kept;
  const auto height = [&](const Point& p) { return sign * (p[axis] - at); };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    if (height(a) >= 0) kept.push_back(a);
    // Strictly on both sides: an end in the plane is no crossing of its own.
    if ((height(a) > 0 && height(b) < 0) || (height(a) < 0 && height(b) > 0)) {
      kept.push_back(crossing(a, b, axis, at));
    }
  }
  return kept;
}

}  // namespace

std::vector<Point> clip_polygon(std::span<const Point> polygon,
                                const std::array<Point, 2>& box) {
  std::vector<Point> kept(polygon.begin(), polygon.end());
  for (int axis = 0; axis < 3; ++axis) {
    kept = clip_at_plane(kept, axis, box[0][axis], 1);
    kept = clip_at_plane(kept, axis, box[1][axis], -1);
    if (kept.size() < 3) return {};
  }
  // Crossings are rounded, and may have left the box by that.
  for (Point& p : kept) p = p.cwiseMax(box[0]).cwiseMin(box[1]);
  return kept;
}

std::optional<std::array<Point, 2>> clip_segment(const std::array<Point, 2>& segment,
                                                 const std::array<Point, 2>& box) {
  const auto& [a, b] = segment;
  const Point along = b - a;
  double from = 0, to = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (along[axis] == 0) {
      if (a[axis] < box[0][axis] || a[axis] > box[1][axis]) return std::nullopt;
      continue;
    }
    double enters = (box[0][axis] - a[axis]) / along[axis];
    double leaves = (box[1][axis] - a[axis]) / along[axis];
    if (enters > leaves) std::swap(enters, leaves);
    from = std::max(from, enters);
    to = std::min(to, leaves);
  }
  if (along.isZero(0) || from >= to) return std::nullopt;
  const auto at = [&](double t) -> Point {
    if (t == 0) return a;
    if (t == 1) return b;
    return (a + t * along).cwiseMax(box[0]).cwiseMin(box[1]);
  };
  return std::array<Point, 2>{at(from), at(to)};
}

Drawing clipped(const Drawing& drawing, const std::array<Point, 2>& box) {
  Drawing inside;
  // Both kinds of triangle: the polygon that is left, as a fan.
  const auto clip_into = [&box](const auto& triangle, auto& triangles) {
    const std::vector<Point> polygon = clip_polygon(triangle.points, box);
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      triangles.push_back(triangle);
      triangles.back().points = {polygon[0], polygon[i - 1], polygon[i]};
    }
  };
  inside.cut.emplace(CutSolids{box, {}, kCutColour});
  for (const PaintedTriangle& t : drawing.triangles) {
    clip_into(t, inside.triangles);
    if (t.solid) inside.cut->triangles.push_back(t.points);
  }
  for (const VeilTriangle& t : drawing.veils) clip_into(t, inside.veils);
  for (const Stroke& stroke : drawing.strokes) {
    if (const auto points = clip_segment(stroke.points, box)) {
      inside.strokes.push_back(stroke);
      inside.strokes.back().points = *points;
    }
  }
  return inside;
}

bool is_empty(const Drawing& drawing) {
  return drawing.triangles.empty() && drawing.veils.empty() && drawing.strokes.empty();
}

}  // namespace sightline::viewers
