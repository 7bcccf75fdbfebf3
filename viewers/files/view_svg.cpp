#include "viewers/files/view_svg.h"

#include <fmt/format.h>

#include <algorithm>

#include "viewers/page.h"
#include "viewers/palette.h"
#include "viewers/queries/view_answer.h"

namespace sightline::viewers {
namespace {

constexpr double kLongerSide = 1000;
constexpr double kVertexRadius = 1.8;

/// From the picture's plane to the units of the file, y down.
class Sheet {
 public:
  explicit Sheet(const PlaneWindow& window)
      : window_(window),
        scale_(kLongerSide / (window.high - window.low).maxCoeff()),
        size_(scale_ * (window.high - window.low)) {}

  [[nodiscard]] const PlanePoint& size() const { return size_; }
  [[nodiscard]] PlanePoint place(const PlanePoint& p) const {
    return {scale_ * (p.x() - window_.low.x()), scale_ * (window_.high.y() - p.y())};
  }

 private:
  PlaneWindow window_;
  double scale_;
  PlanePoint size_;
};

std::string pair_text(const PlanePoint& p) {
  return fmt::format("{:.7g} {:.7g}", p.x(), p.y());
}

std::string style_sheet(const PointView& view, std::size_t edges, bool further) {
  std::string css =
      "  .patch { stroke: none; }\n  line { stroke-linecap: round; }\n"
      "  circle { fill: #16181f; }\n";
  for (const MapEdgeKind kind :
       {MapEdgeKind::Silhouette, MapEdgeKind::Crease, MapEdgeKind::Valley,
        MapEdgeKind::Boundary, MapEdgeKind::Contact, MapEdgeKind::Crossing,
        MapEdgeKind::Cut}) {
    if (kind == MapEdgeKind::Cut &&
        std::ranges::none_of(
            view.edges, [](const MapEdge& e) { return e.kind == MapEdgeKind::Cut; })) {
      continue;
    }
    const LineStyle style = style_of(kind, edges);
    css += fmt::format("  .{} {{ stroke: {}; stroke-width: {:g}; }}\n", name(kind),
                       hex(style.colour), style.width);
  }
  if (!further) return css;
  for (const auto kind : {FurtherLine::Kind::Seam, FurtherLine::Kind::Hidden}) {
    const LineStyle style = style_of(kind, edges);
    css += fmt::format(
        "  .{} {{ stroke: {}; stroke-width: {:g};{} }}\n", name(kind), hex(style.colour),
        style.width, kind == FurtherLine::Kind::Hidden ? " stroke-dasharray: 5 4;" : "");
  }
  return css;
}

std::string path_data(const DrawnRegion& region, const Sheet& sheet) {
  std::string data;
  for (const std::vector<PlanePoint>& ring : region.rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      data += i == 0 ? 'M' : 'L';
      data += pair_text(sheet.place(ring[i]));
    }
    data += 'Z';
  }
  return data;
}

std::string patch_element(const Scene& scene, const MapRegion& region,
                          const DrawnRegion& drawn, const Sheet& sheet) {
  const int object = scene.facets()[region.facets[0]].object;
  const std::string name = html_escaped(scene.objects()[object].name);
  return fmt::format(
      "<path class=\"patch\" fill=\"{}\" fill-rule=\"evenodd\" data-region=\"{}\" "
      "data-patch=\"{}\" data-facets=\"{}\" data-object=\"{}\" d=\"{}\"><title>region "
      "{}: patch {} of {}, facets {}</title></path>\n",
      hex(drawn.colour), drawn.region, fmt::join(region.patches, " "),
      fmt::join(region.facets, " "), name, path_data(drawn, sheet), drawn.region,
      fmt::join(region.patches, " "), name, fmt::join(region.facets, " "));
}

std::string edge_element(const MapEdge& edge, const DrawnEdge& drawn,
                         const Sheet& sheet) {
  const PlanePoint a = sheet.place(drawn.points[0]), b = sheet.place(drawn.points[1]);
  std::string line = fmt::format("{} {}", edge.line.facets[0], edge.line.facets[1]);
  if (edge.line.edge >= 0) line = fmt::format("{}", edge.line.edge);
  if (edge.line.box_side >= 0)
    line = fmt::format("{} {}", edge.line.facets[0], box_side_name(edge.line.box_side));
  return fmt::format(
      "<line class=\"{0}\" data-edge=\"{1}\" data-line=\"{2}\" x1=\"{3:.7g}\" "
      "y1=\"{4:.7g}\" x2=\"{5:.7g}\" y2=\"{6:.7g}\"><title>{7}: {0}</title></line>\n",
      name(edge.kind), drawn.edge, line, a.x(), a.y(), b.x(), b.y(), told(edge.line));
}

std::string further_element(const FurtherLine& line, const DrawnFurther& drawn,
                            const Sheet& sheet) {
  const PlanePoint a = sheet.place(drawn.points[0]), b = sheet.place(drawn.points[1]);
  return fmt::format(
      "<line class=\"{0}\" x1=\"{1:.7g}\" y1=\"{2:.7g}\" x2=\"{3:.7g}\" "
      "y2=\"{4:.7g}\"><title>{5}: {0}</title></line>\n",
      name(line.kind), a.x(), a.y(), b.x(), b.y(), told(line.line));
}

std::string vertex_title(const Scene& scene, const MapVertex& vertex) {
  switch (vertex.kind) {
    case MapVertexKind::Corner:
      return fmt::format("corner {}, vertex {} of the file", vertex.corner,
                         scene.vertex_of(vertex.corner));
    case MapVertexKind::T:
      return fmt::format("{} passes behind {}", told(vertex.far), told(vertex.near));
    default:
      return std::string(name(vertex.kind));
  }
}

std::string vertex_element(const Scene& scene, const MapVertex& vertex,
                           const DrawnVertex& drawn, const Sheet& sheet) {
  const PlanePoint p = sheet.place(drawn.at);
  return fmt::format(
      "<circle class=\"{}\" data-vertex=\"{}\" cx=\"{:.7g}\" cy=\"{:.7g}\" r=\"{:g}\">"
      "<title>{}</title></circle>\n",
      name(vertex.kind), drawn.vertex, p.x(), p.y(), kVertexRadius,
      vertex_title(scene, vertex));
}

}  // namespace

std::string view_svg(const Scene& scene, const PointView& view,
                     const ViewDrawing& drawing) {
  const Sheet sheet(drawing.plane.window());
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.7g} {1:.7g}\" "
      "width=\"{0:.7g}\" height=\"{1:.7g}\">\n<style>\n{2}</style>\n"
      "<rect class=\"paper\" width=\"{0:.7g}\" height=\"{1:.7g}\" fill=\"{3}\"/>\n",
      sheet.size().x(), sheet.size().y(),
      style_sheet(view, drawing.edges.size(), !drawing.further.empty()), hex(kPaper));
  text += "<g id=\"patches\">\n";
  for (const DrawnRegion& drawn : drawing.regions) {
    text += patch_element(scene, view.regions[drawn.region], drawn, sheet);
  }
  if (!drawing.further.empty()) text += "</g>\n<g id=\"further\">\n";
  for (const DrawnFurther& drawn : drawing.further) {
    text += further_element(drawing.further_lines[drawn.line], drawn, sheet);
  }
  text += "</g>\n<g id=\"edges\">\n";
  for (const DrawnEdge& drawn : drawing.edges) {
    text += edge_element(view.edges[drawn.edge], drawn, sheet);
  }
  text += "</g>\n<g id=\"vertices\">\n";
  for (const DrawnVertex& drawn : drawing.vertices) {
    text += vertex_element(scene, view.vertices[drawn.vertex], drawn, sheet);
  }
  return text + "</g>\n</svg>\n";
}

}  // namespace sightline::viewers
