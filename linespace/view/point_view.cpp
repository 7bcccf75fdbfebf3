#include "linespace/point_view.h"

#include <algorithm>
#include <string>

#include "linespace/numbers/exact_position.h"
#include "linespace/picture/view_scene.h"
#include "linespace/view/further_lines.h"
#include "linespace/view/line_view.h"
#include "linespace/view/possibly_seen.h"
#include "linespace/view/view_accidents.h"
#include "linespace/view/view_graph.h"
#include "linespace/view/view_map.h"
#include "linespace/view/view_measures.h"
#include "linespace/view/view_structure.h"
#include "linespace/work/stage.h"

namespace sightline {

using namespace internal;

namespace {

BoxCut box_cut(const ViewBox& box) {
  for (const ExactPosition* corner : {&box.low, &box.high}) {
    for (const double x : corner->nearest) {
      if (!is_admissible(x))
        throw InvalidInput("the box: a coordinate outside [2^-140, 2^140]");
    }
  }
  return {exact_point(box.low), exact_point(box.high)};
}

}  // namespace

ViewBox view_box(const Point& low, const Point& high) {
  return {eye_at(low).at, eye_at(high).at};
}

ViewBox view_box(const std::array<std::string, 6>& bounds) {
  const auto corner = [&](int first) {
    return viewpoint(Viewpoint::Kind::Eye,
                     {bounds[first], bounds[first + 1], bounds[first + 2]})
        .at;
  };
  ViewBox box{corner(0), corner(3)};
  (void)box_cut(box);
  return box;
}

struct PointViewIndex::Impl {
  Impl(const Scene& s, const std::optional<BoxCut>& box, const Request& request)
      : scene(s, box, request) {}
  ViewScene scene;
};

PointViewIndex::PointViewIndex(const Scene& scene, const Request& request)
    : impl_(std::make_unique<Impl>(scene, std::nullopt, request)) {}
PointViewIndex::PointViewIndex(const Scene& scene, const ViewBox& box,
                               const Request& request)
    : impl_(std::make_unique<Impl>(scene, box_cut(box), request)) {}
PointViewIndex::~PointViewIndex() = default;
PointViewIndex::PointViewIndex(PointViewIndex&&) noexcept = default;

int PointViewIndex::patch_of(int facet, bool front) const {
  return impl_->scene.patch(facet, front);
}

const ViewScene& PointViewIndex::shared() const { return impl_->scene; }

namespace {

// Lines beside which a face that may be seen ends, or is cut by another, each once.
std::vector<int> lines_to_ask(const ViewScene& scene, const EyeStar& star,
                              std::span<const std::uint8_t> possibly_seen) {
  std::vector<int> lines(star.sides().begin(), star.sides().end());
  for (std::size_t l = scene.first_window_line(); l < scene.lines().size(); ++l)
    lines.push_back(static_cast<int>(l));
  for (int f = 0; f < static_cast<int>(possibly_seen.size()); ++f) {
    if (possibly_seen[f] == 0) continue;
    const int sides = static_cast<int>(scene.corners(f).size());
    for (int k = 0; k < sides; ++k) {
      if (const int line = scene.line_of_side(f, k); line >= 0) lines.push_back(line);
    }
    for (const int line : scene.crossings_of(f)) lines.push_back(line);
  }
  std::ranges::sort(lines);
  lines.erase(std::ranges::unique(lines).begin(), lines.end());
  return lines;
}

// The graph of all that is seen, and what it was made with.
struct Sight {
  Sight(const ViewScene& scene, const Viewpoint& eye, Stage& stage)
      : space(scene, eye),
        seen(possibly_seen(space)),
        star(space),
        window(space),
        viewer(space, star, window, seen) {
    std::vector<LinePiece> pieces;
    const std::vector<int> lines = lines_to_ask(scene, star, seen);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      stage.at(i, lines.size());
      viewer.view(lines[i], pieces);
    }
    graph = join_pieces(space, star, pieces, seen);
    stage.check(0.8);
  }

  EyeSpace space;
  std::vector<std::uint8_t> seen;
  EyeStar star;
  Window window;
  LineViewer viewer;
  ViewGraph graph;
};

PointView seen_from(const ViewScene& scene, const Viewpoint& eye,
                    const Request& request) {
  const PrecisionScope precision(request.precision);
  Stage stage(request, "view");
  Sight sight(scene, eye, stage);
  const EyeSpace& space = sight.space;
  const EyeStar& star = sight.star;
  const ViewGraph& graph = sight.graph;
  const SuspectPoints suspects = suspect_points(space, sight.viewer);
  ViewMap map = make_map(space, graph, suspects.points, sight.seen);

  PointView view;
  view.eye = eye;
  view.place = star.place();
  view.place_ids = star.ids();
  std::vector<bool> background;
  for (const MapRegion& r : map.regions) background.push_back(r.patches.empty());
  const ViewMeasures measures = measure(space, graph, map.region_of, background);
  view.accidents =
      find_accidents(space, sight.window, sight.viewer, suspects, sight.seen);
  if (!star.faces().empty()) {
    const GeneratorKind kind = star.place() == EyePlace::Corner ? GeneratorKind::Vertex
                               : star.place() == EyePlace::Edge ? GeneratorKind::Edge
                                                                : GeneratorKind::Face;
    Accident on_scene{AccidentKind::OnScene, {}};
    for (const int id : star.ids()) on_scene.generators.push_back({kind, id});
    view.accidents.push_back(std::move(on_scene));
  }
  view.general = view.accidents.empty();
  if (view.general) view.structure = structure_of(scene, map);
  for (const ViewMeasures::OfFacet& f : measures.facets) {
    SeenFacet seen_facet{f.side / 2, f.side % 2 == 0, f.pieces, f.measure, std::nullopt};
    if (!space.is_direction() && view.general) seen_facet.gradient = f.gradient;
    view.facets.push_back(seen_facet);
  }
  for (std::size_t r = 0; r < map.regions.size(); ++r) {
    map.regions[r].measure = measures.regions[r];
  }
  view.vertices = std::move(map.vertices);
  view.edges = std::move(map.edges);
  view.regions = std::move(map.regions);
  view.components = map.components;
  view.background_pieces = map.background_pieces;
  view.seams = map.seams;
  return view;
}

}  // namespace

PointView PointViewIndex::view(const Viewpoint& eye, const Request& request) const {
  return seen_from(impl_->scene, eye, request);
}

PointView PointViewIndex::view_through(const Viewpoint& eye,
                                       std::span<const Point> window,
                                       const Request& request) const {
  if (window.size() < 3)
    throw InvalidInput("the window: a polygon of three corners or more");
  for (const Point& p : window) {
    for (const double x : p) {
      if (!is_admissible(x))
        throw InvalidInput("the window: a coordinate outside [2^-140, 2^140]");
    }
  }
  return seen_from(impl_->scene.with_window(window), eye, request);
}

std::vector<FurtherLine> PointViewIndex::further_lines(const Viewpoint& eye, bool seams,
                                                       bool hidden,
                                                       const Request& request) const {
  const PrecisionScope precision(request.precision);
  Stage stage(request, "further lines");
  const Sight sight(impl_->scene, eye, stage);
  std::vector<FurtherLine> lines;
  if (seams) {
    lines = seam_lines(sight.space, sight.graph,
                       make_map(sight.space, sight.graph, {}, sight.seen));
  }
  if (hidden) {
    const auto more = hidden_lines(sight.space, sight.star);
    lines.insert(lines.end(), more.begin(), more.end());
  }
  return lines;
}

}  // namespace sightline
