// Instances of polygon-to-polygon visibility that are hard to get right, most with their
// answer known by construction, and random ones.  The same for the same arguments on
// every machine.

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/naive_polygon_visibility.h"

namespace sightline::testing {

struct VisibilityCase {
  std::string name;
  VisibilityInstance instance;
  /// The answer, where it is known by construction.
  std::optional<bool> visible;
};

/// Two equilateral triangles of circumradius 1/2, parallel, alike and opposite each
/// other, at z = 0 and z = 1, and n equilateral triangles between: centres uniform in the
/// prism between the two, orientations uniform, edge lengths uniform in [s/2, 3s/2], so
/// that s is the mean edge length; the circumradius is the edge length / sqrt(3).  They
/// may cut the planes of a and b, stick out of the prism and cross each other.
[[nodiscard]] VisibilityInstance slab_instance(std::uint64_t seed, int n, double s);

/// Triangles, axis-aligned rectangles and planar quads with corners on the integer grid
/// [0, side]^3, a at the bottom and b at the top of it or anywhere: almost everything is
/// aligned, touches, or lies in one plane.
[[nodiscard]] VisibilityInstance grid_instance(std::uint64_t seed, int n, int side);

/// Walls of tiles with slits, T-junctions and corners that meet; half-walls; crossing and
/// folded screens; occluders in the plane of a; lines along planes of occluders;
/// pinwheels; lenses.  Openings are of the width given, at least 2^-40 and a power of
/// two; 2^-30 is about 1e-9 of the scene.
[[nodiscard]] std::vector<VisibilityCase> known_visibility_cases(double width = 0x1p-30);

/// Between two polygons, four large triangles that leave free only the lines that pass
/// their four edges e1..e4 on given sides.  The edges are three rulings z = s, y = s x of
/// the quadric y = x z and a line that touches it on the z axis, moved by epsilon.
///
/// Epsilon > 0: the four edges have two transversals, x = +-sqrt(4 epsilon), y = x z, and
/// the free lines are a lens between these two, which are its only extremal lines:
/// visible. Epsilon = 0: the transversals coincide, the lens is empty: hidden.  Epsilon <
/// 0: hidden. Requires a power of two, its negative, or 0, between 2^-40 and 2^-10 in
/// magnitude.
[[nodiscard]] VisibilityInstance lens_instance(double epsilon);

/// Curved surfaces of triangles with corners rounded to multiples of 2^-20.
///
/// 2 k^2 triangles over the square of that half width around (0, 0, 1/2), bulging up by
/// `height` in the middle.
[[nodiscard]] std::vector<std::vector<Point>> bulge(int k, double half_width,
                                                    double height);
/// A closed ball in `rings` rings, 4 rings (rings - 1) triangles.
[[nodiscard]] std::vector<std::vector<Point>> ball(const Point& centre, double radius,
                                                   int rings);

/// The same question asked otherwise: axes permuted, reflected and sheared by an integer
/// map, polygons' corners rotated and reversed, occluders shuffled, a and b exchanged.
/// Exact, and so with the same answer, when coordinates have at most 46 bits.
[[nodiscard]] VisibilityInstance transformed(const VisibilityInstance& instance,
                                             std::uint64_t seed);

/// Writes `sightline visible`'s input, doubles with 17 digits; each instance also has its
/// "name" and "expected" (true, false or null).  Throws std::runtime_error when the file
/// cannot be written.
void write_visibility_json(const std::string& path,
                           const std::vector<VisibilityCase>& cases);

}  // namespace sightline::testing
