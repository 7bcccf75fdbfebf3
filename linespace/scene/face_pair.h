// Do two faces have more in common than the corners and sides they share?
//
// Both are convex and exactly planar.  Whatever they have in common beyond shared corners
// and shared sides shows as one of these, each an exact test:
//   1. a corner of one lies on the other and is no corner of it;
//   2. a side of one crosses the other's plane inside the other;
//   3. a side of one lies in the other's plane and crosses a side of it, or joins two
//      corners of it through its inside, or is a side of it too with both faces,
//      coplanar, on the same side of it.

#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "linespace/predicates.h"
#include "linespace/scene.h"

namespace sightline::internal {

/// Asks about one pair after the other; keeps its memory between them.
class FacePair {
 public:
  explicit FacePair(const Scene& scene) : scene_(scene) {}

  /// Faces f and g meet beyond the corners and sides they share.
  [[nodiscard]] bool meet(int f, int g);

 private:
  using Corners = std::span<const int>;

  [[nodiscard]] PlaneThrough plane_of(int k) const;
  bool find_signs();
  [[nodiscard]] bool shares_side_across() const;
  Sign turn(int k, int a, int b, int c);
  bool covers(int k, int p);
  bool corner_inside(int k);
  [[nodiscard]] bool pierces(int k) const;
  bool runs_inside(int k);
  bool same_side(Corners own, std::size_t i, std::size_t j, Sign side, int k);

  const Scene& scene_;
  std::array<Corners, 2> ids_;
  std::array<std::vector<Sign>, 2> signs_;  // of corners, above the other's plane
  bool coplanar_ = false;
  std::array<std::optional<int>, 2> axis_;
  std::array<Sign, 2> front_{};
};

}  // namespace sightline::internal
