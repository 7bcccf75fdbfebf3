#include "viewers/pictures/view_drawing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "viewers/palette.h"

namespace sightline::viewers {
namespace {

bool is_inside(const PlanePoint& p, const PlaneWindow& window) {
  return (p.array() >= window.low.array()).all() &&
         (p.array() <= window.high.array()).all();
}

void add_regions(ViewDrawing& drawing, const Scene& scene, const PointView& view) {
  const std::vector<Colour> colours = object_colours(scene);
  for (std::size_t i = 0; i < view.regions.size(); ++i) {
    const MapRegion& region = view.regions[i];
    if (region.patches.empty() || region.facets.empty()) continue;
    DrawnRegion drawn{
        static_cast<int>(i),
        colour_of_facet(scene, region.facets[0], view, drawing.plane, colours),
        {}};
    for (const std::vector<int>& walk : region.boundary) {
      std::vector<PlanePoint> ring = drawing.plane.clipped_polygon(ring_of(view, walk));
      if (!ring.empty()) drawn.rings.push_back(std::move(ring));
    }
    if (!drawn.rings.empty()) drawing.regions.push_back(std::move(drawn));
  }
}

void add_edges(ViewDrawing& drawing, const PointView& view) {
  for (std::size_t i = 0; i < view.edges.size(); ++i) {
    const auto [from, to] = view.edges[i].ends;
    const auto piece =
        drawing.plane.clipped_piece(view.vertices[from].at, view.vertices[to].at);
    if (piece) drawing.edges.push_back({static_cast<int>(i), *piece});
  }
}

void add_vertices(ViewDrawing& drawing, const PointView& view) {
  for (std::size_t i = 0; i < view.vertices.size(); ++i) {
    const Point h = drawing.plane.homogeneous(view.vertices[i].at);
    if (!(h.z() > 0)) continue;
    const PlanePoint p = h.head<2>() / h.z();
    if (!is_inside(p, drawing.plane.window())) continue;
    drawing.vertices.push_back({static_cast<int>(i), p});
  }
}

// From 400 edges on the ink stays about the same, down to a quarter of the width.
LineStyle thinned(LineStyle style, std::size_t edges) {
  const double thinner = 20 / std::sqrt(static_cast<double>(edges));
  style.width *= static_cast<float>(std::clamp(thinner, 0.25, 1.0));
  return style;
}

}  // namespace

ViewDrawing view_drawing(const Scene& scene, const PointView& view,
                         const PictureWish& wish, std::vector<FurtherLine> further) {
  ViewDrawing drawing{PicturePlane(view, scene.bounds(), wish), {}, {}, {}, {}, {}};
  for (std::size_t i = 0; i < further.size(); ++i) {
    const auto piece = drawing.plane.clipped_piece(further[i].at[0], further[i].at[1]);
    if (piece) drawing.further.push_back({static_cast<int>(i), *piece});
  }
  drawing.further_lines = std::move(further);
  add_regions(drawing, scene, view);
  add_edges(drawing, view);
  add_vertices(drawing, view);
  return drawing;
}

std::vector<Point> ring_of(const PointView& view, const std::vector<int>& walk) {
  std::vector<Point> ring;
  for (const int half : walk) {
    ring.push_back(view.vertices[view.edges[half / 2].ends[half % 2]].at);
  }
  return ring;
}

Colour colour_of_facet(const Scene& scene, int facet, const PointView& view,
                       const PicturePlane& plane,
                       const std::vector<Colour>& object_colours) {
  const Facet& f = scene.facets()[facet];
  const auto corners = scene.face_points(f.faces[0]);
  const Point& a = scene.point(corners[0]);
  Point normal = (scene.point(corners[1]) - a)
                     .stableNormalized()
                     .cross((scene.point(corners[2]) - a).stableNormalized())
                     .stableNormalized();
  const Point& eye = view.eye.at.nearest;
  const bool far = view.eye.kind == Viewpoint::Kind::Direction;
  if (normal.dot(far ? eye : Point(eye - a)) < 0) normal = -normal;
  const auto& [right, up, forward] = plane.axes();
  const Point light = (0.70 * up - 0.42 * right - 0.58 * forward).normalized();
  const auto shade = static_cast<float>(0.78 + 0.22 * normal.dot(light));
  const Colour& c = object_colours[f.object];
  return {shade * c.red, shade * c.green, shade * c.blue};
}

LineStyle style_of(MapEdgeKind kind, std::size_t edges) {
  static constexpr LineStyle kStyles[] = {{{0.08F, 0.09F, 0.12F}, 2.4F},   // silhouette
                                          {{0.22F, 0.23F, 0.27F}, 1.2F},   // crease
                                          {{0.38F, 0.40F, 0.46F}, 1.2F},   // valley
                                          {{0.08F, 0.20F, 0.27F}, 2.0F},   // boundary
                                          {{0.36F, 0.22F, 0.50F}, 1.2F},   // contact
                                          {{0.84F, 0.15F, 0.24F}, 1.4F},   // crossing
                                          {{0.04F, 0.04F, 0.06F}, 3.6F}};  // cut
  return thinned(kStyles[static_cast<int>(kind)], edges);
}

LineStyle style_of(FurtherLine::Kind kind, std::size_t edges) {
  const bool seam = kind == FurtherLine::Kind::Seam;
  return thinned(seam ? LineStyle{{0.58F, 0.60F, 0.65F}, 0.8F}
                      : LineStyle{{0.45F, 0.48F, 0.56F}, 0.9F},
                 edges);
}

}  // namespace sightline::viewers
