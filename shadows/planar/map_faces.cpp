#include "shadows/planar/map_faces.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>

#include "linespace/picture/classes.h"
#include "linespace/scene.h"
#include "linespace/work/stop_scope.h"
#include "shadows/planar/scan_line.h"

namespace sightline::internal {
namespace {

class FaceFinder {
 public:
  explicit FaceFinder(PlanarData& map)
      : map_(map), components_(map.vertices.size()), all_edges_(map.edges.size()) {
    std::iota(all_edges_.begin(), all_edges_.end(), 0);
  }

  void run() {
    link();
    trace();
    for (const PlanarEdge& e : map_.edges) components_.join(e.ends[0], e.ends[1]);
    nest();
    number();
  }

 private:
  // Of a half-edge the next one: clockwise of its twin around the vertex where it ends.
  void link() {
    map_.next.assign(2 * map_.edges.size(), -1);
    for (std::size_t v = 0; v < map_.vertices.size(); ++v) {
      const std::span<const int> star = map_.stars[static_cast<int>(v)];
      for (std::size_t i = 0; i < star.size(); ++i) {
        map_.next[star[i] ^ 1] = star[(i + star.size() - 1) % star.size()];
      }
    }
  }

  void trace() {
    cycle_.assign(map_.next.size(), -1);
    for (std::size_t h = 0; h < cycle_.size(); ++h) {
      if (cycle_[h] >= 0) continue;
      for (int g = static_cast<int>(h); cycle_[g] < 0; g = map_.next[g]) {
        cycle_[g] = static_cast<int>(first_.size());
      }
      first_.push_back(static_cast<int>(h));
    }
    outward_.assign(first_.size(), false);
  }

  // For each connected component: the boundary that faces the outside of the component,
  // and what lies there.
  void nest() {
    faces_ = std::make_unique<Classes>(first_.size() + 1);
    std::vector<int> best(map_.vertices.size(), -1);
    std::vector<double> most(map_.vertices.size(), -1);
    // The edge of each component that spans most scan lines.
    for (const int e : all_edges_) {
      const int c = components_.root(map_.edges[e].ends[0]);
      if (const double span = extent(e); span > most[c]) {
        most[c] = span;
        best[c] = e;
      }
    }
    const ScanIndex index(map_);
    for (std::size_t v = 0; v < best.size(); ++v) {
      hear_stop();
      if (best[v] >= 0) place(index, best[v]);
    }
  }

  [[nodiscard]] double extent(int e) const {
    const auto& [from, to] = map_.edges[e].ends;
    return (map_.vertices[from].at - map_.vertices[to].at).cwiseAbs().maxCoeff();
  }

  // Number of the boundary of all: the plane around the outline.
  [[nodiscard]] int plane() const { return static_cast<int>(first_.size()); }

  // Looks from an edge of a component along a line through the edge.
  void place(const ScanIndex& index, int e) {
    const auto& [from, to] = map_.edges[e].ends;
    const Eigen::Vector2d p = map_.vertices[from].at, q = map_.vertices[to].at;
    const bool horizontal = std::abs(p.y() - q.y()) >= std::abs(p.x() - q.x());
    const int axis = horizontal ? 1 : 0;
    // Not at the middle, where symmetric scenes have their vertices.
    for (const double share : {0.4571, 0.6173, 0.3319, 0.7723}) {
      const double at = p[axis] + share * (q[axis] - p[axis]);
      const auto hits =
          hits_by_doubles(map_, index.edges_at(horizontal, at), horizontal, at);
      if (hits && place(e, *hits)) return;
    }
    place_exactly(e);
  }

  void place_exactly(int e) {
    ArcParameter from = map_.position(e, 0), to = map_.position(e, 1);
    const auto& supports = map_.geometry->all.supports;
    const int own = map_.geometry->all.arcs[map_.edges[e].arc].support;
    const ExactParameter end = exact(supports, own, to);
    ExactParameter at = exact(supports, own, from);
    for (;;) {
      const QuadraticRoot s = quadratic_root(between(at, end));
      const SurdPoint p = point_at(supports[own], s);
      for (const bool horizontal : {true, false}) {
        const Rational x = rational(horizontal ? p.y.a : p.x.a) / rational(p.w.a);
        const auto hits = exact_hits(map_, all_edges_, {horizontal, x});
        if (hits && place(e, *hits)) return;
      }
      at = s;
    }
  }

  // Sorts; false where enclosures overlap and nothing exact is known.
  static bool sort(std::vector<ScanHit>& hits) {
    const auto apart_in_order = [](const ScanHit& a, const ScanHit& b) {
      return a.range.hi < b.range.lo;
    };
    std::ranges::sort(hits, [](const ScanHit& a, const ScanHit& b) {
      if (apart(a.range, b.range) || !a.exact) return a.range.lo < b.range.lo;
      return compare(*a.exact, *b.exact) == Sign::Negative;
    });
    return hits.empty() || hits[0].exact ||
           std::ranges::adjacent_find(hits, std::not_fn(apart_in_order)) == hits.end();
  }

  // All hits from far away up to the component's first: what lies between two of them
  // is one face.  The face around the component is thus united with the boundaries of
  // whatever else lies in it before the component, up to its outer boundary.
  bool place(int e, std::vector<ScanHit> hits) {
    if (!sort(hits)) return false;
    const int component = components_.root(map_.edges[e].ends[0]);
    int before = plane();
    for (const ScanHit& h : hits) {
      faces_->join(before, cycle_[h.half_edge]);
      if (components_.root(map_.edges[h.half_edge >> 1].ends[0]) == component) {
        outward_[cycle_[h.half_edge]] = true;
        return true;
      }
      before = cycle_[h.half_edge ^ 1];
    }
    return false;
  }

  // Which boundaries are outside of the outline.
  [[nodiscard]] std::vector<char> outside() {
    std::vector<char> is_outside(first_.size() + 1, 0);
    is_outside[faces_->root(plane())] = 1;
    for (const int e : all_edges_) {
      const PlanarEdge& edge = map_.edges[e];
      if (!edge.outline) continue;
      const int inner = 2 * e + (edge.inside_of_first ? 0 : 1);
      is_outside[faces_->root(cycle_[inner ^ 1])] = 1;
    }
    for (std::size_t h = 0; h < cycle_.size(); ++h) {
      const PlanarEdge& edge = map_.edges[h >> 1];
      const bool outer = edge.outline && edge.inside_of_first == ((h & 1) == 1);
      if (!outer && is_outside[faces_->root(cycle_[h])]) {
        throw InvalidInput("a curve of a planar map leaves the outline");
      }
    }
    return is_outside;
  }

  // Faces in the order of their smallest half-edge.
  void number() {
    const std::vector<char> is_outside = outside();
    std::vector<int> number(first_.size() + 1, -1);
    map_.faces.clear();
    for (std::size_t c = 0; c < first_.size(); ++c) {
      const int root = faces_->root(static_cast<int>(c));
      if (is_outside[root]) continue;
      if (number[root] < 0) {
        number[root] = static_cast<int>(map_.faces.size());
        map_.faces.push_back({-1, {}});
      }
      PlanarFace& face = map_.faces[number[root]];
      if (outward_[c]) {
        face.holes.push_back(first_[c]);
      } else {
        face.outer = first_[c];
      }
    }
    map_.face.resize(cycle_.size());
    for (std::size_t h = 0; h < cycle_.size(); ++h) {
      map_.face[h] = number[faces_->root(cycle_[h])];
    }
  }

  PlanarData& map_;
  Classes components_;
  std::vector<int> all_edges_;
  std::vector<int> cycle_;          // of a half-edge
  std::vector<int> first_;          // half-edge of a cycle
  std::vector<char> outward_;       // of a cycle: it faces the outside of its component
  std::unique_ptr<Classes> faces_;  // of cycles, and the plane
};

}  // namespace

void find_faces(PlanarData& map) { FaceFinder(map).run(); }

}  // namespace sightline::internal
