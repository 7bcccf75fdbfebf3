#include <algorithm>

#include "tests/support/naive_view.h"

namespace sightline::testing {
namespace {

std::string text(const std::vector<int>& numbers) {
  std::string result;
  for (const int n : numbers) result += std::to_string(n) + ",";
  return result;
}
std::string text(const NaiveLine& line) {
  std::string result("e");
  result += text(line.edges);
  for (const auto& [f, g] : line.crossings)
    result += std::string("x") + text(std::vector{f, g});
  return result;
}
std::string joined(std::vector<std::string> parts) {
  std::ranges::sort(parts);
  std::string result;
  for (const std::string& p : parts) result += p + "\n";
  return result;
}

}  // namespace

std::string structure_of(const NaiveView& view) {
  std::vector<std::string> vertices, all;
  for (const NaiveVertex& v : view.vertices) {
    vertices.push_back(std::string("v") + std::to_string(static_cast<int>(v.kind)) + " " +
                       std::to_string(v.corner) + text(v.near) + text(v.far));
  }
  // A touch is named by the edges that meet in it.
  std::vector<std::vector<std::string>> beside(view.regions.size()),
      meeting(vertices.size());
  for (const NaiveEdge& e : view.edges) {
    for (const int v : e.ends) meeting[v].push_back(text(e.line));
  }
  for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] += joined(meeting[v]);
  for (const NaiveEdge& e : view.edges) {
    std::string name = text(e.line) + " kinds";
    for (const MapEdgeKind k : e.kinds) name += std::to_string(static_cast<int>(k));
    // Which end is the first one is chance.
    std::string one = vertices[e.ends[0]] + " to " + vertices[e.ends[1]] + " left " +
                      text(view.regions[e.left].facets) + " right " +
                      text(view.regions[e.right].facets);
    std::string other = vertices[e.ends[1]] + " to " + vertices[e.ends[0]] + " left " +
                        text(view.regions[e.right].facets) + " right " +
                        text(view.regions[e.left].facets);
    name += std::min(one, other);
    beside[e.left].push_back(name);
    beside[e.right].push_back(name);
    all.push_back(std::string("edge ") + name);
  }
  for (std::size_t r = 0; r < beside.size(); ++r) {
    all.push_back(std::string("region ") + text(view.regions[r].facets) +
                  joined(beside[r]));
  }
  return joined(all);
}

}  // namespace sightline::testing
