// Scenes made from a seed: random polytopes, boxes and cities, for tests and benchmarks.
//
// Every generator gives the same soup for the same arguments on every machine: numbers
// come from std::mt19937_64 by distributions of our own, and the arithmetic behind a
// decision (hulls, disjointness) is exact.  Each solid is one named group, its faces
// counter-clockwise seen from outside.  A generator that cannot place what was asked for
// throws std::runtime_error.

#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "linespace/scene.h"

namespace sightline::testing {

/// Random numbers that do not depend on the standard library's distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform on the multiples of 2^-53 in [0, 1), mapped to [lo, hi).
  double uniform(double lo = 0, double hi = 1) {
    return lo + (hi - lo) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  /// Uniform on lo, ..., hi, both included.
  int integer(int lo, int hi) {
    return lo + static_cast<int>(engine_() % (static_cast<std::uint64_t>(hi - lo) + 1));
  }
  bool one_in(int n) { return integer(1, n) == 1; }
  /// Uniform on the unit sphere; square roots only, so the same on every machine.
  Point direction();
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (int i = static_cast<int>(items.size()) - 1; i > 0; --i) {
      std::swap(items[i], items[integer(0, i)]);
    }
  }

 private:
  std::mt19937_64 engine_;
};

struct PolytopeOptions {
  /// Points on a sphere of which a polytope is the hull: its number of vertices, save
  /// where rounding to the grid hides one.
  int min_vertices = 4, max_vertices = 12;
  /// Radii of these spheres, in scene units.
  double min_radius = 0.5, max_radius = 1;
  /// Share of the cube that these spheres would fill; up to about 0.3.
  double density = 0.1;
  /// Coordinates are multiples of 2^-bits.
  int bits = 12;
};

/// `count` disjoint convex polyhedra with triangular faces, scattered in a cube.
[[nodiscard]] PolygonSoup random_polytopes(std::uint64_t seed, int count,
                                           const PolytopeOptions& options = {});

/// `count` disjoint slanted parallelepipeds: six exactly planar quads each, in general
/// position among each other.
[[nodiscard]] PolygonSoup random_parallelepipeds(std::uint64_t seed, int count,
                                                 const PolytopeOptions& options = {});

/// An axis-aligned box by its corners of smallest and of largest coordinates.
struct AlignedBox {
  std::array<double, 3> min, max;
};

/// One group of six quads per box, named box0, box1, ...; boxes share no vertex records,
/// also where they touch.
[[nodiscard]] PolygonSoup boxes_soup(const std::vector<AlignedBox>& boxes);

struct BoxOptions {
  /// 0: continuous coordinates.  Otherwise integers in [0, grid].
  int grid = 0;
  /// Interiors stay disjoint; boundaries may meet.
  bool may_touch = false;
  /// Side lengths, as a share of the cube's side (continuous), or in units (grid).
  double min_size = 0.1, max_size = 0.3;
  /// The cube's side when coordinates are continuous.
  double side = 10;
};

/// `count` axis-aligned boxes in a cube, disjoint or (may_touch) with disjoint interiors.
[[nodiscard]] PolygonSoup random_boxes(std::uint64_t seed, int count,
                                       const BoxOptions& options = {});

/// `count` disjoint boxes, each turned by a random rotation in doubles, so that its quads
/// are planar only up to rounding.
[[nodiscard]] PolygonSoup rotated_boxes(std::uint64_t seed, int count);

/// How a few boxes on the integer grid meet.
enum class Touching {
  FaceToFace,      ///< two unit cubes with one common face
  FacePart,        ///< a small box on the middle of a larger one's side
  FaceOverlap,     ///< two equal boxes shifted along their common face plane
  FaceFlush,       ///< different heights, one pair of side walls in one plane
  Edge,            ///< two boxes with a whole common edge, diagonal to each other
  EdgePart,        ///< the same, shifted along the edge
  EdgeOnFace,      ///< an edge of one inside the plane of another's face, faces abutting
  CrossedEdges,    ///< a roof's edge crosses the bottom edge of a box on it
  Corner,          ///< two boxes with only a corner in common
  CornerOnEdge,    ///< a corner of one inside an edge of another
  Stack,           ///< three boxes of one footprint on top of each other
  Pyramid,         ///< three boxes of shrinking footprint on top of each other
  Row,             ///< four equal boxes side by side
  RowOfDifferent,  ///< four boxes side by side, of different heights
  Around,          ///< four boxes around a square shaft, touching along edges
  Courtyard,       ///< four walls closing a shaft, face to face
  TeeJunction,     ///< two boxes abut on a third's face, touching each other too
  OnSlab           ///< two boxes standing apart on a slab
};
[[nodiscard]] const std::vector<Touching>& all_touching();
[[nodiscard]] std::string name(Touching kind);
[[nodiscard]] PolygonSoup touching_boxes(Touching kind);

/// Boxes of random size standing on a thick ground slab: bottoms in the plane z = 0,
/// which is the slab's top; footprints disjoint with streets between; coordinates
/// continuous.  Six quads a building and six for the slab: the largest such number not
/// above `polygon_count` (at least 12).  Groups: ground, building0, building1, ...
[[nodiscard]] PolygonSoup city(std::uint64_t seed, int polygon_count);

struct GridCityOptions {
  /// Buildings may share walls, edges and corners.
  bool may_touch = false;
  int max_height = 4;
};

/// The same with all coordinates small integers: coplanar roofs, aligned walls.
[[nodiscard]] PolygonSoup grid_city(std::uint64_t seed, int polygon_count,
                                    const GridCityOptions& options = {});

struct StreetCityOptions {
  /// Few sides and heights, so that walls and roofs line up over the whole city.
  bool square = false;
  /// Height of the boxes' bottoms.  0: they stand on the slab's top.  Below 0, but above
  /// -5: they are sunk into the slab.  Above 0: they float.  All else is the same.
  double bottom = 0;
};

/// Rows of boxes, one a lot of 10 x 10, on a slab 5 thick, with its top in the plane
/// z = 0, that is 10 larger than the lots all round.  Street city: offset in the lot 0 to
/// 2, sides 3 to 7, tops at 2 to 25, all continuous.  Square city: on the lot's corner,
/// sides 4, 6 or 7, tops at 3, 5, 8, 12 or 20.  Numbers and names of groups as in city().
[[nodiscard]] PolygonSoup street_city(std::uint64_t seed, int polygon_count,
                                      const StreetCityOptions& options = {});

/// A street or square city of seed 1 with one more polygon, "light": a square that shines
/// down, a tenth of the slab wide, over its middle, at twice the height of the highest
/// roof.
[[nodiscard]] PolygonSoup lit_city(int polygon_count, bool square);

/// A unit cube seen from within, each wall squares x squares squares, with `count`
/// disjoint boxes of sides 0.1 to 0.3, about half of them standing on a wall, with a
/// tenth of the squares along each side: 648, 2,592, 10,368 polygons for 10, 20, 40
/// squares, 8 boxes. Groups: room, box0, box1, ...
[[nodiscard]] PolygonSoup enclosure(std::uint64_t seed, int squares, int count);

/// `count` triangles scattered in the cube [-1, 1]^3, which intersect at will; about as
/// many are met by a line whatever the count.  No groups.
[[nodiscard]] PolygonSoup triangle_soup(std::uint64_t seed, int count);

/// The same with every polygon of more than three corners cut into triangles around its
/// first corner: right for convex polygons.
[[nodiscard]] PolygonSoup cut_into_triangles(const PolygonSoup& soup);

/// Writes an OBJ file, doubles with 17 digits, one `o` line per group.  Throws
/// std::runtime_error when the file cannot be written.
void write_obj(const std::string& path, const PolygonSoup& soup);

/// A point in the scene's box, or that far beyond it, in units of its size; on a grid of
/// 2^-8, so that steps of a 1024th of a way between two are exact.
[[nodiscard]] Point grid_point(Random& random, const Scene& scene, double beyond);

}  // namespace sightline::testing
