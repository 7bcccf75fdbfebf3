// A copy of a scene in general position, near the original: for what lines up, to see
// what of an answer stays when nothing lines up any more.

#pragma once

#include <cstdint>

#include "linespace/scene.h"

namespace sightline {

/// The polygons of a scene with every object moved as a whole, by its own random affine
/// map near the identity.  Laws:
/// - No point moves by more than `size` (scene units).
/// - Nothing is rounded on the way: a face that is planar stays planar, exactly, if its
///   points are multiples of a power of two above size / 16, if it is a triangle, or if
///   it is parallel to two coordinate axes; other polygons may get folds, as in a file.
///   So solids stay solids, and convex ones convex.
/// - Polygons keep their numbers and groups, and each object its faces and edges.  What
///   two objects share (walls, corners) they no longer share: they come apart, or
///   overlap, by up to twice the size.  Within an object what is parallel or coplanar
///   stays so.
/// - The same on every machine for the same scene, size and seed.
/// Requires a size of at least 2^-16 times the largest coordinate, and finite; throws
/// InvalidInput otherwise.
[[nodiscard]] PolygonSoup perturbed(const Scene& scene, double size, std::uint64_t seed);

}  // namespace sightline
