#include "aspect/views/label_graph.h"

#include <algorithm>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include "aspect/views/sample_space.h"
#include "linespace/picture/classes.h"

namespace sightline::internal {

int LabelGraph::add(Viewpoint at, ViewLabels labels) {
  nodes_.push_back({std::move(at), std::move(labels)});
  return size() - 1;
}

void LabelGraph::add_wall(int a, int b, const std::vector<PathEvent>& events) {
  if (samples_ < 0) samples_ = size();
  walls_[{std::min(a, b), std::max(a, b)}].insert(events.begin(), events.end());
}

std::vector<std::array<int, 2>> LabelGraph::neighbours(Projection projection) const {
  std::vector<Point> at;
  for (const Node& node : nodes_) {
    const Point& p = node.at.at.nearest;
    at.push_back(projection == Projection::Orthographic ? Point(p.normalized()) : p);
  }
  return neighbours_of(at, projection);
}

void LabelGraph::join(std::vector<std::array<int, 2>> neighbours) {
  neighbours_ = std::move(neighbours);
  Classes classes(nodes_.size());
  const auto same = [&](int a, int b) {
    return nodes_[a].labels.label == nodes_[b].labels.label;
  };
  for (const auto& [a, b] : neighbours_) {
    if (same(a, b)) classes.join(a, b);
  }
  for (const auto& [pair, events] : walls_) {
    if (same(pair[0], pair[1])) classes.join(pair[0], pair[1]);
  }
  number_.assign(nodes_.size(), -1);
  members_.clear();
  std::map<int, int> numbers;
  for (int i = 0; i < size(); ++i) {
    const auto [it, is_new] =
        numbers.emplace(classes.root(i), static_cast<int>(numbers.size()));
    number_[i] = it->second;
    if (is_new) members_.emplace_back();
    members_[it->second].push_back(i);
  }
}

std::vector<std::array<int, 2>> LabelGraph::nearest_of_one_label() const {
  std::map<std::string, std::vector<int>> by_label;  // aspects
  for (std::size_t a = 0; a < members_.size(); ++a)
    by_label[nodes_[members_[a].front()].labels.label].push_back(static_cast<int>(a));
  const auto at = [&](int node) {
    const Point& p = nodes_[node].at.at.nearest;
    const bool far = nodes_[node].at.kind == Viewpoint::Kind::Direction;
    return far ? Point(p.normalized()) : p;
  };
  std::vector<std::array<int, 2>> out;
  for (const auto& [label, aspects] : by_label) {
    for (std::size_t i = 0; i < aspects.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        std::array<int, 2> best{-1, -1};
        double nearest = std::numeric_limits<double>::infinity();
        for (const int a : members_[aspects[i]]) {
          for (const int b : members_[aspects[j]]) {
            const double d = (at(a) - at(b)).norm();
            if (d < nearest) {
              nearest = d;
              best = {a, b};
            }
          }
        }
        out.push_back(best);
      }
    }
  }
  return out;
}

std::vector<int> LabelGraph::labels_met() const {
  std::unordered_map<std::string, int> met;
  for (const Node& node : nodes_) ++met[node.labels.label];
  std::vector<int> out;
  for (const auto& [label, times] : met) out.push_back(times);
  return out;
}

std::set<std::string> LabelGraph::labels() const {
  std::set<std::string> out;
  for (const Node& node : nodes_) out.insert(node.labels.label);
  return out;
}

AspectGraph LabelGraph::answer() const {
  AspectGraph out;
  out.aspects = members_.size();
  std::unordered_set<std::string> labels, faces, shapes;
  for (const Node& node : nodes_) {
    labels.insert(node.labels.label);
    faces.insert(node.labels.faces);
    shapes.insert(node.labels.shape);
  }
  out.distinct = labels.size();
  out.by_visible_faces = faces.size();
  out.by_shape = shapes.size();
  // Walls between aspects: what was told, else what is beside each other.
  std::map<std::array<int, 2>, std::set<PathEvent>> walls;
  const auto between = [&](const std::array<int, 2>& pair) {
    const int a = number_[pair[0]], b = number_[pair[1]];
    return std::array{std::min(a, b), std::max(a, b)};
  };
  for (const auto& [pair, events] : walls_) {
    const auto key = between(pair);
    if (key[0] != key[1]) walls[key].insert(events.begin(), events.end());
  }
  if (walls_.empty()) {
    for (const auto& pair : neighbours_) {
      const auto key = between(pair);
      if (key[0] != key[1]) walls[key];
    }
  }
  out.adjacencies = walls.size();
  if (request_->list) list(out, walls);
  return out;
}

// The node of each aspect with the most steps to nodes of other aspects.
std::vector<int> LabelGraph::deepest() const {
  std::vector<std::vector<int>> beside(nodes_.size());
  for (const auto& [a, b] : neighbours_) {
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  std::vector<int> depth(nodes_.size(), -1), front;
  for (int i = 0; i < size(); ++i) {
    const bool border =
        std::ranges::any_of(beside[i], [&](int j) { return number_[j] != number_[i]; });
    if (!border) continue;
    depth[i] = 0;
    front.push_back(i);
  }
  for (std::size_t k = 0; k < front.size(); ++k) {
    for (const int j : beside[front[k]]) {
      if (depth[j] >= 0) continue;
      depth[j] = depth[front[k]] + 1;
      front.push_back(j);
    }
  }
  std::vector<int> out;
  for (const auto& members : members_) {
    out.push_back(
        *std::ranges::max_element(members, {}, [&](int i) { return depth[i]; }));
  }
  return out;
}

void LabelGraph::list(
    AspectGraph& out,
    const std::map<std::array<int, 2>, std::set<PathEvent>>& walls) const {
  for (const int i : deepest()) {
    Aspect& aspect = out.list.emplace_back();
    aspect.at = nodes_[i].at;
    aspect.facets = nodes_[i].labels.facets;
    aspect.structure = nodes_[i].labels.structure;
  }
  for (std::size_t a = 0; a < members_.size(); ++a) {
    const int samples = samples_ < 0 ? size() : samples_;
    const auto own =
        std::ranges::count_if(members_[a], [&](int i) { return i < samples; });
    out.list[a].weight = weight_ * static_cast<double>(own) / samples;
  }
  for (const auto& [pair, events] : walls) {
    const std::vector<PathEvent> told(events.begin(), events.end());
    out.list[pair[0]].neighbours.push_back({pair[1], told});
    out.list[pair[1]].neighbours.push_back({pair[0], told});
  }
  for (Aspect& aspect : out.list)
    std::ranges::sort(aspect.neighbours, {}, &AspectNeighbour::aspect);
}

}  // namespace sightline::internal
