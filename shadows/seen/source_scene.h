// The source as all points ask for it: its faces by planes, and the scene that hides it.

#pragma once

#include <array>
#include <map>
#include <mutex>
#include <vector>

#include "linespace/picture/view_scene.h"
#include "shadows/light_source.h"

namespace sightline::internal {

/// Source faces of one plane that emit to the same side.
struct SourcePlane {
  std::vector<int> faces;    ///< scene faces, convex polygons
  std::vector<bool> fronts;  ///< each emits from its front, else from its back
  /// The sides of these faces, counter-clockwise as seen from where they emit.
  struct Side {
    std::array<int, 2> ends;  ///< points
    int line;                 ///< in SourceScene::scene()
    /// Number of the source's side: one for sides on one line, with the source on the
    /// same hand, that touch or overlap.
    int name;
    /// Of a diagonal of a polygon that rounding has bent, the line of the triangle
    /// beyond, which runs against this one; else -1.
    int twin_line = -1;
  };
  std::vector<std::vector<Side>> sides;  ///< by position in `faces`
  /// By position in `faces`: faces that touch along an edge or overlap are one; so are
  /// the triangles of a polygon that rounding has bent.
  std::vector<int> source_face;
  /// Around all of them, in their plane, counter-clockwise; rounded.
  std::vector<Point> hull;
};

/// Immutable but for what it remembers.  Keeps a reference to the scene.
class SourceScene {
 public:
  SourceScene(const Scene& scene, const LightSource& source, const Request& request);

  [[nodiscard]] const ViewScene& scene() const { return scene_; }
  [[nodiscard]] const std::vector<SourcePlane>& planes() const { return planes_; }
  /// On which side of the plane a point lies: Positive where the faces emit to.
  [[nodiscard]] Sign side(const SourcePlane& plane, int point) const {
    const Sign s = scene_.plane_side(plane.faces.front(), point);
    return plane.fronts.front() ? s : -s;
  }
  /// Where the segment between two points on different sides of the plane crosses it.
  /// Computed when it is first asked for.
  [[nodiscard]] ExactPoint crossing(const SourcePlane& plane, int p, int q) const;

 private:
  void group_by_planes(const LightSource& source);
  void name_sides(SourcePlane& plane, int& names) const;
  void find_source_faces(SourcePlane& plane, int& numbers) const;
  void find_diagonals();

  ViewScene scene_;
  std::vector<SourcePlane> planes_;
  mutable std::mutex mutex_;                                    // of what follows
  mutable std::map<std::array<int, 3>, ExactPoint> crossings_;  // by plane and points
};

}  // namespace sightline::internal
