// Which features of a scene can make events: the edges that can be silhouettes (ridges),
// from where lines graze them, and the corners with the faces around them (stars).
// Computed once for a scene; shared by all viewpoints.

#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "linespace/contacts/contact.h"
#include "linespace/generator.h"
#include "linespace/predicates.h"
#include "linespace/scene.h"
#include "linespace/silhouettes/buried_stretches.h"
#include "linespace/silhouettes/ridge_groups.h"
#include "linespace/silhouettes/ridge_sides.h"
#include "linespace/space/bvh.h"
#include "linespace/work/deadline.h"
#include "linespace/work/stage.h"

namespace sightline::internal {

class SolidIndex;
struct ForeignTouch;

/// How a line meets an edge, coming from a viewpoint: not at all from outside, grazing,
/// or entering the solid there.
enum class EdgeContact : std::uint8_t { None, Graze, End };

/// An edge with a free gap of more than half a turn around it: some lines graze there.
/// In polygon mode also a crease at which lines only end; an edge with three faces or
/// more has one for each gap (docs/polygon_mode.md).
///
/// The faces at the edge lie in the wedge between half-planes A and B; a line through a
/// point of the edge grazes iff it does not pass from the wedge into its opposite, that
/// is, iff the viewpoint is not strictly inside one of the two.
struct Ridge {
  std::int32_t edge;  ///< the first, where edges of several objects coincide
  std::vector<std::int32_t> objects;  ///< of all coinciding edges
  std::array<std::int32_t, 2> points;
  /// Oriented so that the wedge is behind both.
  PlaneSide a, b;
  /// A point beside the edge in the plane of a, of b; and the facet of the face there.
  std::array<std::int32_t, 2> thirds, facets;
  /// Facets of all faces at the edge and at edges that coincide with it, ascending.
  std::vector<std::int32_t> all_facets;
  /// A foreign face touches the open edge: lines there need the general contact test.
  bool touched;
  /// Lines can graze: false for reflex edges.
  bool grazes = true;
  /// Inside other objects' faces: the foot of a wall; `touched` too.
  bool foot = false;
  /// Polygon mode: from a viewpoint strictly in front of both planes, strictly behind
  /// both (inside the wedge), the edge is seen and the line ends there.
  bool ends_in_front = false, ends_behind = false;
  /// From a viewpoint in the plane of a, of b, on the face's side: whether the line along
  /// the face ends at the edge, for edges that no line grazes.
  std::array<bool, 2> ends_along{true, true};
  /// Polygon mode, `touched`: what is seen differs along the edge and is asked line by
  /// line (silhouettes/drawn.h).
  bool any_side = false;
  /// Faces of other objects that the open edge passes through.  Not empty only if
  /// `touched`, each of these faces meets the edge in one point inside its facet, and no
  /// other foreign face touches the edge: then only lines to these points need the
  /// general contact test.
  std::vector<std::int32_t> pierced_by = {};
  /// Then: where the edge is in the material of solids.
  std::vector<BuriedStretch> buried = {};

  /// Lines to any of its points may need the general contact test.
  [[nodiscard]] bool touched_along() const { return touched && pierced_by.empty(); }
  /// Polygon mode: lines can end here.
  [[nodiscard]] bool can_end() const { return ends_in_front || ends_behind; }
  /// Lines graze here, and not only end.
  [[nodiscard]] bool can_graze() const { return grazes && !foot; }
  /// The contact seen from a viewpoint with these signs of a and b.
  [[nodiscard]] EdgeContact contact(Sign sign_a, Sign sign_b) const {
    if (sign_a != sign_b || sign_a == Sign::Zero) {
      if (grazes) return EdgeContact::Graze;
      if (any_side) return EdgeContact::End;
      // In the plane of one face: along it from the free side, or else from inside.
      const bool along = sign_a != Sign::Positive && sign_b != Sign::Positive &&
                         ((sign_a == Sign::Zero && ends_along[0]) ||
                          (sign_b == Sign::Zero && ends_along[1]));
      return ends_behind && along ? EdgeContact::End : EdgeContact::None;
    }
    const bool ends = sign_a == Sign::Positive ? ends_in_front : ends_behind;
    return ends ? EdgeContact::End : EdgeContact::None;
  }
};

/// From behind both planes of a ridge's wedge, from in front of both: some line touches
/// the edge.
[[nodiscard]] inline std::array<bool, 2> touched_on(const Ridge& r) {
  return {r.contact(Sign::Negative, Sign::Negative) != EdgeContact::None,
          r.contact(Sign::Positive, Sign::Positive) != EdgeContact::None};
}

/// The faces around a corner, touching ones of other objects included.
struct Star {
  std::int32_t point = -1;
  /// With the point on their boundary or inside.
  std::vector<std::int32_t> faces;
  /// Its own facets, ascending: those with an edge that ends at the point.
  std::vector<std::int32_t> facets;
  /// Rays along the sides at the point, as far end points: one per direction.
  std::vector<std::int32_t> rays;
  /// For each ray whether an edge runs along it; other rays only cut a face, or a facet,
  /// in parts.
  std::vector<std::uint8_t> along_edge;
  /// Each face as (ray, ray, facet), positions in `rays`, less than half a turn apart.
  struct Sector {
    std::int32_t from, to, facet;
  };
  std::vector<Sector> sectors;
  /// The solid is locally the intersection of half-spaces: `sectors` are its faces.
  bool convex = false;
  /// Some facet has the point in its inside: only lines in that plane can graze.
  bool in_plane_only = false;
  std::vector<std::int32_t> planes;  ///< then: a face of each of those facets
  /// A facet that has no corner here has the point on it, or two objects have theirs
  /// here: lines need the general contact test when it is in their way.
  bool touched = false;
};

class Silhouettes {
 public:
  /// Hears the request's progress and threads only; the deadline is that of the longer
  /// work that this is a part of.  Throws Stopped.  Cost: n log n for n faces, copies of
  /// objects included, where few others touch.
  explicit Silhouettes(const Scene& scene, EventMode events = EventMode::Solid,
                       const Request& request = {});
  Silhouettes(const Scene& scene, EventMode events, const Request& request,
              const Deadline& deadline);

  [[nodiscard]] const Scene& scene() const { return *scene_; }
  /// Polygon mode: ridges() holds creases at which lines only end too.
  [[nodiscard]] bool polygon() const { return events_ == EventMode::Polygon; }
  [[nodiscard]] std::span<const Ridge> ridges() const { return ridges_; }
  /// Ridge number of a scene edge (the same for coinciding ones; of several gaps that in
  /// which lines graze, or the first), -1 when no line has a contact there.
  [[nodiscard]] int ridge_of_edge(int edge) const { return ridge_of_edge_[edge]; }
  /// Faces other than its own two are at the edge: on both sides of it may be material.
  [[nodiscard]] bool borders_others(const Ridge& ridge) const {
    return ridge.touched || scene_->edges()[ridge.edge].sides.size() > 2;
  }
  /// An edge as lines name it: the same for all that coincide.
  [[nodiscard]] Generator named(int edge) const {
    const int ridge = ridge_of_edge_[edge];
    return {GeneratorKind::Edge, ridge < 0 ? edge : ridges_[ridge].edge};
  }
  /// The objects of a corner, of all edges that coincide with an edge, of a facet;
  /// ascending.  Empty for an edge with number -1.
  [[nodiscard]] std::span<const std::int32_t> objects_of(const Generator& x) const;
  [[nodiscard]] std::span<const Star> stars() const { return stars_; }
  /// Position in stars() of a corner point, -1 for other points.
  [[nodiscard]] int star_of_point(int point) const { return star_of_point_[point]; }
  /// The corner lies strictly inside a solid: it takes part in no event.
  [[nodiscard]] bool inside_solid(int star) const { return inside_[star] != 0; }

  /// The point is strictly inside a closed object, in its material
  /// (scene/solid_index.h).
  [[nodiscard]] bool in_material(const ExactPoint& p) const;

  /// Objects with an edge that ends at the point, ascending: not those that have it
  /// inside a facet or a straight edge.
  [[nodiscard]] std::span<const std::int32_t> objects_at(int point) const {
    return {object_ids_.data() + object_starts_[point],
            static_cast<std::size_t>(object_starts_[point + 1] - object_starts_[point])};
  }
  /// Behind the face is the inside of a closed object: not of a sheet, nor of a room in
  /// which something stands (silhouettes/rooms.h).
  [[nodiscard]] bool solid_behind(int face) const {
    return scene_->solid_behind(face) || empty_room_[scene_->faces()[face].object] != 0;
  }
  /// Number of the part of an object that a face is of: faces that hang together by edges
  /// of two faces.
  [[nodiscard]] int shell(int face) const { return shells_[face]; }
  /// Closed, bounded inside, and convex up to folds along edges declared flat; no room
  /// with something in it, nor around one.
  [[nodiscard]] bool convex_solid(int object) const { return convex_[object] != 0; }

  /// The sides around a facet that is a convex polygon, in its faces' orientation; empty
  /// for other facets, and for those of one face.
  [[nodiscard]] std::span<const std::array<std::int32_t, 2>> facet_outline(
      int facet) const {
    return outlines_[facet];
  }

  /// Some side of the facet is no ridge that stands free: lines in its plane need the
  /// general contact test.
  [[nodiscard]] bool facet_touched(int facet) const {
    return touched_facets_[facet] != 0;
  }

  [[nodiscard]] const Bvh& face_tree() const { return face_tree_; }
  /// What blocks lines as one: a convex solid of few faces, told by its object, or a face
  /// of anything else, told by its complement (~face).
  [[nodiscard]] std::span<const std::int32_t> blockers() const { return blockers_; }
  [[nodiscard]] const Box& blocker_box(std::int32_t blocker) const {
    return blocker < 0 ? face_box(~blocker) : object_box(blocker);
  }
  /// Over blockers(); leaves hold positions there.
  [[nodiscard]] const Bvh& blocker_tree() const { return blocker_tree_; }
  /// Over ridges(); leaves hold ridge numbers.
  [[nodiscard]] const Bvh& ridge_tree() const { return ridge_tree_; }
  /// What the ridges below a node of ridge_tree() share.
  [[nodiscard]] const RidgeGroup& ridge_group(std::size_t node) const {
    return ridge_groups_[node];
  }
  /// What proves that no line touches the ridge at a position in ridge_tree().items().
  [[nodiscard]] const RidgeSides& ridge_sides(std::size_t position) const {
    return ridge_sides_[position];
  }
  [[nodiscard]] const PlaneSide& face_plane(int face) const { return face_planes_[face]; }
  [[nodiscard]] const Box& face_box(int face) const { return face_boxes_[face]; }
  /// Around all faces of an object; a point for one without.
  [[nodiscard]] const Box& object_box(int object) const { return object_boxes_[object]; }

 private:
  void find_convex_solids();
  void find_rooms();
  void find_outlines();
  void find_object_boxes();
  void find_blockers();
  void find_ridges(const Request& request, Stage& stage);
  void find_touched_facets();
  void find_shells();
  struct EdgeFaces;  // the faces at one edge
  void look_at_edges(int first, std::span<EdgeFaces> found) const;
  bool look_at_own_faces(const Edge& e, EdgeFaces& at) const;
  [[nodiscard]] int extreme_half_plane(const Edge& e, const EdgeFaces& at,
                                       Sign wanted) const;
  [[nodiscard]] bool fronts_face_gap(const Edge& e, const EdgeFaces& at) const;
  void find_touching(const Edge& e, ForeignTouch found, EdgeFaces& at) const;
  [[nodiscard]] std::vector<BuriedStretch> buried_stretches(
      std::array<std::int32_t, 2> points, std::span<const std::int32_t> pierced_by) const;
  [[nodiscard]] bool untouched_in_material(std::array<std::int32_t, 2> points) const;
  [[nodiscard]] bool inside_material(int point) const {
    return star_of_point_[point] >= 0 && inside_[star_of_point_[point]] != 0;
  }
  void add_edge(int edge, const EdgeFaces& at, std::vector<Box>& boxes);
  void add_ridge(int edge, const EdgeFaces& at, std::vector<Box>& boxes);
  void add_gaps(int edge, const EdgeFaces& at, std::vector<Box>& boxes);
  bool join_ridge(int edge, const EdgeFaces& at);
  void find_joined_crease(int first, int end);
  [[nodiscard]] bool shows_crease(std::array<std::int32_t, 2> points,
                                  std::int32_t first_edge, std::int32_t last_edge) const;
  void find_stars(const Request& request, Stage& stage);
  [[nodiscard]] Star star_of(int point) const;
  [[nodiscard]] bool inside_facet(int point, int facet,
                                  std::span<const std::int32_t> faces) const;
  void find_inside(const Request& request, Stage& stage);

  const Scene* scene_;
  EventMode events_;
  std::vector<Box> face_boxes_, object_boxes_;
  Bvh face_tree_;
  Bvh ridge_tree_, blocker_tree_;
  std::vector<std::int32_t> blockers_;
  std::vector<PlaneSide> face_planes_;
  std::vector<Ridge> ridges_;
  std::vector<RidgeSides> ridge_sides_;
  std::vector<RidgeGroup> ridge_groups_;
  std::vector<std::int32_t> ridge_of_edge_;
  std::vector<Star> stars_;
  std::vector<std::int32_t> star_of_point_;
  std::vector<std::uint8_t> inside_;
  std::vector<std::uint8_t> convex_;
  std::vector<std::vector<std::array<std::int32_t, 2>>> outlines_;
  std::vector<std::uint8_t> touched_facets_;
  std::vector<std::int32_t> shells_;  // by face
  std::vector<std::int32_t> object_starts_, object_ids_;
  std::vector<std::uint8_t> empty_room_;  // by object
  std::shared_ptr<const SolidIndex> solids_;
};

/// Sign of a plane's bounded value at p, by the exact predicate where the bound is too
/// weak.
[[nodiscard]] inline Sign sign_of(const BoundedValue& value, const PlaneSide& plane,
                                  const Point& p) {
  if (std::abs(value.value) > value.error || value.error == 0) {
    ++thread_stage_counts().by_double;
    return sign_of(value.value);
  }
  return plane(p);
}

template <class T>
void sort_unique(std::vector<T>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

/// Some id is in both.
[[nodiscard]] inline bool share(std::span<const std::int32_t> a,
                                std::span<const std::int32_t> b) {
  return std::any_of(a.begin(), a.end(), [&](std::int32_t x) {
    return std::find(b.begin(), b.end(), x) != b.end();
  });
}

/// The point is a corner of the face.
[[nodiscard]] inline bool has_point(const Scene& scene, int face, int point) {
  const auto p = scene.face_points(face);
  return std::find(p.begin(), p.end(), point) != p.end();
}

/// The three points that give a face its plane.
[[nodiscard]] inline std::array<std::int32_t, 3> plane_points(const Scene& scene,
                                                              int face) {
  const auto p = scene.face_points(face);
  return {p[0], p[1], p[2]};
}

[[nodiscard]] inline PlaneThrough face_plane_through(const Scene& scene, int face) {
  const auto p = scene.face_points(face);
  return {scene.point(p[0]), scene.point(p[1]), scene.point(p[2])};
}

/// A plane through p and q parallel to a coordinate axis that the face's plane is not
/// parallel to: whatever lies in the face's plane is told apart by it as by the line pq.
/// Positive on the face's inside when p, q are consecutive corners.
class InPlaneSide {
 public:
  InPlaneSide(const Scene& scene, int face);
  /// Which side of line pq point x lies on, for p, q, x in the face's plane: Positive to
  /// the left, seen from the face's front.
  [[nodiscard]] Sign operator()(const Point& p, const Point& q, const Point& x) const;
  /// A number proportional to the distance of x from line pq, with a sign that depends on
  /// the side: for ratios on one line pq.
  [[nodiscard]] Rational value(const Point& p, const Point& q, const Point& x) const;

 private:
  int axis_ = 0;
  Sign orientation_ = Sign::Zero;
};

/// Where a point of a face's plane lies: strictly inside the polygon, on its boundary, or
/// outside.
enum class PointInFace : std::uint8_t { Outside, Boundary, Inside };
[[nodiscard]] PointInFace locate_in_plane(const Scene& scene, int face, const Point& x);

}  // namespace sightline::internal
