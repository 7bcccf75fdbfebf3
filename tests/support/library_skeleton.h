// The library's skeleton told in coordinates, to compare with another.

#pragma once

#include <algorithm>
#include <functional>
#include <utility>

#include "linespace/scene.h"
#include "skeleton/graph.h"
#include "tests/support/canonical_skeleton.h"

namespace sightline::testing {

inline std::string node_name(NodeKind kind) {
  switch (kind) {
    case NodeKind::VV:
      return "VV";
    case NodeKind::VEE:
      return "VEE";
    case NodeKind::EVE:
      return "EVE";
    case NodeKind::FvE:
      return "FvE";
    case NodeKind::EEEE:
      return "EEEE";
    case NodeKind::FEE:
      return "FEE";
    case NodeKind::FF:
      return "FF";
    case NodeKind::Saddle:
      return "Saddle";
    case NodeKind::Pierce:
      return "Pierce";
    case NodeKind::Degenerate:
      return "Degenerate";
  }
  return "?";
}

using PointMap = std::function<Point(const Point&)>;

/// The names in coordinates of what a scene's skeleton is made of.  All coordinates go
/// through `map` first, so that the skeleton of a moved scene can be moved back.
class CanonicalKeys {
 public:
  explicit CanonicalKeys(const Scene& scene, PointMap map = {})
      : scene_(scene), map_(std::move(map)), outlines_(scene.facets().size()) {
    for (const Edge& e : scene.edges()) {
      for (const Edge::Side& side : e.sides) {
        for (const int p : e.points) {
          outlines_[scene.faces()[side.face].facet].push_back(coordinates(p));
        }
      }
    }
  }

  [[nodiscard]] Coordinates coordinates(int point) const {
    const Point p = map_ ? map_(scene_.point(point)) : scene_.point(point);
    return Coordinates{p[0] + 0.0, p[1] + 0.0, p[2] + 0.0};  // no -0
  }

  [[nodiscard]] GeneratorKey of(const Generator& g) const {
    GeneratorKey key{'V', {}};
    switch (g.kind) {
      case GeneratorKind::Vertex:
        key.points = {coordinates(g.id)};
        break;
      case GeneratorKind::Edge:
        key.kind = 'E';
        for (const int p : scene_.edges()[g.id].points)
          key.points.push_back(coordinates(p));
        break;
      case GeneratorKind::Face:
        key.kind = 'F';
        key.points = outlines_[g.id];
        break;
    }
    std::ranges::sort(key.points);
    const auto repeated = std::ranges::unique(key.points);
    key.points.erase(repeated.begin(), repeated.end());
    return key;
  }

  /// Generators in order along the line, end contacts in small letters.
  [[nodiscard]] std::vector<GeneratorKey> along(const SkeletonArc& arc) const {
    std::vector<GeneratorKey> result;
    if (arc.is_ev()) {
      result = {of({GeneratorKind::Vertex, arc.vertex()}),
                of({GeneratorKind::Edge, arc.edge()})};
    } else {
      for (const int e : arc.edges()) result.push_back(of({GeneratorKind::Edge, e}));
    }
    mark(result, arc.ends);
    return result;
  }

  [[nodiscard]] NodeKey of(const Skeleton& skeleton, const SkeletonNode& node) const {
    std::vector<GeneratorKey> along_line;
    for (const Generator& g : skeleton.generators(node)) along_line.push_back(of(g));
    // Within a contact of a degenerate line generators are in no order of their own.
    if (node.kind != NodeKind::Degenerate) mark(along_line, node.ends);
    return node_key(
        node_name(node.kind) + (node.self ? "_self" : "") + (node.end ? "_end" : ""),
        std::move(along_line));
  }

 private:
  static void mark(std::vector<GeneratorKey>& along, const std::array<bool, 2>& end) {
    const auto lower = [](char& kind) {
      kind = kind == 'V' ? 'v' : kind == 'E' ? 'e' : 'f';
    };
    if (end[0]) lower(along.front().kind);
    if (end[1]) lower(along.back().kind);
  }

  const Scene& scene_;
  PointMap map_;
  /// Of every facet the ends of its edges: whatever the facet is cut into.
  std::vector<std::vector<Coordinates>> outlines_;
};

/// The whole skeleton so.
inline CanonicalSkeleton canonical(const Scene& scene, const Skeleton& skeleton,
                                   const PointMap& map = {}) {
  const CanonicalKeys keys(scene, map);
  std::vector<NodeKey> by_id;
  for (const SkeletonNode& node : skeleton.nodes) {
    by_id.push_back(keys.of(skeleton, node));
  }
  CanonicalSkeleton result;
  for (const SkeletonArc& arc : skeleton.ev()) {
    ArcKey key = arc_key("EV", keys.along(arc), arc.self,
                         {by_id[arc.nodes[0]], by_id[arc.nodes[1]]});
    const auto& ends = scene.edges()[arc.edge()].points;
    if (keys.coordinates(ends[1]) < keys.coordinates(ends[0]))
      std::swap(key.nodes[0], key.nodes[1]);
    result.arcs.push_back(std::move(key));
  }
  for (const SkeletonArc& arc : skeleton.eee()) {
    result.arcs.push_back(arc_key("EEE", keys.along(arc), arc.self,
                                  {by_id[arc.nodes[0]], by_id[arc.nodes[1]]}));
  }
  result.nodes = std::move(by_id);
  result.sort();
  return result;
}

}  // namespace sightline::testing
