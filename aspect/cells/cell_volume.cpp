#include "aspect/cells/cell_volume.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace sightline::internal {
namespace {

using Vec = Eigen::Matrix<long double, 3, 1>;
using Polygon = std::vector<Vec>;

// A convex polyhedron as its faces, counter-clockwise seen from outside, in the unit
// cube.
class Polyhedron {
 public:
  Polyhedron() {
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (const int side : {0, 1}) {
        Polygon face(4, Vec::Zero());
        for (int k = 0; k < 4; ++k) {
          face[k][axis] = side;
          face[k][u] = k == 1 || k == 2 ? 1 : 0;
          face[k][v] = k >= 2 ? 1 : 0;
        }
        if (side == 0) std::ranges::reverse(face);
        faces_.push_back(std::move(face));
      }
    }
  }

  /// Keeps what has n . x + k >= 0, |n| = 1.
  void cut(const Vec& n, long double k) {
    const auto value = [&](const Vec& p) { return n.dot(p) + k; };
    std::vector<Polygon> kept;
    Polygon lid;
    for (const Polygon& face : faces_) {
      Polygon part;
      const std::size_t size = face.size();
      for (std::size_t i = 0; i < size; ++i) {
        const Vec &a = face[i], &b = face[(i + 1) % size];
        const long double at_a = value(a), at_b = value(b);
        if (at_a >= 0) part.push_back(a);
        if ((at_a >= 0) == (at_b >= 0)) continue;
        part.push_back(a + at_a / (at_a - at_b) * (b - a));
        lid.push_back(part.back());
      }
      if (part.size() >= 3) kept.push_back(std::move(part));
    }
    faces_ = std::move(kept);
    if (lid.size() < 3 || faces_.empty()) return;
    // Around their middle, clockwise seen along n: the outside is against n.
    Vec middle = Vec::Zero();
    for (const Vec& p : lid) middle += p / static_cast<long double>(lid.size());
    const Vec u = n.unitOrthogonal(), v = n.cross(u);
    std::ranges::sort(lid, std::ranges::greater{}, [&](const Vec& p) {
      return std::atan2(v.dot(p - middle), u.dot(p - middle));
    });
    faces_.push_back(std::move(lid));
  }

  [[nodiscard]] long double volume() const {
    if (faces_.empty()) return 0;
    const Vec o = faces_.front().front();
    long double six = 0;
    for (const Polygon& face : faces_) {
      for (std::size_t i = 1; i + 1 < face.size(); ++i)
        six += (face[0] - o).dot((face[i] - o).cross(face[i + 1] - o));
    }
    return std::max(0.0L, six / 6);
  }

 private:
  std::vector<Polygon> faces_;
};

}  // namespace

double volume_in_box(std::span<const SignedPlane> sides,
                     const std::array<Point, 2>& box) {
  const Point size = box[1] - box[0];
  Polyhedron polyhedron;
  for (const SignedPlane& side : sides) {
    // In coordinates of the box, in which it is the unit cube.
    const auto& p = side.plane->exact;
    Rational k = rational(p[3]);
    Vec n;
    for (int axis = 0; axis < 3; ++axis) {
      k += rational(p[axis]) * Rational(box[0][axis]);
      n[axis] = CGAL::to_double(p[axis]) * size[axis];
    }
    const long double length = n.norm() * (side.positive ? 1 : -1);
    polyhedron.cut(n / length, static_cast<long double>(k) / length);
  }
  return static_cast<double>(polyhedron.volume()) * size.prod();
}

}  // namespace sightline::internal
