#include "viewers/picture.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::viewers {
namespace {

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

/// Calls plot(index, w) for every sample of a width x height raster inside a triangle.
template <typename Plot>
void fill_triangle(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c,
                   int width, int height, const Plot& plot) {
  const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  if (!(std::abs(area) > 0) || !std::isfinite(area)) return;
  const auto clamp_to = [](double v, int limit) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(limit)));
  };
  const int x0 = clamp_to(std::floor(std::min({a.x, b.x, c.x})), width);
  const int x1 = clamp_to(std::ceil(std::max({a.x, b.x, c.x})), width);
  const int y0 = clamp_to(std::floor(std::min({a.y, b.y, c.y})), height);
  const int y1 = clamp_to(std::ceil(std::max({a.y, b.y, c.y})), height);
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
      plot(static_cast<std::size_t>(y) * width + x, static_cast<float>(w));
    }
  }
}

template <typename Plot>
void fill_polygon(const Projection& projection, std::span<const Point> points, int width,
                  int height, const Plot& plot) {
  std::vector<Point> eye;
  for (const Point& p : points) eye.push_back(projection.to_eye(p));
  eye = clip_near(eye, projection.near());
  for (std::size_t i = 2; i < eye.size(); ++i) {
    fill_triangle(projection.to_screen(eye[0]), projection.to_screen(eye[i - 1]),
                  projection.to_screen(eye[i]), width, height, plot);
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
  const double light = 0.46 + 0.12 * normal.dot(up) +
                       0.42 * std::max(0.0, normal.dot(key)) +
                       0.16 * std::max(0.0, normal.dot(fill));
  const auto lit = [&](float c) { return std::min(1.0F, c * static_cast<float>(light)); };
  return {lit(t.colour.red), lit(t.colour.green), lit(t.colour.blue)};
}

/// How much of the sky each sample sees, judged from the depth buffer: nearer samples
/// around it shut it out, unless they are so much nearer that they are another thing.
std::vector<float> openness(const std::vector<float>& depth_w, int width, int height,
                            double reach_pixels, double reach_depth) {
  std::vector<float> open(depth_w.size(), 1.0F);
  constexpr int kDirections = 12, kSteps = 4;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * width + x;
      if (depth_w[i] <= 0) continue;
      const double z = 1.0 / depth_w[i];
      // A fixed 4 x 4 pattern of rotations, so that the noise is fine and repeatable.
      const double turn = ((x & 3) * 4 + (y & 3)) * (2 * M_PI / kDirections / 16);
      double shut = 0;
      for (int d = 0; d < kDirections; ++d) {
        const double angle = turn + d * 2 * M_PI / kDirections;
        // Opposite samples cancel on a slanted plane: only what sticks out counts.
        double bend = 0;
        for (int s = 1; s <= kSteps; ++s) {
          const double r = reach_pixels * s * s / (kSteps * kSteps);
          const int dx = static_cast<int>(std::lround(r * std::cos(angle)));
          const int dy = static_cast<int>(std::lround(r * std::sin(angle)));
          if (dx == 0 && dy == 0) continue;
          const auto w_at = [&](int px, int py) {
            px = std::clamp(px, 0, width - 1);
            py = std::clamp(py, 0, height - 1);
            return depth_w[static_cast<std::size_t>(py) * width + px];
          };
          const double w1 = w_at(x + dx, y + dy), w2 = w_at(x - dx, y - dy);
          if (w1 <= 0 || w2 <= 0) continue;
          // 1/z is linear over a plane's image, so this vanishes on planes.
          const double rise = (0.5 * (w1 + w2) - depth_w[i]) * z * z;
          if (rise > 0 && rise < reach_depth) {
            bend = std::max(bend, rise / (reach_depth * s / kSteps));
          }
        }
        shut += std::min(1.0, 2.2 * bend);
      }
      open[i] = static_cast<float>(1 - 0.42 * shut / kDirections);
    }
  }
  return open;
}

std::vector<float> blurred(const std::vector<float>& values, int width, int height,
                           int radius) {
  std::vector<float> rows(values.size()), out(values.size());
  for (int y = 0; y < height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * width;
    for (int x = 0; x < width; ++x) {
      float sum = 0;
      for (int k = -radius; k <= radius; ++k) {
        sum += values[row + std::clamp(x + k, 0, width - 1)];
      }
      rows[row + x] = sum / static_cast<float>(2 * radius + 1);
    }
  }
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float sum = 0;
      for (int k = -radius; k <= radius; ++k) {
        const int yy = std::clamp(y + k, 0, height - 1);
        sum += rows[static_cast<std::size_t>(yy) * width + x];
      }
      out[static_cast<std::size_t>(y) * width + x] =
          sum / static_cast<float>(2 * radius + 1);
    }
  }
  return out;
}

/// The stroke as a thin quad facing the camera, its parts before the near plane only.
template <typename Plot>
void fill_stroke(const Projection& projection, const Stroke& stroke, double half_width,
                 int width, int height, const Plot& plot) {
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
  fill_triangle(corner[0], corner[1], corner[2], width, height, plot);
  fill_triangle(corner[0], corner[2], corner[3], width, height, plot);
}

struct Sample {
  float red, green, blue;
};

void blend(Sample& under, const Colour& over, float opacity) {
  under.red += opacity * (over.red - under.red);
  under.green += opacity * (over.green - under.green);
  under.blue += opacity * (over.blue - under.blue);
}

}  // namespace

Image render(const Drawing& drawing, const Camera& camera,
             const PictureOptions& options) {
  const int n = std::max(1, options.samples);
  const int width = options.width * n, height = options.height * n;
  const std::size_t size = static_cast<std::size_t>(width) * height;
  const Projection projection(camera, width, height);
  const Point up = camera.up.normalized();

  // 1. Background and opaque triangles.
  std::vector<Sample> samples(size);
  std::vector<float> nearest(size, 0.0F);
  for (int y = 0; y < height; ++y) {
    const float t = static_cast<float>(y) / static_cast<float>(height);
    const Colour &top = options.background_top, &bottom = options.background_bottom;
    const Sample sky{top.red + t * (bottom.red - top.red),
                     top.green + t * (bottom.green - top.green),
                     top.blue + t * (bottom.blue - top.blue)};
    std::fill_n(samples.begin() + static_cast<std::ptrdiff_t>(y) * width, width, sky);
  }
  for (const PaintedTriangle& t : drawing.triangles) {
    if (is_culled(t, projection.eye())) continue;
    const Colour c = shade(t, projection, up);
    fill_polygon(projection, t.points, width, height, [&](std::size_t i, float w) {
      if (w <= nearest[i]) return;
      nearest[i] = w;
      samples[i] = {c.red, c.green, c.blue};
    });
  }

  // 2. Crevices, on a raster of one sample a pixel.
  if (options.ambient_occlusion) {
    std::vector<float> coarse(static_cast<std::size_t>(options.width) * options.height);
    for (int y = 0; y < options.height; ++y) {
      for (int x = 0; x < options.width; ++x) {
        coarse[static_cast<std::size_t>(y) * options.width + x] =
            nearest[static_cast<std::size_t>(y * n + n / 2) * width + x * n + n / 2];
      }
    }
    const double distance = (camera.target - camera.eye).norm();
    const std::vector<float> open =
        blurred(openness(coarse, options.width, options.height, 0.045 * options.height,
                         0.045 * distance),
                options.width, options.height, 2);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * width + x;
        if (nearest[i] <= 0) continue;
        const float o = open[static_cast<std::size_t>(y / n) * options.width + x / n];
        samples[i].red *= o;
        samples[i].green *= o;
        samples[i].blue *= o;
      }
    }
  }

  // 3. Veils: each sample keeps the product of what passes and the mean colour, so that
  // the order does not matter.
  if (!drawing.veils.empty()) {
    struct Veil {
      float red = 0, green = 0, blue = 0, weight = 0, passes = 1;
    };
    std::vector<Veil> veil(size);
    for (const VeilTriangle& t : drawing.veils) {
      fill_polygon(projection, t.points, width, height, [&](std::size_t i, float w) {
        // The tolerance lets veils that lie on a face show; it is a matter of looks.
        if (w * 1.0005F < nearest[i]) return;
        Veil& v = veil[i];
        v.red += t.opacity * t.colour.red;
        v.green += t.opacity * t.colour.green;
        v.blue += t.opacity * t.colour.blue;
        v.weight += t.opacity;
        v.passes *= 1 - t.opacity;
      });
    }
    for (std::size_t i = 0; i < size; ++i) {
      const Veil& v = veil[i];
      if (v.weight <= 0) continue;
      blend(samples[i], {v.red / v.weight, v.green / v.weight, v.blue / v.weight},
            1 - v.passes);
    }
  }

  // 4. Strokes in the order given.
  for (const Stroke& s : drawing.strokes) {
    const double half_width = 0.5 * s.width * n;
    fill_stroke(projection, s, half_width, width, height, [&](std::size_t i, float w) {
      const float opacity = w * 1.002F >= nearest[i] ? s.opacity : s.hidden_opacity;
      if (opacity > 0) blend(samples[i], s.colour, opacity);
    });
  }

  // 5. Average the samples of each pixel.
  Image image{options.width, options.height, {}};
  image.rgb.reserve(static_cast<std::size_t>(options.width) * options.height * 3);
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) {
      Sample sum{0, 0, 0};
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          const Sample& s =
              samples[static_cast<std::size_t>(y * n + j) * width + x * n + i];
          sum.red += s.red;
          sum.green += s.green;
          sum.blue += s.blue;
        }
      }
      for (const float c : {sum.red, sum.green, sum.blue}) {
        const float mean = c / static_cast<float>(n * n);
        image.rgb.push_back(
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(mean, 0.0F, 1.0F))));
      }
    }
  }
  return image;
}

std::vector<int> visible_ids(const Drawing& drawing, const Camera& camera, int width,
                             int height) {
  const Projection projection(camera, width, height);
  std::vector<int> ids(static_cast<std::size_t>(width) * height, -1);
  std::vector<float> nearest(ids.size(), 0.0F);
  for (const PaintedTriangle& t : drawing.triangles) {
    if (is_culled(t, projection.eye())) continue;
    fill_polygon(projection, t.points, width, height, [&](std::size_t i, float w) {
      if (w <= nearest[i]) return;
      nearest[i] = w;
      ids[i] = t.id;
    });
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
