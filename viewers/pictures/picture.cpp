#include "viewers/picture.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "linespace/work/stage.h"

namespace sightline::viewers {
namespace {

using internal::Stage;

// Notation: eye coordinates have x to the right, y up and z = the depth along the view;
// screen coordinates are samples from the top left, with w = 1/z, which is what varies
// linearly over the screen and is therefore the value the buffer keeps (larger is
// nearer).

struct ScreenPoint {
  double x, y, w;
};

class Projection {
 public:
  Projection(const Camera& camera, int width, int height)
      : eye_(camera.eye), half_width_(0.5 * width), half_height_(0.5 * height) {
    forward_ = (camera.target - camera.eye).normalized();
    right_ = forward_.cross(camera.up).normalized();
    up_ = right_.cross(forward_);
    focal_ = half_height_ / std::tan(0.5 * camera.field_of_view);
    near_ = 1e-3 * (camera.target - camera.eye).norm();
  }

  [[nodiscard]] Point to_eye(const Point& p) const {
    const Point d = p - eye_;
    return {d.dot(right_), d.dot(up_), d.dot(forward_)};
  }
  [[nodiscard]] ScreenPoint to_screen(const Point& e) const {
    const double w = 1 / e.z();
    return {half_width_ + focal_ * e.x() * w, half_height_ - focal_ * e.y() * w, w};
  }
  [[nodiscard]] Point from_screen(const ScreenPoint& p) const {
    return {(p.x - half_width_) / (focal_ * p.w), (half_height_ - p.y) / (focal_ * p.w),
            1 / p.w};
  }
  /// The same with the picture moved by so many samples.
  [[nodiscard]] Projection moved(double x, double y) const {
    Projection copy = *this;
    copy.half_width_ += x;
    copy.half_height_ += y;
    return copy;
  }
  /// Pixels per unit of length at depth 1.
  [[nodiscard]] double focal() const { return focal_; }
  [[nodiscard]] double near() const { return near_; }
  [[nodiscard]] const Point& eye() const { return eye_; }
  [[nodiscard]] const Point& forward() const { return forward_; }
  [[nodiscard]] const Point& right() const { return right_; }
  [[nodiscard]] const Point& up() const { return up_; }

 private:
  Point eye_, forward_, right_, up_;
  double half_width_, half_height_, focal_, near_;
};

/// The part of a convex polygon in eye coordinates in front of the near plane.
std::vector<Point> clip_near(std::span<const Point> polygon, double near) {
  std::vector<Point> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    if (a.z() >= near) kept.push_back(a);
    if ((a.z() >= near) != (b.z() >= near)) {
      kept.push_back(a + (near - a.z()) / (b.z() - a.z()) * (b - a));
    }
  }
  return kept;
}

/// Rows `top` to `bottom` - 1 of samples, stored row after row.
struct Raster {
  int width, top, bottom;
  [[nodiscard]] std::size_t size() const {
    return static_cast<std::size_t>(width) * (bottom - top);
  }
};

/// Calls plot(index, w) for every sample of the raster inside a triangle.
template <typename Plot>
void fill_triangle(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c,
                   const Raster& raster, const Plot& plot) {
  const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (!(std::abs(area) > 0) || !std::isfinite(area)) return;
  const auto clamped = [](double v, int low, int high) {
    return static_cast<int>(
        std::clamp(v, static_cast<double>(low), static_cast<double>(high)));
  };
  const int x0 = clamped(std::floor(std::min({a.x, b.x, c.x})), 0, raster.width);
  const int x1 = clamped(std::ceil(std::max({a.x, b.x, c.x})), 0, raster.width);
  const int y0 =
      clamped(std::floor(std::min({a.y, b.y, c.y})), raster.top, raster.bottom);
  const int y1 = clamped(std::ceil(std::max({a.y, b.y, c.y})), raster.top, raster.bottom);
  const double wx = ((b.w - a.w) * (c.y - a.y) - (c.w - a.w) * (b.y - a.y)) / area;
  const double wy = ((c.w - a.w) * (b.x - a.x) - (b.w - a.w) * (c.x - a.x)) / area;
  const ScreenPoint* corner[4] = {&a, &b, &c, &a};
  for (int y = y0; y < y1; ++y) {
    // The span of the row inside all three sides.
    const double cy = y + 0.5;
    double from = x0, to = x1;
    bool empty = false;
    for (int k = 0; k < 3; ++k) {
      const ScreenPoint& p = *corner[k];
      const ScreenPoint& q = *corner[k + 1];
      // Inside where s * ((q-p) x (sample-p)) >= 0: a x_sample + b >= 0 on this row.
      const double s = area > 0 ? 1 : -1;
      const double slope = -s * (q.y - p.y);
      const double offset = s * ((q.x - p.x) * (cy - p.y) + (q.y - p.y) * p.x);
      if (slope == 0) {
        empty |= offset < 0;
      } else if (slope > 0) {
        from = std::max(from, -offset / slope - 0.5);
      } else {
        to = std::min(to, -offset / slope - 0.5 + 1e-9);
      }
    }
    if (empty || !(from <= to)) continue;
    const int first = std::max(x0, static_cast<int>(std::ceil(from)));
    const int last = std::min(x1 - 1, static_cast<int>(std::floor(to)));
    for (int x = first; x <= last; ++x) {
      const double w = a.w + wx * (x + 0.5 - a.x) + wy * (cy - a.y);
      plot(static_cast<std::size_t>(y - raster.top) * raster.width + x,
           static_cast<float>(w));
    }
  }
}

template <typename Plot>
void fill_polygon(const Projection& projection, std::span<const Point> points,
                  const Raster& raster, const Plot& plot) {
  std::vector<Point> eye;
  for (const Point& p : points) eye.push_back(projection.to_eye(p));
  eye = clip_near(eye, projection.near());
  for (std::size_t i = 2; i < eye.size(); ++i) {
    fill_triangle(projection.to_screen(eye[0]), projection.to_screen(eye[i - 1]),
                  projection.to_screen(eye[i]), raster, plot);
  }
}

bool is_culled(const PaintedTriangle& t, const Point& eye) {
  if (!t.cull_back) return false;
  const Point normal = (t.points[1] - t.points[0]).cross(t.points[2] - t.points[0]);
  return normal.dot(eye - t.points[0]) <= 0;
}

/// Daylight from above and behind the viewer's shoulder, a weak fill from the other side,
/// and a sky that is brighter overhead.
Colour shade(const PaintedTriangle& t, const Projection& projection, const Point& up) {
  Point normal =
      (t.points[1] - t.points[0]).cross(t.points[2] - t.points[0]).normalized();
  if (normal.dot(projection.eye() - t.points[0]) < 0) normal = -normal;
  const Point key =
      (0.9 * up - 0.35 * projection.forward() - 0.55 * projection.right()).normalized();
  const Point fill =
      (0.2 * up - 0.6 * projection.forward() + 0.8 * projection.right()).normalized();
  const double light = 0.6 + 0.09 * normal.dot(up) +
                       0.33 * std::max(0.0, normal.dot(key)) +
                       0.12 * std::max(0.0, normal.dot(fill));
  const auto lit = [&](float c) { return std::min(1.0F, c * static_cast<float>(light)); };
  return {lit(t.colour.red), lit(t.colour.green), lit(t.colour.blue)};
}

/// What a pixel of the coarse raster shows.
struct Surface {
  Point position;  ///< eye coordinates
  Point normal;    ///< towards the eye; zero for the background
};

/// How much of the sky each pixel sees, judged from what lies around it on the picture:
/// the estimator of McGuire, Osman, Bukowski and Hennessy, "The Alchemy Screen-Space
/// Ambient Obscurance Algorithm", 2011, equation 10, with a fixed 4 x 4 pattern of
/// spirals so that the same picture comes out every time.
std::vector<float> openness(const std::vector<Surface>& surfaces, int width, int height,
                            double reach, double pixels_per_unit, Stage& stage) {
  std::vector<float> open(surfaces.size(), 1.0F);
  constexpr int kSamples = 28;
  for (int y = 0; y < height; ++y) {
    stage.check(static_cast<double>(y) / height);
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * width + x;
      const Surface& here = surfaces[i];
      if (here.normal.isZero()) continue;
      const double radius = reach * pixels_per_unit / here.position.z();
      const double turn = ((x & 3) * 4 + (y & 3)) * (2 * M_PI / 16);
      double shut = 0;
      for (int k = 0; k < kSamples; ++k) {
        const double r = radius * (k + 0.5) / kSamples;
        const double angle = turn + k * 2.399963;  // the golden angle
        const int px = x + static_cast<int>(std::lround(r * std::cos(angle)));
        const int py = y + static_cast<int>(std::lround(r * std::sin(angle)));
        if (px < 0 || py < 0 || px >= width || py >= height) continue;
        const Surface& there = surfaces[static_cast<std::size_t>(py) * width + px];
        if (there.normal.isZero()) continue;
        const Point v = there.position - here.position;
        const double squared = v.squaredNorm();
        const double fade = std::max(0.0, 1 - squared / (reach * reach));
        shut += fade * std::max(0.0, v.dot(here.normal) - 1e-3 * here.position.z()) /
                (squared + 1e-4 * reach * reach);
      }
      open[i] = static_cast<float>(std::max(0.35, 1 - 1.5 * reach / kSamples * shut));
    }
  }
  return open;
}

/// The mean over the 4 x 4 pattern, among pixels of nearly the same plane.
std::vector<float> smoothed(const std::vector<float>& values,
                            const std::vector<Surface>& surfaces, int width, int height,
                            double reach, Stage& stage) {
  std::vector<float> out(values.size(), 1.0F);
  for (int y = 0; y < height; ++y) {
    stage.check(static_cast<double>(y) / height);
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * width + x;
      const Surface& here = surfaces[i];
      if (here.normal.isZero()) continue;
      float sum = 0, count = 0;
      for (int dy = -4; dy < 4; ++dy) {
        for (int dx = -4; dx < 4; ++dx) {
          const int px = x + dx, py = y + dy;
          if (px < 0 || py < 0 || px >= width || py >= height) continue;
          const std::size_t k = static_cast<std::size_t>(py) * width + px;
          const Surface& there = surfaces[k];
          if (there.normal.dot(here.normal) < 0.9 ||
              std::abs(here.normal.dot(there.position - here.position)) > 0.05 * reach) {
            continue;
          }
          sum += values[k];
          count += 1;
        }
      }
      out[i] = sum / std::max(count, 1.0F);
    }
  }
  return out;
}

/// The stroke as a thin quad facing the camera, its parts before the near plane only.
template <typename Plot>
void fill_stroke(const Projection& projection, const Stroke& stroke, double half_width,
                 const Raster& raster, const Plot& plot) {
  Point a = projection.to_eye(stroke.points[0]);
  Point b = projection.to_eye(stroke.points[1]);
  if (a.z() < projection.near() && b.z() < projection.near()) return;
  if (a.z() < projection.near()) {
    a += (projection.near() - a.z()) / (b.z() - a.z()) * (b - a);
  }
  if (b.z() < projection.near()) {
    b += (projection.near() - b.z()) / (a.z() - b.z()) * (a - b);
  }
  const ScreenPoint p = projection.to_screen(a), q = projection.to_screen(b);
  const double length = std::hypot(q.x - p.x, q.y - p.y);
  if (!(length > 1e-6) || !std::isfinite(length)) return;
  const double ux = (q.x - p.x) / length * half_width;
  const double uy = (q.y - p.y) / length * half_width;
  const ScreenPoint corner[4] = {{p.x - uy - 0.5 * ux, p.y + ux - 0.5 * uy, p.w},
                                 {p.x + uy - 0.5 * ux, p.y - ux - 0.5 * uy, p.w},
                                 {q.x + uy + 0.5 * ux, q.y - ux + 0.5 * uy, q.w},
                                 {q.x - uy + 0.5 * ux, q.y + ux + 0.5 * uy, q.w}};
  fill_triangle(corner[0], corner[1], corner[2], raster, plot);
  fill_triangle(corner[0], corner[2], corner[3], raster, plot);
}

/// Calls plot(index, w, normal) for every sample that sees a solid cut open, with the
/// cut's depth and the outward normal of the box's face (scene coordinates).
///
/// From a point on, a ray leaves as many solids as it enters, but for those that hold the
/// point.  So behind the point where it enters the box, back sides less front sides
/// count the solids that are cut there.
template <typename Plot>
void fill_cut(const CutSolids& cut, const Projection& centred, int width, int height,
              const Plot& plot) {
  const Raster raster{width, 0, height};
  // A ray through the side between two triangles would count both: aligned scenes have
  // such rays through the samples' centres, but hardly beside them.
  const Projection projection = centred.moved(0.0137, 0.0219);
  const Point& eye = projection.eye();
  const auto corner = [&](const std::array<int, 3>& side) {
    return Point(cut.box[side[0]].x(), cut.box[side[1]].y(), cut.box[side[2]].z());
  };
  std::vector<float> entry(raster.size(), 0.0F);
  std::vector<std::int8_t> face(raster.size(), -1);
  for (int axis = 0; axis < 3; ++axis) {
    for (int end = 0; end < 2; ++end) {
      const double outside = (end == 0 ? -1 : 1) * (eye[axis] - cut.box[end][axis]);
      if (outside <= 0) continue;
      std::array<Point, 4> corners;
      for (int i = 0; i < 4; ++i) {
        std::array<int, 3> side;
        side[axis] = end;
        side[(axis + 1) % 3] = i == 1 || i == 2 ? 1 : 0;
        side[(axis + 2) % 3] = i >= 2 ? 1 : 0;
        corners[i] = corner(side);
      }
      fill_polygon(projection, corners, raster, [&](std::size_t i, float w) {
        entry[i] = w;
        face[i] = static_cast<std::int8_t>(2 * axis + end);
      });
    }
  }
  std::vector<std::int16_t> inside(raster.size(), 0);
  for (const std::array<Point, 3>& t : cut.triangles) {
    const double facing = (t[1] - t[0]).cross(t[2] - t[0]).dot(eye - t[0]);
    if (facing == 0) continue;
    fill_polygon(projection, t, raster, [&](std::size_t i, float w) {
      // A solid that begins or ends in the box's own face is not cut there: the box must
      // run through it by more than a tolerance, which is a matter of looks.
      const bool leaves = facing < 0;
      if (w < entry[i] * (leaves ? 1 - 1e-5F : 1 + 1e-5F)) inside[i] += leaves ? 1 : -1;
    });
  }
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (inside[i] <= 0) continue;
    Point normal = Point::Zero();
    normal[face[i] / 2] = face[i] % 2 == 0 ? -1 : 1;
    plot(i, entry[i], normal);
  }
}

/// What each pixel's centre shows.
std::vector<Surface> visible_surfaces(const Drawing& drawing,
                                      const Projection& projection, int width, int height,
                                      Stage& stage) {
  const std::size_t size = static_cast<std::size_t>(width) * height;
  std::vector<Surface> surfaces(size, {Point::Zero(), Point::Zero()});
  std::vector<float> nearest(size, 0.0F);
  for (const PaintedTriangle& t : drawing.triangles) {
    stage.at(static_cast<std::size_t>(&t - drawing.triangles.data()),
             drawing.triangles.size());
    if (is_culled(t, projection.eye())) continue;
    const Point a = projection.to_eye(t.points[0]);
    Point normal = (projection.to_eye(t.points[1]) - a)
                       .cross(projection.to_eye(t.points[2]) - a)
                       .normalized();
    if (normal.dot(a) > 0) normal = -normal;
    fill_polygon(projection, t.points, {width, 0, height}, [&](std::size_t i, float w) {
      if (w <= nearest[i]) return;
      nearest[i] = w;
      const double x = static_cast<double>(i % width) + 0.5;
      const double y = static_cast<double>(i / width) + 0.5;
      surfaces[i] = {projection.from_screen({x, y, w}), normal};
    });
  }
  if (drawing.cut) {
    fill_cut(*drawing.cut, projection, width, height,
             [&](std::size_t i, float w, const Point& normal) {
               const double x = static_cast<double>(i % width) + 0.5;
               const double y = static_cast<double>(i / width) + 0.5;
               surfaces[i] = {projection.from_screen({x, y, w}),
                              projection.to_eye(projection.eye() + normal)};
             });
  }
  return surfaces;
}

struct Sample {
  float red, green, blue;
};

void blend(Sample& under, const Colour& over, float opacity) {
  under.red += opacity * (over.red - under.red);
  under.green += opacity * (over.green - under.green);
  under.blue += opacity * (over.blue - under.blue);
}

std::uint8_t to_byte(float v) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0F, 1.0F)));
}

/// Veils over some rows of samples.  Each sample keeps the product of what passes and the
/// mean colour, so that the order does not matter.
void add_veils(std::span<const VeilTriangle> veils, const Projection& projection,
               const Raster& raster, std::span<const float> nearest,
               std::span<Sample> samples) {
  struct Veil {
    float red = 0, green = 0, blue = 0, weight = 0, passes = 1;
  };
  if (veils.empty()) return;
  std::vector<Veil> sums(raster.size());
  for (const VeilTriangle& t : veils) {
    fill_polygon(projection, t.points, raster, [&](std::size_t i, float w) {
      // The tolerance lets veils that lie on a face show; it is a matter of looks.
      if (w * 1.0005F < nearest[i]) return;
      Veil& v = sums[i];
      v.red += t.opacity * t.colour.red;
      v.green += t.opacity * t.colour.green;
      v.blue += t.opacity * t.colour.blue;
      v.weight += t.opacity;
      v.passes *= 1 - t.opacity;
    });
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Veil& v = sums[i];
    if (v.weight <= 0) continue;
    blend(samples[i], {v.red / v.weight, v.green / v.weight, v.blue / v.weight},
          1 - v.passes);
  }
}

}  // namespace

struct Canvas::Impl {
  PictureOptions options;
  int scale, width, height;  // samples per pixel side; samples
  Projection projection;
  std::vector<float> nearest;  // w of the nearest triangle, 0 for none
  std::vector<std::uint8_t> rgb;

  Impl(const Camera& camera, const PictureOptions& o)
      : options(o),
        scale(std::max(1, o.samples)),
        width(o.width * scale),
        height(o.height * scale),
        projection(camera, width, height) {}

  void draw_background();
  void draw_triangles(const Drawing& drawing, const Point& up, Stage& stage);
  void darken_crevices(const Drawing& drawing, const Camera& camera, Stage& stage);
};

void Canvas::Impl::draw_background() {
  rgb.reserve(3 * nearest.size());
  for (int y = 0; y < height; ++y) {
    const float t = static_cast<float>(y) / static_cast<float>(height);
    const Colour &top = options.background_top, &bottom = options.background_bottom;
    const std::array<std::uint8_t, 3> sky{
        to_byte(top.red + t * (bottom.red - top.red)),
        to_byte(top.green + t * (bottom.green - top.green)),
        to_byte(top.blue + t * (bottom.blue - top.blue))};
    for (int x = 0; x < width; ++x) rgb.insert(rgb.end(), sky.begin(), sky.end());
  }
}

void Canvas::Impl::draw_triangles(const Drawing& drawing, const Point& up, Stage& stage) {
  for (const PaintedTriangle& t : drawing.triangles) {
    stage.at(static_cast<std::size_t>(&t - drawing.triangles.data()),
             drawing.triangles.size());
    if (is_culled(t, projection.eye())) continue;
    const Colour c = shade(t, projection, up);
    const std::array<std::uint8_t, 3> paint{to_byte(c.red), to_byte(c.green),
                                            to_byte(c.blue)};
    fill_polygon(projection, t.points, {width, 0, height}, [&](std::size_t i, float w) {
      if (w <= nearest[i]) return;
      nearest[i] = w;
      std::copy_n(paint.begin(), 3, rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
    });
  }
  if (!drawing.cut) return;
  const Colour& c = drawing.cut->colour;
  const std::array<std::uint8_t, 3> paint{to_byte(c.red), to_byte(c.green),
                                          to_byte(c.blue)};
  fill_cut(
      *drawing.cut, projection, width, height, [&](std::size_t i, float w, const Point&) {
        nearest[i] = w;
        std::copy_n(paint.begin(), 3, rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
      });
}

/// On a raster of one sample a pixel.
void Canvas::Impl::darken_crevices(const Drawing& drawing, const Camera& camera,
                                   Stage& stage) {
  const Projection coarse(camera, options.width, options.height);
  const std::vector<Surface> surfaces =
      visible_surfaces(drawing, coarse, options.width, options.height, stage);
  // The same on the picture whatever the angle.
  const double reach = 0.055 * (camera.target - camera.eye).norm() *
                       std::tan(0.5 * camera.field_of_view) / std::tan(0.3);
  const std::vector<float> open = smoothed(
      openness(surfaces, options.width, options.height, reach, coarse.focal(), stage),
      surfaces, options.width, options.height, reach, stage);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * width + x;
      if (nearest[i] <= 0) continue;
      const float o =
          open[static_cast<std::size_t>(y / scale) * options.width + x / scale];
      for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
        rgb[k] = static_cast<std::uint8_t>(std::lround(o * static_cast<float>(rgb[k])));
      }
    }
  }
}

Canvas::Canvas(const Drawing& drawing, const Camera& camera,
               const PictureOptions& options)
    : impl_(std::make_unique<Impl>(camera, options)) {
  impl_->nearest.assign(static_cast<std::size_t>(impl_->width) * impl_->height, 0.0F);
  impl_->draw_background();
  Stage stage(impl_->options.request, "drawing faces");
  impl_->draw_triangles(drawing, camera.up.normalized(), stage);
  stage.begin("shading");
  if (options.ambient_occlusion) impl_->darken_crevices(drawing, camera, stage);
}

Canvas::~Canvas() = default;

Image Canvas::picture(const Drawing& marks) const {
  const Impl& base = *impl_;
  const int n = base.scale;
  Image image{base.options.width, base.options.height, {}};
  image.rgb.reserve(static_cast<std::size_t>(image.width) * image.height * 3);
  // A band of rows at a time, so that the many numbers a sample takes here stay few.
  constexpr int kBand = 96;
  Stage stage(base.options.request, "drawing lines");
  for (int band = 0; band < image.height; band += kBand) {
    stage.check(static_cast<double>(band) / image.height);
    const int rows = std::min(kBand, image.height - band);
    const Raster raster{base.width, band * n, (band + rows) * n};
    const std::size_t first = static_cast<std::size_t>(raster.top) * base.width;
    const std::span<const float> nearest(base.nearest.data() + first, raster.size());
    std::vector<Sample> samples(raster.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::uint8_t* c = base.rgb.data() + 3 * (first + i);
      samples[i] = {static_cast<float>(c[0]) / 255, static_cast<float>(c[1]) / 255,
                    static_cast<float>(c[2]) / 255};
    }
    add_veils(marks.veils, base.projection, raster, nearest, samples);
    for (const Stroke& s : marks.strokes) {
      fill_stroke(
          base.projection, s, 0.5 * s.width * n, raster, [&](std::size_t i, float w) {
            const float opacity = w * 1.002F >= nearest[i] ? s.opacity : s.hidden_opacity;
            if (opacity > 0) blend(samples[i], s.colour, opacity);
          });
    }
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < image.width; ++x) {
        Sample sum{0, 0, 0};
        for (int j = 0; j < n; ++j) {
          for (int i = 0; i < n; ++i) {
            const Sample& s =
                samples[static_cast<std::size_t>(y * n + j) * base.width + x * n + i];
            sum.red += s.red;
            sum.green += s.green;
            sum.blue += s.blue;
          }
        }
        for (const float c : {sum.red, sum.green, sum.blue}) {
          image.rgb.push_back(to_byte(c / static_cast<float>(n * n)));
        }
      }
    }
  }
  return image;
}

Image render(const Drawing& drawing, const Camera& camera,
             const PictureOptions& options) {
  return Canvas(drawing, camera, options).picture(drawing);
}

std::vector<int> visible_ids(const Drawing& drawing, const Camera& camera, int width,
                             int height) {
  const Projection projection(camera, width, height);
  std::vector<int> ids(static_cast<std::size_t>(width) * height, -1);
  std::vector<float> nearest(ids.size(), 0.0F);
  for (const PaintedTriangle& t : drawing.triangles) {
    if (is_culled(t, projection.eye())) continue;
    fill_polygon(projection, t.points, {width, 0, height}, [&](std::size_t i, float w) {
      if (w <= nearest[i]) return;
      nearest[i] = w;
      ids[i] = t.id;
    });
  }
  if (drawing.cut) {
    fill_cut(*drawing.cut, projection, width, height,
             [&](std::size_t i, float, const Point&) { ids[i] = -1; });
  }
  return ids;
}

std::string encode_png(const Image& image) {
  vtkNew<vtkImageData> data;
  data->SetDimensions(image.width, image.height, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* bytes = static_cast<std::uint8_t*>(data->GetScalarPointer());
  const std::size_t row = static_cast<std::size_t>(image.width) * 3;
  for (int y = 0; y < image.height; ++y) {  // VTK counts rows from the bottom
    std::copy_n(image.rgb.data() + row * y, row, bytes + row * (image.height - 1 - y));
  }
  vtkNew<vtkPNGWriter> writer;
  writer->WriteToMemoryOn();
  writer->SetInputData(data);
  writer->Write();
  const vtkUnsignedCharArray* result = writer->GetResult();
  auto* array = const_cast<vtkUnsignedCharArray*>(result);
  return {reinterpret_cast<const char*>(array->GetPointer(0)),
          static_cast<std::size_t>(array->GetNumberOfValues())};
}

}  // namespace sightline::viewers
