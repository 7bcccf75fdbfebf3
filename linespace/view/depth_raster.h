// Pixels of one side of a cube round the eye, or of the plane across a direction, with a
// depth that hides: what is certainly covered, and what lies certainly behind that.
//
// All is rounded, with margins that make "hidden" a proof: a pixel counts as covered by
// an occluder only where all of its area is, with the farthest depth there.

#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace sightline::internal {

/// A function a x + b y + c of the picture, with a bound on its error.
struct PictureFunction {
  double a, b, c, error;
};

/// A convex occluder: covers the pixels where all `sides` are positive, at the least of
/// `depths`.  Depths are larger for what is nearer.
struct RasterOccluder {
  std::vector<PictureFunction> sides, depths;
};

/// A part of the picture, from the least x and y to the largest.
struct PictureRect {
  double min_x, min_y, max_x, max_y;
};

class DepthRaster {
 public:
  /// size x size pixels over the square from -1 to 1; a multiple of 8.
  explicit DepthRaster(int size);

  void draw(const RasterOccluder& occluder, const PictureRect& around);

  /// Every pixel that meets the closed rectangle is covered nearer than the depth.
  [[nodiscard]] bool hides(const PictureRect& rect, double depth) const;

 private:
  [[nodiscard]] int pixel(double x) const;

  int size_;
  std::vector<float> depths_;  // row by row; the least float: nothing covers the pixel
  // The least depth in squares of pixels, never above the true one.
  std::vector<float> coarse_;
  int coarse_size_;
  std::vector<float> least_;  // of one row: scratch
  static constexpr int kTile = 8;

  void refresh(int tile_x, int tile_y);
};

}  // namespace sightline::internal
