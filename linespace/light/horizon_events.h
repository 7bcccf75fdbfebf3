// Events at the horizon of a receiver whose plane cuts the source: two things that cross
// the plane, or lie in it, are seen in one, by lines in the plane itself.

#pragma once

#include <span>
#include <vector>

#include "linespace/light/light_traces.h"
#include "linespace/light/patch_space.h"

namespace sightline::internal {

/// Facets with a wanted face whose planes cut the patch, so that it has points strictly
/// on both sides; ascending.
[[nodiscard]] std::vector<int> horizon_facets(const PatchSpace& at,
                                              std::span<const std::uint8_t> front,
                                              std::span<const std::uint8_t> back);

/// The traces of such a facet: lines in its plane through two points there, as far as
/// they lie on its wanted faces beyond both.  What lies in the way beyond is not asked.
[[nodiscard]] std::vector<LightTrace> horizon_events(const PatchSpace& at, int facet,
                                                     std::span<const std::uint8_t> front,
                                                     std::span<const std::uint8_t> back);

}  // namespace sightline::internal
