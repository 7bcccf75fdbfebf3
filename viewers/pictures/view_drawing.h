// What is drawn of a view: its regions as filled polygons of the picture's plane, its
// edges and vertices, all cut at the window; seams and hidden lines, if asked for.

#pragma once

#include <vector>

#include "viewers/picture.h"
#include "viewers/pictures/picture_plane.h"

namespace sightline::viewers {

/// A region that is no background, to be filled by the even-odd rule.
struct DrawnRegion {
  int region;  ///< position in PointView::regions
  Colour colour;
  std::vector<std::vector<PlanePoint>> rings;
};

struct DrawnEdge {
  int edge;  ///< position in PointView::edges
  std::array<PlanePoint, 2> points;
};

struct DrawnVertex {
  int vertex;  ///< position in PointView::vertices
  PlanePoint at;
};

struct DrawnFurther {
  int line;  ///< position in the list that was given
  std::array<PlanePoint, 2> points;
};

/// What has nothing in the window is not there.
struct ViewDrawing {
  PicturePlane plane;
  std::vector<DrawnRegion> regions;
  std::vector<DrawnEdge> edges;
  std::vector<DrawnVertex> vertices;
  std::vector<DrawnFurther> further;
  std::vector<FurtherLine> further_lines;  ///< as they were given
};

/// Throws InvalidInput as PicturePlane does.
[[nodiscard]] ViewDrawing view_drawing(const Scene& scene, const PointView& view,
                                       const PictureWish& wish = {},
                                       std::vector<FurtherLine> further = {});

/// The directions, or plane points, of the vertices along one walk of a region.
[[nodiscard]] std::vector<Point> ring_of(const PointView& view,
                                         const std::vector<int>& walk);

/// The colour of a facet's object, lighter or darker as the side that is seen is turned
/// to a light above the viewer's left shoulder.
[[nodiscard]] Colour colour_of_facet(const Scene& scene, int facet, const PointView& view,
                                     const PicturePlane& plane,
                                     const std::vector<Colour>& object_colours);

/// Of pictures whose longer side measures 1000.
struct LineStyle {
  Colour colour;
  float width;
};
/// Of a drawing of so many edges: many lines are thin.
[[nodiscard]] LineStyle style_of(MapEdgeKind kind, std::size_t edges = 1);

[[nodiscard]] LineStyle style_of(FurtherLine::Kind kind, std::size_t edges = 1);

/// The paper of these pictures, which is seen where nothing of the scene is.
constexpr Colour kPaper{0.985F, 0.987F, 0.992F};

}  // namespace sightline::viewers
