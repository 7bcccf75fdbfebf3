#include "shadows/lit_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "linespace/work/parallel.h"

namespace sightline {

using namespace internal;

namespace {

// Uniform points of a source, by area, and from which side they emit.
class SourceSampler {
 public:
  SourceSampler(const Scene& scene, const LightSource& source) {
    for (const int f : source.faces) {
      const auto corners = scene.face_points(f);
      for (std::size_t k = 2; k < corners.size(); ++k) {
        Triangle t{scene.point(corners[0]), scene.point(corners[k - 1]),
                   scene.point(corners[k]), Eigen::Vector3d::Zero(),
                   std::ranges::binary_search(source.both_sides, f)};
        t.normal = (t.b - t.a).cross(t.c - t.a) * (scene.turned(f) ? -0.5 : 0.5);
        area_ += t.normal.norm();
        triangles_.push_back(t);
        sums_.push_back(area_);
      }
    }
  }

  /// Share of one random point, were it seen, of the form factor times the number of
  /// points.
  template <class Random>
  double share(const Point& p, const Eigen::Vector3d& normal, Random& random,
               Point& at) const {
    std::uniform_real_distribution<double> unit(0, 1);
    const auto found = std::ranges::lower_bound(sums_, unit(random) * area_);
    const Triangle& t =
        triangles_[std::min<std::size_t>(found - sums_.begin(), triangles_.size() - 1)];
    double u = unit(random), v = unit(random);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    at = t.a + u * (t.b - t.a) + v * (t.c - t.a);
    const Eigen::Vector3d way = at - p;
    const double squared = way.squaredNorm();
    const double here = normal.dot(way);
    double there = -t.normal.normalized().dot(way);
    if (t.both_sides) there = std::abs(there);
    if (here <= 0 || there <= 0) return 0;
    return area_ * here * there / (std::numbers::pi * squared * squared);
  }

 private:
  struct Triangle {
    Point a, b, c;
    Eigen::Vector3d normal;  // as long as its area
    bool both_sides;
  };
  std::vector<Triangle> triangles_;
  std::vector<double> sums_;
  double area_ = 0;
};

// Directions of sight.
class Rays {
 public:
  Rays(const PictureCamera& camera, double length) : camera_(&camera) {
    forward_ = (camera.towards - camera.eye).normalized();
    right_ = forward_.cross(camera.up).normalized();
    up_ = right_.cross(forward_);
    forward_ *= length;
    const double half = std::tan(camera.fov / 2) * length;
    right_ *= half;
    up_ *= half * camera.height / camera.width;
  }
  [[nodiscard]] Point far_end(int column, int row) const {
    const double x = 2 * (column + 0.5) / camera_->width - 1;
    const double y = 1 - 2 * (row + 0.5) / camera_->height;
    return camera_->eye + forward_ + x * right_ + y * up_;
  }

 private:
  const PictureCamera* camera_;
  Eigen::Vector3d forward_, right_, up_;
};

// Of the size of coordinates: far above the roundings of a point on a ray.
constexpr double kHair = 0x1p-40;

class Painter {
 public:
  Painter(const OcclusionIndex& occlusion, const BackprojectionIndex& light,
          const LightSource& source, const PictureCamera& camera, int rays)
      : occlusion_(&occlusion),
        scene_(&occlusion.scene()),
        light_(&light),
        source_(&source),
        camera_(&camera),
        sight_(camera, reach(camera)),
        sampler_(*scene_, source),
        rays_(rays) {}

  [[nodiscard]] LitPixel at(int column, int row, std::uint64_t seed) const {
    const Point far = sight_.far_end(column, row);
    const auto contact = occlusion_->first_blocker(camera_->eye, far);
    if (!contact || contact->touches.empty()) return {};
    const Point hit = camera_->eye + contact->from * (far - camera_->eye);
    LitPixel pixel{LitPixel::Kind::Surface, contact->touches.front().face, 0};
    // Its front, as the file has it, or its back.
    Eigen::Vector3d normal = normal_of(pixel.face);
    const bool front = normal.dot(camera_->eye - hit) > 0;
    for (const Touch& touch : contact->touches) {
      const bool listed = std::ranges::binary_search(source_->faces, touch.face);
      const bool both = std::ranges::binary_search(source_->both_sides, touch.face);
      const bool shows = normal_of(touch.face).dot(camera_->eye - hit) > 0;
      if (listed && (shows || both)) return {LitPixel::Kind::Source, touch.face, 1};
    }
    if (!front) normal = -normal;
    pixel.value = rays_ > 0 ? sampled(hit, normal, seed) : exact(pixel.face, hit, front);
    return pixel;
  }

 private:
  // Farther than everything.
  [[nodiscard]] double reach(const PictureCamera& camera) const {
    const auto& [low, high] = scene_->bounds();
    return 4 * ((high - low).norm() + (camera.eye - (low + high) / 2).norm());
  }

  [[nodiscard]] Eigen::Vector3d normal_of(int face) const {
    const auto corners = scene_->face_points(face);
    const Eigen::Vector3d normal =
        (scene_->point(corners[1]) - scene_->point(corners[0]))
            .cross(scene_->point(corners[2]) - scene_->point(corners[0]))
            .normalized();
    return scene_->turned(face) ? Eigen::Vector3d(-normal) : normal;
  }

  [[nodiscard]] double exact(int face, const Point& hit, bool front) const {
    const ShadowPoint point = shadow_point_on_face(*scene_, face, hit, front);
    return light_->from(point).form_factor.value_or(0);
  }

  [[nodiscard]] double sampled(const Point& hit, const Eigen::Vector3d& normal,
                               std::uint64_t seed) const {
    // A hair before the face: rounding may have put the point behind it.
    const double size = hit.cwiseAbs().sum() + camera_->eye.cwiseAbs().sum();
    const Point start = hit + kHair * size * normal;
    std::mt19937_64 random(seed);
    double sum = 0;
    for (int i = 0; i < rays_; ++i) {
      Point s;
      const double share = sampler_.share(start, normal, random, s);
      if (share > 0 && occlusion_->is_free(start, s)) sum += share;
    }
    return sum / rays_;
  }

  const OcclusionIndex* occlusion_;
  const Scene* scene_;
  const BackprojectionIndex* light_;
  const LightSource* source_;
  const PictureCamera* camera_;
  Rays sight_;
  SourceSampler sampler_;
  int rays_;
};

}  // namespace

std::vector<LitPixel> lit_picture(const OcclusionIndex& occlusion,
                                  const BackprojectionIndex& light,
                                  const LightSource& source, const PictureCamera& camera,
                                  int rays, std::uint64_t seed, const Request& request) {
  const Painter painter(occlusion, light, source, camera, rays);
  const auto width = static_cast<std::size_t>(camera.width);
  std::vector<LitPixel> pixels(width * static_cast<std::size_t>(camera.height));
  Stage stage(request, "pixels");
  for_each_of(0, pixels.size(), pixels.size(), request, stage, [&](std::size_t i) {
    pixels[i] = painter.at(static_cast<int>(i % width), static_cast<int>(i / width),
                           seed ^ (i * 0x9e3779b97f4a7c15u));
  });
  return pixels;
}

}  // namespace sightline
