#include "shadows/lines/line_layers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "linespace/predicates.h"

namespace sightline::internal {
namespace {

std::vector<Point> corners_of(const Scene& scene, int face) {
  std::vector<Point> corners;
  for (const int p : scene.face_points(face)) corners.push_back(scene.point(p));
  return corners;
}

std::vector<Box> boxes_of_faces(const Scene& scene) {
  std::vector<Box> boxes;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    boxes.push_back(box_of(corners_of(scene, static_cast<int>(f))));
  }
  return boxes;
}

Eigen::Vector4d plane_of_face(const Scene& scene, int face) {
  const std::vector<Point> c = corners_of(scene, face);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < c.size(); ++i) {
    normal += (c[i - 1] - c[0]).cross(c[i] - c[0]);
  }
  normal.normalize();
  return {normal.x(), normal.y(), normal.z(), -normal.dot(c[0])};
}

/// Which boxes the whole line may meet: slabs, widened against rounding.
class LineSlabs {
 public:
  LineSlabs(const Point& origin, const Eigen::Vector3d& along) : origin_(origin) {
    for (int i = 0; i < 3; ++i) inverse_[i] = 1 / along[i];
  }
  [[nodiscard]] bool may_meet(const Box& box) const {
    double from = -std::numeric_limits<double>::infinity(), to = -from;
    for (int i = 0; i < 3; ++i) {
      // A box and an origin in one plane, and a line along it: 0 / 0, which is anywhere.
      const double a = (box.min[i] - origin_[i]) * inverse_[i];
      const double b = (box.max[i] - origin_[i]) * inverse_[i];
      if (std::isnan(a) || std::isnan(b)) continue;
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
    // Four roundings of each bound.
    constexpr double kWider = 0x1p-48;
    return from - to <= kWider * (std::abs(from) + std::abs(to));
  }

 private:
  Point origin_;
  Eigen::Vector3d inverse_;
};

}  // namespace

LineFaces::LineFaces(const Scene& scene) : scene_(scene), tree_(boxes_of_faces(scene)) {
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    planes_.push_back(plane_of_face(scene, static_cast<int>(f)));
  }
}

// A side has the line on the left or on the right; the two faces at a side find the same
// number with opposite signs, so that a line never slips through between them.
void LineFaces::hits(const Chord& line, std::vector<LineHit>& found) const {
  found.clear();
  const Eigen::Vector3d along = (line.to - line.from).normalized();
  const Point& origin = line.from;
  const LineSlabs slabs(origin, along);
  tree_.traverse([&](const Box& box) { return slabs.may_meet(box); },
                 [&](std::uint32_t item) {
                   const int face = static_cast<int>(item);
                   const auto points = scene_.face_points(face);
                   bool left = true, right = true;
                   Eigen::Vector3d last = scene_.point(points.back()) - origin;
                   for (const int p : points) {
                     const Eigen::Vector3d next = scene_.point(p) - origin;
                     const double side = last.cross(next).dot(along);
                     left = left && side >= 0;
                     right = right && side <= 0;
                     last = next;
                   }
                   if (left == right) return;
                   const Eigen::Vector4d& plane = planes_[face];
                   const double fall = plane.head<3>().dot(along);
                   if (fall == 0) return;
                   const double height = plane.head<3>().dot(origin) + plane[3];
                   found.push_back({-height / fall, face, fall < 0});
                 });
  std::ranges::sort(found, [](const LineHit& a, const LineHit& b) {
    return a.at != b.at ? a.at < b.at : a.face < b.face;
  });
}

bool LineFaces::coplanar(int a, int b) const {
  const auto p = scene_.face_points(a);
  return std::ranges::all_of(scene_.face_points(b), [&](int q) {
    return orient3d(scene_.point(p[0]), scene_.point(p[1]), scene_.point(p[2]),
                    scene_.point(q)) == Sign::Zero;
  });
}

LineWalker::LineWalker(const LineFaces& faces)
    : faces_(faces), windings_(faces.scene().objects().size(), 0) {
  const auto& [low, high] = faces.scene().bounds();
  const double size = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  // Thousands of roundings of a coordinate: nearer ones are asked whether their planes
  // are the same.
  nearness_ = 0x1p-38 * size;
}

bool LineWalker::together(const LineHit& a, const LineHit& b) const {
  return b.at - a.at <= nearness_ && faces_.coplanar(a.face, b.face);
}

void LineWalker::pass(const LineHit& hit) {
  const Scene& scene = faces_.scene();
  if (!scene.solid_behind(hit.face)) return;
  int& winding = windings_[scene.faces()[hit.face].object];
  const bool was = winding > 0;
  winding += hit.from_front ? 1 : -1;
  around_ += static_cast<int>(winding > 0) - static_cast<int>(was);
}

std::span<const LineLayer> LineWalker::layers(const Chord& line) {
  faces_.hits(line, hits_);
  layers_.clear();
  std::size_t from = 0;
  for (std::size_t i = 0; i < hits_.size(); ++i) {
    pass(hits_[i]);
    if (i + 1 < hits_.size() && together(hits_[from], hits_[i + 1])) continue;
    layers_.push_back({std::span(hits_).subspan(from, i + 1 - from), around_ > 0});
    from = i + 1;
  }
  // A line that went astray may end within an object; the next one begins outside.
  for (const LineHit& hit : hits_) windings_[faces_.scene().faces()[hit.face].object] = 0;
  around_ = 0;
  return layers_;
}

}  // namespace sightline::internal
