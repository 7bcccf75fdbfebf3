// What several views together show of one patch, and what is left.

#pragma once

#include <memory>
#include <vector>

#include "aspect/choice/patch_sides.h"
#include "aspect/choice/seen_parts.h"

namespace sightline::internal {

/// A patch as a set of points of its plane, on a grid of 2^29 steps across it: what is
/// seen is rounded, and so are unions.
class PatchArea {
 public:
  PatchArea(const Scene& scene, const PatchSide& side);
  ~PatchArea();
  PatchArea(PatchArea&&) noexcept;

  /// The region is seen: it is no longer among what is left of the patch.
  void take_away(const SeenRegion& region);
  /// What is left, as a share of the whole patch.  Less than kGrain is nothing.
  [[nodiscard]] double left() const;
  /// Corners are rounded to 2^-29 of the patch's extent, so that an edge across it moves
  /// by less than 2^-28 of its square: some thirty edges may leave as much as this.
  static constexpr double kGrain = 0x1p-23;
  /// A point well inside the largest of the pieces into which what is left is cut.
  [[nodiscard]] Point place_left() const;
  /// The piece of place_left() counts as seen from now on, though no view shows it.
  void give_up_place();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The place, on the patch's plane, lies in the region.
[[nodiscard]] bool contains(const SeenRegion& region, const PatchSide& side,
                            const Point& place);
[[nodiscard]] bool shows(const SeenParts& view, const PatchSide& side,
                         const Point& place);

}  // namespace sightline::internal
