// Areas of umbra, penumbra and lit region of a face, without a mesh.
//
// Along a scan line the naive class can change only where the line meets the plane of a
// face, the plane of a corner and an edge, or the quadric of the lines through three
// edges.  Between two such places it is asked once; the lengths are integrated across by
// Gauss's rule, in panels that are halved until two orders agree.  The lit region is a
// polygon, and so is what faces away from all light: their areas are rational.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tests/support/naive_shadow.h"

namespace sightline::testing {

struct NaiveShadowAreas {
  double umbra = 0, penumbra = 0, lit = 0;
  int scan_lines = 0, asked = 0;
};

/// Of a convex face's front.  panel_ends: where integration begins anew, in the second of
/// the face's two coordinates (those that follow, in the order x y z x y, the one in
/// which its normal is largest); they change the cost, not the limit.  `off`: a share of
/// the face, of the error of one panel.
[[nodiscard]] NaiveShadowAreas naive_shadow_areas(std::span<const NaiveShadowFace> faces,
                                                  const NaiveShadow& naive, int face,
                                                  std::vector<double> panel_ends,
                                                  double off);

/// In the two coordinates, times the face's area over that of its shadow on them.
struct NaiveRationalArea {
  Rational plane;  ///< in the two coordinates
  double factor;   ///< to space
};
/// nullopt where the source is neither above nor below some blocker: then the polygons
/// are not bounded by projections of corners.
[[nodiscard]] std::optional<NaiveRationalArea> naive_lit_area(
    std::span<const NaiveShadowFace> faces, int face);
[[nodiscard]] NaiveRationalArea naive_away_area(std::span<const NaiveShadowFace> faces,
                                                int face);

}  // namespace sightline::testing
