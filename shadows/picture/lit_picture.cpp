#include "shadows/lit_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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
    const Seen seen = look(column, row);
    LitPixel pixel = seen.pixel;
    if (pixel.kind != LitPixel::Kind::Surface) return pixel;
    const Eigen::Vector3d normal = normal_of(pixel.face);
    pixel.value = rays_ > 0 ? sampled(seen.hit, seen.front ? normal : -normal, seed)
                            : value_of(seen);
    return pixel;
  }

  /// What is seen through a pixel, its value still to be found.
  struct Seen {
    LitPixel pixel;
    Point hit;
    bool front;  ///< of the face, as the file has it
  };
  [[nodiscard]] Seen look(int column, int row) const {
    const Point far = sight_.far_end(column, row);
    const auto contact = occlusion_->first_blocker(camera_->eye, far);
    if (!contact || contact->touches.empty()) return {};
    const Point hit = camera_->eye + contact->from * (far - camera_->eye);
    const Eigen::Vector3d back = camera_->eye - hit;
    const int face = contact->touches.front().face;
    for (const Touch& touch : contact->touches) {
      const bool listed = std::ranges::binary_search(source_->faces, touch.face);
      const bool both = std::ranges::binary_search(source_->both_sides, touch.face);
      const bool shows = normal_of(touch.face).dot(back) > 0;
      if (listed && (shows || both)) {
        return {{LitPixel::Kind::Source, touch.face, 1}, hit, shows};
      }
    }
    return {{LitPixel::Kind::Surface, face, 0}, hit, normal_of(face).dot(back) > 0};
  }

  /// Of a surface, exactly.
  [[nodiscard]] double value_of(const Seen& seen) const {
    const ShadowPoint point =
        shadow_point_on_face(*scene_, seen.pixel.face, seen.hit, seen.front);
    return light_->from(point).form_factor.value_or(0);
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

/// A picture in which values are found between others where these agree.
class SmoothPicture {
 public:
  SmoothPicture(const Painter& painter, const Scene& scene, const PictureCamera& camera,
                double tolerance, const Request& request)
      : painter_(&painter),
        scene_(&scene),
        request_(&request),
        width_(camera.width),
        height_(camera.height),
        tolerance_(tolerance),
        seen_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

  std::vector<LitPixel> run() {
    Stage stage(*request_, "pixels");
    // 1. What is seen, and exact values on a grid of squares and their middles.
    each(stage, [&](Painter::Seen& seen, int column, int row) {
      seen = painter_->look(column, row);
      if (column % 4 == row % 4 && column % 2 == 0) make_exact(seen);
    });
    for (const Painter::Seen& s : seen_) {
      if (s.pixel.kind == LitPixel::Kind::Surface)
        brightest_ = std::max(brightest_, s.pixel.value);
    }
    // 2. The middles of the squares' sides; then those of squares half as large, and of
    // their sides: each from four neighbours that are there already.
    fill(stage, 2, {{{-2, 0}, {2, 0}, {0, -2}, {0, 2}}}, [](int column, int row) {
      return column % 2 == 0 && row % 2 == 0 && column % 4 != row % 4;
    });
    fill(stage, 3, {{{-1, -1}, {1, -1}, {-1, 1}, {1, 1}}},
         [](int column, int row) { return column % 2 == 1 && row % 2 == 1; });
    fill(stage, 4, {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}},
         [](int column, int row) { return column % 2 != row % 2; });
    std::vector<LitPixel> pixels;
    pixels.reserve(seen_.size());
    for (const Painter::Seen& s : seen_) pixels.push_back(s.pixel);
    return pixels;
  }

 private:
  using Neighbours = std::array<std::array<int, 2>, 4>;  // columns, rows from a pixel

  /// step(seen, column, row) for all pixels, the part-th of four rounds.
  template <class Step>
  void each(Stage& stage, Step&& step, std::size_t part = 1) {
    const std::size_t n = seen_.size(), first = (part - 1) * n;
    for_each_of(first, first + n, 4 * n, *request_, stage, [&](std::size_t k) {
      const auto i = static_cast<int>(k - first);
      step(seen_[k - first], i % width_, i / width_);
    });
  }

  /// Values of these pixels: between those of their neighbours, else exact.
  template <class Chosen>
  void fill(Stage& stage, std::size_t part, const Neighbours& neighbours,
            Chosen&& chosen) {
    each(
        stage,
        [&](Painter::Seen& seen, int column, int row) {
          if (chosen(column, row) && !interpolate(seen, column, row, neighbours))
            make_exact(seen);
        },
        part);
  }

  void make_exact(Painter::Seen& seen) const {
    if (seen.pixel.kind == LitPixel::Kind::Surface)
      seen.pixel.value = painter_->value_of(seen);
  }

  /// False where the neighbours do not tell the value.
  bool interpolate(Painter::Seen& seen, int column, int row,
                   const Neighbours& neighbours) const {
    double sum = 0, least = std::numeric_limits<double>::infinity(), most = 0;
    for (const auto& [right, down] : neighbours) {
      const int x = column + right, y = row + down;
      if (x < 0 || y < 0 || x >= width_ || y >= height_) return false;
      const Painter::Seen& other =
          seen_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                static_cast<std::size_t>(x)];
      if (!shows_same(other, seen)) return false;
      sum += other.pixel.value;
      least = std::min(least, other.pixel.value);
      most = std::max(most, other.pixel.value);
    }
    if (most - least > tolerance_ * brightest_ || (least == 0 && most > 0)) return false;
    seen.pixel.value = sum / 4;
    return true;
  }

  [[nodiscard]] bool shows_same(const Painter::Seen& a, const Painter::Seen& b) const {
    return a.pixel.kind == LitPixel::Kind::Surface &&
           b.pixel.kind == LitPixel::Kind::Surface && a.front == b.front &&
           scene_->faces()[a.pixel.face].facet == scene_->faces()[b.pixel.face].facet;
  }

  const Painter* painter_;
  const Scene* scene_;
  const Request* request_;
  int width_, height_;
  double tolerance_, brightest_ = 0;
  std::vector<Painter::Seen> seen_;  // by pixels, rows from the top
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

std::vector<LitPixel> smooth_lit_picture(const OcclusionIndex& occlusion,
                                         const BackprojectionIndex& light,
                                         const LightSource& source,
                                         const PictureCamera& camera, double tolerance,
                                         const Request& request) {
  const Painter painter(occlusion, light, source, camera, 0);
  return SmoothPicture(painter, occlusion.scene(), camera, tolerance, request).run();
}

}  // namespace sightline
