// The planes that bound the umbra and the whole shadow of one convex body under another.

#pragma once

#include <string>
#include <vector>

#include "linespace/space/cut_polyhedron.h"
#include "shadows/shadow_volume.h"
#include "shadows/volumes/convex_body.h"

namespace sightline::internal {

struct ShadowPlane {
  HalfSpace inside;
  ShadowSideKind kind;
  std::vector<std::string> generators;
  /// A point of the plane is outside: a facet whose points see a part of the source.
  bool open = false;
};

/// The points p for which every segment to the source meets the solid: each lies in all
/// of these half-spaces.
[[nodiscard]] std::vector<ShadowPlane> umbra_planes(const ConvexBody& source,
                                                    const ConvexBody& solid);
/// The points p for which some segment to the source meets the solid.  None where all
/// points are: the two overlap.
[[nodiscard]] std::vector<ShadowPlane> shadow_planes(const ConvexBody& source,
                                                     const ConvexBody& solid);
/// The half-spaces behind a body's own facets, whose common part the body is.
[[nodiscard]] std::vector<ShadowPlane> body_planes(const ConvexBody& body,
                                                   ShadowSideKind kind);

}  // namespace sightline::internal
