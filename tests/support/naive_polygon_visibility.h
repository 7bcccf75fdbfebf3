// Whether two convex polygons see each other past convex occluders, decided by brute
// force in exact arithmetic for a handful of occluders: written from the contract's
// definition
// ("sightline visible FILE.json"), sharing no code with the library.
//
// Visible means: some closed segment from a point of a's relative interior to one of b's
// misses every closed occluder.

#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tests/support/exact.h"

namespace sightline::testing {

struct VisibilityInstance {
  std::vector<Point> a, b;
  std::vector<std::vector<Point>> occluders;
};

struct ExactWitness {
  Vec3 from, to;
};

/// Whether p is in a's relative interior, q in b's, and the closed segment pq misses all
/// closed occluders, those in its plane and degenerate ones (segments, points) too.
/// Exact; nothing is rounded.  a, b: planar convex polygons of positive area; occluders:
/// planar convex polygons or points of one line, in order; repeated points are allowed.
[[nodiscard]] bool is_free(const VisibilityInstance& instance, const Vec3& p,
                           const Vec3& q);

/// The first of n random segments that is_free() accepts.  nullopt proves nothing.
[[nodiscard]] std::optional<ExactWitness> find_free_segment(
    const VisibilityInstance& instance, std::uint64_t seed, int n);

enum class NaiveAnswer {
  Visible,   ///< proved by a witness that is_free() accepts
  Hidden,    ///< no extremal line is free
  Undecided  ///< an extremal line looks free, but no segment close to it is
};

struct NaiveVisibility {
  NaiveAnswer answer;
  std::optional<ExactWitness> witness;
  /// Quadruples of edges tried, and those of them that needed exact arithmetic.
  long quadruples = 0, exact_quadruples = 0;
};

/// How it decides.  Polygons are first made to avoid each other: a and b lose what
/// coplanar occluders cover and are cut where an occluder pierces them and along each
/// other's planes; cuts are null sets, and visibility is open, so none matters.  Then
/// every vertex of every occluder moves outwards in its plane by about 2^-120 of its
/// polygon's size, every vertex of a and b inwards, each by a factor of its own: what is
/// visible then was visible before, always; the converse holds when no gap is narrower
/// than about 2^-120 of the scene.  Of the lines that meet both polygons and cross no
/// occluder's interior between them, the closure, if not empty, contains one determined
/// by four edges, two vertices (or crossings of coplanar edges), or a vertex, a plane
/// through it and an edge.  All of these are tried; each is checked in the numbers a + b
/// sqrt(D).
///
/// Hidden rests on that; Visible only on is_free().  Undecided if a and b are coplanar
/// and random segments between them are all blocked.
///
/// Requires exactly planar convex polygons with at most about 30 edges in all; throws
/// std::invalid_argument when one is not planar or a or b has no area.
/// Cost: about 1 us for each quadruple of edges, 50 us for those in special position.
[[nodiscard]] NaiveVisibility naive_visibility(const VisibilityInstance& instance);

}  // namespace sightline::testing
