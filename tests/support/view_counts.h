// What tests that know a view by hand compare: its map in numbers, its edges by kind, the
// measures of its facets, its accidents.

#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>
#include <vector>

#include "linespace/visibility_map.h"

namespace sightline::testing {

struct MapCounts {
  int corners = 0, t_vertices = 0, touches = 0, accident_vertices = 0;
  int edges = 0, regions = 0, components = 0, background_pieces = 0, seams = 0;
  friend bool operator==(const MapCounts&, const MapCounts&) = default;
  friend std::ostream& operator<<(std::ostream& out, const MapCounts& c) {
    return out << c.corners << " corners, " << c.t_vertices << " T, " << c.touches
               << " touches, " << c.accident_vertices << " accidents; " << c.edges
               << " edges, " << c.regions << " regions, " << c.components
               << " components, " << c.background_pieces << " of background, " << c.seams
               << " seams";
  }
};

[[nodiscard]] inline MapCounts counts(const PointView& view) {
  const auto of = [&](MapVertexKind kind) {
    return static_cast<int>(std::ranges::count(view.vertices, kind, &MapVertex::kind));
  };
  return {of(MapVertexKind::Corner),
          of(MapVertexKind::T),
          of(MapVertexKind::Touch),
          of(MapVertexKind::Accident),
          static_cast<int>(view.edges.size()),
          static_cast<int>(view.regions.size()),
          view.components,
          view.background_pieces,
          view.seams};
}

/// V - E + F - 1 - C: 0 for every eye that is not on the scene.
[[nodiscard]] inline int euler_excess(const PointView& view) {
  return static_cast<int>(view.vertices.size()) - static_cast<int>(view.edges.size()) +
         static_cast<int>(view.regions.size()) - 1 - view.components;
}

struct EdgeCounts {
  int silhouette = 0, crease = 0, valley = 0, boundary = 0, contact = 0, crossing = 0;
  friend bool operator==(const EdgeCounts&, const EdgeCounts&) = default;
  friend std::ostream& operator<<(std::ostream& out, const EdgeCounts& c) {
    return out << c.silhouette << " silhouettes, " << c.crease << " creases, " << c.valley
               << " valleys, " << c.boundary << " boundaries, " << c.contact
               << " contacts, " << c.crossing << " crossings";
  }
};

[[nodiscard]] inline EdgeCounts edge_counts(const PointView& view) {
  const auto of = [&](MapEdgeKind kind) {
    return static_cast<int>(std::ranges::count(view.edges, kind, &MapEdge::kind));
  };
  return {of(MapEdgeKind::Silhouette), of(MapEdgeKind::Crease),
          of(MapEdgeKind::Valley),     of(MapEdgeKind::Boundary),
          of(MapEdgeKind::Contact),    of(MapEdgeKind::Crossing)};
}

/// The facet of a polygon of the file, numbered from 0.
[[nodiscard]] inline int facet_of(const Scene& scene, int polygon) {
  for (const Face& face : scene.faces()) {
    if (face.source == polygon) return face.facet;
  }
  return -1;
}

/// What is seen of the facet of a polygon; nullptr if nothing is.
[[nodiscard]] inline const SeenFacet* seen(const Scene& scene, const PointView& view,
                                           int polygon) {
  const auto it =
      std::ranges::find(view.facets, facet_of(scene, polygon), &SeenFacet::facet);
  return it == view.facets.end() ? nullptr : &*it;
}

/// Its solid angle or area, 0 if it is not seen.
[[nodiscard]] inline double measure(const Scene& scene, const PointView& view,
                                    int polygon) {
  const SeenFacet* facet = seen(scene, view, polygon);
  return facet == nullptr ? 0 : facet->measure;
}

/// Of all regions; requires that none is infinite.
[[nodiscard]] inline double sum_of_regions(const PointView& view) {
  double sum = 0;
  for (const MapRegion& region : view.regions) sum += region.measure.value();
  return sum;
}

[[nodiscard]] inline int count(const PointView& view, AccidentKind kind) {
  return static_cast<int>(std::ranges::count(view.accidents, kind, &Accident::kind));
}

/// The accident is told, with exactly these generators.
[[nodiscard]] inline bool tells(const PointView& view, Accident accident) {
  std::ranges::sort(accident.generators);
  return std::ranges::find(view.accidents, accident) != view.accidents.end();
}

[[nodiscard]] inline Generator face_generator(int facet) {
  return {GeneratorKind::Face, facet};
}
/// The corner at these coordinates; id -1 if there is none.
[[nodiscard]] inline Generator corner_generator(const Scene& scene, const Point& at) {
  for (const int p : scene.corners()) {
    if (scene.point(p) == at) return {GeneratorKind::Vertex, p};
  }
  return {GeneratorKind::Vertex, -1};
}
/// The edge between these two corners, in either order; id -1 if there is none.
[[nodiscard]] inline Generator edge_generator(const Scene& scene, const Point& a,
                                              const Point& b) {
  for (std::size_t e = 0; e < scene.edges().size(); ++e) {
    const Point& p = scene.point(scene.edges()[e].points[0]);
    const Point& q = scene.point(scene.edges()[e].points[1]);
    if ((p == a && q == b) || (p == b && q == a))
      return {GeneratorKind::Edge, static_cast<int>(e)};
  }
  return {GeneratorKind::Edge, -1};
}

/// The solid angle of a rectangle a x b at distance h, seen from above one of its
/// corners.
[[nodiscard]] inline double rectangle_angle(double a, double b, double h) {
  return std::atan(a * b / (h * std::sqrt(a * a + b * b + h * h)));
}

}  // namespace sightline::testing
