// Scenes and skeletons as VTK files, with a .vtm that ParaView opens ready to look at.

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "skeleton/graph.h"
#include "viewers/drawing.h"

namespace sightline {
struct Shadows;
class ShadowVolumes;
}  // namespace sightline

namespace sightline::viewers {

/// What goes into the files besides the scene; pointers may be null.
struct VtkContents {
  const Skeleton* skeleton = nullptr;
  /// Arcs drawn out to their far ends, as a block of their own.
  const std::vector<RuledStrip>* strips = nullptr;
  /// Discontinuity meshes.
  const Shadows* shadows = nullptr;
  /// Umbra and penumbra in space.
  const ShadowVolumes* volumes = nullptr;
};

/// Writes into `folder` (made if need be) and returns the names of the files:
///   scene.vtp   polygons of the file; cell arrays polygon, face, facet, object, colour;
///               field array object_names
///   edges.vtp   generating edges as lines; edge, edge_kind, object, colour
///   arcs_EV.vtp, arcs_EV_self.vtp
///               an arc is the triangle between its vertex and its part of the edge; arc,
///               vertex, edge, range, nodes, kind, colour
///   arcs_EEE.vtp, arcs_EEE_self.vtp
///               an arc is its lines between the outer edges as one triangle strip, at
///               most kEeeDeviation of the scene's diagonal from the ruled surface; arc
///               (counts on from the EV arcs), edges, objects, range, nodes, kind,
///               colour; field array deviation (scene units)
///   strips_EV.vtp, ...
///               arcs as ruled strips from far end to far end; arc, side (0 before the
///               contacts, 1 behind them), far_polygon (-1 outside), colour
///   nodes_VV.vtp, nodes_VEE.vtp, ...
///               an extremal line's part between its outermost contacts; node,
///               generators (text), self, end, kind, colour; of an EEEE also second
///   shadow_faces.vtp
///               the faces of discontinuity meshes, curves as chords; receiver (name),
///               facet, face, class, structure, area (scene units squared).  A face that
///               is not convex is cut into triangles and trapezoids; `face` tells which
///               belong together
///   shadow_edges.vtp
///               their edges, a line for each chord; receiver, facet, edge, kind, order
///               (-1 for none), left, right
///   shadow_vertices.vtp
///               their vertices; receiver, facet, vertex.  Numbers are those of the
///               answer of `sightline shadows --list`
///   shadow_umbra.vtp, shadow_penumbra.vtp
///               the surfaces of the volumes, a polygon each side; side, kind, generators
///   sightline.vtm
///               all of these as named blocks
/// A cell of an EEE arc takes some 100 bytes and 60 a line of its strip, in memory and in
/// the file alike.  `colour` is an RGB array and the active scalars.  Each file is
/// written whole or not at all.  Of the request, stop, budget and progress count: throws
/// Stopped, and then the index is not written.  Throws OutputError.
std::vector<std::string> write_vtk(const std::filesystem::path& folder,
                                   const Scene& scene, const VtkContents& contents,
                                   const Request& request = {});

/// Whether write_vtk or write_vtk_lines may write a file of this name.
[[nodiscard]] bool is_vtk_name(const std::string& name);

/// Straight pieces, or polygons, of one kind, with what they are called and told of.
struct LineBlock {
  struct Piece {
    Point from, to;
    std::string note;  ///< goes into the cell array `note`
  };
  struct Polygon {
    std::vector<Point> corners;
    std::string note;
  };
  std::string name;
  std::string kind;  ///< chooses the colour, as colour_of_kind
  std::vector<Piece> pieces;
  std::vector<Polygon> polygons = {};
};

/// For answers without a scene: each block that is not empty as NAME.vtp, lines and then
/// polygons with the cell arrays kind, id (position in the block), note, colour; and
/// sightline.vtm over all. Returns the names of the files.  Throws OutputError.
std::vector<std::string> write_vtk_lines(const std::filesystem::path& folder,
                                         const std::vector<LineBlock>& blocks,
                                         const Request& request = {});

/// What view can show of files written by write_vtk or write_vtk_lines.
struct VtkPicture {
  PolygonSoup soup;                 ///< the block "scene"; empty where there is none
  std::vector<VeilTriangle> veils;  ///< arcs, strips and other polygons
  std::vector<Stroke> strokes;      ///< nodes and other lines
};

/// Reads a .vtm of ours, or a single .vtp of ours with the scene.vtp beside it, if any.
/// Throws InvalidInput, also when there is nothing to show.
[[nodiscard]] VtkPicture read_vtk(const std::filesystem::path& file);

}  // namespace sightline::viewers
