#include "viewers/files/view_vtk.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "viewers/files/vtk_cells.h"
#include "viewers/palette.h"
#include "viewers/pictures/trapezoids.h"
#include "viewers/queries/view_answer.h"
#include "viewers/vtk_export.h"

namespace sightline::viewers {
namespace {

using internal::Stage;
using Rings = std::vector<std::vector<PlanePoint>>;

/// The plane of a facet with coordinates in it, counter-clockwise as the eye sees it.
class FacetPlane {
 public:
  FacetPlane(const Scene& scene, int facet, const PointView& view)
      : bounds_(scene.bounds()), view_(view) {
    const auto corners = scene.face_points(scene.facets()[facet].faces[0]);
    origin_ = scene.point(corners[0]);
    u_ = (scene.point(corners[1]) - origin_).stableNormalized();
    const Point w = (scene.point(corners[2]) - origin_).stableNormalized();
    normal_ = u_.cross(w).stableNormalized();
    const Point& eye = view.eye.at.nearest;
    const bool far = view.eye.kind == Viewpoint::Kind::Direction;
    if (normal_.dot(far ? eye : Point(eye - origin_)) < 0) normal_ = -normal_;
    v_ = normal_.cross(u_);
  }

  /// Where the eye sees the plane in this direction, or at this plane point.  What
  /// rounding moves out of the scene's box is moved back to its border.
  [[nodiscard]] PlanePoint seen(const Point& at) const {
    const bool point = view_.eye.kind == Viewpoint::Kind::Eye;
    const Point from = point ? view_.eye.at.nearest : at;
    const Point along = point ? at : view_.eye.at.nearest.stableNormalized();
    const double t = normal_.dot(origin_ - from) / normal_.dot(along);
    Point p = std::isfinite(t) ? Point(from + t * along) : from;
    p = p.cwiseMax(bounds_[0]).cwiseMin(bounds_[1]) - origin_;
    return {p.dot(u_), p.dot(v_)};
  }
  [[nodiscard]] Point in_space(const PlanePoint& p) const {
    return origin_ + p.x() * u_ + p.y() * v_;
  }

 private:
  const std::array<Point, 2>& bounds_;
  const PointView& view_;
  Point origin_, u_, v_, normal_;
};

/// Turns left, or goes straight on, at each corner.
bool is_convex(const std::vector<PlanePoint>& ring) {
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i < n; ++i) {
    const PlanePoint before = ring[(i + 1) % n] - ring[i];
    const PlanePoint after = ring[(i + 2) % n] - ring[(i + 1) % n];
    if (before.x() * after.y() - before.y() * after.x() < 0) return false;
  }
  return true;
}

/// Convex, since not all readers fill others rightly.  The boundary of a region turns
/// once around it, so that left turns alone make it convex.
Rings convex_polygons(const Rings& rings) {
  return rings.size() == 1 && is_convex(rings[0]) ? rings : trapezoids(rings);
}

void add_region(Cells& cells, const Scene& scene, const MapRegion& region, int number,
                const std::vector<Point>& corners, const Colour& colour) {
  std::vector<vtkIdType> ids;
  for (const Point& p : corners) ids.push_back(cells.add_point(p));
  cells.add_polygon(ids, colour);
  cells.value("region", {number});
  cells.value("patch", {region.patches[0]});
  cells.value("facet", {region.facets[0]});
  cells.value("facets", fmt::format("{}", fmt::join(region.facets, " ")));
  cells.value("object", {scene.facets()[region.facets[0]].object});
  cells.value("measure",
              {region.measure.value_or(std::numeric_limits<double>::quiet_NaN())});
}

void add_edge(Cells& cells, const MapEdge& edge, int number, const Point& from,
              const Point& to) {
  cells.add_line(from, to, style_of(edge.kind).colour);
  cells.value("edge", {number});
  cells.value("line", {edge.line.edge});
  cells.value("facets", {edge.line.facets[0], edge.line.facets[1]});
  cells.value("kind", std::string(name(edge.kind)));
  cells.value("ends", {edge.ends[0], edge.ends[1]});
  cells.value("left", {edge.left});
  cells.value("right", {edge.right});
}

void add_vertex(Cells& cells, const MapVertex& vertex, int number, const Point& at) {
  cells.add_vertex(at, {0.09F, 0.09F, 0.12F});
  cells.value("vertex", {number});
  cells.value("kind", std::string(name(vertex.kind)));
  cells.value("corner", {vertex.corner});
}

Cells regions_in_space(const Scene& scene, const PointView& view,
                       const PicturePlane& picture, Stage& stage) {
  Cells cells;
  const std::vector<Colour> colours = object_colours(scene);
  for (std::size_t i = 0; i < view.regions.size(); ++i) {
    stage.at(i, view.regions.size());
    const MapRegion& region = view.regions[i];
    if (region.patches.empty() || region.facets.empty()) continue;
    const FacetPlane plane(scene, region.facets[0], view);
    Rings rings;
    for (const std::vector<int>& walk : region.boundary) {
      std::vector<PlanePoint>& ring = rings.emplace_back();
      for (const Point& at : ring_of(view, walk)) ring.push_back(plane.seen(at));
    }
    for (const std::vector<PlanePoint>& polygon : convex_polygons(rings)) {
      std::vector<Point> corners;
      for (const PlanePoint& p : polygon) corners.push_back(plane.in_space(p));
      add_region(cells, scene, region, static_cast<int>(i), corners,
                 colour_of_facet(scene, region.facets[0], view, picture, colours));
    }
  }
  return cells;
}

Cells edges_in_space(const PointView& view) {
  Cells cells;
  for (std::size_t i = 0; i < view.edges.size(); ++i) {
    const MapEdge& edge = view.edges[i];
    add_edge(cells, edge, static_cast<int>(i), edge.segment[0], edge.segment[1]);
  }
  return cells;
}

/// The nearest end of an edge in this vertex; nullopt where none ends.
std::vector<std::optional<Point>> points_of_vertices(const PointView& view) {
  std::vector<std::optional<Point>> points(view.vertices.size());
  const Point& eye = view.eye.at.nearest;
  const auto depth = [&](const Point& p) {
    return view.eye.kind == Viewpoint::Kind::Eye ? (p - eye).norm() : -p.dot(eye);
  };
  for (const MapEdge& edge : view.edges) {
    for (const int end : {0, 1}) {
      std::optional<Point>& point = points[edge.ends[end]];
      const Point& p = edge.segment[end];
      if (!point || depth(p) < depth(*point)) point = p;
    }
  }
  return points;
}

Cells vertices_in_space(const PointView& view) {
  Cells cells;
  const std::vector<std::optional<Point>> points = points_of_vertices(view);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i]) add_vertex(cells, view.vertices[i], static_cast<int>(i), *points[i]);
  }
  return cells;
}

Point on_paper(const PlanePoint& p) { return {p.x(), p.y(), 0}; }

Cells drawn_regions(const Scene& scene, const PointView& view, const ViewDrawing& drawing,
                    Stage& stage) {
  Cells cells;
  for (const DrawnRegion& drawn : drawing.regions) {
    stage.at(0, drawing.regions.size());
    for (const std::vector<PlanePoint>& polygon : convex_polygons(drawn.rings)) {
      std::vector<Point> corners;
      for (const PlanePoint& p : polygon) corners.push_back(on_paper(p));
      add_region(cells, scene, view.regions[drawn.region], drawn.region, corners,
                 drawn.colour);
    }
  }
  return cells;
}

Cells drawn_edges(const PointView& view, const ViewDrawing& drawing) {
  Cells cells;
  for (const DrawnEdge& drawn : drawing.edges) {
    add_edge(cells, view.edges[drawn.edge], drawn.edge, on_paper(drawn.points[0]),
             on_paper(drawn.points[1]));
  }
  return cells;
}

Cells drawn_vertices(const PointView& view, const ViewDrawing& drawing) {
  Cells cells;
  for (const DrawnVertex& drawn : drawing.vertices) {
    add_vertex(cells, view.vertices[drawn.vertex], drawn.vertex, on_paper(drawn.at));
  }
  return cells;
}

}  // namespace

VtkViews::VtkViews(std::filesystem::path folder, const Scene& scene)
    : folder_(std::move(folder)), scene_(&scene) {}

void VtkViews::add(const PointView& view, const ViewDrawing& drawing,
                   const Request& request) {
  Stage stage(request, "VTK files");
  make_folder(folder_);
  const std::string prefix = fmt::format("view{}_", count_++);
  const auto write = [&](const std::string& name, const Cells& cells, bool in_space) {
    if (cells.empty()) return;
    const std::string block = prefix + name;
    files_.push_back(
        {block, poly_data_file(folder_ / (block + ".vtp"), cells.poly_data(), stage)});
    if (in_space) blocks_.push_back(block);
  };
  write("regions", regions_in_space(*scene_, view, drawing.plane, stage), true);
  write("edges", edges_in_space(view), true);
  write("vertices", vertices_in_space(view), true);
  write("picture_regions", drawn_regions(*scene_, view, drawing, stage), false);
  write("picture_edges", drawn_edges(view, drawing), false);
  write("picture_vertices", drawn_vertices(view, drawing), false);
}

std::vector<std::string> VtkViews::finish(const Request& request) {
  std::vector<std::string> names = write_vtk(folder_, *scene_, {}, request);
  begin_vtk_folder(folder_);
  std::erase(names, kVtkIndex);
  for (const auto& [block, file] : files_) {
    file->commit();
    names.push_back(block + ".vtp");
  }
  write_whole(folder_ / kVtkIndex, multi_block_text(blocks_));
  names.emplace_back(kVtkIndex);
  return names;
}

}  // namespace sightline::viewers
