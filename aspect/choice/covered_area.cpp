#include "aspect/choice/covered_area.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/polygon/polygon.hpp>
#include <cmath>

namespace sightline::internal {
namespace {

namespace grid = boost::polygon;
using namespace boost::polygon::operators;  // NOLINT: set operations are operators there
using GridPoint = grid::point_data<int>;
using GridPolygon = grid::polygon_data<int>;
using GridSet = grid::polygon_set_data<int>;

double area_of(const GridSet& set) {
  return set.empty() ? 0 : static_cast<double>(grid::area(set));
}

}  // namespace

struct PatchArea::Impl {
  Point low;             // the middle of the patch
  Eigen::Vector3d u, v;  // of length 1
  double scale = 1;      // grid steps a scene unit
  GridSet left;
  double whole = 0;
  std::vector<GridPolygon> pieces;

  [[nodiscard]] GridSet set_of(const std::vector<std::vector<Point>>& outlines) const {
    GridSet out;
    for (const auto& outline : outlines) {
      std::vector<GridPoint> points;
      for (const Point& p : outline) {
        constexpr double kEnd = 1 << 30;
        const auto on_grid = [&](const Eigen::Vector3d& axis) {
          return static_cast<int>(
              std::lround(std::clamp(axis.dot(p - low) * scale, -kEnd, kEnd)));
        };
        points.emplace_back(on_grid(u), on_grid(v));
      }
      GridSet one;
      one.insert(GridPolygon(points.begin(), points.end()));
      out ^= one;
    }
    return out;
  }

  [[nodiscard]] const GridPolygon& largest() {
    pieces.clear();
    left.get_trapezoids(pieces);
    return *std::ranges::max_element(pieces, {},
                                     [](const GridPolygon& p) { return grid::area(p); });
  }
};

PatchArea::PatchArea(const Scene& scene, const PatchSide& side)
    : impl_(std::make_unique<Impl>()) {
  const Eigen::Vector3d n = side.normal.normalized();
  impl_->u = n.unitOrthogonal();
  impl_->v = n.cross(impl_->u);
  std::vector<std::vector<Point>> faces;
  Point sum = Point::Zero();
  double count = 0;
  for (const int f : side.faces) {
    std::vector<Point>& outline = faces.emplace_back();
    for (const int p : scene.face_points(f)) {
      outline.push_back(scene.point(p));
      sum += scene.point(p);
      ++count;
    }
  }
  impl_->low = sum / count;
  double extent = 0;
  for (const auto& outline : faces) {
    for (const Point& p : outline) extent = std::max(extent, (p - impl_->low).norm());
  }
  impl_->scale = (1 << 28) / extent;
  for (const auto& outline : faces) impl_->left += impl_->set_of({outline});
  impl_->whole = area_of(impl_->left);
}
PatchArea::~PatchArea() = default;
PatchArea::PatchArea(PatchArea&&) noexcept = default;

void PatchArea::take_away(const SeenRegion& region) {
  impl_->left -= impl_->set_of(region.outlines);
}

double PatchArea::left() const { return area_of(impl_->left) / impl_->whole; }

Point PatchArea::place_left() const {
  const GridPolygon& piece = impl_->largest();
  double x = 0, y = 0, n = 0;
  for (auto p = piece.begin(); p != piece.end(); ++p) {
    x += grid::x(*p);
    y += grid::y(*p);
    ++n;
  }
  return impl_->low + (impl_->u * x + impl_->v * y) / (n * impl_->scale);
}

void PatchArea::give_up_place() {
  GridSet piece;
  piece.insert(impl_->largest());
  impl_->left -= piece;
}

bool contains(const SeenRegion& region, const PatchSide& side, const Point& place) {
  int drop = 0;
  side.normal.cwiseAbs().maxCoeff(&drop);
  const int x = (drop + 1) % 3, y = (drop + 2) % 3;
  bool inside = false;
  for (const auto& outline : region.outlines) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Point &a = outline[i], &b = outline[(i + 1) % outline.size()];
      if ((a[y] > place[y]) == (b[y] > place[y])) continue;
      const double at = a[x] + (place[y] - a[y]) / (b[y] - a[y]) * (b[x] - a[x]);
      if (place[x] < at) inside = !inside;
    }
  }
  return inside;
}

bool shows(const SeenParts& view, const PatchSide& side, const Point& place) {
  return std::ranges::any_of(view.regions, [&](const SeenRegion& region) {
    return region.patch == side.patch && contains(region, side, place);
  });
}

}  // namespace sightline::internal
