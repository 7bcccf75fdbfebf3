// The state of a PortalSequence, shared by the search, the witness and the swaths.

#pragma once

#include <map>
#include <set>
#include <vector>

#include "linespace/portals/portal.h"
#include "linespace/request.h"
#include "linespace/work/deadline.h"

namespace sightline::internal {

/// A contact of a line: what it touches in one place.
struct PortalContact {
  Place at;
  std::vector<PortalGenerator> generators;
  bool fixed = false;
  int point = -1;  // of a fixed one, the sequence's number
};

/// An extremal line with what holds it.  Edges and points are the sequence's numbers.
struct HeldLine {
  ExactLine line;
  std::vector<Meeting> meetings = {};        // one a portal
  std::vector<PortalContact> contacts = {};  // along the line's own orientation
  bool forward = true;                       // stabs in its own orientation
  bool backward = true;                      // stabs turned round
  // What families of stabbing lines next to it may be held by.
  std::vector<int> edges = {};   // touched edges, and those at touched corners
  std::vector<int> points = {};  // of fixed contacts
  std::vector<int> planes = {};  // portals in whose planes it lies
};

struct Precedes {
  bool operator()(const HomogeneousPoint& p, const HomogeneousPoint& q) const {
    return precedes(p, q);
  }
};

using ContactKey = std::vector<PortalGenerator>;
[[nodiscard]] ContactKey contact_key(const HeldLine& held);
[[nodiscard]] StabbingKind kind_of(const HeldLine& held);

struct PortalState;
/// Adds how a line that meets the portal does so; false when it then no longer stabs.
bool add_meeting(const PortalState& state, HeldLine& held, int portal);

struct PortalState {
  std::vector<Portal> portals;
  std::vector<LineThrough> edges;  // of all portals
  std::vector<int> edge_portals;   // whose they are
  std::vector<int> carriers;       // the first edge that lies on the same line
  std::vector<int> first_edges;    // of each portal, a number in `edges`
  std::vector<HomogeneousPoint> points;
  std::map<HomogeneousPoint, int, Precedes> point_ids;
  std::set<std::pair<int, int>> without_order;  // portals whose interiors cross
  std::vector<HeldLine> held;
  bool only_a_point = true;  // all portals so far are one point
  PortalStatistics statistics;
  std::vector<ExtremalStabbingLine> lines;  // of `held`, in the same order

  /// The number of a point, a new one if it was not there.
  int point_id(HomogeneousPoint p);
  /// The edges that a generator's corner or edge belongs to, one or two.
  [[nodiscard]] std::vector<int> edges_at(const PortalGenerator& generator) const;
};

}  // namespace sightline::internal
