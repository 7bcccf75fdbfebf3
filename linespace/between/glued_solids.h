// Convex solids glued to faces, and the segments inside them.
//
// Faces in the planes of a and b do not block between a and b (face_visibility.h).  So a
// segment that starts where a face of a convex solid touches a, and ends where another
// touches b, would run unhindered through its inside.  Such segments do not count: x in a
// and y in b do not see each other if the solid has x on a face f in a's plane and y on a
// face g in b's plane.  (A segment that enters the solid at f meets another of its faces
// unless it ends in b's plane; where it does not leave there, that face blocks.)

#pragma once

#include <functional>
#include <map>
#include <vector>

#include "linespace/scene.h"

namespace sightline::internal {

/// What is behind all of its faces is material.
[[nodiscard]] bool is_convex_solid(const Object& object);

/// All corners of face b are in the plane of face a.
[[nodiscard]] bool in_one_plane(const Scene& scene, int a, int b);

/// The convex solids with faces in the plane of one face, near it.
class GluedSolids {
 public:
  /// near(face): all faces whose boxes meet that of the face, and perhaps others.
  GluedSolids(const Scene& scene, int face,
              const std::function<std::vector<int>(int)>& near);

  /// All segments from the face to b go into a solid that has the face, as a whole, on
  /// its surface, and leave it through another of its faces or end there: b is behind the
  /// face and does not reach into the solid.
  [[nodiscard]] bool hide(int b) const;

  /// Faces that block between a and b besides those off both planes.  Of two sets, a
  /// segment has to miss one: the first holds for segments that end on one side of a's
  /// plane, the second for the other.  One set where both would do, usually an empty one.
  [[nodiscard]] static std::vector<std::vector<int>> blockers(const GluedSolids& a,
                                                              const GluedSolids& b);

 private:
  const Scene& scene_;
  int face_;
  std::map<int, std::vector<int>> faces_;  // in the face's plane, by object
  std::vector<int> holding_;               // one face of each solid that has all of it
};

}  // namespace sightline::internal
