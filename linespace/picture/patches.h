// Patches: facets, of one object or several, that lie in one plane, face alike, and hang
// together.

#pragma once

#include <functional>
#include <vector>

#include "linespace/silhouettes/silhouettes.h"

namespace sightline::internal {

/// For facet f, the patch number of its front at 2 f and of its back at 2 f + 1.  Two
/// facets are of one patch when faces of theirs lie in one plane and touch along a
/// segment or overlap, and so on from facet to facet.  A closed object's facet faces to
/// its front; that of an object that is a sheet faces both ways.  Cost: n log n for n
/// faces, few of which touch each other.
[[nodiscard]] std::vector<int> find_patches(
    const Silhouettes& silhouettes, const std::function<bool(int object)>& is_sheet);

/// Two faces of one plane have a segment or more in common.
[[nodiscard]] bool hang_together(const Scene& scene, int face, int other);

}  // namespace sightline::internal
