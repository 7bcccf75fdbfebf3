#include "linespace/blockers/edge_pieces.h"

#include <algorithm>
#include <cmath>

namespace sightline::internal {
namespace {

// Speed only: nine of ten edges are no longer than the usual length; pieces are half as
// long, and edges up to four times as long are left whole.
constexpr double kUsual = 0.9;
constexpr double kLong = 4;
constexpr double kPiece = 0.5;
constexpr int kMostPieces = 64;

// Around the point at x: the difference, the product and the sum are rounded once each.
Box around(const Point& p0, const Point& p1, double x, double outwards) {
  Box box;
  int varies = 0;
  for (int i = 0; i < 3; ++i) varies += p0[i] != p1[i] ? 1 : 0;
  for (int i = 0; i < 3; ++i) {
    const double d = p1[i] - p0[i];
    const double at = x == 0 ? p0[i] : x == 1 ? p1[i] : p0[i] + x * d;
    box.min[i] = box.max[i] = at;
    if (d == 0 || x == 0 || x == 1) continue;
    const double error = 4 * kUnit * (std::abs(p0[i]) + std::abs(d));
    if (varies == 1) {
      const double shifted = at + (d > 0 ? outwards : -outwards) * error;
      box.min[i] = box.max[i] =
          std::clamp(shifted, std::min(p0[i], p1[i]), std::max(p0[i], p1[i]));
    } else {
      box.min[i] = at - error;
      box.max[i] = at + error;
    }
  }
  return box;
}

}  // namespace

std::array<double, 3> EdgePiece::pad() const {
  std::array<double, 3> pad;
  for (int i = 0; i < 3; ++i) {
    pad[i] = (1 + 2 * kUnit) *
             std::max(ends[0].max[i] - ends[0].min[i], ends[1].max[i] - ends[1].min[i]);
  }
  return pad;
}

std::vector<Point> EdgePiece::corners() const {
  std::vector<Point> points;
  for (const Box& box : ends) {
    for (unsigned c = 0; c < 8; ++c) {
      Point p;
      bool again = false;
      for (int i = 0; i < 3; ++i) {
        const bool upper = (c >> i & 1u) != 0;
        again |= upper && box.min[i] == box.max[i];
        p[i] = upper ? box.max[i] : box.min[i];
      }
      if (!again) points.push_back(p);
    }
  }
  return points;
}

EdgePiece piece_of(const Point& p0, const Point& p1, double from, double to) {
  return {from, to, {around(p0, p1, from, -1), around(p0, p1, to, 1)}};
}

EdgeCutter::EdgeCutter(const Silhouettes& silhouettes) : usual_(0) {
  const Scene& scene = silhouettes.scene();
  std::vector<double> lengths;
  for (const Ridge& r : silhouettes.ridges()) {
    lengths.push_back((scene.point(r.points[1]) - scene.point(r.points[0])).norm());
  }
  if (lengths.empty()) return;
  const auto at = lengths.begin() + static_cast<std::ptrdiff_t>(
                                        kUsual * static_cast<double>(lengths.size()));
  std::nth_element(lengths.begin(), at, lengths.end());
  usual_ = *at;
}

int EdgeCutter::pieces(const Point& p0, const Point& p1) const {
  const double length = (p1 - p0).norm();
  if (!(length > kLong * usual_)) return 1;
  int pieces = 1;
  while (pieces < kMostPieces && length > kPiece * usual_ * pieces) pieces *= 2;
  return pieces;
}

}  // namespace sightline::internal
