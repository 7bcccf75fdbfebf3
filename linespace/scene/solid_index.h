// Where a point lies among the closed objects of a scene: the one place that says what
// "inside" means.
//
// The surface of a closed object winds around every point off it a whole number of times:
// once around the points inside a box whose faces show their fronts outwards, minus once
// around those inside a box turned inside out, not at all around points outside.  A point
// is inside the object, in its material, iff that number is positive, where the shells
// turned inside out (Scene::turned) are left out: the space within such a shell is air,
// but what stands there, of the same object too, is not.

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "linespace/numbers/rational.h"
#include "linespace/scene.h"
#include "linespace/space/bvh.h"

namespace sightline::internal {

/// Immutable; may be shared between threads.  Keeps a reference to the scene.  Cost:
/// n log n for n faces.
class SolidIndex {
 public:
  explicit SolidIndex(const Scene& scene);

  /// How many times the surface of a closed object winds around the point; nullopt when
  /// the point lies on the surface.  Exact, and always decided.  Requires admissible
  /// coordinates (predicates.h).  Cost: the faces of the object over or under the point
  /// along one coordinate axis, found in log n; all of them in an object of few faces.
  [[nodiscard]] std::optional<int> winding(int object, const Point& p) const {
    const auto w = windings(object, p);
    return w ? std::optional(w->solid - w->turned) : std::nullopt;
  }
  /// What winds around a point.  `solid`: how many times the faces with material behind
  /// them do.  `turned`: how many times the faces of shells turned inside out would, if
  /// these were turned outwards.  Points with rational coordinates take some microseconds
  /// a face.
  struct Windings {
    int solid = 0, turned = 0;
  };
  [[nodiscard]] std::optional<Windings> windings(int object, const Point& p) const;
  [[nodiscard]] std::optional<Windings> windings(int object, const ExactPoint& p) const;

  /// Some closed object has the point strictly inside: off its surface, in its material.
  [[nodiscard]] bool in_solid(const Point& p) const;
  /// All closed objects that do.
  [[nodiscard]] std::vector<int> solids_around(const Point& p) const;
  [[nodiscard]] std::vector<int> solids_around(const ExactPoint& p) const;

 private:
  template <class P>
  [[nodiscard]] std::optional<Windings> count_windings(int object, const P& p) const;
  template <class P>
  [[nodiscard]] std::vector<int> list_solids_around(const P& p) const;

  // A closed object: which faces it has, and how they are looked up.
  struct Solid {
    int object;
    Box box;
    int axis;       // of the least extent: rays run along it
    int tree = -1;  // position in trees_; -1: each face is looked at
  };

  const Scene* scene_;
  std::vector<Solid> solids_;
  std::vector<std::int32_t> solid_of_object_;  // position in solids_, -1 if not closed
  Bvh solid_tree_;
  std::vector<Bvh> trees_;  // items are positions in the object's `faces`
};

}  // namespace sightline::internal
