// All curves on one receiver along which the view of the light may change.

#pragma once

#include "linespace/light/light_events.h"
#include "shadows/mesh/receiver_plane.h"

namespace sightline::internal {

/// Curve i of `curves` has the id i.
struct ReceiverCurves {
  struct Name {
    ShadowEdgeKind kind;
    std::vector<std::string> generators;
    friend auto operator<=>(const Name&, const Name&) = default;
  };
  std::vector<PlaneCurve> curves;
  std::vector<Name> names;
};

/// What all receivers share: a trace and one of its pieces, by the face that it is on.
struct PieceOnFace {
  int trace, piece;
};

/// receiver: the patch of the plane's faces.  pieces: those on these faces.
[[nodiscard]] ReceiverCurves receiver_curves(const Scene& scene,
                                             const ReceiverPlane& plane,
                                             const SourcePatch& receiver,
                                             const LightEvents& events,
                                             std::span<const PieceOnFace> pieces);

}  // namespace sightline::internal
