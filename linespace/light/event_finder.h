// Events of one patch of a source: all that pass through a point, all in which an edge is
// the farthest of three from the source.

#pragma once

#include <span>
#include <vector>

#include "linespace/light/family_scan.h"
#include "linespace/light/light_traces.h"
#include "linespace/light/patch_space.h"
#include "linespace/light/source_sight.h"

namespace sightline::internal {

/// Either kind of segment that lines can touch.
struct AnySegment {
  LightFeature name;
  const LightLine* line;
  int edge = -1;  // position in the space's edges; -1: a side of the source
};

/// Keeps references and scratch: one for a thread.
class EventFinder {
 public:
  EventFinder(const PatchSpace& at, const SourceSight& sight,
              std::span<const std::uint8_t> front, std::span<const std::uint8_t> back)
      : at_(at),
        sight_(sight),
        space_(at.space),
        scan_(at.space, at.patch, at.sides, at.faces_in_front, front, back) {}

  std::vector<LightTrace> of_point(const PencilPoint& p, bool on_source);
  std::vector<LightTrace> of_edge(int edge);
  [[nodiscard]] std::size_t families() const { return families_; }

 private:
  void add_pencil(const PencilPoint& p, const AnySegment& e);
  void name_pencil(const PencilPoint& p, const AnySegment& e, LightTrace& trace) const;
  void visit_pair(const AnySegment& a, const AnySegment& m, const AnySegment& b, bool am);
  void add_regulus(const AnySegment& a, const AnySegment& m, const AnySegment& b);
  void add_in_plane(const AnySegment& a, const AnySegment& e, const AnySegment& f,
                    const AnySegment& across);
  void keep(const LineFamily& family, LightTrace trace);
  [[nodiscard]] bool crosses_source(const Four<Approx>& plane) const;
  [[nodiscard]] bool share_convex(const std::vector<int>& x,
                                  const std::vector<int>& y) const;
  [[nodiscard]] AnySegment segment(int edge) const {
    const LightEdge& e = space_.edges()[edge];
    return {{LightFeature::Kind::Edge, e.edge}, e.line, edge};
  }
  [[nodiscard]] AnySegment source_side(std::size_t i) const {
    return {{LightFeature::Kind::SourceSide, static_cast<int>(i)}, &at_.sides[i], -1};
  }
  [[nodiscard]] const LightEdge* moving(const AnySegment& s) const {
    return s.edge < 0 ? nullptr : &space_.edges()[s.edge];
  }
  [[nodiscard]] int common_facet(const AnySegment& a, const AnySegment& b) const;

  const PatchSpace& at_;
  const SourceSight& sight_;
  const LightSpace& space_;
  FamilyScan scan_;
  std::vector<LightTrace> out_;
  std::size_t families_ = 0;
};

}  // namespace sightline::internal
