// The FF nodes: lines in the planes of two facets, across the inside of both.

#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "linespace/numbers/rational.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/work/deadline.h"
#include "skeleton/build/part.h"
#include "skeleton/graph.h"
#include "skeleton/nodes/node_contacts.h"
#include "skeleton/nodes/node_joiner.h"
#include "skeleton/request.h"

namespace sightline::internal {

/// A free line of two facets, from the first of the sides it crosses to the last.
struct FoundFacePair {
  NodeContacts contacts;  ///< kind FF, or Degenerate where it touches something more
  std::array<Point, 2> segment;
};

/// Visits pairs of facets; keeps scratch, so one per thread.
///
/// Two facets that are exactly planar, in planes that are not parallel, have one common
/// line.  It crosses the inside of each in intervals, one for a convex facet, whose ends
/// are rational: an end on side pq of F is p + s (q - p), s = G(p) / (G(p) - G(q)), a
/// ratio of values of degree 3.  Of all intervals of both, in order along the line, those
/// are of one node that the free segment goes through; what is free the contacts decide,
/// so that a line that enters a solid at a reflex side is none, and facets that touch or
/// cross need no case of their own.
class FacePairs {
 public:
  /// Keeps references; `facets` is a tree over the boxes of all facets.
  FacePairs(const Silhouettes& silhouettes, const Bvh& facets, const FacetPart& part);

  /// Appends the nodes of facet f with all facets of higher number.
  void visit(int f, std::vector<FoundFacePair>& out);

 private:
  struct Interval {
    ExactPoint from, to;
    bool of_first;
  };

  [[nodiscard]] bool crosses(int facet, const PlaneSide& plane) const;
  void visit_pair(int f, int g, std::vector<FoundFacePair>& out);
  void add_intervals(int facet, int across, bool of_first);
  void merge_intervals(int axis);
  [[nodiscard]] bool surely_blocked(const ExactPoint& a, const ExactPoint& b);
  void add_node(int f, int g, std::size_t first, std::size_t last,
                std::vector<FoundFacePair>& out);

  const Silhouettes& g_;
  const Scene& scene_;
  const Bvh& facets_;
  const FacetPart& part_;
  std::vector<Interval> intervals_;
  std::vector<std::uint32_t> facet_stamp_;  // of the pair at hand: 1
};

/// Adds the FF nodes to a skeleton, and to its degenerate nodes those that are new.
void add_face_pairs(const Silhouettes& silhouettes, const SkeletonRequest& request,
                    const Deadline& deadline, Skeleton& skeleton, NodeJoiner& nodes);

}  // namespace sightline::internal
