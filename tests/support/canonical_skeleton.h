// A visibility skeleton told in coordinates only, so that skeletons of reordered, moved
// or independently computed scenes can be compared for equality.

#pragma once

#include <array>
#include <compare>
#include <map>
#include <string>
#include <vector>

namespace sightline::testing {

using Coordinates = std::array<double, 3>;

/// A vertex by its point, an edge by its two ends, a facet by the ends of all
/// its edges; sorted.
struct GeneratorKey {
  char kind;  ///< 'V', 'E' or 'F'; 'v' or 'e' where it is an end contact
  std::vector<Coordinates> points;
  friend auto operator<=>(const GeneratorKey&, const GeneratorKey&) = default;
};

/// A node: its name with "_self" or "_end" where that applies, and its generators.  Of
/// VV, VEE, EVE, EEEE and FEE in order along the line, in the direction that comes first
/// lexicographically; of the others sorted.  The two lines through four edges may have
/// equal keys.
struct NodeKey {
  std::string kind;
  std::vector<GeneratorKey> generators;
  friend auto operator<=>(const NodeKey&, const NodeKey&) = default;
};

/// An arc: its generators in order along its lines, in the direction that comes first
/// lexicographically.  Of EV, nodes[0] is the one towards the edge's smaller end point;
/// of EEE, the smaller one.
struct ArcKey {
  std::string kind;  ///< "EV" or "EEE"
  std::vector<GeneratorKey> generators;
  bool self = false;
  std::array<NodeKey, 2> nodes;
  friend auto operator<=>(const ArcKey&, const ArcKey&) = default;
};

/// All nodes and arcs, sorted, repeated where several are alike.
struct CanonicalSkeleton {
  std::vector<NodeKey> nodes;
  std::vector<ArcKey> arcs;
  friend bool operator==(const CanonicalSkeleton&, const CanonicalSkeleton&) = default;

  void sort();
  /// Number of nodes and of arcs of each kind, of arcs with "_self" and "_end" where that
  /// applies.
  [[nodiscard]] std::map<std::string, int> counts() const;
};

/// Puts the generators of a node in the order that NodeKey asks for.
[[nodiscard]] NodeKey node_key(std::string kind, std::vector<GeneratorKey> along_line);

/// Puts generators and nodes of an arc in the order that ArcKey asks for.  Of EV, the
/// nodes are given from the edge's smaller end point to the other.
[[nodiscard]] ArcKey arc_key(std::string kind, std::vector<GeneratorKey> along_line,
                             bool self, std::array<NodeKey, 2> nodes);

/// What one has and the other has not, in words, at most `limit` items of each; empty
/// when they are equal.
[[nodiscard]] std::string difference(const CanonicalSkeleton& a,
                                     const std::string& a_name,
                                     const CanonicalSkeleton& b,
                                     const std::string& b_name, int limit = 4);

}  // namespace sightline::testing
