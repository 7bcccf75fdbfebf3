// The EEE part of the visibility skeleton by brute force, in exact arithmetic: written
// from the definitions of the contract ("sightline skeleton", solid and polygon mode),
// sharing no code and no parametrisation with the library, to test it against.

#pragma once

#include "linespace/scene.h"
#include "tests/support/canonical_skeleton.h"

namespace sightline::testing {

/// All EEE arcs of disjoint convex polyhedra, one per group, with triangular or exactly
/// planar faces, and all nodes at which they end: VEE, EVE, EEEE and FEE.
///
/// Nodes are found from their own definitions (VEE and EVE by naive_ev(), every four
/// edges, every face and two edges) and arcs from theirs (every three edges, every
/// interval between critical lines), independently; then every end of an arc must be one
/// of those nodes and every node the end of exactly two arcs, which implies
/// EEE = VEE + EVE + EEEE + FEE.  std::logic_error otherwise.
///
/// With `end_contacts` (polygon mode) those with end contacts as well, told as by
/// naive_ev(): an arc is a run of lines with the same contacts; EVE and EEEE nodes and
/// FEE nodes with the face in the middle end two arcs, the other FEE nodes three, VEE
/// nodes two or more.
///
/// Throws NotGeneral (naive_ev.h) where naive_ev() does, and when a line that supports
/// all its contacts has one more than its kind of node, touches a solid in the plane of a
/// face without being an FEE of it, or is the double root of its four edges.
/// Cost: for n edges, about n^3 sign tests, and n of them for each of the few thousand
/// triples that some line supports; 8 solids with n = 144 take a few seconds.
[[nodiscard]] CanonicalSkeleton naive_eee(const PolygonSoup& soup,
                                          bool end_contacts = false);

}  // namespace sightline::testing
