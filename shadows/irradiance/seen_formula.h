// The closed form of irradiance in the faces of a discontinuity mesh.
//
// All points of a face see the light bounded by the same lines in space: sides of the
// source, edges of blockers, lines in the source's plane.  So the form factor is one
// formula, Lambert's sum over the sides of what is seen, and no point need be asked what
// hides the light from it.  The formula also has values, and derivatives, at points
// outside of the face, where it is not the irradiance.

#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "shadows/irradiance/majorant.h"
#include "shadows/seen/source_scene.h"
#include "shadows/shadow_mesh.h"

namespace sightline::internal {

/// What points of one plane see of the light, by one structure.
struct SeenFormula {
  struct Side {
    Point at;             ///< on the line
    Eigen::Vector3d way;  ///< along it, of length 1
    bool on_source;       ///< the line lies in the source's plane
    /// Where the side begins: the point in which it meets the line of the side before it
    /// in space; else the two lines only cross as seen.
    bool meets;
    Point corner;
  };
  /// Sides first, ..., last - 1, the part seen on one hand.
  struct Loop {
    int first, last;
    Point on_plane;          ///< of the source
    Eigen::Vector3d facing;  ///< unit normal on the side to which the source emits
  };
  std::vector<Side> sides;
  std::vector<Loop> loops;

  /// Form factor of an element at p with this unit normal, rounded.  Cost: an arc tangent
  /// for each side.
  [[nodiscard]] double value(const Point& p, const Eigen::Vector3d& normal) const;

  /// Bounds of the derivatives with x, |x| <= 1, of the value at middle + axes x: over an
  /// ellipse in the plane of the receiver, whose unit normal is given.  Unknown for one
  /// that reaches the line of a side that only crosses another as seen, the plane of the
  /// source, or the height of a corner.  Derived in docs/irradiance.md.  Rounding adds
  /// less than 1e-9 of the bound.
  [[nodiscard]] Majorant bound(const Point& middle,
                               const Eigen::Matrix<double, 3, 2>& axes,
                               const Eigen::Vector3d& normal) const;
};

/// Makes formulas of structures, for points of one plane.
class FormulaMaker {
 public:
  /// face: of the scene; its plane is the receiver's.
  FormulaMaker(const SourceScene& source, int face);

  /// nullopt where a name does not tell one line: where a facet that rounding has bent
  /// cuts the source's plane.
  [[nodiscard]] std::optional<SeenFormula> formula(
      const std::vector<SeenBoundary>& boundaries);

 private:
  struct Line {
    std::array<ExactPoint, 2> ends;
    bool on_source;
    Point at = Point::Zero();  // rounded
    Eigen::Vector3d way = Eigen::Vector3d::Zero();
  };

  [[nodiscard]] std::optional<int> line_of(const SeenSide& side, int plane);
  [[nodiscard]] std::optional<Line> in_source_plane(int face, int plane) const;
  [[nodiscard]] bool same(int line, int other);
  [[nodiscard]] bool add_loop(const SeenBoundary& boundary, SeenFormula& out);
  [[nodiscard]] std::optional<Point> meeting(int line, int other);

  const SourceScene* source_;
  int face_;
  std::map<int, int> planes_;                       // of the source, by source face
  std::map<int, std::array<int, 2>> source_sides_;  // ends, by name
  std::map<std::tuple<SeenSide::Kind, int, int>, int> numbers_;
  std::vector<Line> lines_;
  std::map<std::array<int, 2>, std::optional<Point>> meetings_;
};

}  // namespace sightline::internal
