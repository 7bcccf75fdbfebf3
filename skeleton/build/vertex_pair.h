// One vertex and one ridge, while an arc of theirs is looked for: vertex_pair.cpp finds
// what of the ridge is closed, vertex_view.cpp makes arcs of the rest.

#pragma once

#include <cstdint>
#include <vector>

#include "linespace/swaths/edge_cuts.h"
#include "skeleton/build/vertex_view.h"

namespace sightline::internal {

/// Lists of a pair, kept from one to the next for their memory.
struct VertexViewer::PairLists {
  std::vector<Cut> cuts;
  std::vector<std::int32_t> blockers;  // whose boxes may meet the triangle
  std::vector<std::int32_t> faces;     // the same: once they are listed
  std::vector<std::int32_t> edge_facets;
  // Polygon mode: where along the edge the contact at the viewpoint is an end contact.
  std::vector<CutInterval> ending;
  // The open part is split where `ending` begins and ends.  For each piece of it: 1 if
  // the contact at the viewpoint is an end contact there.
  std::vector<std::uint8_t> piece_ends;
  // Where a face of the star is edge-on, and on both sides the viewpoint is (is no) end.
  struct Turn {
    Cut at;
    bool ends;
  };
  std::vector<Turn> turns;
  std::vector<Cut> pierced;  // where Ridge::pierced_by meet the edge

  void clear() {
    cuts.clear();
    blockers.clear();
    faces.clear();
    edge_facets.clear();
    ending.clear();
    piece_ends.clear();
    turns.clear();
    pierced.clear();
  }
};

struct VertexViewer::Pair {
  const Ridge* r;
  const Edge* edge;
  const Point& e0;
  const Point& e1;
  PlaneSide plane;  // of the viewpoint and the edge
  Shaft triangle;
  CutUnion closed;  // where the edge is hidden or the viewpoint does not support
  PairLists& lists;
  bool listed = false;      // the faces are
  bool mild = false;        // some sign is zero: ends need their contacts listed
  bool degenerate = false;  // stretches need the general contact test
  bool edge_ends = false;   // polygon mode: the edge is an end contact
  // Polygon mode: the lines lie in the plane of a face that both are on; those that end
  // there are left out.
  bool share_facet = false;

  void close(const Cut& from, const Cut& to) { closed.add(from, to); }
  Cut keep(const Cut& cut) {
    lists.cuts.push_back(cut);
    return cut;
  }
};

}  // namespace sightline::internal
