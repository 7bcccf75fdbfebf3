#include "linespace/swaths/carriers.h"

#include <algorithm>
#include <unordered_map>

#include "linespace/work/stop_scope.h"

namespace sightline::internal {

Carriers::Carriers(const Silhouettes& g) {
  const Scene& scene = g.scene();
  std::unordered_map<std::uint64_t, std::int32_t> known;
  const auto key = [](std::int32_t p, std::int32_t q) {
    return (static_cast<std::uint64_t>(std::min(p, q)) << 32) |
           static_cast<std::uint32_t>(std::max(p, q));
  };
  const auto carrier_of = [&](std::int32_t p, std::int32_t q, std::int32_t edge) {
    const auto [at, fresh] =
        known.try_emplace(key(p, q), static_cast<std::int32_t>(all.size()));
    if (fresh) {
      all.push_back({{std::min(p, q), std::max(p, q)}, edge});
      ridge.push_back(edge >= 0 ? g.ridge_of_edge(edge) : -1);
    }
    return at->second;
  };
  std::vector<std::int32_t> of_edge;
  for (std::size_t e = 0; e < scene.edges().size(); ++e) {
    hear_stop();
    const auto& points = scene.edges()[e].points;
    of_edge.push_back(carrier_of(points[0], points[1], static_cast<std::int32_t>(e)));
  }
  for (const Ridge& r : g.ridges()) of_ridge.push_back(of_edge[r.edge]);
  starts.push_back(0);
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    hear_stop();
    const auto corners = scene.face_points(static_cast<int>(f));
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const int p = corners[k];
      const int q = corners[(k + 1) % corners.size()];
      const int edge = scene.edge_of_side(static_cast<int>(f), static_cast<int>(k));
      const std::int32_t c = edge >= 0 ? of_edge[edge] : carrier_of(p, q, -1);
      // An edge may be longer than the side, and its ends in the other order.
      const Point d = scene.point(q) - scene.point(p);
      const Point along = scene.point(all[c].points[1]) - scene.point(all[c].points[0]);
      int axis = 0;
      d.cwiseAbs().maxCoeff(&axis);
      sides.push_back({c, (d[axis] > 0) == (along[axis] > 0)});
    }
    starts.push_back(static_cast<std::int32_t>(sides.size()));
  }
}

}  // namespace sightline::internal
