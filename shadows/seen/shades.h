// What may stand between a point and a plane of the source: convex polygons of the
// picture that hide what lies behind them.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "linespace/picture/eye_space.h"
#include "shadows/seen/source_scene.h"

namespace sightline::internal {

/// A convex polygon of the picture, counter-clockwise as the eye sees it: a face, the
/// part of a face before the source's plane, a convex solid as a whole, or a part of the
/// source.
struct Shade {
  struct Side {
    std::array<int, 2> ends;  ///< points
    int line;                 ///< on which the side lies; -1 where a facet goes on
  };
  std::vector<Side> sides;  ///< in any order
  /// Further lines that are seen along sides, ascending: those of edge-on faces.
  std::vector<int> further_lines;
};

/// A face that may hide, as it is before any eye asks.
struct HidingFace {
  int face;
  /// Where the face crosses the source's plane, the part before it: its corners,
  /// counter-clockwise as seen from the face's front, each with the side of the face on
  /// which the part goes on, -1 for the cut.  kLeaving and kEntering stand for ends of
  /// the cut that are no corners of the face.
  struct Corner {
    int point, side;
  };
  static constexpr int kLeaving = -1, kEntering = -2;
  std::vector<Corner> part = {};
  std::array<int, 2> cut_ends{kLeaving, kEntering};  ///< or corners
  std::array<ExactPoint, 2> cut{};
};

/// Faces of which some part may lie strictly between the point and the plane of the
/// source, in the cone over the source.  Some that do not may be among them.
[[nodiscard]] std::vector<HidingFace> find_hiding_faces(const SourceScene& source,
                                                        const SourcePlane& plane,
                                                        const Point& rounded_point);

/// Makes shades of hiding faces as an eye sees them.  Faces that it sees edge-on hide
/// nothing and are left out, and so are backs of convex solids whose fronts are there.
class ShadeMaker {
 public:
  /// all_lines: Shade::further_lines are asked for.
  ShadeMaker(const EyeSpace& eye, const SourceScene& source, const SourcePlane& plane,
             bool all_lines)
      : eye_(&eye), source_(&source), plane_(&plane), all_lines_(all_lines) {}

  /// Of the hiding faces that are cut number i (from 0) has its two ends at the points
  /// first_cut_point + 2 i and + 1 of the eye's scene, and its cut on the line
  /// first_cut_line + i.
  [[nodiscard]] std::vector<Shade> shades(const std::vector<HidingFace>& hiding_faces,
                                          int first_cut_point, int first_cut_line) const;

 private:
  [[nodiscard]] Shade of_face(int face) const;
  [[nodiscard]] Shade of_part(const HidingFace& hiding, int cut_point,
                              int cut_line) const;
  [[nodiscard]] std::optional<Shade> of_solid(int object) const;
  [[nodiscard]] bool is_convex(const Shade& shade) const;

  const EyeSpace* eye_;
  const SourceScene* source_;
  const SourcePlane* plane_;
  bool all_lines_;
};

}  // namespace sightline::internal
