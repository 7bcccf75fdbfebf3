#include "shadows/planar/map_edges.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "linespace/picture/classes.h"
#include "linespace/work/stop_scope.h"
#include "shadows/planar/arcs/candidate_pairs.h"
#include "shadows/planar/half_edge_order.h"

namespace sightline::internal {
namespace {

// A stop is heard in the calling thread, which takes part.
template <class F>
void in_parallel(std::size_t count, const F& f) {
  oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    hear_stop();
    f(i);
  });
}

// A position on an arc that will be a vertex.
struct Entry {
  ArcParameter at;
  int point;
};

// Of the outline: that of any arc's ends is no larger.
double largest_coordinate(const PlaneArcs& all) {
  double largest = 0;
  for (const PlaneArc& arc : all.arcs) {
    for (const ArcEnd& end : arc.ends) {
      for (const double x : {end.box_x.lo, end.box_x.hi, end.box_y.lo, end.box_y.hi}) {
        largest = std::max(largest, std::abs(x));
      }
    }
  }
  return largest;
}

struct FoundCrossing {
  int b;
  ArcCrossing where;
};

class MapBuilder {
 public:
  explicit MapBuilder(PlaneArcs&& arcs) : all_(std::move(arcs)), entries_(arc_count()) {}

  PlanarData build(std::span<const PlaneCurve> curves, CrossingCounts& counts) {
    find_crossings(counts);
    add_member_ends();
    sort_entries();
    number_vertices();
    add_edges(curves);
    PlanarData map;
    auto geometry = std::make_shared<PlanarGeometry>();
    geometry->all = std::move(all_);
    geometry->curves.assign(curves.begin(), curves.end());
    geometry->positions = std::move(positions_);
    geometry->corners = std::move(corners_);
    map.geometry = geometry;
    map.edges = std::move(edges_);
    for (std::vector<int>& ids : ids_) {
      std::ranges::sort(ids);
      ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
      map.curves.add(ids);
    }
    add_vertices(map);
    return map;
  }

 private:
  [[nodiscard]] std::size_t arc_count() const { return all_.arcs.size(); }

  void find_crossings(CrossingCounts& counts) {
    const ArcGrid grid(all_);
    std::vector<std::vector<FoundCrossing>> found(arc_count());
    std::vector<CrossingCounts> counted(arc_count());
    in_parallel(arc_count(), [&](std::size_t a) {
      std::vector<ArcCrossing> crossings;
      for (const int b : grid.partners(static_cast<int>(a))) {
        crossings.clear();
        append_crossings(all_, static_cast<int>(a), b, crossings, counted[a]);
        for (ArcCrossing& c : crossings) found[a].push_back({b, std::move(c)});
      }
    });
    for (std::size_t a = 0; a < found.size(); ++a) {
      counts.pairs += counted[a].pairs;
      counts.by_filter += counted[a].by_filter;
      counts.by_end += counted[a].by_end;
      counts.by_exact += counted[a].by_exact;
      for (FoundCrossing& c : found[a]) {
        entries_[a].push_back({std::move(c.where.on_a), points_});
        entries_[c.b].push_back({std::move(c.where.on_b), points_});
        ++points_;
      }
    }
  }

  // Member m of an arc has the entries member_first_[arc] + 2 m, and + 1.
  void add_member_ends() {
    for (std::size_t a = 0; a < arc_count(); ++a) {
      member_first_.push_back(entries_[a].size());
      for (const ArcMember& m : all_.arcs[a].members) {
        entries_[a].push_back({m.from, points_++});
        entries_[a].push_back({m.to, points_++});
      }
    }
  }

  // Along each arc; those at one position become one point.
  void sort_entries() {
    rank_.resize(arc_count());
    positions_.resize(arc_count());
    std::vector<std::vector<std::array<int, 2>>> same(arc_count());
    in_parallel(arc_count(), [&](std::size_t a) { sort_entries(a, same[a]); });
    points_at_ = std::make_unique<Classes>(static_cast<std::size_t>(points_));
    for (const auto& pairs : same) {
      for (const auto& [i, j] : pairs) points_at_->join(i, j);
    }
  }

  void sort_entries(std::size_t a, std::vector<std::array<int, 2>>& same) {
    std::vector<Entry>& entries = entries_[a];
    const int own = all_.arcs[a].support;
    std::vector<int> order(entries.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, [&](int i, int j) {
      return compare(all_.supports, own, entries[i].at, entries[j].at) == Sign::Negative;
    });
    std::vector<ArcParameter>& positions = positions_[a];
    rank_[a].resize(entries.size());
    int last = -1;
    for (const int i : order) {
      if (last >= 0 &&
          compare(all_.supports, own, entries[last].at, entries[i].at) == Sign::Zero) {
        same.push_back({entries[last].point, entries[i].point});
        keep_better(positions.back(), entries[i].at);
      } else {
        positions.push_back(entries[i].at);
        point_of_position_[a].push_back(entries[i].point);
      }
      rank_[a][i] = static_cast<int>(positions.size()) - 1;
      last = i;
    }
  }

  // Of two enclosures of one position.
  static void keep_better(ArcParameter& p, const ArcParameter& q) {
    const auto simple = [](const ArcParameter& x) {
      return x.exact && std::holds_alternative<QuadraticRoot>(*x.exact);
    };
    const double pw = p.range.hi - p.range.lo, qw = q.range.hi - q.range.lo;
    if (std::pair(!simple(q), qw) < std::pair(!simple(p), pw)) p = q;
  }

  void number_vertices() {
    vertex_of_.resize(arc_count());
    std::vector<int> number(static_cast<std::size_t>(points_), -1);
    for (std::size_t a = 0; a < arc_count(); ++a) {
      for (const int point : point_of_position_[a]) {
        int& n = number[points_at_->root(point)];
        if (n < 0) n = vertex_count_++;
        vertex_of_[a].push_back(n);
      }
    }
  }

  void add_edges(std::span<const PlaneCurve> curves) {
    for (std::size_t a = 0; a < arc_count(); ++a) {
      const std::size_t first = edges_.size();
      const std::vector<int>& vertices = vertex_of_[a];
      for (std::size_t k = 0; k + 1 < vertices.size(); ++k) {
        const int i = static_cast<int>(k);
        edges_.push_back(
            {{vertices[k], vertices[k + 1]}, static_cast<int>(a), {i, i + 1}});
      }
      ids_.resize(edges_.size());
      const std::vector<ArcMember>& members = all_.arcs[a].members;
      for (std::size_t m = 0; m < members.size(); ++m) {
        const int from = rank_[a][member_first_[a] + 2 * m];
        const int to = rank_[a][member_first_[a] + 2 * m + 1];
        if (members[m].curve < 0) {
          corners_[a].push_back(from);
          corners_[a].push_back(to);
        }
        for (int k = from; k < to; ++k) {
          PlanarEdge& edge = edges_[first + static_cast<std::size_t>(k)];
          if (members[m].curve >= 0) {
            ids_[first + static_cast<std::size_t>(k)].push_back(
                curves[members[m].curve].id);
          } else {
            edge.outline = true;
            edge.inside_of_first = !members[m].backwards;
          }
        }
      }
    }
    for (std::vector<int>& positions : corners_) std::ranges::sort(positions);
    unite_pieces_of_conics();
  }

  // Of two edges between the same vertices on one conic: are they the same piece?
  [[nodiscard]] bool same_piece(const PlanarEdge& e, const PlanarEdge& f) {
    const auto at = [&](const PlanarEdge& g, int end) -> const ExactParameter& {
      return exact(all_.supports, all_.arcs[g.arc].support,
                   positions_[g.arc][g.position[end]]);
    };
    const QuadraticRoot s = quadratic_root(between(at(e, 0), at(e, 1)));
    const SurdPoint p = point_at(all_.supports[all_.arcs[e.arc].support], s);
    const std::optional<QuadraticRoot> t =
        parameter_of(all_.supports[all_.arcs[f.arc].support], p);
    return t && compare(ExactParameter(*t), at(f, 0)) == Sign::Positive &&
           compare(ExactParameter(*t), at(f, 1)) == Sign::Negative;
  }

  void unite_pieces_of_conics() {
    std::map<std::array<int, 3>, std::vector<std::size_t>> pieces;
    std::vector<int> arcs_on(all_.supports.size(), 0);
    for (const PlaneArc& arc : all_.arcs) ++arcs_on[all_.conic[arc.support]];
    std::vector<char> dropped(edges_.size(), 0);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const int support = all_.arcs[edges_[e].arc].support;
      if (all_.supports[support].straight || arcs_on[all_.conic[support]] < 2) continue;
      const auto [u, v] = std::minmax(edges_[e].ends[0], edges_[e].ends[1]);
      std::vector<std::size_t>& others = pieces[{all_.conic[support], u, v}];
      const auto same = std::ranges::find_if(
          others, [&](std::size_t f) { return same_piece(edges_[f], edges_[e]); });
      if (same == others.end()) {
        others.push_back(e);
        continue;
      }
      dropped[e] = 1;
      ids_[*same].insert(ids_[*same].end(), ids_[e].begin(), ids_[e].end());
    }
    std::size_t kept = 0;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (dropped[e]) continue;
      if (kept != e) {
        edges_[kept] = edges_[e];
        ids_[kept] = std::move(ids_[e]);
      }
      ++kept;
    }
    edges_.resize(kept);
    ids_.resize(kept);
  }

  void add_vertices(PlanarData& map) const {
    std::vector<std::vector<int>> stars(static_cast<std::size_t>(vertex_count_));
    for (std::size_t e = 0; e < map.edges.size(); ++e) {
      for (const int end : {0, 1}) {
        stars[map.edges[e].ends[end]].push_back(static_cast<int>(2 * e) + end);
      }
    }
    const HalfEdgeOrder order(*map.geometry, map.edges);
    const double most = kVertexError * largest_coordinate(map.geometry->all);
    map.vertices.resize(stars.size());
    in_parallel(stars.size(), [&](std::size_t v) {
      map.vertices[v] = rounded_vertex(map, stars[v], most);
      if (stars[v].size() > 2) order.sort(stars[v]);
    });
    for (const std::vector<int>& star : stars) map.stars.add(star);
  }

  // The best of the enclosures that the edges at a vertex give.
  static PlanarVertex rounded_vertex(const PlanarData& map, const std::vector<int>& star,
                                     double most) {
    PlanarVertex best{{0, 0}, std::numeric_limits<double>::infinity()};
    for (const bool precise : {false, true}) {
      for (const int h : star) {
        ArcParameter at = map.position(h >> 1, h & 1);
        const int support = map.geometry->all.arcs[map.edges[h >> 1].arc].support;
        const BallNumber s =
            precise ? precise_ball(exact(map.geometry->all.supports, support, at))
                    : ball(at.range);
        const auto r = point_range(map.geometry->all.supports[support], s);
        if (!r) continue;
        const double x = r->x.middle(), y = r->y.middle();
        const double error =
            std::max({r->x.hi - x, x - r->x.lo, r->y.hi - y, y - r->y.lo});
        if (error < best.error) best = PlanarVertex{{x, y}, error};
        if (precise && best.error <= most) break;
      }
      if (best.error <= most) break;
    }
    return best;
  }

  PlaneArcs all_;
  std::vector<std::vector<Entry>> entries_;  // of an arc
  std::vector<std::size_t> member_first_;    // of an arc
  std::vector<std::vector<int>> rank_;       // of an entry: its position
  std::vector<std::vector<ArcParameter>> positions_;
  std::vector<std::vector<int>> point_of_position_{arc_count()};
  std::vector<std::vector<int>> corners_{arc_count()};
  std::vector<std::vector<int>> vertex_of_;  // of a position
  std::unique_ptr<Classes> points_at_;
  int points_ = 0;
  int vertex_count_ = 0;
  std::vector<PlanarEdge> edges_;
  std::vector<std::vector<int>> ids_;  // of an edge
};

}  // namespace

PlanarData vertices_and_edges(std::span<const PlaneCurve> curves,
                              const PlaneOutline& outline, CrossingCounts& counts) {
  return MapBuilder(plane_arcs(curves, outline)).build(curves, counts);
}

}  // namespace sightline::internal
