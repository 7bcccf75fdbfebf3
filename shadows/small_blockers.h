// Feature size for shadows: small blockers that may be left out, and what that changes at
// most.
//
// With fewer blockers a discontinuity mesh has fewer edges.  What is left out are whole
// parts, so that what was closed stays closed; how much more light a receiver then gets
// at any of its points is bounded (proof: docs/shadows.md, "Feature size").
//
//   const auto parts = small_parts(scene, 0.5, source.faces);
//   const double bound = left_out_bound(scene, source, receivers, parts);
//
// Neighbours: shadow_mesh.h finds the mesh; scene_without (scene.h) takes polygons out.

#pragma once

#include <vector>

#include "linespace/request.h"
#include "linespace/scene.h"
#include "shadows/light_source.h"
#include "shadows/shadow_mesh.h"

namespace sightline {

/// Faces of one object that hang together by corners, apart from its others.
struct SmallPart {
  int object;
  std::vector<int> faces;     ///< scene faces, ascending
  std::vector<int> polygons;  ///< their numbers in the file, ascending
  double diagonal;            ///< of its box, scene units; rounded
};

/// The parts whose box has a diagonal shorter than the feature size (decided exactly), in
/// order of object and first face; none of 0.  Never among them: parts with a face of
/// `kept`; hollows and what is listed inside out; a part of an object that is not closed
/// while another of its parts is.
/// Throws InvalidInput for a feature size that is not finite or below 0.
/// Cost: n log n for n faces.
[[nodiscard]] std::vector<SmallPart> small_parts(const Scene& scene, double feature_size,
                                                 const std::vector<int>& kept);

/// How much the form factor to the source can grow at most, at any point of the receivers
/// with the normal of their face, when these parts are taken out of the scene.  0 where
/// none can be in the way.  Not above the unhidden form factor of the source; that much
/// where a part touches a receiver, or nearly so, and stands in the way.
/// Cost: at first parts times faces of receivers; then up to 20,000 times the parts that
/// are near; of the request budget and stop are heard.  Throws Stopped.
[[nodiscard]] double left_out_bound(const Scene& scene, const LightSource& source,
                                    const std::vector<Receiver>& receivers,
                                    const std::vector<SmallPart>& parts,
                                    const Request& request = {});

}  // namespace sightline
