#include "shadows/factors/convex_merge.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "linespace/predicates.h"
#include "shadows/factors/exchange_geometry.h"

namespace sightline::internal {
namespace {

using Side = std::array<double, 6>;

Side side_of(const Point& a, const Point& b) {
  return {a.x(), a.y(), a.z(), b.x(), b.y(), b.z()};
}

/// How a, b, c turn, seen against the normal; nullopt where rounding may decide.
std::optional<int> turn(const Point& a, const Point& b, const Point& c,
                        const Eigen::Vector3d& normal) {
  const Eigen::Vector3d cross = (b - a).cross(c - b);
  if (cross == Eigen::Vector3d::Zero()) return 0;
  const double value = normal.dot(cross);
  const double size = normal.norm() * (b - a).norm() * (c - b).norm();
  // A thousand times what the roundings of two differences and two products do.
  constexpr double kTurnIsSure = 1e-12;
  if (std::abs(value) < kTurnIsSure * size) return std::nullopt;
  return value > 0 ? 1 : -1;
}

class Merger {
 public:
  explicit Merger(std::vector<PointList> polygons) : polygons_(std::move(polygons)) {
    for (std::size_t i = 0; i < polygons_.size(); ++i) enter(i);
  }

  std::vector<PointList> merge() {
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
      while (!polygons_[i].empty() && grow(i)) {
      }
    }
    // Rows that have grown may fit on each other now.
    bool grown = true;
    while (grown) {
      grown = false;
      for (std::size_t i = 0; i < polygons_.size(); ++i) {
        while (!polygons_[i].empty() && grow(i)) grown = true;
      }
    }
    std::erase_if(polygons_, [](const PointList& p) { return p.empty(); });
    return std::move(polygons_);
  }

 private:
  void enter(std::size_t i) {
    const PointList& p = polygons_[i];
    for (std::size_t k = 0; k < p.size(); ++k) {
      owners_.emplace(side_of(p[k], p[(k + 1) % p.size()]), i);
    }
  }
  void leave(std::size_t i) {
    const PointList& p = polygons_[i];
    for (std::size_t k = 0; k < p.size(); ++k) {
      auto [first, last] = owners_.equal_range(side_of(p[k], p[(k + 1) % p.size()]));
      for (; first != last; ++first) {
        if (first->second == i) {
          owners_.erase(first);
          break;
        }
      }
    }
  }
  bool grow(std::size_t i) {
    const PointList p = polygons_[i];
    for (std::size_t k = 0; k < p.size(); ++k) {
      const auto [first, last] =
          owners_.equal_range(side_of(p[(k + 1) % p.size()], p[k]));
      for (auto it = first; it != last; ++it) {
        const std::size_t j = it->second;
        if (j == i) continue;
        if (auto both = joined(p, k, polygons_[j])) {
          leave(i);
          leave(j);
          polygons_[j].clear();
          polygons_[i] = std::move(*both);
          enter(i);
          return true;
        }
      }
    }
    return false;
  }
  /// p's side k is a side of the other polygon, the other way round.
  static std::optional<PointList> joined(const PointList& p, std::size_t k,
                                         const PointList& other) {
    const auto c = spanning_corners(p);
    for (const Point& q : other) {
      if (orient3d(c[0], c[1], c[2], q) != Sign::Zero) return std::nullopt;
    }
    const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
    const auto d = spanning_corners(other);
    if (normal.dot((d[1] - d[0]).cross(d[2] - d[0])) <= 0) return std::nullopt;
    PointList all;
    for (std::size_t i = 1; i <= p.size(); ++i) all.push_back(p[(k + i) % p.size()]);
    const auto begin = std::ranges::find(other, all.back()) - other.begin();
    for (std::size_t i = 1; i + 1 < other.size(); ++i) {
      all.push_back(other[(begin + i) % other.size()]);
    }
    PointList result;
    const std::size_t n = all.size();
    for (std::size_t i = 0; i < n; ++i) {
      const auto t = turn(all[(i + n - 1) % n], all[i], all[(i + 1) % n], normal);
      if (!t || *t < 0) return std::nullopt;
      if (*t > 0) result.push_back(all[i]);
    }
    if (result.size() < 3) return std::nullopt;
    return result;
  }

  std::vector<PointList> polygons_;
  std::multimap<Side, std::size_t> owners_;
};

}  // namespace

std::vector<PointList> merged_convex(std::vector<PointList> polygons) {
  return Merger(std::move(polygons)).merge();
}

}  // namespace sightline::internal
