#include "viewers/pictures/trapezoids.h"

#include <algorithm>
#include <map>

namespace sightline::viewers {
namespace {

/// A side of a ring, going up.
struct Side {
  PlanePoint low, high;

  [[nodiscard]] PlanePoint at(double y) const {
    if (y <= low.y()) return low;
    if (y >= high.y()) return high;
    const double t = (y - low.y()) / (high.y() - low.y());
    return {low.x() + t * (high.x() - low.x()), y};
  }
};

std::vector<Side> sides_of(const std::vector<std::vector<PlanePoint>>& rings) {
  std::vector<Side> sides;
  for (const std::vector<PlanePoint>& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const PlanePoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if (a.y() < b.y()) sides.push_back({a, b});
      if (b.y() < a.y()) sides.push_back({b, a});
    }
  }
  std::ranges::sort(sides, {}, [](const Side& s) { return s.low.y(); });
  return sides;
}

std::vector<double> heights_of(const std::vector<Side>& sides) {
  std::vector<double> heights;
  for (const Side& side : sides) {
    heights.push_back(side.low.y());
    heights.push_back(side.high.y());
  }
  std::ranges::sort(heights);
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  return heights;
}

/// What is between two sides from one height to another.
std::vector<PlanePoint> piece(const Side& left, const Side& right, double from,
                              double to) {
  std::vector<PlanePoint> corners;
  for (const PlanePoint& p : {left.at(from), right.at(from), right.at(to), left.at(to)}) {
    if (corners.empty() || corners.back() != p) corners.push_back(p);
  }
  if (corners.front() == corners.back()) corners.pop_back();
  return corners;
}

}  // namespace

std::vector<std::vector<PlanePoint>> trapezoids(
    const std::vector<std::vector<PlanePoint>>& rings) {
  const std::vector<Side> sides = sides_of(rings);
  const std::vector<double> heights = heights_of(sides);
  std::vector<std::vector<PlanePoint>> pieces;
  const auto add = [&](const std::pair<int, int>& beside, double from, double to) {
    std::vector<PlanePoint> p =
        piece(sides[beside.first], sides[beside.second], from, to);
    if (p.size() > 2) pieces.push_back(std::move(p));
  };
  std::vector<int> active;
  std::size_t next = 0;
  // The sides beside each piece that has begun, and where.
  std::map<std::pair<int, int>, double> open;
  for (std::size_t h = 0; h < heights.size(); ++h) {
    const double y = heights[h];
    std::erase_if(active, [&](int s) { return sides[s].high.y() <= y; });
    while (next < sides.size() && sides[next].low.y() <= y) {
      active.push_back(static_cast<int>(next++));
    }
    std::map<std::pair<int, int>, double> going;
    if (h + 1 < heights.size()) {
      const double middle = 0.5 * (y + heights[h + 1]);
      std::ranges::sort(active, {}, [&](int s) { return sides[s].at(middle).x(); });
      for (std::size_t i = 0; i + 1 < active.size(); i += 2) {
        const std::pair<int, int> beside{active[i], active[i + 1]};
        const auto begun = open.find(beside);
        going[beside] = begun == open.end() ? y : begun->second;
      }
    }
    for (const auto& [beside, from] : open) {
      if (!going.contains(beside)) add(beside, from, y);
    }
    open = std::move(going);
  }
  return pieces;
}

}  // namespace sightline::viewers
