// Viewpoints with their labels, and the aspects that neighbours of one label make.

#pragma once

#include <array>
#include <map>
#include <set>
#include <vector>

#include "aspect/aspect_graph.h"
#include "aspect/views/labels.h"

namespace sightline::internal {

class LabelGraph {
 public:
  struct Node {
    Viewpoint at;
    ViewLabels labels;
  };

  /// `weight`: of all of view space, of which each of the nodes up to the first wall has
  /// an equal share.
  LabelGraph(const AspectRequest& request, double weight)
      : request_(&request), weight_(weight) {}

  int add(Viewpoint at, ViewLabels labels);
  [[nodiscard]] int size() const { return static_cast<int>(nodes_.size()); }
  [[nodiscard]] const Node& node(int i) const { return nodes_[i]; }
  /// These events happen between two nodes.
  void add_wall(int a, int b, const std::vector<PathEvent>& events);

  /// Pairs of nodes that a Delaunay triangulation of all of them joins.
  [[nodiscard]] std::vector<std::array<int, 2>> neighbours(Projection projection) const;
  /// Neighbours of one label lie in one aspect; others, where no walls were told, count
  /// as beside each other.
  void join(std::vector<std::array<int, 2>> neighbours);
  [[nodiscard]] std::size_t aspects() const { return members_.size(); }
  /// For every two aspects with one label the two nodes of them that are nearest to each
  /// other.  After join().
  [[nodiscard]] std::vector<std::array<int, 2>> nearest_of_one_label() const;
  /// How often each label is met.
  [[nodiscard]] std::vector<int> labels_met() const;
  [[nodiscard]] std::set<std::string> labels() const;

  /// Counts, and the list where it is wanted.  After join().
  [[nodiscard]] AspectGraph answer() const;

 private:
  [[nodiscard]] std::vector<int> deepest() const;
  void list(AspectGraph& out,
            const std::map<std::array<int, 2>, std::set<PathEvent>>& walls) const;

  const AspectRequest* request_;
  double weight_;
  std::vector<Node> nodes_;
  int samples_ = -1;  // nodes before the first wall; -1: all
  std::map<std::array<int, 2>, std::set<PathEvent>> walls_;  // between nodes
  std::vector<std::array<int, 2>> neighbours_;
  std::vector<int> number_;                // of aspects, by node
  std::vector<std::vector<int>> members_;  // nodes, by aspect
};

}  // namespace sightline::internal
