#include "aspect/exact/general_aspects.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <set>

#include "aspect/cells/inner_point.h"
#include "aspect/cells/space_bounds.h"
#include "aspect/cells/space_cells.h"
#include "aspect/cells/sphere_cells.h"
#include "aspect/exact/event_surfaces.h"
#include "aspect/sampled/sampled_aspects.h"
#include "aspect/views/labels.h"
#include "aspect/views/sample_space.h"
#include "linespace/numbers/exact_position.h"
#include "linespace/path/path_names.h"
#include "linespace/picture/classes.h"
#include "linespace/picture/view_scene.h"
#include "linespace/sight/face_crossings.h"
#include "linespace/work/deadline.h"
#include "linespace/work/parallel.h"
#include "skeleton/build.h"

namespace sightline::internal {
namespace {

// So many cells take minutes: n^2 of directions, n^3 / 6 of points.
constexpr std::size_t kMostCircles = 600, kMostPlanes = 100;

// The surfaces that cut view space, and the cells between them.
class EventCells {
 public:
  // nullopt where there are too many, or all directions or points are alike along some
  // axis.
  static std::optional<EventCells> of(const Scene& scene, const Request& left,
                                      const AspectRequest& request) {
    EventCells out;
    if (request.projection == Projection::Orthographic) {
      auto circles = event_circles(scene, kMostCircles);
      if (!circles || !span_space(*circles)) return std::nullopt;
      out.normals_ = std::move(*circles);
      out.sphere_.emplace(sphere_cells(out.normals_));
      return out;
    }
    auto planes = event_planes(scene, kMostPlanes);
    if (!planes) return std::nullopt;
    out.planes_ = std::move(*planes);
    if (request.bounds) out.bounds_ = add_bounds(out.planes_, *request.bounds);
    std::vector<CircleNormal> normals;
    for (const LightPlane& p : out.planes_) normals.push_back(normal_of(p));
    if (!span_space(normals)) return std::nullopt;
    out.space_.emplace(space_cells(out.planes_, left));
    return out;
  }

  struct Wall {
    int negative, positive;  // cells
    int surface;             // a circle or a plane
    int number;              // among walls of the sphere or of space
  };
  [[nodiscard]] std::vector<Wall> walls() const {
    std::vector<Wall> out;
    const auto add = [&](const auto& all, auto surface) {
      for (const auto& w : all)
        out.push_back({w.negative, w.positive, w.*surface, static_cast<int>(out.size())});
    };
    sphere_ ? add(sphere_->walls, &SphereCells::Wall::circle)
            : add(space_->walls, &SpaceCells::Wall::plane);
    return out;
  }
  [[nodiscard]] const SignTable& table() const {
    return sphere_ ? sphere_->cells : space_->cells;
  }
  [[nodiscard]] bool in_bounds(int cell) const {
    return !space_ || within(space_->cells, cell, bounds_);
  }
  [[nodiscard]] bool unbounded(int cell) const {
    return space_ && space_->unbounded[cell];
  }
  // Euler's formula on the sphere, and in space for cells of planes that span it.
  [[nodiscard]] bool closes() const {
    const auto cells = static_cast<long>(table().size());
    if (sphere_) {
      return static_cast<long>(sphere_->vertices) -
                 static_cast<long>(sphere_->walls.size()) + cells ==
             2;
    }
    return static_cast<long>(space_->vertices) - static_cast<long>(space_->edges) +
               static_cast<long>(space_->walls.size()) - cells ==
           -1;
  }

  struct Inside {
    ExactPoint at;
    double weight = 0, clearance = 0;
  };
  // Of every cell its sides; then a viewpoint inside.
  void collect_sides() {
    arcs_.resize(sphere_ ? table().size() : 0);
    sides_.resize(sphere_ ? 0 : table().size());
    if (sphere_) {
      for (const SphereCells::Wall& w : sphere_->walls) {
        arcs_[w.negative].push_back({false, &w});
        arcs_[w.positive].push_back({true, &w});
      }
    } else {
      for (const SpaceCells::Wall& w : space_->walls) {
        sides_[w.negative].push_back({&planes_[w.plane], false});
        sides_[w.positive].push_back({&planes_[w.plane], true});
      }
    }
  }
  [[nodiscard]] Inside inside(int cell, const Scene& scene,
                              const AspectRequest& request) const {
    if (sphere_) {
      const InnerDirection inner = inner_direction(normals_, arcs_[cell]);
      return {inner.at, inner.solid_angle, inner.clearance};
    }
    const InnerPoint inner = inner_point(sides_[cell], scene.bounds());
    const double volume =
        request.list ? volume_in(view_box(scene, request), sides_[cell]) : 0;
    return {inner.at, volume, inner.clearance};
  }
  // A point inside a wall between two cells, given one inside each; nullopt where the
  // straight way between these leaves the two cells.
  [[nodiscard]] std::optional<ExactPoint> on_wall(const Wall& wall, const ExactPoint& a,
                                                  const ExactPoint& b) const {
    return sphere_ ? std::optional(on_arc(sphere_->walls[wall.number]))
                   : on_piece(wall, a, b);
  }

 private:
  // Arcs are shorter than half a turn: the sum of their ends is between them.
  [[nodiscard]] ExactPoint on_arc(const SphereCells::Wall& w) const {
    ExactPoint sum{};
    for (const SphereCells::Vertex& v : {w.from, w.to}) {
      const RingVector d = cross(normals_[v.a].exact, normals_[v.b].exact);
      ExactPoint p{rational(d[0]), rational(d[1]), rational(d[2])};
      const double length = rounded(p).norm();
      for (int i = 0; i < 3; ++i)
        sum[i] += (v.opposite ? Rational(-1) : Rational(1)) * p[i] / Rational(length);
    }
    return sum;
  }
  [[nodiscard]] static Rational value_at(const LightPlane& plane, const ExactPoint& p) {
    Rational out = rational(plane.exact[3]);
    for (int i = 0; i < 3; ++i) out += rational(plane.exact[i]) * p[i];
    return out;
  }
  [[nodiscard]] std::optional<ExactPoint> on_piece(const Wall& wall, const ExactPoint& a,
                                                   const ExactPoint& b) const {
    const LightPlane* own = &planes_[space_->walls[wall.number].plane];
    const Rational x = value_at(*own, a), y = value_at(*own, b);
    const ExactPoint p = along(a, b, Rational(x / (x - y)));
    for (const int cell : {wall.negative, wall.positive}) {
      for (const SignedPlane& side : sides_[cell]) {
        if (side.plane == own) continue;
        const Rational value = value_at(*side.plane, p);
        if (side.positive ? value <= 0 : value >= 0) return std::nullopt;
      }
    }
    return p;
  }

  std::vector<CircleNormal> normals_;
  std::vector<LightPlane> planes_;  // of events, then of bounds
  std::vector<BoundSide> bounds_;
  std::optional<SphereCells> sphere_;
  std::optional<SpaceCells> space_;
  std::vector<std::vector<SphereArc>> arcs_;
  std::vector<std::vector<SignedPlane>> sides_;
};

// Lines that touch three edges and go on, or end at the last: in polygon mode the
// skeleton has all of them.
bool has_three_edge_events(const Scene& scene, const Request& left) {
  SkeletonRequest request;
  static_cast<Request&>(request) = left;
  request.ev = false;
  request.events = EventMode::Polygon;
  const Skeleton skeleton = build_skeleton(scene, request);
  if (!skeleton.complete) throw Stopped("events of three edges", 0);
  return !skeleton.arcs.empty();
}

class GeneralGraph {
 public:
  GeneralGraph(const Scene& scene, const AspectRequest& request, const Deadline& deadline,
               EventCells cells)
      : scene_(&scene),
        request_(&request),
        deadline_(&deadline),
        index_(scene, request),
        cells_(std::move(cells)) {
    cells_.collect_sides();
  }

  // nullopt where a view inside a cell lies on an event.
  std::optional<AspectGraph> graph() {
    const auto n = static_cast<std::size_t>(cells_.table().size());
    inside_.resize(n);
    labels_.resize(n);
    AspectGraph out;
    try {
      look();
    } catch (const Stopped&) {
      out.complete = false;
    }
    if (on_event_) return std::nullopt;
    join();
    out.method = AspectMethod::Exact;
    out.certified = out.complete && cells_.closes();
    out.views = views_;
    count(out);
    if (request_->list) list(out);
    if (out.complete && request_->check > 0) check(out);
    return out;
  }

 private:
  void look() {
    const auto n = inside_.size();
    const Request left = deadline_->what_is_left(*request_);
    Stage stage(left, "views of cells");
    std::atomic<std::size_t> views{0};
    std::atomic<bool> on_event{false};
    const auto step = [&](std::size_t i) {
      const int cell = static_cast<int>(i);
      if (!cells_.in_bounds(cell)) return;
      inside_[i] = cells_.inside(cell, *scene_, *request_);
      const PointView view = index_.view(viewpoint_at_exactly(inside_[i].at));
      ++views;
      if (view.place == EyePlace::Inside) return;
      if (view.place != EyePlace::Free || !view.general) {
        on_event = true;
        return;
      }
      labels_[i] = labels_of(view, *scene_, *request_);
    };
    try {
      for_each_of(0, n, n, left, stage, step);
    } catch (const Stopped&) {
      views_ = views;
      throw;
    }
    views_ = views;
    on_event_ = on_event;
  }
  [[nodiscard]] Viewpoint viewpoint_at_exactly(const ExactPoint& p) const {
    const bool far = request_->projection == Projection::Orthographic;
    return {far ? Viewpoint::Kind::Direction : Viewpoint::Kind::Eye, exact_position(p)};
  }

  void join() {
    walls_ = cells_.walls();
    Classes classes(labels_.size());
    for (const EventCells::Wall& w : walls_) {
      const auto &a = labels_[w.negative], &b = labels_[w.positive];
      if (a && b && a->label == b->label) classes.join(w.negative, w.positive);
    }
    number_.assign(labels_.size(), -1);
    for (std::size_t c = 0; c < labels_.size(); ++c) {
      if (!labels_[c]) continue;
      const int root = classes.root(static_cast<int>(c));
      if (root == static_cast<int>(c)) {
        number_[c] = static_cast<int>(members_.size());
        members_.emplace_back();
      }
      number_[c] = number_[root];
      members_[number_[c]].push_back(static_cast<int>(c));
    }
  }

  void count(AspectGraph& out) const {
    std::set<std::string> labels, faces, shapes;
    std::size_t unbounded = 0;
    for (const auto& cells : members_) {
      labels.insert(labels_[cells.front()]->label);
      unbounded += std::ranges::any_of(cells, [&](int c) { return cells_.unbounded(c); });
      for (const int c : cells) {
        faces.insert(labels_[c]->faces);
        shapes.insert(labels_[c]->shape);
      }
    }
    out.aspects = members_.size();
    out.distinct = labels.size();
    out.by_visible_faces = faces.size();
    out.by_shape = shapes.size();
    std::set<std::array<int, 2>> pairs;
    for (const EventCells::Wall& w : walls_) {
      if (const auto pair = between(w)) pairs.insert(*pair);
    }
    out.adjacencies = pairs.size();
    if (request_->projection == Projection::Perspective && !request_->bounds) {
      out.unbounded = unbounded;
      out.bounded = out.aspects - unbounded;
    }
  }
  // Two aspects, ascending; nullopt for a wall inside one or beside none.
  [[nodiscard]] std::optional<std::array<int, 2>> between(
      const EventCells::Wall& w) const {
    const int a = number_[w.negative], b = number_[w.positive];
    if (a < 0 || b < 0 || a == b) return std::nullopt;
    return std::array{std::min(a, b), std::max(a, b)};
  }

  void list(AspectGraph& out) {
    for (const auto& cells : members_) {
      const int best = *std::ranges::max_element(
          cells, {}, [&](int c) { return inside_[c].clearance; });
      Aspect& aspect = out.list.emplace_back();
      aspect.at = viewpoint_at_exactly(inside_[best].at);
      double weight = 0;
      for (const int c : cells) weight += inside_[c].weight;
      aspect.weight = weight;
      // A cell's own surfaces need not be walls.
      if (cells.size() == 1) aspect.clearance = inside_[best].clearance;
      aspect.facets = labels_[best]->facets;
      aspect.structure = labels_[best]->structure;
    }
    std::map<std::array<int, 2>, std::set<AspectWall>> events;
    const auto told = one_wall_each();
    const auto found = events_of(told, out);
    for (std::size_t i = 0; i < told.size(); ++i)
      events[*between(*told[i])].insert(found[i].begin(), found[i].end());
    for (const auto& [pair, of_pair] : events) {
      const std::vector<AspectWall> walls(of_pair.begin(), of_pair.end());
      out.list[pair[0]].neighbours.push_back({pair[1], walls});
      out.list[pair[1]].neighbours.push_back({pair[0], walls});
    }
    for (Aspect& aspect : out.list)
      std::ranges::sort(aspect.neighbours, {}, &AspectNeighbour::aspect);
  }
  // Of two aspects and the circle or plane between them one wall, by way of example.
  [[nodiscard]] std::vector<const EventCells::Wall*> one_wall_each() const {
    std::vector<const EventCells::Wall*> out;
    std::set<std::array<int, 3>> known;
    for (const EventCells::Wall& w : walls_) {
      const auto pair = between(w);
      if (pair && known.insert({(*pair)[0], (*pair)[1], w.surface}).second)
        out.push_back(&w);
    }
    return out;
  }
  // What is lined up for an eye on each of these walls.
  [[nodiscard]] std::vector<std::vector<PathEvent>> events_of(
      const std::vector<const EventCells::Wall*>& walls, AspectGraph& out) const {
    std::vector<std::vector<PathEvent>> found(walls.size());
    const Request left = deadline_->what_is_left(*request_);
    try {
      Stage stage(left, "events of walls");
      for_each_of(0, walls.size(), walls.size(), left, stage, [&](std::size_t i) {
        const EventCells::Wall& w = *walls[i];
        const auto at = cells_.on_wall(w, inside_[w.negative].at, inside_[w.positive].at);
        if (!at) return;
        const PointView view = index_.view(viewpoint_at_exactly(*at));
        found[i] = internal::events_of(*scene_, view, {}, {});
      });
    } catch (const Stopped&) {
      out.complete = out.certified = false;
    }
    return found;
  }

  void check(AspectGraph& out) const {
    std::set<std::string> labels;
    for (const auto& cells : members_) labels.insert(labels_[cells.front()]->label);
    out.check = check_labels(index_, *request_, labels);
  }

  const Scene* scene_;
  const AspectRequest* request_;
  const Deadline* deadline_;
  PointViewIndex index_;
  EventCells cells_;
  std::vector<EventCells::Inside> inside_;         // by cell
  std::vector<std::optional<ViewLabels>> labels_;  // by cell
  std::vector<EventCells::Wall> walls_;
  std::vector<int> number_;                // of aspects, by cell; -1: none
  std::vector<std::vector<int>> members_;  // cells, by aspect
  std::size_t views_ = 0;
  bool on_event_ = false;
};

}  // namespace

std::variant<AspectGraph, std::string> general_aspects(const Scene& scene,
                                                       const AspectRequest& request) {
  if (!std::ranges::all_of(scene.facets(), &Facet::planar))
    return "a facet is planar only up to rounding";
  const Deadline deadline(request);
  try {
    const Silhouettes silhouettes(scene, EventMode::Polygon, request, deadline);
    if (!FaceCrossings(silhouettes).empty()) return "objects cross each other";
    auto cells = EventCells::of(scene, deadline.what_is_left(request), request);
    if (!cells) {
      const bool far = request.projection == Projection::Orthographic;
      return "corners and edges make more than " +
             std::to_string(far ? kMostCircles : kMostPlanes) +
             (far ? " great circles" : " planes") + ", or these meet in one line";
    }
    if (has_three_edge_events(scene, deadline.what_is_left(request)))
      return "three edges come into one line of sight (EEE events)";
    auto graph = GeneralGraph(scene, request, deadline, std::move(*cells)).graph();
    if (graph) return std::move(*graph);
    return "a view between the planes of corners and edges lies on an event";
  } catch (const Stopped&) {
    AspectGraph nothing;
    nothing.complete = false;
    return nothing;
  }
}

}  // namespace sightline::internal
