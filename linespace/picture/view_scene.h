// What all views of a scene share: the lines in space that can bound what is seen, and
// which facets make a patch.

#pragma once

#include <array>
#include <span>
#include <vector>

#include "linespace/numbers/rational.h"
#include "linespace/scene/solid_index.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/visibility_map.h"

namespace sightline::internal {

/// A segment in space beside which something else may be seen on either side: an edge of
/// the scene, a side between two faces of one facet that is bent there by rounding, or a
/// segment in which two faces cut through each other.
struct ViewLine {
  std::array<int, 2> ends;  ///< point numbers, as ViewScene counts them
  MapLine name;
  /// Of a crossing: the two faces; else -1.
  std::array<int, 2> crossing{-1, -1};
};

/// Immutable.  Keeps a reference to the scene.
class ViewScene {
 public:
  ViewScene(const Scene& scene, const Request& request);

  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] const Silhouettes& silhouettes() const { return silhouettes_; }
  /// Closed objects in whose material the point lies strictly (silhouettes/rooms.h),
  /// ascending.
  [[nodiscard]] std::vector<int> material_at(const ExactPoint& p) const;

  [[nodiscard]] std::span<const ViewLine> lines() const { return lines_; }
  /// The smallest number of all lines that continue this one straight on, with no gap, by
  /// whatever object.
  [[nodiscard]] int whole_line(int line) const { return whole_lines_[line]; }
  /// The line on which the side of a face from its corner k to the next lies; -1 where
  /// the face goes on in the same plane.
  [[nodiscard]] int line_of_side(int face, int k) const {
    return side_lines_[scene_->faces()[face].first_corner + k];
  }
  /// Crossings of a face with others, as line numbers.
  [[nodiscard]] std::span<const int> crossings_of(int face) const;

  /// Scene edges of an object.
  [[nodiscard]] std::span<const int> edges_of(int object) const {
    return std::span(edge_ids_).subspan(edge_starts_[object],
                                        edge_starts_[object + 1] - edge_starts_[object]);
  }

  /// Points are numbered as in the scene; then come the ends of crossings.
  [[nodiscard]] int point_count() const {
    return static_cast<int>(scene_->points().size() + constructed_.size());
  }
  [[nodiscard]] bool is_constructed(int point) const {
    return point >= static_cast<int>(scene_->points().size());
  }
  [[nodiscard]] ExactPoint exact(int point) const {
    return is_constructed(point) ? constructed_[point - scene_->points().size()]
                                 : exact_point(scene_->point(point));
  }
  /// Rounded, where constructed.
  [[nodiscard]] Point position(int point) const {
    return is_constructed(point) ? rounded(exact(point)) : scene_->point(point);
  }

  /// On which side of a face's plane a point lies: Positive in front.
  [[nodiscard]] Sign plane_side(int face, int point) const;
  [[nodiscard]] Rational exact_plane_value(int face, const ExactPoint& p) const;

  /// Does point p lie on the straight line through a and b in space?
  [[nodiscard]] bool in_line(int a, int b, int p) const;
  /// Do the two lie on one straight line in space?
  [[nodiscard]] bool on_one_line(int line, int other) const;

  /// The patch of a facet as it is seen from its front, or its back.
  [[nodiscard]] int patch(int facet, bool front) const {
    return patches_[2 * facet + (front ? 0 : 1)];
  }

 private:
  void add_lines();
  void add_crossings();
  void find_whole_lines();

  const Scene* scene_;
  Silhouettes silhouettes_;
  SolidIndex solids_;
  std::vector<ViewLine> lines_;
  std::vector<int> side_lines_, whole_lines_;
  std::vector<int> crossing_starts_, crossing_lines_;  // by face
  std::vector<int> edge_starts_, edge_ids_;            // by object
  std::vector<ExactPoint> constructed_;
  std::vector<int> patches_;
};

}  // namespace sightline::internal
