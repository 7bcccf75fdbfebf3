// Rational numbers and exact points, for what is constructed and then asked again.

#pragma once

#include <Eigen/Core>
#include <array>
#include <boost/multiprecision/gmp.hpp>

namespace sightline::internal {

/// Not CGAL::Exact_rational, which is another type where gmpxx is installed.
using Rational = boost::multiprecision::number<boost::multiprecision::gmp_rational,
                                               boost::multiprecision::et_off>;
using ExactPoint = std::array<Rational, 3>;

[[nodiscard]] inline ExactPoint exact_point(const Eigen::Vector3d& p) {
  return {Rational(p.x()), Rational(p.y()), Rational(p.z())};
}

}  // namespace sightline::internal
