// What a convex solid, a convex facet or a face hides from a viewpoint, as a Shadow; and
// which face to try first.

#pragma once

#include <span>
#include <vector>

#include "linespace/silhouettes/silhouettes.h"
#include "linespace/space/shaft.h"

namespace sightline::internal {

/// Behind a convex solid's front faces, inside the cone of its outline.  Requires
/// silhouettes.convex_solid(object).
[[nodiscard]] Shadow solid_shadow(const Silhouettes& silhouettes, int object,
                                  const Point& viewpoint);

/// Beyond the plane of a face's convex facet, inside the cone of its sides; of the face
/// alone where its facet is not known to be convex.  No planes when seen edge-on.
[[nodiscard]] Shadow facet_shadow(const Silhouettes& silhouettes, int face,
                                  const Point& viewpoint);

/// What one occluder is known by: its convex solid, convex facet, or face.
[[nodiscard]] std::int64_t occluder_key(const Silhouettes& silhouettes, int face);

/// Appends all faces of the occluder that a face belongs to.
void add_occluder_faces(const Silhouettes& silhouettes, int face,
                        std::vector<std::int32_t>& faces);

/// The nearest face between two points that plain double arithmetic finds, faces of
/// facets with facet_stamp[f] == stamp left out; -1 for none.  A proposal only.
[[nodiscard]] int propose_occluder(const Silhouettes& silhouettes, const Point& from,
                                   const Point& to,
                                   std::span<const std::uint32_t> facet_stamp,
                                   std::uint32_t stamp);

}  // namespace sightline::internal
