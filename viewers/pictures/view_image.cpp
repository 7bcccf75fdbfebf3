#include "viewers/pictures/view_image.h"

#include <algorithm>
#include <cmath>

#include "linespace/work/stage.h"

namespace sightline::viewers {
namespace {

using internal::Stage;
using Rings = std::vector<std::vector<PlanePoint>>;

constexpr int kSamples = 3;  ///< per pixel side

std::uint8_t to_byte(float v) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0F, 1.0F)));
}

/// Samples of the window, rows from the top.
class Samples {
 public:
  Samples(const PlaneWindow& window, int pixels) : window_(window) {
    const PlanePoint extent = window.high - window.low;
    scale_ = pixels * kSamples / extent.maxCoeff();
    for (int axis = 0; axis < 2; ++axis) {
      const double side = std::ceil(extent[axis] * scale_ / kSamples - 1e-6);
      size_[axis] = std::max(1, static_cast<int>(side));
    }
    const std::size_t count =
        static_cast<std::size_t>(size_[0]) * size_[1] * kSamples * kSamples;
    samples_.assign(count,
                    {to_byte(kPaper.red), to_byte(kPaper.green), to_byte(kPaper.blue)});
  }

  /// Of the plane, for the length of a sample.
  [[nodiscard]] double unit() const { return 1 / scale_; }

  /// By the even-odd rule.
  void fill(const Rings& rings, const Colour& colour) {
    const Sample paint{to_byte(colour.red), to_byte(colour.green), to_byte(colour.blue)};
    std::vector<std::pair<int, double>> crossings = crossings_of(rings);
    std::ranges::sort(crossings);
    const int width = size_[0] * kSamples;
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const auto [row, from] = crossings[i];
      const double to = crossings[i + 1].second;
      const int first = static_cast<int>(std::ceil(std::clamp(from, 0.0, width + 0.0)));
      const int last = static_cast<int>(std::ceil(std::clamp(to, 0.0, width + 0.0)));
      Sample* const begin = samples_.data() + static_cast<std::ptrdiff_t>(row) * width;
      std::fill(begin + first, begin + std::max(first, last), paint);
    }
  }

  /// Of a width in samples.
  void stroke(const PlanePoint& a, const PlanePoint& b, double width,
              const Colour& colour) {
    const double length = (b - a).norm();
    if (!(length > 0)) return;
    const PlanePoint along = 0.5 * width * unit() / length * (b - a);
    const PlanePoint aside(-along.y(), along.x());
    const PlanePoint p = a - 0.5 * along, q = b + 0.5 * along;
    fill({{p + aside, p - aside, q - aside, q + aside}}, colour);
  }

  [[nodiscard]] Image image() const {
    Image image{size_[0], size_[1], {}};
    image.rgb.reserve(std::size_t{3} * size_[0] * size_[1]);
    for (int y = 0; y < size_[1]; ++y) {
      for (int x = 0; x < size_[0]; ++x) {
        for (const std::uint8_t channel : mean(x, y)) image.rgb.push_back(channel);
      }
    }
    return image;
  }

 private:
  using Sample = std::array<std::uint8_t, 3>;

  /// Where rows of samples cross the rings, as the row and a position along it: from one
  /// to the next every second sample is inside.
  [[nodiscard]] std::vector<std::pair<int, double>> crossings_of(
      const Rings& rings) const {
    std::vector<std::pair<int, double>> crossings;
    const double rows = size_[1] * kSamples;
    for (const std::vector<PlanePoint>& ring : rings) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        PlanePoint a = place(ring[i]), b = place(ring[(i + 1) % ring.size()]);
        if (a.y() > b.y()) std::swap(a, b);
        const int first = static_cast<int>(std::ceil(std::clamp(a.y(), 0.0, rows)));
        const int last = static_cast<int>(std::ceil(std::clamp(b.y(), 0.0, rows)));
        for (int row = first; row < last; ++row) {
          const double t = (row - a.y()) / (b.y() - a.y());
          crossings.emplace_back(row, a.x() + t * (b.x() - a.x()));
        }
      }
    }
    return crossings;
  }

  /// In samples from the upper left, so that a sample's middle has whole numbers.
  [[nodiscard]] PlanePoint place(const PlanePoint& p) const {
    return {(p.x() - window_.low.x()) * scale_ - 0.5,
            (window_.high.y() - p.y()) * scale_ - 0.5};
  }

  [[nodiscard]] Sample mean(int x, int y) const {
    const int width = size_[0] * kSamples;
    std::array<int, 3> sum{};
    for (int j = 0; j < kSamples; ++j) {
      for (int i = 0; i < kSamples; ++i) {
        const std::size_t at =
            static_cast<std::size_t>(y * kSamples + j) * width + x * kSamples + i;
        for (int c = 0; c < 3; ++c) sum[c] += samples_[at][c];
      }
    }
    Sample mean{};
    for (int c = 0; c < 3; ++c) {
      mean[c] = static_cast<std::uint8_t>(sum[c] / (kSamples * kSamples));
    }
    return mean;
  }

  PlaneWindow window_;
  double scale_;
  std::array<int, 2> size_{};  ///< pixels
  std::vector<Sample> samples_;
};

}  // namespace

Image view_image(const ViewDrawing& drawing, const PointView& view, int pixels,
                 const Request& request) {
  Stage stage(request, "drawing");
  Samples samples(drawing.plane.window(), pixels);
  const std::size_t count = drawing.regions.size() + drawing.edges.size();
  std::size_t done = 0;
  for (const DrawnRegion& region : drawing.regions) {
    stage.at(done++, count);
    samples.fill(region.rings, region.colour);
  }
  // Widths are told for a picture of 1000 pixels.
  const double width = kSamples * pixels / 1000.0;
  for (const DrawnFurther& further : drawing.further) {
    const LineStyle style =
        style_of(drawing.further_lines[further.line].kind, drawing.edges.size());
    samples.stroke(further.points[0], further.points[1], style.width * width,
                   style.colour);
  }
  for (const DrawnEdge& edge : drawing.edges) {
    stage.at(done++, count);
    const LineStyle style = style_of(view.edges[edge.edge].kind, drawing.edges.size());
    samples.stroke(edge.points[0], edge.points[1], style.width * width, style.colour);
  }
  return samples.image();
}

}  // namespace sightline::viewers
