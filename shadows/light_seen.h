// What a point sees of an area light, as values.
//
// The structure of the part seen: Drettakis and Fiume, A fast shadow algorithm for area
// light sources using backprojection, 1994.
// Neighbours: backprojection.h finds all this.

#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "linespace/scene.h"

namespace sightline {

enum class ShadowClass : std::uint8_t { Umbra, Penumbra, Lit };

/// What one side of the part seen lies on.
struct SeenSide {
  enum class Kind : std::uint8_t {
    Source,  ///< a side of the source: its number among the source's sides
    Edge,    ///< an edge of the scene: the smallest id of all that go on straight
    Cut,     ///< where the facet of a blocker cuts the source's plane
    Horizon
  };
  Kind kind;
  int id;  ///< 0 for the horizon
  friend auto operator<=>(const SeenSide&, const SeenSide&) = default;
};

/// A closed boundary of the part seen of one source face, the seen part on the left as
/// the point sees it.
struct SeenBoundary {
  /// Which source face: faces of the source in one plane that face alike and touch along
  /// an edge, or overlap, are one.
  int source_face;
  /// Side k runs from corners[k] to the next one.  Several names where several things
  /// are seen in line there; ascending.
  std::vector<std::vector<SeenSide>> sides;
  std::vector<Point> corners;  ///< on the source, rounded
};

struct Backprojection {
  ShadowClass shadow;
  /// Area of the source that is seen, over the area of those source faces that show the
  /// point their front; 0 where none does.  Within 1e-12; above 0 in the penumbra, below
  /// 1 unless that rounds to 1.
  double visible_fraction;
  /// Of an element at the point to what is seen of the source; nullopt without a normal.
  /// Within 1e-12.
  std::optional<double> form_factor;
  /// Of the form factor with the point, 1 / scene units; nullopt without a normal, and
  /// where it differs from side to side.
  std::optional<Eigen::Vector3d> gradient;
  /// Where the point lies in one plane in which things are seen in line, and the gradient
  /// differs on its two sides: both limits.  Where it lies in several such planes,
  /// neither this nor the gradient is told.
  std::optional<std::array<Eigen::Vector3d, 2>> one_sided = std::nullopt;
  /// In a canonical order: two points see the source alike iff their boundaries have the
  /// same source faces and sides.
  std::vector<SeenBoundary> boundaries;
};

}  // namespace sightline
