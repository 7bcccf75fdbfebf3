// What all views of a scene share: the lines in space that can bound what is seen, and
// which facets make a patch.

#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "linespace/numbers/rational.h"
#include "linespace/picture/cut_faces.h"
#include "linespace/picture/view_line.h"
#include "linespace/scene/solid_index.h"
#include "linespace/silhouettes/silhouettes.h"

namespace sightline::internal {

class FaceCrossings;

/// What is computed once for a scene.  Immutable.  Keeps a reference to the scene.
class SharedViewScene {
 public:
  /// With a box: as if the scene were what of its faces lies in it.
  SharedViewScene(const Scene& scene, const std::optional<BoxCut>& box,
                  const Request& request);

  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] const Silhouettes& silhouettes() const { return silhouettes_; }
  /// Closed objects in whose material the point lies strictly (silhouettes/rooms.h),
  /// ascending.  An object that a box cuts open has none.
  [[nodiscard]] std::vector<int> material_at(const ExactPoint& p) const;
  [[nodiscard]] bool in_material(const ExactPoint& p) const {
    return cut_ ? !material_at(p).empty() : silhouettes_.in_material(p);
  }

  /// What the box leaves; nullptr without one.
  [[nodiscard]] const CutFaces* cut() const { return cut_ ? &*cut_ : nullptr; }
  /// Corners of a face; of a face that a box cuts, those of what is left, and none where
  /// that has no area.
  [[nodiscard]] std::span<const int> corners(int face) const {
    return cut_ ? cut_->corners(face) : scene_->face_points(face);
  }
  [[nodiscard]] std::span<const ViewLine> lines() const { return lines_; }
  /// The smallest number of all lines that continue this one straight on, with no gap, by
  /// whatever object.
  [[nodiscard]] int whole_line(int line) const { return whole_lines_[line]; }
  /// The line on which the side of a face from its corner k to the next lies; -1 where
  /// the face goes on in the same plane.
  [[nodiscard]] int line_of_side(int face, int k) const {
    return cut_ ? cut_->line_of_side(face, k)
                : side_lines_[scene_->faces()[face].first_corner + k];
  }
  /// The line is an edge of the scene beside which one facet lies.
  [[nodiscard]] bool has_one_facet(int line) const;
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
  void cut_and_cross(const std::optional<BoxCut>& box);
  void add_crossings(const FaceCrossings& crossings, PointNumbers& numbers);
  void find_whole_lines();

  const Scene* scene_;
  Silhouettes silhouettes_;
  SolidIndex solids_;
  std::vector<ViewLine> lines_;
  std::vector<int> side_lines_, whole_lines_;
  std::vector<int> crossing_starts_, crossing_lines_;  // by face
  std::vector<int> edge_starts_, edge_ids_;            // by object
  std::vector<ExactPoint> constructed_;
  std::optional<CutFaces> cut_;
  std::vector<int> patches_;
};

/// The lines of a scene, and those that one view adds.
class ViewLines {
 public:
  ViewLines(std::span<const ViewLine> given, std::span<const ViewLine> added)
      : given_(given), added_(added) {}
  [[nodiscard]] const ViewLine& operator[](std::size_t i) const {
    return i < given_.size() ? given_[i] : added_[i - given_.size()];
  }
  [[nodiscard]] std::size_t size() const { return given_.size() + added_.size(); }

 private:
  std::span<const ViewLine> given_, added_;
};

/// A scene as a view asks it: what all views share, and what this one adds, such as the
/// sides of the window through which it looks.  Cheap to copy.
class ViewScene {
 public:
  ViewScene(const Scene& scene, const Request& request)
      : ViewScene(scene, std::nullopt, request) {}
  ViewScene(const Scene& scene, const std::optional<BoxCut>& box, const Request& request)
      : shared_(std::make_shared<SharedViewScene>(scene, box, request)) {}
  /// The same scene, seen through a polygon: its corners are the last points, its sides
  /// the last lines.
  [[nodiscard]] ViewScene with_window(std::span<const Point> corners) const;
  /// The same scene with further points, numbered from point_count() on, and lines
  /// between any points, numbered from lines().size() on, which have no names.
  [[nodiscard]] ViewScene with_lines(std::vector<ExactPoint> points,
                                     std::span<const std::array<int, 2>> lines) const;

  [[nodiscard]] const Scene& scene() const { return shared_->scene(); }
  [[nodiscard]] const Silhouettes& silhouettes() const { return shared_->silhouettes(); }
  [[nodiscard]] std::vector<int> material_at(const ExactPoint& p) const {
    return shared_->material_at(p);
  }
  [[nodiscard]] bool in_material(const ExactPoint& p) const {
    return shared_->in_material(p);
  }
  [[nodiscard]] const CutFaces* cut() const { return shared_->cut(); }
  [[nodiscard]] std::span<const int> corners(int face) const {
    return shared_->corners(face);
  }
  [[nodiscard]] bool has_one_facet(int line) const {
    return shared_->has_one_facet(line);
  }
  [[nodiscard]] ViewLines lines() const { return {shared_->lines(), added_lines_}; }
  /// Number of the first line of the window; lines().size() where there is none.
  [[nodiscard]] int first_window_line() const {
    return static_cast<int>(shared_->lines().size());
  }
  [[nodiscard]] int whole_line(int line) const {
    return line < first_window_line() ? shared_->whole_line(line) : line;
  }
  [[nodiscard]] int line_of_side(int face, int k) const {
    return shared_->line_of_side(face, k);
  }
  [[nodiscard]] std::span<const int> crossings_of(int face) const {
    return shared_->crossings_of(face);
  }
  [[nodiscard]] std::span<const int> edges_of(int object) const {
    return shared_->edges_of(object);
  }
  [[nodiscard]] int point_count() const {
    return shared_->point_count() + static_cast<int>(added_points_.size());
  }
  [[nodiscard]] bool is_constructed(int point) const {
    return shared_->is_constructed(point);
  }
  [[nodiscard]] ExactPoint exact(int point) const {
    return point < shared_->point_count() ? shared_->exact(point)
                                          : added_points_[point - shared_->point_count()];
  }
  [[nodiscard]] Point position(int point) const {
    return point < shared_->point_count()
               ? shared_->position(point)
               : rounded(added_points_[point - shared_->point_count()]);
  }
  [[nodiscard]] Sign plane_side(int face, int point) const {
    return point < shared_->point_count()
               ? shared_->plane_side(face, point)
               : static_cast<Sign>(exact_plane_value(face, exact(point)).sign());
  }
  [[nodiscard]] Rational exact_plane_value(int face, const ExactPoint& p) const {
    return shared_->exact_plane_value(face, p);
  }
  [[nodiscard]] bool in_line(int a, int b, int p) const;
  [[nodiscard]] bool on_one_line(int line, int other) const;
  [[nodiscard]] int patch(int facet, bool front) const {
    return shared_->patch(facet, front);
  }

 private:
  std::shared_ptr<const SharedViewScene> shared_;
  std::vector<ExactPoint> added_points_;
  std::vector<ViewLine> added_lines_;
};

}  // namespace sightline::internal
