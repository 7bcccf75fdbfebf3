// Area of faces and points inside them; the functions are told in planar_map.h.

#include <algorithm>
#include <cmath>

#include "shadows/planar/edge_bow.h"
#include "shadows/planar/planar_map.h"
#include "shadows/planar/scan_line.h"

namespace sightline::internal {
namespace {

std::vector<int> boundary_edges(const PlanarMap& map, int f) {
  std::vector<int> edges;
  const auto walk = [&](int first) {
    int h = first;
    do {
      edges.push_back(PlanarMap::edge_of(h));
      h = map.next(h);
    } while (h != first);
  };
  walk(map.outer_boundary(f));
  for (const int h : map.holes(f)) walk(h);
  std::ranges::sort(edges);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

// A stretch of a scan line inside a face.
struct Stretch {
  bool horizontal;
  double at = 0, from = 0, to = 0;

  [[nodiscard]] double width() const { return to - from; }
  [[nodiscard]] double middle() const { return 0.5 * (from + to); }
};

// The widest stretch in face f, by hits with all its edges.
std::optional<Stretch> widest(const PlanarData& map, int f, std::vector<ScanHit> hits,
                              bool horizontal, double at) {
  std::ranges::sort(hits, {}, [](const ScanHit& h) { return h.range.lo; });
  std::optional<Stretch> best;
  for (std::size_t i = 0; i + 1 < hits.size(); ++i) {
    if (map.face[hits[i].half_edge ^ 1] != f) continue;
    const Stretch s{horizontal, at, hits[i].range.hi, hits[i + 1].range.lo};
    // No rounding puts the middle on an end.
    if (!(s.from < s.middle() && s.middle() < s.to)) continue;
    if (!best || s.width() > best->width()) best = s;
  }
  return best;
}

// The largest gaps between the coordinates of what bounds the face, largest first.
std::vector<std::array<double, 2>> gaps(const PlanarData& map, std::span<const int> edges,
                                        int axis) {
  std::vector<double> at;
  for (const int e : edges) {
    for (const int v : map.edges[e].ends) at.push_back(map.vertices[v].at[axis]);
    if (!map.support_of_edge(e).straight) {
      at.push_back(edge_bow(map, e).at(0.5)[axis]);
    }
  }
  std::ranges::sort(at);
  std::vector<std::array<double, 2>> out;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    if (at[i] < at[i + 1]) out.push_back({at[i], at[i + 1]});
  }
  std::ranges::stable_sort(out, std::greater{},
                           [](const std::array<double, 2>& g) { return g[1] - g[0]; });
  return out;
}

PlanePoint on_line(bool horizontal, const Rational& at, const Rational& position) {
  return horizontal ? PlanePoint{position, at} : PlanePoint{at, position};
}

// Through points of an edge of the face, until the line meets all its edges properly.
PlanePoint exact_interior_point(const PlanarData& map, int f,
                                std::span<const int> edges) {
  const int e = map.faces[f].outer >> 1;
  const auto& supports = map.geometry->all.supports;
  const int own = map.geometry->all.arcs[map.edges[e].arc].support;
  ArcParameter from = map.position(e, 0), to = map.position(e, 1);
  const ExactParameter end = exact(supports, own, to);
  ExactParameter last = exact(supports, own, from);
  for (;;) {
    const QuadraticRoot s = quadratic_root(between(last, end));
    const SurdPoint p = point_at(supports[own], s);
    for (const bool horizontal : {true, false}) {
      const Rational at = rational(horizontal ? p.y.a : p.x.a) / rational(p.w.a);
      auto hits = exact_hits(map, edges, {horizontal, at});
      if (!hits) continue;
      std::ranges::sort(*hits, [](const ScanHit& g, const ScanHit& h) {
        return compare(*g.exact, *h.exact) == Sign::Negative;
      });
      for (std::size_t i = 0; i + 1 < hits->size(); ++i) {
        if (map.face[(*hits)[i].half_edge ^ 1] != f) continue;
        const Dyadic x = between(*(*hits)[i].exact, *(*hits)[i + 1].exact);
        return on_line(horizontal, at, rational(x));
      }
    }
    last = s;
  }
}

double signed_area(const PlanarMap& map, const PlanarData& data, int first) {
  const Eigen::Vector2d origin = map.vertex(map.origin(first)).at;
  double sum = 0;
  int h = first;
  do {
    const Eigen::Vector2d p = map.vertex(map.origin(h)).at - origin;
    const Eigen::Vector2d q = map.vertex(map.target(h)).at - origin;
    sum += 0.5 * (p.x() * q.y() - p.y() * q.x());
    if (!data.support_of_edge(h >> 1).straight) {
      const double beside = area_beside_chord(edge_bow(data, h >> 1));
      sum += (h & 1) == 0 ? beside : -beside;
    }
    h = map.next(h);
  } while (h != first);
  return sum;
}

}  // namespace

PlanePoint PlanarMap::interior_point(int f) const {
  const std::vector<int> edges = boundary_edges(*this, f);
  constexpr std::size_t kTries = 3;
  for (const bool horizontal : {true, false}) {
    std::optional<Stretch> best;
    double best_score = 0;
    const auto candidates = gaps(*data_, edges, horizontal ? 1 : 0);
    for (std::size_t i = 0; i < std::min(kTries, candidates.size()); ++i) {
      const double gap = candidates[i][1] - candidates[i][0];
      if (best && gap <= best_score) break;
      const double at = candidates[i][0] + 0.5 * gap;
      auto hits = hits_by_doubles(*data_, edges, horizontal, at);
      if (!hits) continue;
      const auto stretch = widest(*data_, f, std::move(*hits), horizontal, at);
      if (!stretch || (best && std::min(gap, stretch->width()) <= best_score)) continue;
      best = stretch;
      best_score = std::min(gap, stretch->width());
    }
    if (best) return on_line(horizontal, Rational(best->at), Rational(best->middle()));
  }
  return exact_interior_point(*data_, f, edges);
}

double PlanarMap::area(int f) const {
  double sum = signed_area(*this, *data_, outer_boundary(f));
  for (const int h : holes(f)) sum += signed_area(*this, *data_, h);
  return sum;
}

}  // namespace sightline::internal
