#include "viewers/pictures/lit_image.h"

#include <algorithm>
#include <cmath>

namespace sightline::viewers {
namespace {

std::uint8_t byte(double x) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
}

/// Linear light as a PNG stores it (sRGB, IEC 61966-2-1).
double stored(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// The value that this share of the surfaces' pixels do not exceed.
double brightest(const std::vector<LitPixel>& pixels, double share) {
  std::vector<double> values;
  for (const LitPixel& pixel : pixels) {
    if (pixel.kind == LitPixel::Kind::Surface) values.push_back(pixel.value);
  }
  if (values.empty()) return 0;
  const auto rank = static_cast<std::ptrdiff_t>(
      std::ceil(share * static_cast<double>(values.size() - 1)));
  std::ranges::nth_element(values, values.begin() + rank);
  return values[rank];
}

}  // namespace

Image lit_image(const std::vector<LitPixel>& pixels, int width, int height,
                double share) {
  const double most = brightest(pixels, share);
  // Umbra stays apart from nothing.
  constexpr double kLeast = 0.004, kBrightest = 0.9;
  Image image{width, height, {}};
  image.rgb.reserve(3 * pixels.size());
  for (const LitPixel& pixel : pixels) {
    std::array<std::uint8_t, 3> colour{18, 22, 38};
    if (pixel.kind == LitPixel::Kind::Source) colour = {255, 244, 214};
    if (pixel.kind == LitPixel::Kind::Surface) {
      const double bright = most > 0 ? std::min(pixel.value / most, 1.0) : 0;
      colour.fill(byte(stored(kLeast + (kBrightest - kLeast) * bright)));
    }
    image.rgb.insert(image.rgb.end(), colour.begin(), colour.end());
  }
  return image;
}

}  // namespace sightline::viewers
