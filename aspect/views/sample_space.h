// Viewpoints at which view space is sampled, and which of them are neighbours.

#pragma once

#include <array>
#include <vector>

#include "aspect/aspect_graph.h"

namespace sightline::internal {

struct Samples {
  std::vector<Point> at;  ///< directions of length about 1, or points
  std::vector<std::array<int, 2>> neighbours;
};

/// The bounds of a perspective graph; without any the scene's box made three times as
/// large about its middle.
[[nodiscard]] std::array<Point, 2> view_box(const Scene& scene,
                                            const AspectRequest& request);

/// 4 pi, or the volume of that box.
[[nodiscard]] double view_weight(const Scene& scene, const AspectRequest& request);

/// At least request.samples.  Regular: a geodesic sphere, turned so that its directions
/// lie in no plane of an aligned scene; a grid of cells' middles.  Random: with the
/// neighbours of a Delaunay triangulation.
[[nodiscard]] Samples samples_of(const Scene& scene, const AspectRequest& request);

/// Pairs of a Delaunay triangulation of directions or points, ascending.
[[nodiscard]] std::vector<std::array<int, 2>> neighbours_of(const std::vector<Point>& at,
                                                            Projection projection);

/// Further independent random viewpoints.
[[nodiscard]] std::vector<Point> random_samples(const Scene& scene,
                                                const AspectRequest& request, int count,
                                                std::uint64_t seed);

}  // namespace sightline::internal
