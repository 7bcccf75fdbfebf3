// Groups from the names of a scene file's nodes.

#pragma once

#include <string>
#include <vector>

#include "linespace/scene.h"

namespace sightline::internal {

/// Whether groups that list so many faces take too much of the memory: more than 2^22,
/// and each of the file's faces more than 64 times.
[[nodiscard]] inline bool lists_too_many(std::size_t listed, std::size_t faces) {
  return listed > std::size_t{1} << 22 && listed / 64 > faces;
}

/// Gathers the nodes of a tree, children before their parents, and makes groups of them.
/// A node's group has the faces of all nodes below it.
class NodeGroups {
 public:
  /// A node of that name whose faces, and those of all nodes below it, are first to
  /// last - 1.  Nodes without name or faces are left out.
  void add(const std::string& name, int first, int last, bool is_root);

  /// The groups, in the order in which a face takes its object from them: a face's object
  /// is the first group that lists it.  Of the nodes above a face the nearest comes
  /// first, if no other node has its name.  Names that several nodes have
  /// ("IfcMappedItem") come after these; the root's comes with them.  Throws InvalidInput
  /// when nodes are nested so deep that lists_too_many() holds.
  [[nodiscard]] std::vector<PolygonSoup::Group> groups();

 private:
  struct Node {
    std::string name;
    int first, last;
    bool is_root;
  };
  std::vector<Node> nodes_;
};

}  // namespace sightline::internal
