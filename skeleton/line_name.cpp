#include <gmp.h>

#include <cstddef>

#include "skeleton/line_name_internal.h"

namespace sightline::internal {
namespace {

using Integer = boost::multiprecision::number<boost::multiprecision::gmp_int,
                                              boost::multiprecision::et_off>;

// Two bytes tell how many follow and the sign.
void append(LineName& name, const Integer& x) {
  const auto& value = x.backend().data();
  const std::size_t count = x == 0 ? 0 : (mpz_sizeinbase(value, 2) + 7) / 8;
  const std::size_t head = 2 * count + (x < 0 ? 1 : 0);
  name.push_back(static_cast<char>(head >> 8));
  name.push_back(static_cast<char>(head & 255));
  const std::size_t start = name.size();
  name.resize(start + count);
  mpz_export(name.data() + start, nullptr, 1, 1, 0, 0, value);
}

struct Whole {
  std::array<Integer, 3> point;
  Integer denominator;
};
Whole over_one_denominator(const ExactPoint& p) {
  Whole out;
  out.denominator = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    out.denominator = lcm(out.denominator, static_cast<Integer>(denominator(p[i])));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Integer part = out.denominator / static_cast<Integer>(denominator(p[i]));
    out.point[i] = static_cast<Integer>(numerator(p[i])) * part;
  }
  return out;
}

}  // namespace

// With points A / alpha and B / beta the direction is w = alpha B - beta A and the moment
// A x w / alpha, up to one factor: all times alpha they are integers.
LineName name_of_line(const std::array<ExactPoint, 2>& line) {
  const auto [a, alpha] = over_one_denominator(line[0]);
  const auto [b, beta] = over_one_denominator(line[1]);
  std::array<Integer, 3> w;
  for (std::size_t i = 0; i < 3; ++i) w[i] = alpha * b[i] - beta * a[i];
  std::array<Integer, 6> whole;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    whole[i] = alpha * w[i];
    whole[i + 3] = a[j] * w[k] - a[k] * w[j];
  }
  Integer divisor = 0;
  bool negative = false;
  for (const Integer& x : whole) {
    if (divisor == 0) negative = x < 0;
    divisor = gcd(divisor, x);
  }
  LineName name;
  for (const Integer& x : whole)
    append(name, negative ? Integer(-x / divisor) : Integer(x / divisor));
  return name;
}

}  // namespace sightline::internal
