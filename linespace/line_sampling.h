// Random lines, uniform in the sense of integral geometry, and random segments between
// polygons.
//
// The measure.  Lines of space have, up to a factor, one measure that rigid motions leave
// alone (Santalo 1976, chapter 12).  With its usual factor for oriented lines it is
//   dG = dA dw,
// dw the solid angle of the direction and dA the area across it, or equivalently
//   dG = |cos| dP dw          through a point P of a surface, cos to its normal,
//   dG = |cos cos'| / r^2 dP dQ      joining points P, Q of two surfaces at distance r.
// "Uniform" below means: with a density constant in dG.  Consequences (Cauchy, Crofton)
// that users rely on and tests check: the lines that meet a convex body of surface S have
// measure pi S; so of uniform lines meeting a convex body, the share that meets a convex
// body inside is the ratio of the surfaces; and the mean chord is 4 V / S.
//
// The numbers.  A sample is a function of (seed, number of the sample) alone: the same on
// any machine, in any order, on any number of threads.  Points are rounded to doubles.
// Neighbours: visibility_estimate.h asks how many such segments are free.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "linespace/scene.h"

namespace sightline {

/// The random numbers of one sample, as many as are asked for: Philox4x64-10 (Salmon et
/// al. 2011) with key (seed, 0) and counter (block, sample, 0, 0).
class SampleNumbers {
 public:
  SampleNumbers(std::uint64_t seed, std::uint64_t sample)
      : seed_(seed), sample_(sample) {}

  /// 64 independent fair bits.
  std::uint64_t bits() {
    if (used_ == 4) refill();
    return block_[used_++];
  }
  /// Uniform on the multiples of 2^-53 in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

 private:
  void refill();

  std::uint64_t seed_, sample_, next_block_ = 0;
  std::array<std::uint64_t, 4> block_{};
  int used_ = 4;
};

/// Philox4x64-10 itself, a bijection of the counter for each key.
[[nodiscard]] std::array<std::uint64_t, 4> philox(std::array<std::uint64_t, 4> counter,
                                                  std::array<std::uint64_t, 2> key);

/// The part of an oriented line inside the body it was drawn for.
struct Chord {
  Point from, to;
};

/// Uniform on the unit sphere; square roots only (Marsaglia 1972).
[[nodiscard]] Point random_direction(SampleNumbers& numbers);

/// A uniform line among those that meet the ball: through two independent uniform points
/// of the sphere.  (A chord of length r meets the sphere at cosine r / 2R at both ends,
/// so |cos cos'| / r^2 is constant.)
[[nodiscard]] Chord line_by_two_points(const Ball& ball, SampleNumbers& numbers);

/// A uniform line among those that meet the ball, by the other classical way: a uniform
/// direction, and a uniform point of the disk across it through the ball's centre.
[[nodiscard]] Chord line_by_direction(const Ball& ball, SampleNumbers& numbers);

/// Uniform points of a set of convex planar polygons, by area.  A point costs a binary
/// search among the triangles that fans cut the polygons into.
class PolygonSampler {
 public:
  /// Polygons by their corners in order.  Throws InvalidInput when their areas do not sum
  /// to a positive finite number.
  explicit PolygonSampler(std::span<const std::vector<Point>> polygons);
  /// Faces of a scene, each counted as often as listed.
  PolygonSampler(const Scene& scene, std::span<const int> faces);

  struct Sample {
    Point point;
    int polygon;   ///< position in what the constructor was given
    Point normal;  ///< unit length, to the front
  };
  /// Two numbers are used.  A triangle with a share s of the area has 2^53 s rows of
  /// points; one with less than 2^-53 may have none.  A coordinate nearer to 0 than
  /// predicates accept becomes 0.
  [[nodiscard]] Sample point(SampleNumbers& numbers) const;

  [[nodiscard]] double area() const { return ends_.back(); }  ///< scene units squared

 private:
  struct Triangle {
    Point a, to_b, to_c, normal;
    int polygon;
  };
  void add(int polygon, std::span<const Point> corners);
  void check_area() const;

  std::vector<Triangle> triangles_;
  std::vector<double> ends_;  // running sums of their areas
};

/// Uniform lines among those that meet a convex body: the point of entry is uniform on
/// its boundary, the direction has a density proportional to the cosine (every line
/// enters once).  No line is rejected.
class ConvexBodyLines {
 public:
  /// The body's faces, counter-clockwise seen from outside; that they bound a convex body
  /// is not checked.  Throws InvalidInput as PolygonSampler does.
  explicit ConvexBodyLines(std::vector<std::vector<Point>> faces);
  /// The box [low, high].
  ConvexBodyLines(const Point& low, const Point& high);

  /// Cost: proportional to the number of faces.
  [[nodiscard]] Chord line(SampleNumbers& numbers) const;

  [[nodiscard]] double surface() const { return boundary_.area(); }

 private:
  PolygonSampler boundary_;
  std::vector<Point> corners_, normals_;  // a corner and the outward normal of each face
};

/// A segment from a uniform point of A to a uniform point of B.
struct PairSegment {
  PolygonSampler::Sample a, b;
  /// |cos cos'| / r^2 times both areas.  Its mean over samples is the measure dG of the
  /// oriented lines that meet A and then B, each counted once per pair of points: pi
  /// times A's area times the form factor, for convex polygons facing each other.  0 when
  /// the two points coincide.  Unbounded where A and B touch.
  double measure;
};
[[nodiscard]] PairSegment segment_between(const PolygonSampler& a,
                                          const PolygonSampler& b,
                                          SampleNumbers& numbers);

/// A uniform line among the oriented ones that meet A and then convex polygon B, by
/// rejection: lines through A are drawn until one meets B; nullopt after `most_tries`.
/// A try succeeds with the probability of the form factor from A, both sides of it, to B.
/// A line that meets several polygons of A counts once for each.
[[nodiscard]] std::optional<Chord> line_through(const PolygonSampler& a,
                                                std::span<const Point> b,
                                                SampleNumbers& numbers,
                                                int most_tries = 1 << 16);

}  // namespace sightline
