#include "shadows/factors/exposed_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "linespace/predicates.h"
#include "shadows/factors/exchange_geometry.h"

namespace sightline::internal {
namespace {

std::vector<int> faces_of_solids(const Scene& scene) {
  std::vector<int> faces;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    if (scene.solid_behind(static_cast<int>(f))) faces.push_back(static_cast<int>(f));
  }
  return faces;
}

PointList points_of(const Scene& scene, int face) {
  PointList points;
  for (const int p : scene.face_points(face)) points.push_back(scene.point(p));
  return points;
}

std::vector<Box> boxes_of(const Scene& scene, const std::vector<int>& faces) {
  std::vector<Box> boxes;
  for (const int f : faces) boxes.push_back(box_of(points_of(scene, f)));
  return boxes;
}

bool overlap(const Box& a, const Box& b) {
  for (int i = 0; i < 3; ++i) {
    if (a.max[i] < b.min[i] || b.max[i] < a.min[i]) return false;
  }
  return true;
}

using Segment = std::array<Point, 2>;

/// Along which a face meets the plane of c from before it; its sides, where it lies in
/// the plane.
std::vector<Segment> traces(const PointList& face, const std::array<Point, 3>& c) {
  std::vector<Segment> result;
  std::vector<Sign> signs;
  for (const Point& p : face) signs.push_back(orient3d(c[0], c[1], c[2], p));
  const auto has = [&](Sign s) { return std::ranges::find(signs, s) != signs.end(); };
  const std::size_t n = face.size();
  if (!has(Sign::Positive) && !has(Sign::Negative)) {
    for (std::size_t i = 0; i < n; ++i) result.push_back({face[i], face[(i + 1) % n]});
    return result;
  }
  if (!has(Sign::Positive)) return result;
  std::vector<Point> ends;
  const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    if (signs[i] == Sign::Zero) ends.push_back(face[i]);
    if (signs[i] * signs[j] == Sign::Negative) {
      const double a = normal.dot(face[i] - c[0]), b = normal.dot(face[j] - c[0]);
      ends.emplace_back(face[i] + a / (a - b) * (face[j] - face[i]));
    }
  }
  if (ends.size() >= 2) result.push_back({ends.front(), ends.back()});
  return result;
}

/// The parts of a convex polygon to both sides of a segment's line, where the segment
/// crosses it.
std::vector<PointList> split(const PointList& polygon, const Segment& segment,
                             const Eigen::Vector3d& normal) {
  const Eigen::Vector3d along = segment[1] - segment[0];
  const Eigen::Vector3d across = normal.cross(along);
  const double slack = 1e-12 * across.norm();
  double size = 0;
  for (const Point& p : polygon) size = std::max(size, (p - polygon[0]).norm());
  std::vector<double> heights;
  bool left = false, right = false;
  double low = 1, high = 0;  // of the polygon's stretch on the line, in segments
  for (const Point& p : polygon) {
    double h = across.dot(p - segment[0]);
    if (std::abs(h) <= slack * size) h = 0;
    heights.push_back(h);
    left = left || h > 0;
    right = right || h < 0;
  }
  if (!left || !right) return {polygon};
  PointList a, b;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t j = (i + 1) % polygon.size();
    const auto mark = [&](const Point& p) {
      const double t = along.dot(p - segment[0]) / along.squaredNorm();
      low = std::min(low, t);
      high = std::max(high, t);
      a.push_back(p);
      b.push_back(p);
    };
    if (heights[i] > 0) a.push_back(polygon[i]);
    if (heights[i] < 0) b.push_back(polygon[i]);
    if (heights[i] == 0) mark(polygon[i]);
    if (heights[i] * heights[j] < 0) {
      mark(polygon[i] +
           heights[i] / (heights[i] - heights[j]) * (polygon[j] - polygon[i]));
    }
  }
  if (high <= 1e-12 || low >= 1 - 1e-12) return {polygon};
  return {a, b};
}

}  // namespace

ExposedParts::ExposedParts(const Scene& scene)
    : scene_(scene),
      solids_(scene),
      faces_(faces_of_solids(scene)),
      tree_(boxes_of(scene, faces_)) {}

std::vector<PointList> ExposedParts::of(const PointList& polygon, bool& buried) const {
  if (faces_.empty()) return {polygon};
  std::vector<PointList> exposed;
  bool any = false;
  for (PointList& part : cells(polygon)) {
    if (is_buried(part)) {
      any = true;
    } else {
      exposed.push_back(std::move(part));
    }
  }
  if (!any) return {polygon};
  buried = true;
  return exposed;
}

std::vector<PointList> ExposedParts::cells(const PointList& polygon) const {
  const auto c = spanning_corners(polygon);
  const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
  const Box box = box_of(polygon);
  std::vector<Segment> segments;
  tree_.traverse([&](const Box& b) { return overlap(box, b); },
                 [&](std::uint32_t item) {
                   for (Segment& s : traces(points_of(scene_, faces_[item]), c)) {
                     if (s[0] != s[1]) segments.push_back(s);
                   }
                 });
  std::vector<PointList> parts{polygon};
  for (const Segment& s : segments) {
    std::vector<PointList> next;
    for (const PointList& part : parts) {
      for (PointList& piece : split(part, s, normal)) {
        if (piece.size() >= 3) next.push_back(std::move(piece));
      }
    }
    parts = std::move(next);
  }
  return parts;
}

bool ExposedParts::is_buried(const PointList& part) const {
  Point middle = Point::Zero();
  for (const Point& p : part) middle += p;
  middle /= static_cast<double>(part.size());
  const auto c = spanning_corners(part);
  const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
  double size = 0;
  for (const Point& p : part) size = std::max(size, (p - middle).norm());
  return solids_.in_solid(middle + std::ldexp(size, -40) * normal);
}

}  // namespace sightline::internal
