#include <algorithm>

#include "tests/support/naive_view.h"

namespace sightline::testing {
namespace {

std::string text(const std::vector<int>& numbers) {
  std::string result;
  for (const int n : numbers) result += std::to_string(n) + ",";
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
                       std::to_string(v.corner) + " " + v.near.in_space + " " +
                       v.far.in_space);
  }
  // A touch is named by the edges that meet in it.
  std::vector<std::vector<std::string>> beside(view.regions.size()),
      meeting(vertices.size());
  for (const NaiveEdge& e : view.edges) {
    for (const int v : e.ends) meeting[v].push_back(e.line.in_space);
  }
  for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] += joined(meeting[v]);
  for (const NaiveEdge& e : view.edges) {
    // Not by its kind: of a line of several scene edges some may be of another object, or
    // have one face, and which of them are seen is no matter.
    std::string name = e.line.in_space;
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
