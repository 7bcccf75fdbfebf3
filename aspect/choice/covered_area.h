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

  /// Of the patch this is left no more.
  void take_away(const SeenRegion& region);
  /// Of what is left, the share of the whole patch.  Less than kGrain is nothing.
  [[nodiscard]] double left() const;
  static constexpr double kGrain = 1e-7;
  /// A point well inside the largest of the pieces into which what is left is cut.
  [[nodiscard]] Point place_left() const;
  /// That piece is no more asked for.
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
