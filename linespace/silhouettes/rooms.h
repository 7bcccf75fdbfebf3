// Objects turned inside out: which of them hold nothing; which points are in material.
//
// The inside of such an object, a *room*, is air.  While nothing stands in a convex room
// nobody there sees more than its walls, and from outside it is the solid that it would
// be if turned outwards: the skeleton takes it for that.  Any other room is a sheet that
// closes around its inside (GLOSSARY.md, "room").

#pragma once

#include <cstdint>
#include <vector>

#include "linespace/predicates.h"
#include "linespace/scene.h"
#include "linespace/scene/solid_index.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// What is asked of a scene's faces and objects, prepared once.
struct RoomsQuestion {
  const Scene& scene;
  const std::vector<PlaneSide>& face_planes;
  const Bvh& face_tree;
  const std::vector<Box>& object_boxes;
  /// By object: closed, and convex but for its orientation.
  const std::vector<std::uint8_t>& convex;
};

/// By object: turned inside out, convex, and no face of another object has a point
/// strictly inside.  Exact.
[[nodiscard]] std::vector<std::uint8_t> empty_rooms(const RoomsQuestion& question);

/// Some closed object has the point strictly inside, and none of its hollows (Scene) has
/// it inside or on its surface.
[[nodiscard]] bool in_material(const Scene& scene, const SolidIndex& solids,
                               const Point& p);
[[nodiscard]] bool in_material(const Scene& scene, const SolidIndex& solids,
                               const ExactPoint& p);
/// These objects, ascending.
[[nodiscard]] std::vector<int> material_at(const Scene& scene, const SolidIndex& solids,
                                           const ExactPoint& p);

}  // namespace sightline::internal
