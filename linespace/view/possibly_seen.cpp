#include "linespace/view/possibly_seen.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "linespace/view/depth_raster.h"

namespace sightline::internal {
namespace {

// Relative margin: far above what a dozen roundings of coordinates do.
constexpr double kMargin = 0x1p-36;

// Coordinates of one raster: a point x seen at (p / r, q / r) with the depth 1 / r from
// an eye, or at (p, q) with the depth r from a direction.
struct Side {
  Eigen::Matrix3d axes;  // rows: p, q, r
};

class Culler {
 public:
  explicit Culler(const EyeSpace& eye);

  std::vector<std::uint8_t> cull();

 private:
  // What a box fills of a raster; nullopt: nothing.  Depth: the largest of its points.
  struct Filled {
    PictureRect rect;
    double depth;
  };
  [[nodiscard]] std::optional<Filled> fill(const Side& side, const Box& box) const;
  [[nodiscard]] bool hidden(const Box& box) const;
  void find_window();
  [[nodiscard]] bool beyond_window(const Box& box) const;
  void draw_face(int face);
  void draw_convex(std::span<const std::array<int, 2>> sides, std::span<const int> faces,
                   const Box& around);
  [[nodiscard]] bool draw_object(int object);
  [[nodiscard]] Eigen::Vector3d local(const Side& side, int point) const {
    return side.axes * (eye_->scene().position(point) - origin_);
  }
  [[nodiscard]] std::optional<PictureFunction> side_function(const Side& side, int p,
                                                             int q) const;
  [[nodiscard]] std::optional<PictureFunction> depth_function(const Side& side,
                                                              int face) const;

  const EyeSpace* eye_;
  Point origin_;
  double size_;  // of all coordinates, the origin's included
  std::vector<Side> sides_;
  std::vector<DepthRaster> rasters_;
  // Half-spaces that hold all that is seen through the window: normal . (x - point) >= 0.
  std::vector<Eigen::Vector3d> window_;
  std::vector<Point> window_points_;  // on their planes
  enum class Drawn : std::uint8_t { Not, AsOne, ByFaces };
  std::vector<Drawn> drawn_objects_;
  std::vector<std::uint8_t> drawn_facets_;
};

int raster_size(std::size_t faces) {
  return faces < 2000 ? 128 : faces < 50000 ? 256 : 512;
}

Culler::Culler(const EyeSpace& eye) : eye_(&eye) {
  const Scene& scene = eye.scene().scene();
  const auto& box = scene.bounds();
  if (eye.is_direction()) {
    origin_ = 0.5 * (box[0] + box[1]);
    const double radius = 0.5 * (box[1] - box[0]).norm();
    const double scale = radius > 0 ? 1 / (radius * (1 + kMargin)) : 1;
    const Eigen::Vector3d d = eye.rounded_eye().normalized();
    const Eigen::Vector3d p = d.unitOrthogonal();
    Side side;
    side.axes << p.transpose(), d.cross(p).transpose(), d.transpose();
    side.axes *= scale;
    sides_.push_back(side);
  } else {
    origin_ = eye.rounded_eye();
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        Side side;
        side.axes.setZero();
        side.axes(0, (axis + 1) % 3) = 1;
        side.axes(1, (axis + 2) % 3) = sign;  // a rotation, not a mirror
        side.axes(2, axis) = sign;
        sides_.push_back(side);
      }
    }
  }
  size_ = std::max({origin_.cwiseAbs().maxCoeff(), box[0].cwiseAbs().maxCoeff(),
                    box[1].cwiseAbs().maxCoeff()});
  rasters_.assign(sides_.size(), DepthRaster(raster_size(scene.faces().size())));
  drawn_objects_.assign(scene.objects().size(), Drawn::Not);
  drawn_facets_.assign(scene.facets().size(), 0);
  find_window();
}

std::optional<Culler::Filled> Culler::fill(const Side& side, const Box& box) const {
  Eigen::Vector3d least = Eigen::Vector3d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector3d most = -least;
  std::array<Eigen::Vector3d, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const Point corner((i & 1) != 0 ? box.max[0] : box.min[0],
                       (i & 2) != 0 ? box.max[1] : box.min[1],
                       (i & 4) != 0 ? box.max[2] : box.min[2]);
    corners[i] = side.axes * (corner - origin_);
    least = least.cwiseMin(corners[i]);
    most = most.cwiseMax(corners[i]);
  }
  if (eye_->is_direction()) {
    const double slack = 4 * kMargin * (1 + size_ * side.axes.norm());
    return Filled{{least[0] - slack, least[1] - slack, most[0] + slack, most[1] + slack},
                  most[2] + slack};
  }
  const double slack = kMargin * size_;
  // Beyond one of the four planes that bound this side of the cube.
  bool left = true, right = true, below = true, above = true;
  for (const Eigen::Vector3d& c : corners) {
    left &= c[0] < -c[2] - slack;
    right &= c[0] > c[2] + slack;
    below &= c[1] < -c[2] - slack;
    above &= c[1] > c[2] + slack;
  }
  if (left || right || below || above || most[2] < -slack) return std::nullopt;
  Filled filled{{-1, -1, 1, 1}, std::numeric_limits<double>::infinity()};
  if (least[2] <= 4 * slack) return filled;
  filled.depth = (1 + 4 * kMargin) / (least[2] - slack);
  filled.rect = {2, 2, -2, -2};
  // Errors of c are below the slack, and the quotient's share of it grows with 1 / r.
  const double off = 4 * slack / least[2];
  for (const Eigen::Vector3d& c : corners) {
    const double x = c[0] / c[2], y = c[1] / c[2];
    filled.rect.min_x = std::min(filled.rect.min_x, x - off * (1 + std::abs(x)));
    filled.rect.max_x = std::max(filled.rect.max_x, x + off * (1 + std::abs(x)));
    filled.rect.min_y = std::min(filled.rect.min_y, y - off * (1 + std::abs(y)));
    filled.rect.max_y = std::max(filled.rect.max_y, y + off * (1 + std::abs(y)));
  }
  return filled;
}

void Culler::find_window() {
  const ViewScene& scene = eye_->scene();
  const ViewLines lines = scene.lines();
  for (std::size_t l = scene.first_window_line(); l < lines.size(); ++l) {
    const auto [p, q] = lines[l].ends;
    const Point a = scene.position(p), b = scene.position(q);
    const Eigen::Vector3d way =
        eye_->is_direction() ? eye_->rounded_eye() : Eigen::Vector3d(a - origin_);
    Eigen::Vector3d n = way.cross(b - a).normalized();
    // Towards the window's middle.
    Point middle = Point::Zero();
    for (std::size_t k = scene.first_window_line(); k < lines.size(); ++k)
      middle += scene.position(lines[k].ends[0]);
    middle /= static_cast<double>(lines.size() - scene.first_window_line());
    if (n.dot(middle - a) < 0) n = -n;
    if (!n.allFinite()) continue;
    window_.push_back(n);
    window_points_.push_back(a);
  }
}

bool Culler::beyond_window(const Box& box) const {
  for (std::size_t k = 0; k < window_.size(); ++k) {
    double most = 0, size = size_;
    for (int i = 0; i < 3; ++i) {
      const double x = window_[k][i] > 0 ? box.max[i] : box.min[i];
      most += window_[k][i] * (x - window_points_[k][i]);
      size += std::abs(x) + std::abs(window_points_[k][i]);
    }
    if (most < -kMargin * size) return true;
  }
  return false;
}

bool Culler::hidden(const Box& box) const {
  const CutFaces* const cut = eye_->scene().cut();
  if ((cut != nullptr && cut->box().misses(box)) || beyond_window(box)) return true;
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    const auto filled = fill(sides_[s], box);
    if (filled && !rasters_[s].hides(filled->rect, filled->depth)) return false;
  }
  return true;
}

// Positive on the left of the line from p to q, as the eye sees it.
std::optional<PictureFunction> Culler::side_function(const Side& side, int p,
                                                     int q) const {
  const Eigen::Vector3d u = local(side, p), v = local(side, q);
  if (eye_->is_direction()) {
    const double a = u[1] - v[1], b = v[0] - u[0];
    return PictureFunction{a, b, u[0] * v[1] - u[1] * v[0],
                           16 * kMargin * (1 + size_ * side.axes.norm())};
  }
  // Seen from inside the sphere left is where the determinant is negative.
  const Eigen::Vector3d n = v.cross(u);
  const double error = 16 * kMargin * size_ * (u.norm() + v.norm());
  if (!(error < std::numeric_limits<double>::infinity())) return std::nullopt;
  return PictureFunction{n[0], n[1], n[2], error};
}

// 1 / r of the face's plane from an eye, r from a direction.
std::optional<PictureFunction> Culler::depth_function(const Side& side, int face) const {
  const auto t = plane_points(eye_->scene().scene(), face);
  const Eigen::Vector3d a = local(side, t[0]);
  const Eigen::Vector3d n =
      (local(side, t[1]) - a).cross(local(side, t[2]) - a).normalized();
  // Rounding may turn the normal of a small face far away.
  const double extent =
      std::min((local(side, t[1]) - a).norm(), (local(side, t[2]) - a).norm());
  if (!(extent > 0x1p-10 * kMargin * size_ * side.axes.norm())) return std::nullopt;
  if (eye_->is_direction()) {
    if (!(std::abs(n[2]) > 0x1p-10)) return std::nullopt;
    return PictureFunction{-n[0] / n[2], -n[1] / n[2], a.dot(n) / n[2],
                           0x1p-20 * (1 + size_ * side.axes.norm())};
  }
  const double distance = a.dot(n);
  if (!(std::abs(distance) > 0x1p-10 * a.norm())) return std::nullopt;
  const Eigen::Vector3d m = n / distance;
  return PictureFunction{m[0], m[1], m[2], 0x1p-20 * m.norm()};
}

void Culler::draw_convex(std::span<const std::array<int, 2>> sides,
                         std::span<const int> faces, const Box& around) {
  RasterOccluder occluder;
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    const auto filled = fill(sides_[s], around);
    if (!filled) continue;
    occluder.sides.clear();
    occluder.depths.clear();
    bool usable = true;
    for (const auto& [p, q] : sides) {
      const auto f = side_function(sides_[s], p, q);
      usable &= f.has_value();
      if (f) occluder.sides.push_back(*f);
    }
    for (const int face : faces) {
      const auto f = depth_function(sides_[s], face);
      usable &= f.has_value();
      if (f) occluder.depths.push_back(*f);
    }
    if (usable) rasters_[s].draw(occluder, filled->rect);
  }
}

// False, and nothing drawn, where its outline is not one of edges: an eye in the fold of
// a facet that rounding bends sees the fold as a part of it.
bool Culler::draw_object(int object) {
  const ViewScene& scene = eye_->scene();
  if (scene.cut() != nullptr && scene.cut()->is_open(object)) return false;
  std::vector<std::array<int, 2>> outline;
  std::vector<int> front;
  for (const int f : scene.scene().objects()[object].faces) {
    if (eye_->front(f) == Sign::Positive) front.push_back(f);
    const int first =
        scene.scene().facets()[scene.scene().faces()[f].facet].faces.front();
    if ((eye_->front(f) == Sign::Positive) != (eye_->front(first) == Sign::Positive))
      return false;
  }
  if (front.empty()) return false;
  for (const int e : scene.edges_of(object)) {
    const Edge& edge = scene.scene().edges()[e];
    if (edge.sides.size() != 2) return false;
    const auto [f, h] = std::pair(edge.sides[0], edge.sides[1]);
    const bool first = eye_->front(f.face) == Sign::Positive;
    if (first == (eye_->front(h.face) == Sign::Positive)) continue;
    const bool forward = first ? f.forward : h.forward;
    outline.push_back({edge.points[forward ? 0 : 1], edge.points[forward ? 1 : 0]});
  }
  draw_convex(outline, front, scene.silhouettes().object_box(object));
  return true;
}

void Culler::draw_face(int face) {
  const ViewScene& scene = eye_->scene();
  const Sign front = eye_->front(face);
  if (front == Sign::Zero) return;
  const Face& f = scene.scene().faces()[face];
  if (scene.silhouettes().convex_solid(f.object) && front == Sign::Positive) {
    Drawn& drawn = drawn_objects_[f.object];
    if (drawn == Drawn::Not)
      drawn = draw_object(f.object) ? Drawn::AsOne : Drawn::ByFaces;
    if (drawn == Drawn::AsOne) return;
  }
  std::vector<std::array<int, 2>> sides;
  const auto turned = [&](int p, int q) {
    sides.push_back(front == Sign::Positive ? std::array{p, q} : std::array{q, p});
  };
  const auto outline = scene.silhouettes().facet_outline(f.facet);
  const Facet& facet = scene.scene().facets()[f.facet];
  const bool is_whole =
      scene.cut() == nullptr || std::ranges::all_of(facet.faces, [&](int other) {
        return scene.cut()->is_whole(other);
      });
  if (!outline.empty() && facet.planar && is_whole) {
    if (drawn_facets_[f.facet]++ != 0) return;
    Box around = scene.silhouettes().face_box(face);
    for (const int other : facet.faces) {
      const Box& box = scene.silhouettes().face_box(other);
      for (int i = 0; i < 3; ++i) {
        around.min[i] = std::min(around.min[i], box.min[i]);
        around.max[i] = std::max(around.max[i], box.max[i]);
      }
    }
    for (const auto& [p, q] : outline) turned(p, q);
    draw_convex(sides, std::span(&face, 1), around);
    return;
  }
  const auto corners = scene.corners(face);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    turned(corners[k], corners[(k + 1) % corners.size()]);
  }
  draw_convex(sides, std::span(&face, 1), scene.silhouettes().face_box(face));
}

// Faces from near to far: each that is not hidden by those before it is drawn.
std::vector<std::uint8_t> Culler::cull() {
  const Bvh& tree = eye_->scene().silhouettes().face_tree();
  std::vector<std::uint8_t> seen(eye_->scene().scene().faces().size(), 0);
  if (tree.empty()) return seen;
  const Eigen::Vector3d d =
      eye_->is_direction() ? eye_->rounded_eye().normalized() : Eigen::Vector3d::Zero();
  const auto far = [&](const Box& box) {
    if (eye_->is_direction()) return -d.dot(centre(box));
    double squared = 0;
    for (int i = 0; i < 3; ++i) {
      const double x = std::max({0.0, box.min[i] - origin_[i], origin_[i] - box.max[i]});
      squared += x * x;
    }
    return squared;
  };
  std::vector<std::uint32_t> stack{0};
  while (!stack.empty()) {
    const Bvh::Node& node = tree.node(stack.back());
    stack.pop_back();
    if (hidden(node.box)) continue;
    if (node.count > 0) {
      for (std::uint32_t i = 0; i < node.count; ++i) {
        const int face = static_cast<int>(tree.items()[node.first + i]);
        if (eye_->scene().corners(face).empty() ||
            hidden(eye_->scene().silhouettes().face_box(face))) {
          continue;
        }
        seen[face] = 1;
        draw_face(face);
      }
      continue;
    }
    const bool first_is_near =
        far(tree.node(node.first).box) <= far(tree.node(node.first + 1).box);
    stack.push_back(node.first + (first_is_near ? 1 : 0));
    stack.push_back(node.first + (first_is_near ? 0 : 1));
  }
  return seen;
}

}  // namespace

std::vector<std::uint8_t> possibly_seen(const EyeSpace& eye) {
  const std::size_t n = eye.scene().scene().faces().size();
  // In small scenes the rasters would cost more than they save.
  constexpr std::size_t kSmall = 200;
  if (n >= kSmall) return Culler(eye).cull();
  std::vector<std::uint8_t> seen(n, 1);
  for (std::size_t f = 0; f < n && eye.scene().cut() != nullptr; ++f)
    seen[f] = eye.scene().corners(static_cast<int>(f)).empty() ? 0 : 1;
  return seen;
}

}  // namespace sightline::internal
