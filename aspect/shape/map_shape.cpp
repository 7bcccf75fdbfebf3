#include "aspect/shape/map_shape.h"

#include <algorithm>
#include <optional>

#include "linespace/checksum.h"

namespace sightline::internal {
namespace {

using Code = std::vector<std::int32_t>;

// Components of the map hang in regions, and regions in components: a tree.  The code of
// a part of it, seen from a region or a component, is the same for isomorphic parts.
class Coder {
 public:
  explicit Coder(const ShapeMap& map) : map_(&map) {
    const std::size_t darts = 2 * map.edges.size();
    next_.resize(darts);
    region_.resize(darts, -1);
    walk_.resize(darts, -1);
    for (std::size_t r = 0; r < map.regions.size(); ++r) {
      for (const auto& walk : map.regions[r].boundary) {
        const std::size_t n = walk.size();
        for (std::size_t k = 0; k < n; ++k) {
          next_[walk[k]] = walk[(k + 1) % n];
          region_[walk[k]] = static_cast<int>(r);
          walk_[walk[k]] = walks_;
        }
        lengths_.push_back(static_cast<int>(n));
        ++walks_;
      }
    }
    degree_.resize(map.vertex_kinds.size(), 0);
    for (const ShapeMap::Edge& e : map.edges) {
      for (const int v : e.ends) ++degree_[v];
    }
    seen_.resize(darts, -1);
  }

  Code code() {
    Code best;
    for (const int root : roots()) {
      Code c = of_region(root, -1);
      if (best.empty() || c < best) best = std::move(c);
    }
    return best;
  }

 private:
  // Regions of the rarest look: the isomorphism maps one of them to one of them.
  [[nodiscard]] std::vector<int> roots() const {
    std::vector<std::pair<std::array<int, 3>, int>> all;  // kind, walks, darts

    for (std::size_t r = 0; r < map_->regions.size(); ++r) {
      const ShapeMap::Region& region = map_->regions[r];
      int length = 0;
      for (const auto& walk : region.boundary) length += static_cast<int>(walk.size());
      all.push_back({{region.kind, static_cast<int>(region.boundary.size()), length},
                     static_cast<int>(r)});
    }
    std::ranges::sort(all);
    std::vector<int> best;
    for (std::size_t k = 0; k < all.size();) {
      std::size_t end = k;
      while (end < all.size() && all[end].first == all[k].first) ++end;
      if (best.empty() || end - k < best.size()) {
        best.clear();
        for (std::size_t i = k; i < end; ++i) best.push_back(all[i].second);
      }
      k = end;
    }
    return best;
  }

  // The region with all that hangs in it, but for the component that has this walk.
  Code of_region(int r, int without) {
    std::vector<Code> parts;
    for (const auto& walk : map_->regions[r].boundary) {
      if (walk_[walk.front()] != without) parts.push_back(of_component(walk));
    }
    std::ranges::sort(parts);
    Code out{map_->regions[r].kind, static_cast<std::int32_t>(parts.size())};
    for (const Code& part : parts) out.insert(out.end(), part.begin(), part.end());
    return out;
  }

  struct Look {
    int kind, vertex, degree, beyond, length;
    friend auto operator<=>(const Look&, const Look&) = default;
  };
  [[nodiscard]] Look look(int dart) const {
    const int v = map_->edges[dart / 2].ends[dart % 2];
    return {map_->edges[dart / 2].kind, map_->vertex_kinds[v], degree_[v],
            map_->regions[region_[dart ^ 1]].kind, lengths_[walk_[dart ^ 1]]};
  }

  // A component as it is seen from the region in which it has this walk: the smallest
  // traversal from a dart of the rarest look.
  Code of_component(const std::vector<int>& walk) {
    std::vector<std::pair<Look, int>> all;
    for (const int d : walk) all.emplace_back(look(d), d);
    std::ranges::sort(all);
    std::size_t from = 0, to = all.size() + 1;
    for (std::size_t k = 0; k < all.size();) {
      std::size_t end = k;
      while (end < all.size() && all[end].first == all[k].first) ++end;
      if (end - k < to - from) {
        from = k;
        to = end;
      }
      k = end;
    }
    std::optional<Code> best;
    for (std::size_t k = from; k < to; ++k) {
      Code c = traversal(all[k].second);
      if (!best || c < *best) best = std::move(c);
    }
    return *best;
  }

  Code traversal(int start) {
    std::vector<int> order{start};
    seen_[start] = 0;
    Code out;
    const auto number = [&](int d) {
      if (seen_[d] < 0) {
        seen_[d] = static_cast<int>(order.size());
        order.push_back(d);
      }
      return seen_[d];
    };
    std::vector<std::pair<std::size_t, int>> inner;  // where, and the first dart there
    std::vector<int> known{walk_[start]};
    for (std::size_t k = 0; k < order.size(); ++k) {
      const int d = order[k];
      const ShapeMap::Edge& edge = map_->edges[d / 2];
      out.push_back(edge.kind * 8 + map_->vertex_kinds[edge.ends[d % 2]]);
      out.push_back(number(next_[d]));
      out.push_back(number(d ^ 1));
      if (std::ranges::find(known, walk_[d]) != known.end()) continue;
      known.push_back(walk_[d]);
      inner.emplace_back(k, d);
    }
    for (const int d : order) seen_[d] = -1;
    for (const auto& [where, d] : inner) {
      const Code region = of_region(region_[d], walk_[d]);
      out.push_back(static_cast<std::int32_t>(where));
      out.insert(out.end(), region.begin(), region.end());
    }
    return out;
  }

  const ShapeMap* map_;
  std::vector<int> next_, region_, walk_, lengths_, degree_, seen_;
  int walks_ = 0;
};

}  // namespace

ShapeMap shape_map(const PointView& view) {
  ShapeMap map;
  for (const MapVertex& v : view.vertices)
    map.vertex_kinds.push_back(static_cast<std::uint8_t>(v.kind));
  for (const MapEdge& e : view.edges)
    map.edges.push_back({e.ends, static_cast<std::uint8_t>(e.kind)});
  for (const MapRegion& r : view.regions)
    map.regions.push_back(
        {static_cast<std::uint8_t>(r.patches.empty() ? 0 : 1), r.boundary});
  return map;
}

std::string shape_of(const ShapeMap& map) {
  Checksum sum;
  for (const std::int32_t c : Coder(map).code()) sum.add(static_cast<std::uint64_t>(c));
  return sum.text();
}

}  // namespace sightline::internal
