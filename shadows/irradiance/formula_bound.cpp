// Bounds of the derivatives of the form factor by one structure; the derivation stands in
// docs/irradiance.md.

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "shadows/irradiance/seen_formula.h"

namespace sightline::internal {
namespace {

// Points of the ellipse over which bounds hold are middle + axes x, |x| <= 1.
using Axes = Eigen::Matrix<double, 3, 2>;

// The largest length of m x.
double largest(const Axes& m) {
  const double a = m.col(0).squaredNorm(), b = m.col(0).dot(m.col(1)),
               c = m.col(1).squaredNorm();
  return std::sqrt(0.5 * (a + c + std::hypot(a - c, 2 * b)));
}

// Of a function of this rate that is 0 in the middle.
Majorant from_zero(double rate) { return {{rate, rate}}; }

// Of a function that has a value there.
Majorant from(double value, double rate) { return {{value + rate, rate}}; }

// A corner of what is seen, as it moves in the plane of the source.
struct Moving {
  Point at;        // as the middle sees it
  Majorant moved;  // the way from there
};

class FormulaBound {
 public:
  FormulaBound(const SeenFormula& formula, const Point& middle, const Axes& axes,
               const Eigen::Vector3d& normal)
      : formula_(&formula),
        middle_(middle),
        axes_(axes),
        normal_(normal),
        reach_(largest(axes)) {}

  [[nodiscard]] Majorant sum() const {
    Majorant sum;
    for (const SeenFormula::Loop& loop : formula_->loops) sum = sum + of_loop(loop);
    return sum;
  }

 private:
  // The largest rate of change of vector . p.
  [[nodiscard]] double rate(const Eigen::Vector3d& vector) const {
    return (axes_.transpose() * vector).norm();
  }

  // Triangles from one corner, which is best one that stands still.
  [[nodiscard]] Majorant of_loop(const SeenFormula::Loop& loop) const {
    const double height = loop.facing.dot(middle_ - loop.on_plane);
    const double slope = rate(loop.facing);
    if (!(height > slope)) return Majorant::unknown();
    std::vector<Moving> corners;
    std::size_t still = 0;
    for (int k = loop.first; k < loop.last; ++k) {
      const int before = k == loop.first ? loop.last - 1 : k - 1;
      const auto corner = formula_->sides[k].meets ? meeting(loop, k, height, slope)
                                                   : crossing(loop, before, k, height);
      if (!corner) return Majorant::unknown();
      corners.push_back(*corner);
      if (corner->moved.a[1] < corners[still].moved.a[1]) still = corners.size() - 1;
    }
    Majorant sum;
    const std::size_t n = corners.size();
    for (std::size_t i = 1; i + 1 < n; ++i) {
      sum = sum + of_triangle(loop, height, slope,
                              {&corners[still], &corners[(still + i) % n],
                               &corners[(still + i + 1) % n]});
    }
    return sum;
  }

  // The shadow of a point X above the plane by u: X + (X - p) u / (height of p - u).
  [[nodiscard]] std::optional<Moving> meeting(const SeenFormula::Loop& loop, int k,
                                              double height, double slope) const {
    const SeenFormula::Side& side = formula_->sides[k];
    const double up = loop.facing.dot(side.corner - loop.on_plane);
    const Eigen::Vector3d way = side.corner - middle_;
    const double below = height - up;
    const double least = std::abs(below) - slope;
    if (!(least > 0)) return std::nullopt;
    // From where it is: X + (X - p) q - (X + way q0), q = u / (height - u).
    Moving corner{side.corner + way * (up / below), {}};
    if (up == 0) return corner;
    const Majorant inverse = reciprocal(from(std::abs(below), slope), least);
    corner.moved = std::abs(up) * (from(way.norm(), reach_) * inverse);
    corner.moved.a[0] = corner.moved.a[1];
    return corner;
  }

  // Where two lines cross as seen.  With N the normal of the plane through p and a line,
  // a point y of the source's plane lies in it if N . (y - p) = 0.  From the corner c of
  // the middle: N . (y - c) = -e, e = N . (c - p), which is 0 there and linear in p.
  // Cramer's rule has y.
  [[nodiscard]] std::optional<Moving> crossing(const SeenFormula::Loop& loop, int first,
                                               int second, double height) const {
    std::array<Eigen::Vector3d, 2> across;  // N, in the middle
    std::array<Majorant, 2> within;         // of its part along the source's plane
    std::array<double, 2> length, turn;
    for (int i = 0; i < 2; ++i) {
      const SeenFormula::Side& side = formula_->sides[i == 0 ? first : second];
      across[i] = (side.at - middle_).cross(side.way);
      length[i] = along_source(loop, across[i]).norm();
      Axes turned;
      for (int k = 0; k < 2; ++k)
        turned.col(k) = along_source(loop, axes_.col(k).cross(side.way));
      turn[i] = largest(turned);
      within[i] = from(length[i], turn[i]);
    }
    const Eigen::Vector3d way = across[0].cross(across[1]);
    const double determinant = loop.facing.dot(way);
    const double least = std::abs(determinant) - turn[0] * length[1] -
                         turn[1] * length[0] - turn[0] * turn[1];
    if (!(least > 0)) return std::nullopt;
    Moving corner{middle_ - way * (height / determinant), {}};
    std::array<Majorant, 2> off;
    for (int i = 0; i < 2; ++i) {
      const SeenFormula::Side& side = formula_->sides[i == 0 ? first : second];
      if (side.on_source) continue;
      off[i] = from_zero(rate(side.way.cross(corner.at - side.at)));
    }
    const Majorant inverse = reciprocal(within[0] * within[1], least);
    corner.moved = (off[0] * within[1] + off[1] * within[0]) * inverse;
    return corner;
  }

  [[nodiscard]] static Eigen::Vector3d along_source(const SeenFormula::Loop& loop,
                                                    const Eigen::Vector3d& v) {
    return v - loop.facing * loop.facing.dot(v);
  }

  // Half the product of the integrand and the triangle's area, twice: over the standard
  // triangle the integrand is (n . w) h / (pi |w|^4), w the way to a point of it.
  [[nodiscard]] Majorant of_triangle(const SeenFormula::Loop& loop, double height,
                                     double slope,
                                     const std::array<const Moving*, 3>& corners) const {
    const double along_normal =
        std::sqrt(std::max(0.0, 1 - std::pow(normal_.dot(loop.facing), 2)));
    Point centroid = Point::Zero();
    Majorant moved;
    for (const Moving* c : corners) {
      centroid += c->at / 3;
      moved = larger(moved, c->moved);
    }
    const Eigen::Vector3d towards = (centroid - middle_).normalized();
    double least = Majorant::kUnknown, farthest = 0, highest = 0;
    for (const Moving* c : corners) {
      const Eigen::Vector3d way = c->at - middle_;
      least = std::min(least, towards.dot(way));
      farthest = std::max(farthest, way.norm());
      highest = std::max(highest, std::abs(normal_.dot(way)));
    }
    least -= moved.a[0] + reach_;
    least = std::max(least, height - slope);
    Majorant way = moved;
    way.a[0] += farthest + reach_;
    way.a[1] += reach_;
    Majorant above = along_normal * moved;
    above.a[0] += highest;
    const Majorant squared = reciprocal(way * way, least * least);
    const Eigen::Vector3d u = corners[1]->at - corners[0]->at,
                          v = corners[2]->at - corners[0]->at;
    Majorant sides[2];
    for (int i = 0; i < 2; ++i) {
      sides[i] = corners[0]->moved + corners[1 + i]->moved;
      sides[i].a[0] += (i == 0 ? u : v).norm();
    }
    Majorant area = sides[0] * sides[1];
    area.a[0] = std::min(area.a[0], std::abs(loop.facing.dot(u.cross(v))) + area.a[1]);
    const Majorant heights = from(height, slope);
    return (0.5 / std::numbers::pi) * (above * heights * squared * squared * area);
  }

  const SeenFormula* formula_;
  Point middle_;
  Axes axes_;
  Eigen::Vector3d normal_;
  double reach_;
};

}  // namespace

Majorant SeenFormula::bound(const Point& middle, const Axes& axes,
                            const Eigen::Vector3d& normal) const {
  constexpr double kRounding = 1 + 1e-9;
  return kRounding * FormulaBound(*this, middle, axes, normal).sum();
}

}  // namespace sightline::internal
