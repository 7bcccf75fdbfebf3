// The FF nodes by brute force, in exact arithmetic: every two faces of two solids.

#pragma once

#include <vector>

#include "linespace/scene.h"
#include "tests/support/canonical_skeleton.h"

namespace sightline::testing {

/// All lines in the planes of two faces of different solids, across the inside of both,
/// that enter no solid between the outermost of the four sides crossed, nor at these.
/// Sorted keys of kind "FF".  For convex polyhedra with disjoint interiors, one per
/// group, with exactly planar faces.  Throws NotGeneral (naive_ev.h) for other groups,
/// and where such a line passes through a corner of one of its two faces.
/// Cost: about f^2 k for f faces of k solids.
[[nodiscard]] std::vector<NodeKey> naive_ff(const PolygonSoup& soup);

}  // namespace sightline::testing
