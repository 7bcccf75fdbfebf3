// Views as VTK files: what is seen, where it lies in space and as it is in the picture.

#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "viewers/output_file.h"
#include "viewers/pictures/view_drawing.h"

namespace sightline::viewers {

/// Writes into a folder the scene, as write_vtk() does, and of each view, `viewN_` before
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
/// what lies in space.  A view is written when it is added and needs not be held; the
/// files get their names in finish(), the index last.  Destroyed without finish(), it
/// leaves nothing but the folder.
class VtkViews {
 public:
  /// Keeps a reference to the scene.
  VtkViews(std::filesystem::path folder, const Scene& scene);

  /// Writes the files of the next view.  Of the request, stop, budget and progress count:
  /// throws Stopped.  Throws OutputError and WriteError.
  void add(const PointView& view, const ViewDrawing& drawing,
           const Request& request = {});
  /// Writes the scene, names all files and returns these names.  Throws as add() does;
  /// then the index is not written.
  std::vector<std::string> finish(const Request& request = {});

 private:
  std::filesystem::path folder_;
  const Scene* scene_;
  int count_ = 0;
  struct Waiting {
    std::string block;
    std::unique_ptr<OutputFile> file;
  };
  std::vector<Waiting> files_;
  std::vector<std::string> blocks_{"scene", "edges"};  // of the index
};

}  // namespace sightline::viewers
