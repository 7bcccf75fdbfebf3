// Views as VTK files: what is seen, where it lies in space and as it is in the picture.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "viewers/pictures/view_drawing.h"

namespace sightline::viewers {

/// A view and what is drawn of it.
struct ViewAndDrawing {
  const PointView* view;
  const ViewDrawing* drawing;
};

/// Writes into `folder` the scene, as write_vtk() does, and of each view, `viewN_` before
/// each name (N from 0):
///   regions.vtp   in space, on the planes of their facets; cell arrays region, patch,
///                 facet (of several the first), facets (text), object, measure (NaN if
///                 infinite)
///   edges.vtp     the pieces of lines in space; edge, line (an edge of the scene; -1 for
///                 a crossing), facets (of a crossing; else -1), kind, ends, left, right
///   vertices.vtp  in space, of points in one line of sight the nearest; vertex, kind,
///                 corner
///   picture_regions.vtp, picture_edges.vtp, picture_vertices.vtp
///                 the same as it is drawn, cut at the window, in the picture's plane
///                 (x, y, 0)
/// Polygons are counter-clockwise as the eye sees them.  A region that is not convex
/// is cut into triangles and trapezoids; `region` tells which belong together.
/// Numbers are those of the answer, `colour` is RGB.  The index sightline.vtm holds
/// what lies in space.  Returns the names of the files.  Of the request, stop, budget
/// and progress count: throws Stopped.  Throws OutputError and WriteError.
std::vector<std::string> write_vtk_views(const std::filesystem::path& folder,
                                         const Scene& scene,
                                         const std::vector<ViewAndDrawing>& views,
                                         const Request& request = {});

}  // namespace sightline::viewers
