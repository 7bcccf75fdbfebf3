// By which faces lines from some viewpoints can enter a convex solid: the others are met
// behind these.

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "linespace/silhouettes/silhouettes.h"

namespace sightline::internal {

/// Found when asked for and kept, so one per thread.
class FacingFaces {
 public:
  explicit FacingFaces(const Silhouettes& silhouettes);

  /// Looks from all points of these points' hull from now on.
  void begin(std::span<const Point> viewpoints);
  /// Requires convex_solid(object).  All faces where the solid's box meets that of the
  /// viewpoints; else those that not all viewpoints are strictly behind.
  [[nodiscard]] std::span<const std::int32_t> of(int object);

 private:
  struct Part {
    std::uint32_t stamp = 0, first = 0, count = 0;  // in faces_
  };

  const Silhouettes& g_;
  std::vector<Point> viewpoints_;
  Box box_{};
  std::uint32_t stamp_ = 0;
  std::vector<Part> parts_;  // by object
  std::vector<std::int32_t> faces_;
};

}  // namespace sightline::internal
