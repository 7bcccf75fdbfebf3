// Shadow volumes: where in space one convex solid hides all of one convex source (umbra),
// and where it hides some of it (umbra and penumbra together), as convex polyhedra.
//
// Both are as if source and solid were alone.  With S the source and P the solid, a point
// is in umbra or penumbra iff some segment to S meets P: the points q + t (q - s) with q
// in P, s in S, t >= 0.  It is in umbra iff that holds for every corner s of S.  Both
// sets are convex, and their sides pass through a corner of one and an edge of the other,
// or along a facet of the solid (docs/shadows.md, "Volumes").
//
//   const ShadowVolumes volumes(scene, light_source(scene, lamp),
//   scene.faces_named("box")); std::cout << volumes.umbra().volume << ' ' <<
//   volumes.penumbra_volume() << '\n';
//
// Nishita and Nakamae, Half-tone representation of 3-D objects illuminated by area
// sources or polyhedron sources, 1983. Neighbours: backprojection.h tells of a point
// among all blockers what it sees; shadow_mesh.h finds the regions on receivers.

#pragma once

#include <memory>
#include <vector>

#include "linespace/exact_position.h"
#include "linespace/scene.h"
#include "shadows/light_seen.h"
#include "shadows/light_source.h"
#include "shadows/shadow_volume.h"

namespace sightline {

/// Immutable; safe to share between threads.
class ShadowVolumes {
 public:
  /// source: faces of one plane that face alike and make one convex polygon, or all faces
  /// of a closed convex object that shines outwards.  solid: faces of the scene: those of
  /// a closed convex object, or of one plane that make one convex polygon (a sheet).
  /// Cut off at the scene's box.  Throws InvalidInput, with one line that says what is
  /// not convex, for others; and where the solid cuts the source. Cost: for a source of m
  /// corners and a solid of n sides about m n (m + n) signs, then the square of the
  /// number of sides of the volumes, in rational numbers.
  ShadowVolumes(const Scene& scene, const LightSource& source,
                const std::vector<int>& solid);
  ~ShadowVolumes();
  ShadowVolumes(ShadowVolumes&&) noexcept;

  /// Points in front of the source that see nothing of it.  The solid is a part of it,
  /// as nothing is seen from inside.  Where the source is larger than the solid it ends
  /// in an apex or a ridge.
  [[nodiscard]] const ShadowVolume& umbra() const;
  /// Points in front of the source that do not see all of it: umbra and penumbra.
  [[nodiscard]] const ShadowVolume& shadow() const;

  /// All are within 1e-15 of themselves, and scene units cubed.  umbra().volume, these
  /// two and away_volume() are what the box consists of; none is the rest.
  [[nodiscard]] double penumbra_volume() const;
  [[nodiscard]] double lit_volume() const;
  /// Behind the plane of the source, or inside a closed source.
  [[nodiscard]] double away_volume() const;
  /// The part of umbra() that is inside the solid.
  [[nodiscard]] double solid_volume() const;

  /// Of a point without a normal, in the box or beyond, exactly: that of
  /// BackprojectionIndex in a scene of source and solid alone.
  [[nodiscard]] ShadowClass at(const ExactPosition& point) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sightline
