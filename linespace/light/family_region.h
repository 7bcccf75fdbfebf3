// Where the lines of a part of a family run: which boxes they certainly miss.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "linespace/light/line_family.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// Rounded, with margins that make "misses" a proof.
class FamilyRegion {
 public:
  /// `size` bounds the scene's coordinates.
  explicit FamilyRegion(double size) : pad_(0x1p-36 * size) {}

  /// The region grows by the lines of the family between two positions, each without
  /// ends.
  void add(const LineFamily& family, double from, double to);
  /// All lines lie in this plane.
  void set_plane(const Four<Approx>& plane);

  [[nodiscard]] bool may_meet(const Box& box) const;

 private:
  // The lines through a point in either box.
  struct Part {
    Box first, last;
  };
  [[nodiscard]] static bool meets(const Part& part, const Box& box);
  [[nodiscard]] bool add_steps(const LineFamily& family, double from, double to,
                               int steps);

  double pad_;
  bool everywhere_ = false;
  std::vector<Part> parts_;
  std::optional<Four<Approx>> plane_;
};

}  // namespace sightline::internal
