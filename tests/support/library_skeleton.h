// The library's skeleton told in coordinates, to compare with another.

#pragma once

#include <algorithm>
#include <functional>

#include "linespace/scene.h"
#include "skeleton/skeleton.h"
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

/// All coordinates go through `map` first, so that the skeleton of a moved scene can be
/// moved back.
inline CanonicalSkeleton canonical(const Scene& scene, const Skeleton& skeleton,
                                   const PointMap& map = {}) {
  const auto coordinates = [&](int point) {
    const Point p = map ? map(scene.point(point)) : scene.point(point);
    return Coordinates{p[0] + 0.0, p[1] + 0.0, p[2] + 0.0};  // no -0
  };
  const auto generator_key = [&](const Generator& g) {
    GeneratorKey key{'V', {}};
    switch (g.kind) {
      case GeneratorKind::Vertex:
        key.points = {coordinates(g.id)};
        break;
      case GeneratorKind::Edge:
        key.kind = 'E';
        for (const int p : scene.edges()[g.id].points)
          key.points.push_back(coordinates(p));
        break;
      case GeneratorKind::Face:
        key.kind = 'F';
        for (const int f : scene.facets()[g.id].faces) {
          for (const int p : scene.face_points(f)) key.points.push_back(coordinates(p));
        }
        break;
    }
    std::ranges::sort(key.points);
    const auto repeated = std::ranges::unique(key.points);
    key.points.erase(repeated.begin(), repeated.end());
    return key;
  };

  const auto mark = [](std::vector<GeneratorKey>& along, const std::array<bool, 2>& end) {
    const auto lower = [](char& kind) {
      kind = kind == 'V' ? 'v' : kind == 'E' ? 'e' : 'f';
    };
    if (end[0]) lower(along.front().kind);
    if (end[1]) lower(along.back().kind);
  };
  std::vector<NodeKey> by_id;
  for (const SkeletonNode& node : skeleton.nodes) {
    std::vector<GeneratorKey> along_line;
    for (const Generator& g : skeleton.generators(node)) {
      along_line.push_back(generator_key(g));
    }
    // Within a contact of a degenerate line generators are in no order of their own.
    if (node.kind != NodeKind::Degenerate) mark(along_line, node.ends);
    by_id.push_back(node_key(
        node_name(node.kind) + (node.self ? "_self" : "") + (node.end ? "_end" : ""),
        std::move(along_line)));
  }
  CanonicalSkeleton result;
  for (const SkeletonArc& arc : skeleton.arcs) {
    std::vector<GeneratorKey> generators = {
        generator_key({GeneratorKind::Vertex, arc.vertex}),
        generator_key({GeneratorKind::Edge, arc.edge})};
    mark(generators, arc.ends);
    ArcKey key = arc_key("EV", std::move(generators), arc.self,
                         {by_id[arc.nodes[0]], by_id[arc.nodes[1]]});
    const auto& ends = scene.edges()[arc.edge].points;
    if (coordinates(ends[1]) < coordinates(ends[0]))
      std::swap(key.nodes[0], key.nodes[1]);
    result.arcs.push_back(std::move(key));
  }
  for (const EeeArc& arc : skeleton.eee_arcs) {
    std::vector<GeneratorKey> along_line;
    for (const std::int32_t e : arc.edges) {
      along_line.push_back(generator_key({GeneratorKind::Edge, e}));
    }
    mark(along_line, arc.ends);
    result.arcs.push_back(arc_key("EEE", std::move(along_line), arc.self,
                                  {by_id[arc.nodes[0]], by_id[arc.nodes[1]]}));
  }
  result.nodes = std::move(by_id);
  result.sort();
  return result;
}

}  // namespace sightline::testing
