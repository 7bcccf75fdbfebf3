// The plane of a picture: for an eye the plane before it at distance 1, for a direction
// the plane through the origin across it; and the window of that plane that is drawn.
//
// In doubles, for pictures: nothing is decided on what comes out.

#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "linespace/visibility_map.h"

namespace sightline::viewers {

/// A point of the picture: x to the right, y up.
using PlanePoint = Eigen::Vector2d;

/// A window's lower left and upper right corner.  Requires low < high in x and y.
struct PlaneWindow {
  PlanePoint low, high;
};

/// What the caller wants of the picture; what is not told is chosen to hold what is seen.
struct PictureWish {
  /// In the picture's plane: at distance 1 of an eye, in scene units for a direction.
  std::optional<PlaneWindow> window;
  /// Of an eye: the full angle from left to right and from bottom to top, radians.
  std::optional<double> field_of_view;
  std::optional<Point> up;       ///< a direction of space that points up in the picture
  std::optional<Point> towards;  ///< a point that the eye looks at
};

class PicturePlane {
 public:
  /// The widest angle to which a window is opened to hold all that is seen, radians.
  static constexpr double kWidest = 2 * M_PI / 3;
  /// Of a window that cannot hold all that is seen, radians.
  static constexpr double kUsual = M_PI / 2;

  /// For this view of a scene of these bounds.  Up in the picture is z, but y where the
  /// eye looks along z.  A direction's window holds all that is seen.  An eye looks at
  /// the middle of what is seen with a window that holds it, if that opens by less than
  /// kWidest, and else along the horizontal towards the scene's middle with kUsual.
  /// Throws InvalidInput when the wish's up is along the line of sight, or the eye is the
  /// point that it is to look at.
  PicturePlane(const PointView& view, const std::array<Point, 2>& bounds,
               const PictureWish& wish = {});

  [[nodiscard]] const PlaneWindow& window() const { return window_; }
  /// Right, up and forward: orthogonal unit vectors.
  [[nodiscard]] const std::array<Point, 3>& axes() const { return axes_; }

  /// What a MapVertex::at is in the picture, as (x z, y z, z): z is above 0 before an
  /// eye, and 1 for a direction.
  [[nodiscard]] Point homogeneous(const Point& at) const;

  /// The part in the window of a straight piece, in its direction; nullopt when it is
  /// outside, or a point.
  [[nodiscard]] std::optional<std::array<PlanePoint, 2>> clipped_piece(
      const Point& from, const Point& to) const;
  /// The part in the window of a polygon, that need not be convex: several parts of it
  /// are joined along the window's border, which even-odd filling does not show
  /// (Sutherland and Hodgman 1974).  Empty when it is outside.
  [[nodiscard]] std::vector<PlanePoint> clipped_polygon(std::span<const Point> ats) const;

 private:
  void look(const Point& forward, const std::optional<Point>& up);
  void look_at_what_is_seen(const PointView& view, const std::array<Point, 2>& bounds,
                            const PictureWish& wish);
  /// The smallest window with what is seen; nullopt when some of it is not before the eye
  /// at all.
  [[nodiscard]] std::optional<PlaneWindow> around(const PointView& view) const;
  [[nodiscard]] std::array<double, 4> distances(const Point& homogeneous) const;

  bool parallel_;
  std::array<Point, 3> axes_;
  PlaneWindow window_;
};

}  // namespace sightline::viewers
