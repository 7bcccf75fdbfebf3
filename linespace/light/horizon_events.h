// Events at the horizon of a receiver whose plane cuts the source, or has a side of it:
// two things that cross the plane, or lie in it, are seen in one, by lines in the plane
// itself.

#pragma once

#include <span>
#include <vector>

#include "linespace/light/light_traces.h"
#include "linespace/light/patch_space.h"

namespace sightline::internal {

/// Wanted faces of one facet in one plane: all, or of a facet that is bent one.
struct HorizonPlane {
  int facet;
  std::vector<int> faces;
};
/// The horizon planes that cut the patch, which has points strictly on both sides of
/// them, or touch it along a side of its hull.
[[nodiscard]] std::vector<HorizonPlane> horizon_planes(
    const PatchSpace& at, std::span<const std::uint8_t> front,
    std::span<const std::uint8_t> back);

/// The traces in such a plane: lines in it through two points there, as far as they lie
/// on the wanted faces beyond both.  What lies in the way beyond is not asked.
[[nodiscard]] std::vector<LightTrace> horizon_events(const PatchSpace& at,
                                                     const HorizonPlane& horizon,
                                                     std::span<const std::uint8_t> front,
                                                     std::span<const std::uint8_t> back);

}  // namespace sightline::internal
