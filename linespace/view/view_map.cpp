#include "linespace/view/view_map.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "linespace/picture/classes.h"

namespace sightline::internal {
namespace {

class MapMaker {
 public:
  MapMaker(const EyeSpace& eye, const ViewGraph& graph) : eye_(&eye), graph_(&graph) {}

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
  void add_boundaries();
  [[nodiscard]] int straight_on(int half_edge) const;
  [[nodiscard]] std::vector<Run> runs(bool seams) const;
  [[nodiscard]] MapEdgeKind kind(int edge) const;
  [[nodiscard]] std::vector<int> patches(int region) const;
  [[nodiscard]] bool lies_on(int region, int edge) const;
  [[nodiscard]] Point place(int line, int point) const;
  [[nodiscard]] bool meet_at(int line, int other, int point) const;
  [[nodiscard]] MapVertex vertex(int point, std::span<const int> leaving) const;
  [[nodiscard]] const std::array<int, 2>& line_ends(int edge) const {
    return eye_->scene().lines()[graph_->edges[edge].line].ends;
  }

  const EyeSpace* eye_;
  const ViewGraph* graph_;
  ViewMap map_;
  std::vector<std::uint8_t> seam_;         // of edges of the graph
  std::vector<std::vector<int>> leaving_;  // half-edges that are no seams, by point
  std::vector<int> edge_of_;  // of half-edges of the graph: half-edge of the map
};

std::vector<int> MapMaker::patches(int region) const {
  std::vector<int> found;
  for (const int side : graph_->regions[region]) {
    found.push_back(eye_->scene().patch(side / 2, side % 2 == 0));
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
  map_.seams = static_cast<int>(runs(true).size());
}

// The half-edge that goes on from this one's end where nothing but a straight line passes
// there; -1 elsewhere.  Seams go on at points of seams alone.
int MapMaker::straight_on(int half_edge) const {
  const int at = graph_->origin(half_edge ^ 1);
  if (seam_[half_edge / 2] == 0) {
    const auto& leaving = leaving_[at];
    if (leaving.size() != 2) return -1;
    const int other = leaving[0] == (half_edge ^ 1) ? leaving[1] : leaving[0];
    return eye_->scene().on_one_line(graph_->edges[half_edge / 2].line,
                                     graph_->edges[other / 2].line)
               ? other
               : -1;
  }
  const int next = graph_->next[half_edge];
  const bool alone = next != (half_edge ^ 1) &&
                     graph_->next[next ^ 1] == (half_edge ^ 1) && seam_[next / 2] != 0;
  return alone && eye_->scene().on_one_line(graph_->edges[half_edge / 2].line,
                                            graph_->edges[next / 2].line)
             ? next
             : -1;
}

std::vector<MapMaker::Run> MapMaker::runs(bool seams) const {
  std::vector<Run> found;
  std::vector<std::uint8_t> done(seam_.size(), 0);
  for (int e = 0; e < static_cast<int>(seam_.size()); ++e) {
    if ((seam_[e] != 0) != seams || done[e] != 0) continue;
    int first = 2 * e;
    for (int back; (back = straight_on(first ^ 1)) >= 0;) first = back ^ 1;
    Run run;
    for (int h = first; h >= 0; h = straight_on(h)) {
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
  const LongVector &u = eye_->vector(a), &v = eye_->vector(b);
  const LongVector& w = graph_->points[point].vector();
  const LongVector m = cross(u, w), n = cross(w, v);
  const long double s = std::sqrt(dot(m, m)), t = std::sqrt(dot(n, n));
  const Point p = eye_->scene().position(a), q = eye_->scene().position(b);
  if (graph_->points[point].point() == a) return p;
  if (graph_->points[point].point() == b) return q;
  const auto share = static_cast<double>(s / (s + t));
  return p + share * (q - p);
}

// What is seen in the region, beside the edge, contains it.
bool MapMaker::lies_on(int region, int edge) const {
  const auto ends = line_ends(edge);
  const Scene& scene = eye_->scene().scene();
  for (const int side : graph_->regions[region]) {
    for (const int f : scene.facets()[side / 2].faces) {
      if (eye_->scene().plane_side(f, ends[0]) == Sign::Zero &&
          eye_->scene().plane_side(f, ends[1]) == Sign::Zero) {
        return true;
      }
    }
  }
  return false;
}

MapEdgeKind MapMaker::kind(int edge) const {
  const ViewScene& scene = eye_->scene();
  const ViewLine& line = scene.lines()[graph_->edges[edge].line];
  if (line.crossing[0] >= 0) return MapEdgeKind::Crossing;
  const int left = graph_->left(edge), right = graph_->right(edge);
  const bool on_left = lies_on(left, edge), on_right = lies_on(right, edge);
  if (!on_left || !on_right) {
    const bool one_face =
        line.name.edge >= 0 && scene.scene().edges()[line.name.edge].sides.size() == 1;
    return one_face ? MapEdgeKind::Boundary : MapEdgeKind::Silhouette;
  }
  const auto object = [&](int region) {
    return scene.scene().facets()[graph_->regions[region].front() / 2].object;
  };
  if (object(left) != object(right)) return MapEdgeKind::Contact;
  // A point of the right side's facet, off the left side's plane: on the eye's side of
  // that plane it makes a valley.
  const auto& facets = scene.scene().facets();
  const int face = facets[graph_->regions[left].front() / 2].faces.front();
  for (const int f : facets[graph_->regions[right].front() / 2].faces) {
    for (const int c : scene.scene().face_points(f)) {
      const Sign s = eye_->before(face, c);
      if (s != Sign::Zero)
        return s == Sign::Positive ? MapEdgeKind::Valley : MapEdgeKind::Crease;
    }
  }
  return MapEdgeKind::Crease;
}

// Two lines seen to cross in a point of the picture pass one point of space there.
bool MapMaker::meet_at(int line, int other, int point) const {
  if (line == other) return true;
  const ViewScene& scene = eye_->scene();
  const auto [a, b] = scene.lines()[line].ends;
  const auto [c, d] = scene.lines()[other].ends;
  const int at = graph_->points[point].point();
  if (at >= 0 && (at == a || at == b) && (at == c || at == d)) return true;
  const bool along =
      eye_->orient(a, b, c) == Sign::Zero && eye_->orient(a, b, d) == Sign::Zero;
  if (along) return scene.on_one_line(line, other);
  if (scene.is_constructed(a) || scene.is_constructed(b) || scene.is_constructed(c) ||
      scene.is_constructed(d)) {
    return exact_orient(scene.exact(a), scene.exact(b), scene.exact(c), scene.exact(d)) ==
           0;
  }
  const Scene& s = scene.scene();
  return orient3d(s.point(a), s.point(b), s.point(c), s.point(d)) == Sign::Zero;
}

MapVertex MapMaker::vertex(int point, std::span<const int> leaving) const {
  MapVertex v{};
  v.kind = MapVertexKind::Accident;
  v.corner = -1;
  v.at = eye_->drawn_at(graph_->points[point].vector());
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
    v.kind = MapVertexKind::Touch;
    const int p = graph_->points[point].point();
    if (p >= 0 && !eye_->scene().is_constructed(p)) {
      const auto corners = eye_->scene().scene().corners();
      // The point is seen, and not one before or behind it, if a line there ends in it.
      const bool seen = std::ranges::any_of(leaving, [&](int h) {
        const auto& ends = line_ends(h / 2);
        return ends[0] == p || ends[1] == p;
      });
      if (seen && std::ranges::binary_search(corners, p)) {
        v.kind = MapVertexKind::Corner;
        v.corner = p;
      }
    }
  } else if (meeting.size() == 2) {
    // A nearer line that goes straight on, and a farther one that ends behind it.
    for (int i = 0; i < 2; ++i) {
      const auto &near = meeting[i], &far = meeting[1 - i];
      if (near.size() != 2 || far.size() != 1) continue;
      const auto& ends = line_ends(far.front() / 2);
      const int p = graph_->points[point].point();
      if (p >= 0 && (ends[0] == p || ends[1] == p)) continue;
      if (!eye_->scene().on_one_line(line(near[0]), line(near[1]))) continue;
      v.kind = MapVertexKind::T;
      v.near = eye_->scene().lines()[std::min(line(near[0]), line(near[1]))].name;
      v.far = eye_->scene().lines()[line(far.front())].name;
    }
  }
  return v;
}

void MapMaker::add_vertices() {
  std::vector<int> number(graph_->points.size(), -1);
  Classes classes(graph_->points.size());
  for (MapEdge& e : map_.edges) {
    classes.join(e.ends[0], e.ends[1]);
    for (const int p : e.ends) {
      if (number[p] >= 0) continue;
      number[p] = static_cast<int>(map_.vertices.size());
      map_.vertices.push_back(vertex(p, leaving_[p]));
      map_.point_of_vertex.push_back(p);
    }
  }
  for (const int p : map_.point_of_vertex)
    map_.components += classes.root(p) == p ? 1 : 0;
  for (MapEdge& e : map_.edges) e.ends = {number[e.ends[0]], number[e.ends[1]]};
}

void MapMaker::add_boundaries() {
  // The next half-edge of the map, past seams and along straight runs.
  std::vector<std::uint8_t> done(2 * map_.edges.size(), 0);
  for (int h = 0; h < static_cast<int>(edge_of_.size()); ++h) {
    if (edge_of_[h] < 0 || done[edge_of_[h]] != 0) continue;
    std::vector<int> walk;
    for (int x = h;
         walk.empty() || done[edge_of_[x]] == 0 || edge_of_[x] == walk.back();) {
      if (done[edge_of_[x]] == 0) {
        done[edge_of_[x]] = 1;
        walk.push_back(edge_of_[x]);
      }
      x = graph_->next[x];
      while (seam_[x / 2] != 0) x = graph_->next[x ^ 1];
    }
    map_.regions[map_.region_of[graph_->region[h]]].boundary.push_back(std::move(walk));
  }
}

}  // namespace

ViewMap make_map(const EyeSpace& eye, const ViewGraph& graph) {
  return MapMaker(eye, graph).make();
}

}  // namespace sightline::internal
