// The arcs of a planar map: conic arcs as given, and of each line the stretches that
// segments cover, so that segments on one line never have to be compared in pairs.

#pragma once

#include <memory>
#include <span>
#include <vector>

#include "shadows/planar/arcs/arc_box.h"
#include "shadows/planar/arcs/arc_filter.h"
#include "shadows/planar/arcs/exact_parameter.h"
#include "shadows/planar/arcs/plane_support.h"
#include "shadows/planar/plane_curve.h"

namespace sightline::internal {

/// A position on an arc: enclosed, and exactly once somebody asks.
struct ArcParameter {
  DoubleRange range;
  /// The support that crosses there.  -1: `exact` is known.
  int crossing = -1;
  std::shared_ptr<const ExactParameter> exact;
};

/// An input curve, or a side of the outline, on an arc.
struct ArcMember {
  int curve;  ///< number of the input curve; of side k of the outline -1 - k
  ArcParameter from, to;
  bool backwards;  ///< the curve, or the side, runs from `to` to `from`
};

struct ArcEnd {
  ArcParameter at;
  QuadraticRoot exact;
  SurdPoint point;
  BallNumber parameter;
  BallNumber x, y, w;  ///< homogeneous
  DoubleRange box_x, box_y;
};

struct PlaneArc {
  int support;
  std::array<ArcEnd, 2> ends;
  std::vector<ArcMember> members;  ///< one for a conic
};

struct PlaneArcs {
  std::vector<PlaneSupport> supports;
  std::vector<int> conic;  ///< of a support: the first one with the same implicit form
  std::vector<PlaneArc> arcs;
  std::vector<ArcDoubles> doubles;  ///< of each arc
};

/// The order of supports and arcs depends on their geometry alone.
[[nodiscard]] PlaneArcs plane_arcs(std::span<const PlaneCurve> curves,
                                   const PlaneOutline& outline);

/// The position in exact form.  own: the support of the arc that p lies on.
[[nodiscard]] const ExactParameter& exact(const std::vector<PlaneSupport>& supports,
                                          int own, ArcParameter& p);
/// The sign of p - q, both on the support `own`.
[[nodiscard]] Sign compare(const std::vector<PlaneSupport>& supports, int own,
                           ArcParameter& p, ArcParameter& q);

}  // namespace sightline::internal
