// A picture of a scene as its area lights shine on it, without what surfaces reflect.
//
// Neighbours: backprojection.h answers a pixel's point; viewers make an image of it.

#pragma once

#include <cstdint>
#include <vector>

#include "linespace/occlusion.h"
#include "shadows/backprojection.h"

namespace sightline {

/// A camera of perspective.
struct PictureCamera {
  Point eye;
  Point towards;       ///< in the picture's middle; another point than the eye
  Eigen::Vector3d up;  ///< not along the line of sight
  double fov = 1;      ///< from the left to the right, radians, below pi
  int width = 0, height = 0;
};

struct LitPixel {
  enum class Kind : std::uint8_t { Nothing, Source, Surface };
  Kind kind = Kind::Nothing;
  int face = -1;  ///< the first face on the ray through the pixel's centre
  /// Surface: form factor of the point that is seen, on the side that is seen, to the
  /// source: irradiance over the source's radiosity.  Source: 1.
  double value = 0;
};

/// Rows from the top, each from the left.  rays = 0: the face on the ray through each
/// pixel's centre, and what the point on it sees of the light, exactly; the point is the
/// nearest one of doubles, moved exactly onto the face's plane.  rays > 0: instead, that
/// many random points of the source, uniform over its area, each asked whether it is
/// seen from a point 2^-40 of its coordinates' size before the face; `seed` tells which.
/// The request's threads, budget, stop and progress are heard; throws Stopped.
[[nodiscard]] std::vector<LitPixel> lit_picture(const OcclusionIndex& occlusion,
                                                const BackprojectionIndex& light,
                                                const LightSource& source,
                                                const PictureCamera& camera, int rays,
                                                std::uint64_t seed,
                                                const Request& request = {});

/// The same with rays = 0 at a fraction of the cost, for people to look at.  Kind and
/// face of every pixel are those of lit_picture(), and so are values on a grid, one pixel
/// of eight.  The grid is refined until it has every pixel: one whose four neighbours
/// show its facet, none of them dark where another is not, and differ by at most
/// `tolerance` times the brightest pixel of the first grid, has their mean, and all
/// others are exact. What changes only between the pixels of the grid is not seen.
/// Requires tolerance >= 0. Throws as lit_picture().
[[nodiscard]] std::vector<LitPixel> smooth_lit_picture(const OcclusionIndex& occlusion,
                                                       const BackprojectionIndex& light,
                                                       const LightSource& source,
                                                       const PictureCamera& camera,
                                                       double tolerance,
                                                       const Request& request = {});

}  // namespace sightline
