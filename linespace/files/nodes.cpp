// Groups from the names of a scene file's nodes.

#include "linespace/files/nodes.h"

#include <algorithm>
#include <unordered_map>

namespace sightline::internal {

void NodeGroups::add(const std::string& name, int first, int last, bool is_root) {
  if (last > first && !name.empty()) nodes_.push_back({name, first, last, is_root});
}

std::vector<PolygonSoup::Group> NodeGroups::groups() {
  std::unordered_map<std::string, int> uses;
  std::size_t listed = 0, faces_in_all = 0;
  for (const Node& node : nodes_) {
    ++uses[node.name];
    listed += static_cast<std::size_t>(node.last - node.first);
    faces_in_all = std::max(faces_in_all, static_cast<std::size_t>(node.last));
  }
  if (lists_too_many(listed, faces_in_all)) {
    throw InvalidInput("named nodes are nested too deep");
  }
  const auto rank = [&](const Node& node) {
    return node.is_root ? 2 : uses[node.name] > 1 ? 1 : 0;
  };
  std::stable_sort(nodes_.begin(), nodes_.end(),
                   [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  std::vector<PolygonSoup::Group> groups;
  std::unordered_map<std::string, std::size_t> numbers;
  for (const Node& node : nodes_) {
    const auto [entry, is_new] = numbers.emplace(node.name, groups.size());
    if (is_new) groups.push_back({node.name, {}});
    auto& faces = groups[entry->second].faces;
    for (int f = node.first; f < node.last; ++f) faces.push_back(f);
  }
  for (auto& group : groups) {
    std::sort(group.faces.begin(), group.faces.end());
    group.faces.erase(std::unique(group.faces.begin(), group.faces.end()),
                      group.faces.end());
  }
  return groups;
}

}  // namespace sightline::internal
