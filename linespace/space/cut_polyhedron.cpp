#include "linespace/space/cut_polyhedron.h"

#include <algorithm>
#include <map>

namespace sightline::internal {

CutPolyhedron::CutPolyhedron(const ExactPoint& low, const ExactPoint& high) {
  for (int i = 0; i < 3; ++i) {
    if (!(low[i] < high[i])) return;
  }
  for (int k = 0; k < 8; ++k) {
    points_.push_back({(k & 1) != 0 ? high[0] : low[0], (k & 2) != 0 ? high[1] : low[1],
                       (k & 4) != 0 ? high[2] : low[2]});
  }
  facets_ = {{{0, 4, 6, 2}, {0}}, {{1, 3, 7, 5}, {1}}, {{0, 1, 5, 4}, {2}},
             {{2, 6, 7, 3}, {3}}, {{0, 2, 3, 1}, {4}}, {{4, 5, 7, 6}, {5}}};
}

std::vector<int> CutPolyhedron::signs(const HalfSpace& half_space) const {
  std::vector<int> signs;
  for (const ExactPoint& p : points_) signs.push_back(half_space.sign(p));
  return signs;
}

void CutPolyhedron::cut(const HalfSpace& half_space, int number) {
  if (empty()) return;
  // 1. All of it is inside, perhaps with a facet in the plane; or nothing is.
  std::vector<int> sign = signs(half_space);
  if (std::ranges::find(sign, 1) == sign.end()) {
    for (Facet& facet : facets_) {
      if (std::ranges::all_of(facet.corners, [&](int c) { return sign[c] == 0; }))
        facet.planes.push_back(number);
    }
    return;
  }
  if (std::ranges::find(sign, -1) == sign.end()) {
    facets_.clear();
    points_.clear();
    return;
  }
  // 2. Each facet without what is outside.
  std::map<std::array<int, 2>, int> crossings;
  const auto crossing = [&](int p, int q) {
    const auto [at, fresh] = crossings.try_emplace({std::min(p, q), std::max(p, q)},
                                                   static_cast<int>(points_.size()));
    if (fresh) {
      const Rational u = exact_dot(half_space.normal, points_[p]) - half_space.offset;
      const Rational v = exact_dot(half_space.normal, points_[q]) - half_space.offset;
      points_.push_back(along(points_[p], points_[q], Rational(u / (u - v))));
      sign.push_back(0);
    }
    return at->second;
  };
  std::vector<Facet> kept;
  std::map<int, int> next;  // on the new facet
  for (Facet& facet : facets_) {
    std::vector<int> loop;
    bool inside = false;
    for (std::size_t i = 0; i < facet.corners.size(); ++i) {
      const int p = facet.corners[i], q = facet.corners[(i + 1) % facet.corners.size()];
      inside |= sign[p] < 0;
      if (sign[p] <= 0) loop.push_back(p);
      if (sign[p] * sign[q] < 0) loop.push_back(crossing(p, q));
    }
    if (!inside) continue;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int p = loop[i], q = loop[(i + 1) % loop.size()];
      if (sign[p] == 0 && sign[q] == 0) next[q] = p;
    }
    facet.corners = std::move(loop);
    kept.push_back(std::move(facet));
  }
  // 3. The facet in the plane.
  Facet cap{{}, {number}};
  int at = next.begin()->first;
  do {
    cap.corners.push_back(at);
    at = next.at(at);
  } while (at != cap.corners.front());
  kept.push_back(std::move(cap));
  facets_ = std::move(kept);
  forget_unused_points();
}

void CutPolyhedron::forget_unused_points() {
  std::vector<int> position(points_.size(), -1);
  std::vector<ExactPoint> used;
  for (Facet& facet : facets_) {
    for (int& c : facet.corners) {
      if (position[c] < 0) {
        position[c] = static_cast<int>(used.size());
        used.push_back(std::move(points_[c]));
      }
      c = position[c];
    }
  }
  points_ = std::move(used);
}

Rational CutPolyhedron::volume() const {
  Rational sum = 0;
  for (const Facet& facet : facets_) {
    for (std::size_t k = 2; k < facet.corners.size(); ++k) {
      sum += exact_orient(points_[facet.corners[0]], points_[facet.corners[k - 1]],
                          points_[facet.corners[k]], points_[0]);
    }
  }
  return -sum / 6;
}

}  // namespace sightline::internal
