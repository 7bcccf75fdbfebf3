// Form factors of a scene beside those of a second way: the area of free lines of each
// direction, integrated over directions (tests/support/naive_free_lines.h).

#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "shadows/form_factors.h"
#include "tests/support/form_factor_scenes.h"
#include "tests/support/naive_free_lines.h"

namespace sightline::testing {

/// The polygon of a face as the file lists it, or as seen from behind.
inline std::vector<Point> listed_face(const PolygonSoup& soup, int face, bool back) {
  std::vector<Point> corners;
  for (const int v : soup.polygons[face]) corners.push_back(soup.vertices[v]);
  if (back) std::ranges::reverse(corners);
  return corners;
}

inline std::vector<FreeBlocker> free_blockers(const Scene& scene,
                                              const PolygonSoup& soup) {
  std::vector<FreeBlocker> faces;
  for (int f = 0; f < static_cast<int>(soup.polygons.size()); ++f) {
    faces.push_back({listed_face(soup, f, false), scene.solid_behind(f)});
  }
  return faces;
}

/// The two ways of one pair of surfaces of one face each, by the smaller surface.
struct TwoWays {
  double library, free_lines;
};
inline TwoWays two_ways(const FormFactors& f,
                        const std::vector<FormFactorSurface>& surfaces,
                        const PolygonSoup& soup, const std::vector<FreeBlocker>& faces,
                        int i, int j, double tolerance) {
  const std::vector<Point> from =
      listed_face(soup, surfaces[i].faces[0], surfaces[i].back);
  const std::vector<Point> to = listed_face(soup, surfaces[j].faces[0], surfaces[j].back);
  const double area = std::min(f.areas[i], f.areas[j]);
  const FreeLines lines =
      free_lines(from, to, faces_between(from, to, faces), tolerance * area);
  return {f.at(i, j) * f.areas[i] / area, lines.exchange / area};
}

/// Up to so many pairs of the scene that see something of each other; and rows, which add
/// up to 1 but where fronts coincide.
inline void expect_two_ways_agree(const FormFactorScene& s, int most_pairs,
                                  double within) {
  SCOPED_TRACE(s.name);
  const Scene scene(s.soup);
  const std::vector<FormFactorSurface> surfaces = surfaces_of(
      scene, {.groups = s.surfaces, .both_sides = s.both_sides, .each_face = true});
  FormFactorRequest request;
  request.accuracy = 1e-11;
  request.threads = 1;
  const FormFactors f = form_factors(scene, surfaces, request);
  const std::vector<FreeBlocker> faces = free_blockers(scene, s.soup);
  int pairs = 0;
  const int n = static_cast<int>(surfaces.size());
  for (int i = 0; i < n; ++i) {
    const FormFactorRow& row = f.rows[i];
    const double sum = f.row_sum(i) + row.others + row.outside + row.backs;
    if (f.coincident_area == 0) {
      EXPECT_NEAR(sum, 1, 1e-10) << surfaces[i].name;
    }
    for (int j = i + 1; j < n && pairs < most_pairs; ++j) {
      // An azimuth costs most: nothing that is wrong by less than this is looked for.
      const TwoWays both = two_ways(f, surfaces, s.soup, faces, i, j, 0.05 * within);
      if (both.library == 0 && both.free_lines == 0) continue;
      ++pairs;
      EXPECT_NEAR(both.library, both.free_lines, within)
          << surfaces[i].name << " to " << surfaces[j].name;
    }
  }
}

}  // namespace sightline::testing
