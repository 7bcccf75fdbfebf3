#include "linespace/view/view_structure.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "linespace/checksum.h"

namespace sightline::internal {
namespace {

// A vertex by its kind and one or two elements of the scene.
using Label = std::array<int, 3>;

Label label_of(const ViewScene& scene, const ViewMap& map, std::size_t vertex) {
  const MapVertex& v = map.vertices[vertex];
  if (v.kind == MapVertexKind::Corner) return {0, v.corner, -1};
  const auto [x, y] = map.lines_of_vertex[vertex];
  return {v.kind == MapVertexKind::T ? 1 : 2, scene.whole_line(x), scene.whole_line(y)};
}

// An edge by its line and the labels of its ends, the smaller first.
struct EdgeLabel {
  int line;
  Label from, to;
  bool turned;  // from is its second end
  friend auto operator<=>(const EdgeLabel&, const EdgeLabel&) = default;
};

}  // namespace

std::string structure_of(const ViewScene& scene, const ViewMap& map) {
  // Edges in the order of their labels, which are all different.
  std::vector<EdgeLabel> labels;
  for (std::size_t e = 0; e < map.edges.size(); ++e) {
    const auto [a, b] = map.edges[e].ends;
    EdgeLabel label{scene.whole_line(map.line_of_edge[e]), label_of(scene, map, a),
                    label_of(scene, map, b), false};
    if (label.to < label.from) {
      std::swap(label.from, label.to);
      label.turned = true;
    }
    labels.push_back(label);
  }
  std::vector<int> order(labels.size()), rank(labels.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](int e) { return labels[e]; });
  for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<int>(i);

  Checksum hash;
  const auto add = [&](std::int64_t x) { hash.add(static_cast<std::uint64_t>(x)); };
  for (const int e : order) {
    const EdgeLabel& l = labels[e];
    add(l.line);
    // Not the kind: a straight edge of the map may show parts of one object and of
    // another, with one face and with more, so that its kind depends on how much of it is
    // seen.  All else that makes the kind follows from the line and the patches beside
    // it.
    for (const Label& end : {l.from, l.to}) {
      for (const int x : end) add(x);
    }
  }
  // Regions by their patches and their walks, each from its smallest half-edge.
  std::vector<std::vector<std::vector<int>>> regions;
  for (const MapRegion& r : map.regions) {
    std::vector<std::vector<int>> walks;
    for (const auto& boundary : r.boundary) {
      std::vector<int> walk;
      for (const int h : boundary) {
        walk.push_back(2 * rank[h / 2] + ((h % 2 == 1) != labels[h / 2].turned ? 1 : 0));
      }
      std::ranges::rotate(walk, std::ranges::min_element(walk));
      walks.push_back(std::move(walk));
    }
    std::ranges::sort(walks);
    walks.insert(walks.begin(), r.patches);
    regions.push_back(std::move(walks));
  }
  std::ranges::sort(regions);
  for (const auto& region : regions) {
    add(static_cast<std::int64_t>(region.size()));
    for (const auto& walk : region) {
      add(static_cast<std::int64_t>(walk.size()));
      for (const int x : walk) add(x);
    }
  }
  return hash.text();
}

}  // namespace sightline::internal
