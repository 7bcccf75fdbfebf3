#include "linespace/view/depth_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::internal {
namespace {

constexpr float kNothing = -std::numeric_limits<float>::infinity();

// Pixels.  Where a side crosses a row is a quotient within [-1, 1] off by a few 2^-53,
// times half the size, at most 2^9: off by less than 2^-40 pixels.
constexpr double kCrossingMargin = 0x1p-20;

}  // namespace

DepthRaster::DepthRaster(int size)
    : size_(size),
      depths_(static_cast<std::size_t>(size) * size, kNothing),
      coarse_size_(size / kTile),
      least_(static_cast<std::size_t>(size)) {
  coarse_.assign(static_cast<std::size_t>(coarse_size_) * coarse_size_, kNothing);
}

// The column (row) in which x (y) lies.
int DepthRaster::pixel(double x) const {
  const double at = (x + 1) * 0.5 * size_;
  return static_cast<int>(std::clamp(std::floor(at), 0.0, size_ - 1.0));
}

void DepthRaster::draw(const RasterOccluder& occluder, const PictureRect& around) {
  if (around.max_x < -1 || around.min_x > 1 || around.max_y < -1 || around.min_y > 1)
    return;
  const double width = 2.0 / size_, half = width / 2;
  const int first_row = pixel(around.min_y), last_row = pixel(around.max_y);
  const int least = pixel(around.min_x), most = pixel(around.max_x);
  bool drawn = false;
  for (int row = first_row; row <= last_row; ++row) {
    const double y = -1 + (row + 0.5) * width;
    // Columns whose pixels lie wholly on the inner side of each side: a x > bound for the
    // middle of the pixel.
    double from = -1, to = 1;
    bool empty = false;
    for (const PictureFunction& s : occluder.sides) {
      const double rest =
          s.b * y + s.c - (std::abs(s.a) + std::abs(s.b)) * half - s.error;
      if (s.a > 0) {
        from = std::max(from, -rest / s.a);
      } else if (s.a < 0) {
        to = std::min(to, -rest / s.a);
      } else {
        empty |= !(rest > 0);
      }
    }
    if (empty || !(from < to)) continue;
    // Pixels whose middles lie further in than rounding of the quotients reaches.
    int first = std::max(least, static_cast<int>(std::ceil((from + 1) * 0.5 * size_ -
                                                           0.5 + kCrossingMargin)));
    int last = std::min(most, static_cast<int>(std::floor((to + 1) * 0.5 * size_ - 0.5 -
                                                          kCrossingMargin)));
    first = std::max(first, 0);
    last = std::min(last, size_ - 1);
    if (last < first) continue;
    drawn = true;
    // The least of the planes' depths in floats; what these round is taken off.
    const int n = last - first + 1;
    std::fill_n(least_.begin(), n, -kNothing);
    for (const PictureFunction& d : occluder.depths) {
      const double x = -1 + (first + 0.5) * width;
      const double slack = 0x1p-20 * (std::abs(d.a) + std::abs(d.b) + std::abs(d.c));
      const auto begin = static_cast<float>(d.a * x + d.b * y + d.c - slack - d.error -
                                            (std::abs(d.a) + std::abs(d.b)) * half);
      const auto step = static_cast<float>(d.a * width);
      float* const row_least = least_.data();
      for (int i = 0; i < n; ++i) {
        const float depth = begin + step * static_cast<float>(i);
        row_least[i] = depth < row_least[i] ? depth : row_least[i];
      }
    }
    float* const line = depths_.data() + static_cast<std::size_t>(row) * size_ + first;
    const float* const row_least = least_.data();
    for (int i = 0; i < n; ++i) line[i] = line[i] < row_least[i] ? row_least[i] : line[i];
  }
  if (!drawn) return;
  for (int ty = first_row / kTile; ty <= last_row / kTile; ++ty) {
    for (int tx = least / kTile; tx <= most / kTile; ++tx) refresh(tx, ty);
  }
}

void DepthRaster::refresh(int tile_x, int tile_y) {
  std::array<float, kTile> least;
  least.fill(-kNothing);
  for (int y = 0; y < kTile; ++y) {
    const float* const row = depths_.data() +
                             static_cast<std::size_t>(tile_y * kTile + y) * size_ +
                             tile_x * kTile;
    for (int x = 0; x < kTile; ++x) least[x] = row[x] < least[x] ? row[x] : least[x];
  }
  coarse_[static_cast<std::size_t>(tile_y) * coarse_size_ + tile_x] =
      *std::ranges::min_element(least);
}

bool DepthRaster::hides(const PictureRect& rect, double depth) const {
  const int x0 = pixel(rect.min_x), x1 = pixel(rect.max_x);
  const int y0 = pixel(rect.min_y), y1 = pixel(rect.max_y);
  for (int ty = y0 / kTile; ty <= y1 / kTile; ++ty) {
    for (int tx = x0 / kTile; tx <= x1 / kTile; ++tx) {
      if (coarse_[static_cast<std::size_t>(ty) * coarse_size_ + tx] > depth) continue;
      const int ya = std::max(y0, ty * kTile), yb = std::min(y1, ty * kTile + kTile - 1);
      const int xa = std::max(x0, tx * kTile), xb = std::min(x1, tx * kTile + kTile - 1);
      for (int y = ya; y <= yb; ++y) {
        for (int x = xa; x <= xb; ++x) {
          if (!(depths_[static_cast<std::size_t>(y) * size_ + x] > depth)) return false;
        }
      }
    }
  }
  return true;
}

}  // namespace sightline::internal
