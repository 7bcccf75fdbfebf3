#include "linespace/view/view_map.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "linespace/picture/classes.h"
#include "linespace/view/view_accidents.h"

namespace sightline::internal {
namespace {

class MapMaker {
 public:
  MapMaker(const EyeSpace& eye, const ViewGraph& graph,
           std::span<const PicturePoint> suspects,
           std::span<const std::uint8_t> possibly_seen)
      : eye_(&eye), graph_(&graph), suspects_(suspects), possibly_seen_(possibly_seen) {}

  ViewMap make() {
    join_regions();
    find_seams();
    add_edges();
    add_vertices();
    add_boundaries();
    return std::move(map_);
  }

 private:
  // A run of edges of the graph on one line in space, as half-edges in order.
  using Run = std::vector<int>;

  void join_regions();
  void find_seams();
  void add_edges();
  void add_edge(const Run& run);
  void add_vertices();
  void find_accidents_among_ts();
  void add_boundaries();
  [[nodiscard]] int straight_on(int half_edge) const;
  [[nodiscard]] std::vector<Run> runs(bool seams) const;
  [[nodiscard]] MapEdgeKind kind(int edge) const;
  [[nodiscard]] std::vector<int> patches(int region) const;
  [[nodiscard]] bool share_object(int edge) const;
  [[nodiscard]] ExactPoint exact_place(int line, int point) const;
  [[nodiscard]] int corner_on(int line, int point) const;
  [[nodiscard]] Point place(int line, int point) const;
  [[nodiscard]] bool meet_at(int line, int other, int point) const;
  [[nodiscard]] MapVertex vertex(int point, std::span<const int> leaving,
                                 std::array<int, 2>& lines) const;

  const EyeSpace* eye_;
  const ViewGraph* graph_;
  std::span<const PicturePoint> suspects_;
  std::span<const std::uint8_t> possibly_seen_;
  ViewMap map_;
  std::vector<std::uint8_t> seam_;         // of edges of the graph
  std::vector<std::vector<int>> leaving_;  // half-edges that are no seams, by point
  std::vector<int> edge_of_;  // of half-edges of the graph: half-edge of the map
};

std::vector<int> MapMaker::patches(int region) const {
  std::vector<int> found;
  for (const int side : graph_->regions[region]) {
    found.push_back(side == kNoSight ? kNoSight
                                     : eye_->scene().patch(side / 2, side % 2 == 0));
  }
  std::ranges::sort(found);
  found.erase(std::ranges::unique(found).begin(), found.end());
  return found;
}

void MapMaker::join_regions() {
  const std::size_t n = graph_->regions.size();
  std::vector<std::vector<int>> shown(n);
  for (std::size_t r = 0; r < n; ++r) shown[r] = patches(static_cast<int>(r));
  Classes classes(n);
  seam_.resize(graph_->edges.size());
  for (std::size_t e = 0; e < seam_.size(); ++e) {
    const int left = graph_->left(static_cast<int>(e));
    const int right = graph_->right(static_cast<int>(e));
    seam_[e] = shown[left] == shown[right] ? 1 : 0;
    if (seam_[e] != 0) classes.join(left, right);
  }
  map_.region_of.assign(n, -1);
  for (int r = 0; r < static_cast<int>(n); ++r) {
    if (shown[r] == std::vector{kNoSight}) continue;
    int& number = map_.region_of[classes.root(r)];
    if (number < 0) {
      number = static_cast<int>(map_.regions.size());
      map_.regions.emplace_back().patches = shown[r];
      map_.background_pieces += shown[r].empty() ? 1 : 0;
    }
    map_.region_of[r] = number;
    auto& facets = map_.regions[number].facets;
    for (const int side : graph_->regions[r]) facets.push_back(side / 2);
  }
  for (MapRegion& r : map_.regions) {
    std::ranges::sort(r.facets);
    r.facets.erase(std::ranges::unique(r.facets).begin(), r.facets.end());
  }
}

void MapMaker::find_seams() {
  leaving_.resize(graph_->points.size());
  for (int h = 0; h < static_cast<int>(graph_->next.size()); ++h) {
    if (seam_[h / 2] == 0) leaving_[graph_->origin(h)].push_back(h);
  }
  for (const Run& run : runs(true)) {
    map_.seam_pieces.push_back(
        {{graph_->origin(run.front()), graph_->origin(run.back() ^ 1)},
         graph_->edges[run.front() / 2].line});
  }
  map_.seams = static_cast<int>(map_.seam_pieces.size());
}

// The half-edge that goes on from this one's end along the same line in space, with the
// same beside it; -1 where none does.  An edge of the map goes on where no third one
// ends.
int MapMaker::straight_on(int half_edge) const {
  const int back = half_edge ^ 1;
  const auto goes_on = [&](int other) {
    return other != back && eye_->scene().on_one_line(graph_->edges[half_edge / 2].line,
                                                      graph_->edges[other / 2].line);
  };
  if (seam_[half_edge / 2] == 0) {
    const auto& leaving = leaving_[graph_->origin(back)];
    if (leaving.size() != 2) return -1;
    const int other = leaving[0] == back ? leaving[1] : leaving[0];
    return goes_on(other) ? other : -1;
  }
  const auto label = [&](int h) -> const FacetSides& {
    return graph_->regions[graph_->region[h]];
  };
  for (int other = graph_->next[half_edge]; other != back;
       other = graph_->next[other ^ 1]) {
    if (seam_[other / 2] != 0 && label(other) == label(half_edge) &&
        label(other ^ 1) == label(back) && goes_on(other)) {
      return other;
    }
  }
  return -1;
}

std::vector<MapMaker::Run> MapMaker::runs(bool seams) const {
  std::vector<Run> found;
  std::vector<std::uint8_t> done(seam_.size(), 0);
  for (int e = 0; e < static_cast<int>(seam_.size()); ++e) {
    if ((seam_[e] != 0) != seams || done[e] != 0) continue;
    int first = 2 * e;
    // Signs of doubles may lead round in a circle.
    for (std::size_t steps = 0; steps < seam_.size(); ++steps) {
      const int back = straight_on(first ^ 1);
      if (back < 0 || done[back / 2] != 0) break;
      first = back ^ 1;
    }
    Run run;
    for (int h = first; h >= 0 && done[h / 2] == 0; h = straight_on(h)) {
      run.push_back(h);
      done[h / 2] = 1;
    }
    found.push_back(std::move(run));
  }
  return found;
}

void MapMaker::add_edges() {
  edge_of_.assign(graph_->next.size(), -1);
  for (Run& run : runs(false)) {
    // Named by the smallest line, and in its direction.
    const auto named = std::ranges::min_element(
        run, {}, [&](int h) { return graph_->edges[h / 2].line; });
    if (*named % 2 == 1) {
      std::ranges::reverse(run);
      for (int& h : run) h ^= 1;
    }
    add_edge(run);
  }
}

void MapMaker::add_edge(const Run& run) {
  const int number = static_cast<int>(map_.edges.size());
  int named = run.front();
  for (const int h : run) {
    edge_of_[h] = 2 * number;
    edge_of_[h ^ 1] = 2 * number + 1;
    if (graph_->edges[h / 2].line < graph_->edges[named / 2].line) named = h;
  }
  const int from = graph_->origin(run.front()), to = graph_->origin(run.back() ^ 1);
  MapEdge e;
  e.line = eye_->scene().lines()[graph_->edges[named / 2].line].name;
  e.kind = kind(named / 2);
  e.ends = {from, to};  // points; vertices are numbered later
  e.left = map_.region_of[graph_->region[run.front()]];
  e.right = map_.region_of[graph_->region[run.front() ^ 1]];
  e.segment = {place(graph_->edges[run.front() / 2].line, from),
               place(graph_->edges[run.back() / 2].line, to)};
  map_.edges.push_back(e);
  map_.line_of_edge.push_back(graph_->edges[named / 2].line);
}

// Where a line passes a point of the picture, in space.
Point MapMaker::place(int line, int point) const {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  const PicturePoint& at = graph_->points[point];
  if (at.point() == a || at.point() == b) return eye_->scene().position(at.point());
  const LongVector &u = eye_->vector(a), &v = eye_->vector(b), &w = at.vector();
  const LongVector m = cross(u, w), n = cross(w, v);
  const long double s = std::sqrt(dot(m, m)), t = std::sqrt(dot(n, n));
  // What an error of the point changes at most: much, on a line seen short or passing
  // near.
  const long double change =
      (at.error() + 0x1p-60L) * (std::sqrt(dot(u, u)) + std::sqrt(dot(v, v)));
  if (!(change < 0x1p-46L * (s + t))) return rounded(exact_place(line, point));
  const auto share = static_cast<double>(s / (s + t));
  const Point from = eye_->scene().position(a), to = eye_->scene().position(b);
  return from + share * (to - from);
}

bool MapMaker::share_object(int edge) const {
  const auto& facets = eye_->scene().scene().facets();
  for (const int x : graph_->regions[graph_->left(edge)]) {
    for (const int y : graph_->regions[graph_->right(edge)]) {
      if (x == kNoSight || y == kNoSight) continue;
      if (facets[x / 2].object == facets[y / 2].object) return true;
    }
  }
  return false;
}

MapEdgeKind MapMaker::kind(int edge) const {
  const ViewScene& scene = eye_->scene();
  const ViewLine& line = scene.lines()[graph_->edges[edge].line];
  const auto [left, right] = graph_->edges[edge].faces;
  if (line.name.box_side >= 0) return MapEdgeKind::Cut;
  if (line.crossing[0] >= 0 && left >= 0 && right >= 0) return MapEdgeKind::Crossing;
  if (left < 0 || right < 0) {
    const bool one_facet =
        line.name.edge >= 0 && scene.has_one_facet(graph_->edges[edge].line);
    return one_facet ? MapEdgeKind::Boundary : MapEdgeKind::Silhouette;
  }
  if (!share_object(edge)) return MapEdgeKind::Contact;
  // A point of the right face, seen on the right of the edge: on the eye's side of the
  // left face's plane it makes a valley.
  for (const int c : scene.corners(right)) {
    if (eye_->orient(line.ends[0], line.ends[1], c) != Sign::Negative) continue;
    return eye_->before(left, c) == Sign::Positive ? MapEdgeKind::Valley
                                                   : MapEdgeKind::Crease;
  }
  return MapEdgeKind::Crease;
}

// Where a line passes a point of its picture, exactly.
ExactPoint MapMaker::exact_place(int line, int point) const {
  const auto [a, b] = eye_->scene().lines()[line].ends;
  const auto [s, t] = LineCuts(*eye_, line).shares(graph_->points[point].exact());
  return along(eye_->scene().exact(a), eye_->scene().exact(b),
               quotient(t, Rational(s + t)));
}

// Two lines seen to cross in a point of the picture pass one point of space there.
bool MapMaker::meet_at(int line, int other, int point) const {
  if (line == other) return true;
  const ViewScene& scene = eye_->scene();
  const auto [a, b] = scene.lines()[line].ends;
  const auto [c, d] = scene.lines()[other].ends;
  const int at = graph_->points[point].point();
  if (at >= 0 && (at == a || at == b) && (at == c || at == d)) return true;
  // In one plane with the eye, or not: then they meet in space iff they lie in one plane.
  const bool in_line =
      eye_->orient(a, b, c) == Sign::Zero && eye_->orient(a, b, d) == Sign::Zero;
  if (in_line) {
    return scene.on_one_line(line, other) ||
           exact_place(line, point) == exact_place(other, point);
  }
  if (scene.is_constructed(a) || scene.is_constructed(b) || scene.is_constructed(c) ||
      scene.is_constructed(d)) {
    return exact_orient(scene.exact(a), scene.exact(b), scene.exact(c), scene.exact(d)) ==
           0;
  }
  const Scene& s = scene.scene();
  return orient3d(s.point(a), s.point(b), s.point(c), s.point(d)) == Sign::Zero;
}

// The corner of the scene that lies on the line where it passes this point; -1 if none.
int MapMaker::corner_on(int line, int point) const {
  const ViewScene& scene = eye_->scene();
  const auto [a, b] = scene.lines()[line].ends;
  for (const int p : graph_->scene_points[point]) {
    if (!std::ranges::binary_search(scene.scene().corners(), p)) continue;
    if (p == a || p == b || scene.in_line(a, b, p)) return p;
  }
  return -1;
}

MapVertex MapMaker::vertex(int point, std::span<const int> leaving,
                           std::array<int, 2>& lines) const {
  MapVertex v{};
  v.kind = MapVertexKind::Accident;
  v.corner = -1;
  const PicturePoint& seen_at = graph_->points[point];
  if (seen_at.error() <= 0x1p-52L) {
    v.at = eye_->drawn_at(seen_at.vector());
  } else {
    const ExactPoint& w = seen_at.exact();
    v.at = eye_->drawn_at({long_double(w[0]), long_double(w[1]), long_double(w[2])});
  }
  const auto line = [&](int h) { return graph_->edges[h / 2].line; };
  // The edges that end here, by the point of space that they pass.
  std::vector<std::vector<int>> meeting;
  for (const int h : leaving) {
    const auto same = std::ranges::find_if(meeting, [&](const auto& some) {
      return meet_at(line(some.front()), line(h), point);
    });
    if (same == meeting.end()) {
      meeting.push_back({h});
    } else {
      same->push_back(h);
    }
  }
  if (meeting.size() == 1) {
    v.corner = corner_on(line(leaving.front()), point);
    v.kind = v.corner >= 0 ? MapVertexKind::Corner : MapVertexKind::Touch;
    std::set<int> whole;
    for (const int h : leaving) whole.insert(eye_->scene().whole_line(line(h)));
    lines = {*whole.begin(), *std::next(whole.begin(), whole.size() > 1 ? 1 : 0)};
  } else if (meeting.size() == 2) {
    // A nearer line that goes straight on, and a farther one that ends behind it.
    for (int i = 0; i < 2; ++i) {
      const auto &near = meeting[i], &far = meeting[1 - i];
      if (near.size() != 2 || far.size() != 1) continue;
      if (!eye_->scene().on_one_line(line(near[0]), line(near[1]))) continue;
      v.kind = MapVertexKind::T;
      lines = {std::min(line(near[0]), line(near[1])), line(far.front())};
      v.near = eye_->scene().lines()[lines[0]].name;
      v.far = eye_->scene().lines()[line(far.front())].name;
    }
  }
  return v;
}

// Of T-vertices where more than two lines may be seen in one: the far edge may end there.
void MapMaker::find_accidents_among_ts() {
  if (suspects_.empty()) return;
  std::vector<int> ts;
  std::vector<PicturePoint> points;
  for (std::size_t v = 0; v < map_.vertices.size(); ++v) {
    if (map_.vertices[v].kind != MapVertexKind::T) continue;
    ts.push_back(static_cast<int>(v));
    points.push_back(graph_->points[map_.point_of_vertex[v]]);
  }
  points.insert(points.end(), suspects_.begin(), suspects_.end());
  const std::vector<int> numbers = number_points(points);
  std::vector<std::uint8_t> suspect(points.size(), 0);
  for (std::size_t i = ts.size(); i < points.size(); ++i) suspect[numbers[i]] = 1;
  for (std::size_t i = 0; i < ts.size(); ++i) {
    if (suspect[numbers[i]] == 0) continue;
    MapVertex& v = map_.vertices[ts[i]];
    if (goes_straight_on(*eye_, points[i], map_.lines_of_vertex[ts[i]][1],
                         possibly_seen_)) {
      continue;
    }
    v.kind = MapVertexKind::Accident;
    v.near = v.far = MapLine{};
  }
}

void MapMaker::add_vertices() {
  std::vector<int> number(graph_->points.size(), -1);
  Classes classes(graph_->points.size());
  for (MapEdge& e : map_.edges) {
    classes.join(e.ends[0], e.ends[1]);
    for (const int p : e.ends) {
      if (number[p] >= 0) continue;
      number[p] = static_cast<int>(map_.vertices.size());
      auto& lines = map_.lines_of_vertex.emplace_back(std::array{0, 0});
      map_.vertices.push_back(vertex(p, leaving_[p], lines));
      map_.point_of_vertex.push_back(p);
    }
  }
  for (const int p : map_.point_of_vertex)
    map_.components += classes.root(p) == p ? 1 : 0;
  for (MapEdge& e : map_.edges) e.ends = {number[e.ends[0]], number[e.ends[1]]};
  find_accidents_among_ts();
}

void MapMaker::add_boundaries() {
  // The next half-edge of the map, past seams and along straight runs.
  std::vector<std::uint8_t> done(2 * map_.edges.size(), 0);
  for (int h = 0; h < static_cast<int>(edge_of_.size()); ++h) {
    if (edge_of_[h] < 0 || done[edge_of_[h]] != 0) continue;
    std::vector<int> walk;
    int x = h;
    do {
      if (done[edge_of_[x]] == 0) {
        done[edge_of_[x]] = 1;
        walk.push_back(edge_of_[x]);
      }
      x = graph_->next[x];
      while (seam_[x / 2] != 0) x = graph_->next[x ^ 1];
    } while (x != h);
    const int region = map_.region_of[graph_->region[h]];
    if (region >= 0) map_.regions[region].boundary.push_back(std::move(walk));
  }
}

}  // namespace

ViewMap make_map(const EyeSpace& eye, const ViewGraph& graph,
                 std::span<const PicturePoint> suspects,
                 std::span<const std::uint8_t> possibly_seen) {
  return MapMaker(eye, graph, suspects, possibly_seen).make();
}

}  // namespace sightline::internal
