// Viewpoints at which view space is sampled, and which of them are neighbours.

#pragma once

#include <array>
#include <vector>

#include "aspect/aspect_graph.h"

namespace sightline::internal {

struct Samples {
  std::vector<Point> at;  ///< directions of length about 1, or points
  std::vector<std::array<int, 2>> neighbours;
  double weight = 0;  ///< of all together: 4 pi, or the volume of the box
};

/// The bounds of a perspective graph; without any the scene's box made three times as
/// large about its middle.
[[nodiscard]] std::array<Point, 2> view_box(const Scene& scene,
                                            const AspectRequest& request);

/// At least request.samples.  Regular: a geodesic sphere, turned so that its directions
/// lie in no plane of an aligned scene; a grid of cells' middles.  Random: with the
/// neighbours of a Delaunay triangulation.
[[nodiscard]] Samples samples_of(const Scene& scene, const AspectRequest& request);

/// Further independent random viewpoints.
[[nodiscard]] std::vector<Point> random_samples(const Scene& scene,
                                                const AspectRequest& request, int count,
                                                std::uint64_t seed);

}  // namespace sightline::internal
