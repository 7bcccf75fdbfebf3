// The EV part of the visibility skeleton by brute force, in exact arithmetic: written
// from the definitions of the contract ("sightline skeleton", solid and polygon mode),
// sharing no code with the library, to test it against.

#pragma once

#include <stdexcept>
#include <string>

#include "linespace/scene.h"
#include "tests/support/canonical_skeleton.h"

namespace sightline::testing {

/// The scene is not what naive_ev() is defined for.
class NotGeneral : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// All VV, VEE, EVE and FvE nodes and all EV arcs of disjoint convex polyhedra, one per
/// group, with triangular or exactly planar faces.
///
/// Nodes are found from their own definitions (every pair of vertices, every vertex and
/// two edges, every face, corner and edge) and arcs from theirs (every vertex and edge,
/// every interval between critical parameters), independently; then every end of an arc
/// must be one of those nodes, and 2 EV = 4 VV + VEE + FvE.  std::logic_error otherwise.
///
/// With `end_contacts` (polygon mode) those with end contacts as well: their generators
/// are lower-case, their nodes "_end"; there an arc is a run of lines with the same
/// contacts, and the equation does not hold.
///
/// Throws NotGeneral when a group is not such a polyhedron or when four vertices, two of
/// them joined by an edge and not all of one solid, are coplanar.
/// Cost: about n^2 (n k + c) for n edges of k solids, c crossings of a plane; n = 100
/// takes about a second.
[[nodiscard]] CanonicalSkeleton naive_ev(const PolygonSoup& soup,
                                         bool end_contacts = false);

}  // namespace sightline::testing
