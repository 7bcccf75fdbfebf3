// The convex occluders that a viewpoint, or an edge by the ends of itself or of a piece,
// looks at: whether one of them hides a group of edges or a segment.  Those that hid
// something last are tried first.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "linespace/silhouettes/silhouettes.h"
#include "linespace/space/shaft.h"

namespace sightline::internal {

/// Seen from a point, what is behind a convex occluder is convex.  So where the segments
/// from all viewpoints to both ends of a segment, or to all corners of a box, meet it,
/// those between their hulls do; and where one of them passes its inside, all do that are
/// between inner points.  Keeps scratch, so one per thread.
class Occluders {
 public:
  explicit Occluders(const Silhouettes& silhouettes);

  /// Looks from all points of these points' hull from now on.  What they belong to hides
  /// nothing: convex solids by object, other faces by facet.
  void begin(std::span<const Point> viewpoints, std::span<const std::int32_t> own_objects,
             std::span<const std::int32_t> own_facets);

  /// All that is asked until look_away() is inside the box: occluders that hide nothing
  /// there are not asked.
  void look_at(const Box& box);
  void look_away() { looking_ = false; }

  /// Looks for an occluder, among those that hid something lately, that hides every
  /// segment inside the box from all viewpoints.  Returns one of its faces, -1 if there
  /// is none.
  [[nodiscard]] int hider(const Box& box);
  /// The segment q0 q1.
  [[nodiscard]] int hider(const Point& q0, const Point& q1);
  /// Of one that some of these faces belong to.
  [[nodiscard]] int hider(std::span<const std::int32_t> faces, const Point& q0,
                          const Point& q1);
  /// A face's occluder is tried first from now on.
  void remember(int face);

 private:
  [[nodiscard]] int shadow_of(int face);
  [[nodiscard]] std::span<const Shadow> shadows(int shadow) const {
    return std::span(shadows_).subspan(shadow * viewpoints_.size(), viewpoints_.size());
  }
  // Looks at the hull of one box or of two.
  void aim(std::span<const Box> parts);
  [[nodiscard]] bool hides(int shadow) const;
  [[nodiscard]] bool beside(int shadow) const;
  [[nodiscard]] const std::vector<std::int32_t>& asked() const {
    return looking_ ? in_view_ : recent_;
  }
  [[nodiscard]] int recent_hider();
  void keep(int shadow);

  const Silhouettes& g_;
  std::vector<Point> viewpoints_;
  Point middle_;  // of the viewpoints
  // What is looked at, relative to each viewpoint.
  struct Target {
    std::array<std::array<double, 3>, 2> low, high;  // of its parts
    std::size_t parts = 0;
    std::array<double, 3> middle;
  };
  std::vector<Target> targets_;
  std::vector<std::int32_t> own_objects_, own_facets_;
  std::vector<Shadow> shadows_;             // from each viewpoint, occluder by occluder
  std::vector<std::int32_t> faces_;         // one of each occluder with shadows
  std::vector<std::int32_t> shadow_index_;  // by occluder, -2 unknown, -1 none
  std::vector<std::int64_t> shadow_keys_;   // to reset
  std::vector<std::int32_t> recent_;        // those that hid something last come first
  bool looking_ = false;
  std::vector<std::int32_t> in_view_;  // of these, while looking at a box
};

}  // namespace sightline::internal
