// Small scenes full of coincidences, and the same scenes written down in other ways: what
// docs/degenerate_scenes.md ("What is invariant") says changes no answer.

#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "linespace/scene.h"

namespace sightline::testing {

/// What the objects of a scene do to each other.
enum class Crowd {
  Overlapping,    ///< solids that go through each other, sheets across them
  Touching,       ///< boxes with disjoint interiors, wedges and sheets laid against them
  RepeatedFaces,  ///< either of these, with faces listed twice within their object
  NonManifold     ///< objects with edges of three faces or more, pinched corners,
                  ///< T-junctions
};
[[nodiscard]] std::string name(Crowd crowd);

/// 3 to 8 objects on a small grid of integers, each a group of exactly planar faces.
[[nodiscard]] PolygonSoup crowded_scene(Crowd crowd, std::uint64_t seed);

/// A scene that must give the same answers as another.
struct Variant {
  std::string name;
  PolygonSoup soup;
  /// From the first scene into this one, and back; exact.
  std::function<Point(const Point&)> map, undo;
};

/// The scene in another order, on other axes, sheared, moved, scaled, with its edges and
/// facets cut (within each object without T-junctions), with faces repeated, and with
/// several of these at once.  Requires coordinates that are integers below 2^8.
[[nodiscard]] std::vector<Variant> variants_of(const PolygonSoup& soup,
                                               std::uint64_t seed);

}  // namespace sightline::testing
