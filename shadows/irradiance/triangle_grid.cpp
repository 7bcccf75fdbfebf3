#include "shadows/irradiance/triangle_grid.h"

#include <algorithm>
#include <cmath>

namespace sightline::internal {
namespace {

// So far outside of a triangle, in its own coordinates, may a point lie that rounding
// parts from it.
constexpr double kRounding = 1e-9;

}  // namespace

TriangleGrid::TriangleGrid(const std::vector<Corners>& triangles) {
  if (triangles.empty()) return;
  low_ = triangles[0][0];
  Eigen::Vector2d high = low_;
  for (const Corners& t : triangles) {
    for (const auto& p : t) {
      low_ = low_.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const Eigen::Vector2d u = t[1] - t[0], v = t[2] - t[0];
    const double d = u.x() * v.y() - u.y() * v.x();
    places_.push_back(
        {t[0], Eigen::Vector2d(v.y(), -v.x()) / d, Eigen::Vector2d(-u.y(), u.x()) / d});
  }
  side_ = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(triangles.size()))));
  step_ = (high - low_) / side_;
  std::vector<std::vector<int>> cells(triangles.size());
  starts_.assign(static_cast<std::size_t>(side_) * side_ + 1, 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    list_cells(triangles[t], cells[t]);
    for (const int c : cells[t]) ++starts_[c + 1];
  }
  for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
  listed_.resize(starts_.back());
  std::vector<int> next = starts_;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const int c : cells[t]) listed_[next[c]++] = static_cast<int>(t);
  }
}

int TriangleGrid::column(int axis, double x) const {
  return std::clamp(static_cast<int>((x - low_[axis]) / step_[axis]), 0, side_ - 1);
}

// A cell is left out if it lies beyond a side of the triangle, by more than roundings.
void TriangleGrid::list_cells(const Corners& t, std::vector<int>& cells) const {
  const Eigen::Vector2d low = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
  const Eigen::Vector2d high = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
  const Eigen::Vector2d half = 0.5 * step_;
  for (int y = column(1, low.y()); y <= column(1, high.y()); ++y) {
    for (int x = column(0, low.x()); x <= column(0, high.x()); ++x) {
      const Eigen::Vector2d middle(low_.x() + (x + 0.5) * step_.x(),
                                   low_.y() + (y + 0.5) * step_.y());
      bool beyond = false;
      for (int i = 0; i < 3 && !beyond; ++i) {
        const Eigen::Vector2d side = t[(i + 1) % 3] - t[i];
        const Eigen::Vector2d left(-side.y(), side.x());
        const double reach =
            std::abs(left.x()) * half.x() + std::abs(left.y()) * half.y();
        beyond = left.dot(middle - t[i]) < -(1 + 1e-6) * reach;
      }
      if (!beyond) cells.push_back(y * side_ + x);
    }
  }
}

std::optional<TriangleGrid::Found> TriangleGrid::find(const Eigen::Vector2d& p) const {
  if (places_.empty()) return std::nullopt;
  const int cell = column(1, p.y()) * side_ + column(0, p.x());
  double best = -kRounding;
  Found found{-1, {}};
  for (int i = starts_[cell]; i < starts_[cell + 1]; ++i) {
    const Place& place = places_[listed_[i]];
    const Eigen::Vector2d w = p - place.corner;
    const double b = place.x.dot(w), c = place.y.dot(w);
    const double least = std::min({1 - b - c, b, c});
    if (!(least > best)) continue;
    best = least;
    found = {listed_[i], {1 - b - c, b, c}};
    if (least >= 0) break;
  }
  if (found.triangle < 0) return std::nullopt;
  return found;
}

}  // namespace sightline::internal
