// The lines of an EEE arc as a surface to draw: a patch of a ruled quadric.

#pragma once

#include <array>
#include <vector>

#include "linespace/scene.h"
#include "skeleton/graph.h"

namespace sightline::viewers {

/// The lines through three edges, by the parameter s on the first: from P(s) on the first
/// edge through the middle edge to Q(s) on the last.  In doubles, for drawing.
///
/// P is linear in s and Q a Moebius function of it: Q = Q0 + t (Q1 - Q0) with
/// t = F0 / (F0 - F1), F_b(s) = orient3d(P(s), Q_b, M0, M1) linear in s.
class EeeSurface {
 public:
  EeeSurface(const Scene& scene, const EeeArc& arc);

  /// P(s) and Q(s), clamped to the last edge.
  [[nodiscard]] std::array<Point, 2> line(double s) const;

  /// Lines in order of s from range[0] to range[1], both included, such that the triangle
  /// strip P0 Q0 P1 Q1 ... over them is nowhere farther than `deviation` (scene units)
  /// from the surface they span, nor the surface from the strip, rounding aside.
  ///
  /// Why: let neighbouring lines be P0Q0 and P1Q1.  Between them a point of the surface
  /// is (1-u) ((1-a) P0 + a P1) + u ((1-b) Q0 + b Q1), as P and Q move on straight edges,
  /// and b is a Moebius function of a that fixes 0 and 1: b = a / (a + k (1-a)).  The
  /// weights of P0 and Q1 are (1-u)(1-a) and u b; with m the smaller one, moving the
  /// point by m (P1 - P0 + Q0 - Q1) makes it zero and puts the point on triangle P0 Q0 P1
  /// or P1 Q0 Q1.  For given a, m is largest where both weights are equal, 1 / (1/b +
  /// 1/(1-a)), and over a that is at most 1 / (2 (1 + sqrt k)), reached at a = 1 -
  /// 1 / (1 + sqrt k).  So the deviation is at most |(P1-P0) - (Q1-Q0)| / (2 (1 + sqrt
  /// k)), and halves with the step in s.
  [[nodiscard]] std::vector<std::array<Point, 2>> rungs(std::array<double, 2> range,
                                                        double deviation) const;

 private:
  [[nodiscard]] double last_parameter(double s) const;

  std::array<Point, 2> p_, q_;
  double f_[2][2];  // F_b(a) at the ends a of the first edge
};

/// The deviation that files and pictures keep to: this share of the scene's diagonal.
constexpr double kEeeDeviation = 1e-3;

/// The arc's lines from end to end, to kEeeDeviation of the scene's diagonal.
[[nodiscard]] std::vector<std::array<Point, 2>> rungs_of(const Scene& scene,
                                                         const EeeArc& arc);

/// The volume, in cubic scene units, of the tetrahedron between the arc's end lines: how
/// much there is to see of the surface's curvature, 0 where it is flat.
[[nodiscard]] double spanned_volume(const Scene& scene, const EeeArc& arc);

}  // namespace sightline::viewers
