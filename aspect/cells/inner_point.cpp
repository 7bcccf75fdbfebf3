#include "aspect/cells/inner_point.h"

#include <CGAL/Gmpq.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "linespace/space/cut_polyhedron.h"

namespace sightline::internal {
namespace {

using Vec = Eigen::Vector3d;

Vec direction(const RingVector& v) {
  const std::array<double, 3> d = scaled<3>({Surd{v[0]}, Surd{v[1]}, Surd{v[2]}}, 0);
  return Vec(d[0], d[1], d[2]).normalized();
}

class Disc {
 public:
  Disc(std::span<const CircleNormal> normals, std::span<const SphereArc> arcs)
      : normals_(normals), arcs_(arcs) {
    for (const SphereArc& arc : arcs) {
      Vec n = direction(normals[arc.wall->circle].exact);
      inward_.push_back(arc.positive ? n : Vec(-n));
      ends_.push_back({vertex(arc.wall->from), vertex(arc.wall->to)});
      // Counter-clockwise around the cell.
      if (!arc.positive) std::swap(ends_.back()[0], ends_.back()[1]);
    }
  }

  [[nodiscard]] InnerDirection find() const {
    Vec middle = Vec::Zero();
    for (const auto& [a, b] : ends_) middle += a + b;
    middle.normalize();
    const Vec centre = centre_of_largest().value_or(middle);
    for (const Vec& candidate : {centre, middle}) {
      const ExactPoint at{Rational(candidate[0]), Rational(candidate[1]),
                          Rational(candidate[2])};
      if (is_inside(at)) return {at, solid_angle(candidate), clearance(candidate)};
    }
    const ExactPoint at = exact_middle();
    const Vec rounded(static_cast<double>(at[0]), static_cast<double>(at[1]),
                      static_cast<double>(at[2]));
    return {at, solid_angle(middle), std::max(0.0, clearance(rounded.normalized()))};
  }

 private:
  [[nodiscard]] RingVector exact_vertex(const SphereCells::Vertex& v) const {
    const auto &a = normals_[v.a].exact, &b = normals_[v.b].exact;
    return v.opposite ? cross(b, a) : cross(a, b);
  }
  [[nodiscard]] Vec vertex(const SphereCells::Vertex& v) const {
    return direction(exact_vertex(v));
  }

  [[nodiscard]] bool is_inside(const ExactPoint& at) const {
    return std::ranges::all_of(arcs_, [&](const SphereArc& arc) {
      const auto& n = normals_[arc.wall->circle].exact;
      const Rational value =
          exact_dot({rational(n[0]), rational(n[1]), rational(n[2])}, at);
      return arc.positive ? value > 0 : value < 0;
    });
  }

  [[nodiscard]] double clearance(const Vec& at) const {
    double least = 1;
    for (const Vec& n : inward_) least = std::min(least, n.dot(at));
    return std::asin(least);
  }

  // The largest disc touches three of the arcs.
  [[nodiscard]] std::optional<Vec> centre_of_largest() const {
    constexpr std::size_t kMostArcs = 24;
    const std::size_t n = inward_.size();
    if (n > kMostArcs) return std::nullopt;
    std::optional<Vec> best;
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        for (std::size_t k = 0; k < j; ++k) {
          Eigen::Matrix3d m;
          m << inward_[i].transpose(), inward_[j].transpose(), inward_[k].transpose();
          const Vec c = m.fullPivLu().solve(Vec::Ones()).normalized();
          const double radius = clearance(c);
          if (!(radius > largest)) continue;
          largest = radius;
          best = c;
        }
      }
    }
    return best;
  }

  // Of triangles from a direction inside to the sides: Van Oosterom and Strackee 1983.
  [[nodiscard]] double solid_angle(const Vec& inside) const {
    double sum = 0;
    for (const auto& [a, b] : ends_) {
      const double volume = inside.dot(a.cross(b));
      sum += 2 * std::atan2(volume, 1 + inside.dot(a) + a.dot(b) + b.dot(inside));
    }
    return sum;
  }

  [[nodiscard]] ExactPoint exact_middle() const {
    ExactPoint sum;
    // Of both ends of every arc: those from which the arcs start may be two vertices, and
    // their sum on the boundary.
    for (const SphereArc& arc : arcs_) {
      for (const SphereCells::Vertex& end : {arc.wall->from, arc.wall->to}) {
        const auto v = exact_vertex(end);
        Rational size = 0;
        for (const Ring& x : v) size = std::max(size, Rational(abs(rational(x))));
        for (int i = 0; i < 3; ++i) sum[i] += rational(v[i]) / size;
      }
    }
    return sum;
  }

  std::span<const CircleNormal> normals_;
  std::span<const SphereArc> arcs_;
  std::vector<Vec> inward_;
  std::vector<std::array<Vec, 2>> ends_;
};

CGAL::Gmpq gmpq(const Ring& x) {
  const Rational q = rational(x);
  return CGAL::Gmpq(q.str());
}

}  // namespace

InnerDirection inner_direction(std::span<const CircleNormal> normals,
                               std::span<const SphereArc> arcs) {
  return Disc(normals, arcs).find();
}

InnerPoint inner_point(std::span<const SignedPlane> sides,
                       const std::array<Point, 2>& box) {
  using Program = CGAL::Quadratic_program<CGAL::Gmpq>;
  // Greatest r with n . x + k >= |n| r for all planes turned inwards, r <= size.
  Program program(CGAL::LARGER, false, 0, false, 0);
  const double size = (box[1] - box[0]).norm();
  constexpr int kRadius = 3;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto row = static_cast<int>(i);
    const auto& p = sides[i].plane->exact;
    double square = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = CGAL::to_double(p[axis]);
      square += x * x;
      program.set_a(axis, row, sides[i].positive ? gmpq(p[axis]) : -gmpq(p[axis]));
    }
    program.set_a(kRadius, row, -CGAL::Gmpq(std::sqrt(square)));
    program.set_b(row, sides[i].positive ? -gmpq(p[3]) : gmpq(p[3]));
  }
  program.set_u(kRadius, true, CGAL::Gmpq(size));
  program.set_c(kRadius, -1);
  const auto solution = CGAL::solve_linear_program(program, CGAL::Gmpq());
  std::vector<CGAL::Gmpq> x;
  for (auto v = solution.variable_values_begin(); v != solution.variable_values_end();
       ++v) {
    x.push_back(v->numerator() / v->denominator());
  }
  ExactPoint exact;
  for (int axis = 0; axis < 3; ++axis) {
    std::ostringstream text;
    text << x[axis];
    exact[axis] = Rational(text.str());
  }
  const auto least = [&](const ExactPoint& at) {
    std::optional<double> distance;
    for (const SignedPlane& side : sides) {
      const auto& p = side.plane->exact;
      Rational value = rational(p[3]);
      double square = 0;
      for (int axis = 0; axis < 3; ++axis) {
        value += rational(p[axis]) * at[axis];
        square += std::pow(CGAL::to_double(p[axis]), 2);
      }
      if (!side.positive) value = -value;
      const double d = static_cast<double>(value) / std::sqrt(square);
      distance = std::min(distance.value_or(d), value > 0 ? d : -1.0);
    }
    return *distance;
  };
  ExactPoint rounded;
  for (int axis = 0; axis < 3; ++axis)
    rounded[axis] = Rational(static_cast<double>(exact[axis]));
  const double at_rounded = least(rounded);
  if (at_rounded > 0) return {rounded, at_rounded};
  return {exact, least(exact)};
}

double volume_in(const std::array<Point, 2>& box, std::span<const SignedPlane> sides) {
  CutPolyhedron part(exact_point(box[0]), exact_point(box[1]));
  int number = 6;  // after the sides of the box
  for (const auto& [plane, positive] : sides) {
    const Rational sign(positive ? -1 : 1);
    const auto& p = plane->exact;
    const ExactPoint normal{sign * rational(p[0]), sign * rational(p[1]),
                            sign * rational(p[2])};
    part.cut({normal, -sign * rational(p[3])}, number++);
  }
  return nearest_double(part.volume());
}

}  // namespace sightline::internal
