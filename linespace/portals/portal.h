// One portal, and how an exact line meets it; what portals.cpp and its neighbours share.
//
// Everything here is exact.  Constructed points are homogeneous over Ring; a place along
// a line is a fraction of surds of that line's field.

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "linespace/lines/transversals.h"
#include "linespace/portals.h"
#include "linespace/transversals.h"

namespace sightline::internal {

/// The point x / w, w > 0.
struct HomogeneousPoint {
  RingVector x;
  Ring w = 1;
};
[[nodiscard]] HomogeneousPoint homogeneous(const Eigen::Vector3d& p);
/// Lexicographic order of coordinates.
[[nodiscard]] bool precedes(const HomogeneousPoint& p, const HomogeneousPoint& q);

/// A portal with repeated and flat corners taken out.
struct Portal {
  enum class Shape { Point, Slit, Polygon };
  Shape shape = Shape::Point;
  std::vector<Eigen::Vector3d> corners;
  std::vector<int> names;          ///< of corners and edges, as the caller numbered them
  std::vector<LineThrough> edges;  ///< edge i begins at corner i; none of a point
  bool planar = true;
  // Of a polygon: the plane dot(normal, x) == offset of its first three corners.
  RingVector normal;
  Ring offset = 0;

  [[nodiscard]] int corner_count() const { return static_cast<int>(corners.size()); }
  [[nodiscard]] PlaneThrough plane() const {
    return {corners[0], corners[1], corners[2]};
  }
};

/// Checks and cleans.  Throws InvalidInput: "portal 3: ...".
[[nodiscard]] Portal make_portal(std::span<const Eigen::Vector3d> corners, int index);

/// A place on a line: num / den, den > 0, growing along the line.
struct Place {
  Surd num, den;
};
[[nodiscard]] Sign compare(const Place& a, const Place& b, const Ring& radicand);

/// A generator that a line touches, and where.  Its index is the cleaned portal's.
struct PortalTouch {
  PortalGenerator generator;
  Place at;
};

/// How a line meets a portal: in the places from `first` to `last`.
struct Meeting {
  bool in_plane = false;  ///< of a polygon
  bool along = false;     ///< a slit lies on the line
  std::vector<PortalTouch> touches;
  Place first, last;
};

/// The place of a point of the line.
[[nodiscard]] Place place_of_point(const ExactLine& line, const Eigen::Vector3d& p);

[[nodiscard]] bool meets(const ExactLine& line, const Portal& portal);
/// Requires meets().
[[nodiscard]] Meeting meeting(const ExactLine& line, const Portal& portal, int index);
/// Whether it passes the relative interior of a polygon, not in its plane.
[[nodiscard]] bool crosses_interior(const ExactLine& line, const Portal& portal);

[[nodiscard]] ExactLine line_through(const HomogeneousPoint& p,
                                     const HomogeneousPoint& q);
/// nullopt when p and the lines do not fix one line.
[[nodiscard]] std::optional<ExactLine> line_through(const HomogeneousPoint& p,
                                                    const LineThrough& l,
                                                    const LineThrough& m);
/// The line through p in a polygon's plane that meets l; nullopt when p is not in the
/// plane or does not fix one line.
[[nodiscard]] std::optional<ExactLine> line_in_plane(const HomogeneousPoint& p,
                                                     const LineThrough& l,
                                                     const Portal& polygon);
/// Whether p is on the line of an edge.
[[nodiscard]] bool lies_on(const HomogeneousPoint& p, const LineThrough& edge);
/// Whether p is in the plane of a point and an edge.
[[nodiscard]] bool in_plane_of(const HomogeneousPoint& p, const HomogeneousPoint& point,
                               const LineThrough& edge);

/// On which side of a polygon's plane a point lies.
[[nodiscard]] Sign side_of_plane(const Portal& polygon, const HomogeneousPoint& p);
/// Where an edge crosses a plane; nullopt unless its ends lie strictly on different
/// sides.
[[nodiscard]] std::optional<HomogeneousPoint> crossing(const LineThrough& edge,
                                                       const PlaneThrough& plane);
/// Where an edge's line crosses a plane; nullopt when it is parallel to it or in it.
[[nodiscard]] std::optional<HomogeneousPoint> line_crossing(const LineThrough& edge,
                                                            const PlaneThrough& plane);
/// The common point of two closed segments that are not parallel.
[[nodiscard]] std::optional<HomogeneousPoint> crossing(const LineThrough& e,
                                                       const LineThrough& f);
/// Whether the plane of a polygon meets another portal.
[[nodiscard]] bool plane_meets(const Portal& polygon, const Portal& portal);
/// Whether two portals have a common point.
[[nodiscard]] bool touch(const Portal& a, const Portal& b);
/// Whether relative interiors meet, of portals that do not lie in one plane.
[[nodiscard]] bool interiors_cross(const Portal& a, const Portal& b);

[[nodiscard]] Eigen::Vector3d rounded(const HomogeneousPoint& p);
/// The point at a place of a rational line.
[[nodiscard]] HomogeneousPoint exact_place(const ExactLine& line, const Place& place);
/// The point at a place, as RoundedPoint bounds it.
[[nodiscard]] Eigen::Vector3d rounded_place(const ExactLine& line, const Place& place);

}  // namespace sightline::internal
