#include "linespace/between/concurrent_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

namespace sightline::internal {
namespace {

// w_i, times the sign of line i.
template <class Vector, class Dot, class Cross>
auto signed_weights(const std::array<Vector, 3>& directions,
                    const std::array<SignedLine, 3>& lines, const Vector& along, Dot dot,
                    Cross cross) {
  std::array<decltype(dot(along, along)), 3> w;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    w[i] = dot(along, cross(directions[j], directions[k])) * lines[i].sign;
  }
  return w;
}

}  // namespace

std::optional<std::array<std::array<Rational, 9>, 3>> concurrent_weights(
    const std::array<SignedLine, 3>& lines, const std::array<ExactPoint, 3>& a,
    const std::array<ExactPoint, 3>& b) {
  std::array<ExactPoint, 3> directions;
  for (int i = 0; i < 3; ++i) {
    directions[i] = exact_difference(exact_point(lines[i].points[1]),
                                     exact_point(lines[i].points[0]));
  }
  if (exact_dot(directions[0], exact_cross(directions[1], directions[2])) == 0) {
    return std::nullopt;
  }
  std::array<std::array<Rational, 9>, 3> weights;
  bool up = false, down = false;
  for (int n = 0; n < 9; ++n) {
    const auto w = signed_weights(directions, lines, exact_difference(b[n % 3], a[n / 3]),
                                  exact_dot, exact_cross);
    for (int i = 0; i < 3; ++i) {
      up |= w[i] > 0;
      down |= w[i] < 0;
      weights[i][n] = abs(w[i]);
    }
  }
  if (up == down) return std::nullopt;
  return weights;
}

bool may_have_concurrent_weights(const std::array<SignedLine, 3>& lines,
                                 const Triangle& a, const Triangle& b) {
  std::array<Point, 3> directions;
  for (int i = 0; i < 3; ++i) {
    directions[i] = (lines[i].points[1] - lines[i].points[0]).normalized();
  }
  bool up = false, down = false;
  for (int n = 0; n < 9; ++n) {
    const Point along = b[n % 3] - a[n / 3];
    const auto w = signed_weights(
        directions, lines, along, [](const Point& u, const Point& v) { return u.dot(v); },
        [](const Point& u, const Point& v) -> Point { return u.cross(v); });
    // Near zero, exact numbers decide.
    const double doubtful = 0x1p-40 * along.norm();
    for (const double x : w) {
      up |= x > doubtful;
      down |= x < -doubtful;
    }
  }
  return up != down;
}

std::vector<std::array<int, 3>> concurrent_triples(const std::vector<SignedLine>& lines,
                                                   std::size_t most) {
  const auto less = [](const Point& u, const Point& v) {
    return std::lexicographical_compare(u.data(), u.data() + 3, v.data(), v.data() + 3);
  };
  std::map<Point, std::vector<int>, decltype(less)> at(less);
  std::vector<std::array<int, 3>> triples;
  for (int n = 0; n < static_cast<int>(lines.size()); ++n) {
    for (const int end : {0, 1}) {
      std::vector<int>& others = at[lines[n].points[end]];
      for (std::size_t i = 0; i < others.size(); ++i) {
        for (std::size_t j = i + 1; j < others.size() && triples.size() < most; ++j) {
          triples.push_back({others[i], others[j], n});
        }
      }
      others.push_back(n);
    }
  }
  return triples;
}

}  // namespace sightline::internal
