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

}  // namespace

LineName name_of_line(const std::array<ExactPoint, 2>& line) {
  const ExactPoint way = exact_difference(line[1], line[0]);
  const ExactPoint moment = exact_cross(line[0], way);
  std::array<Rational, 6> exact;
  for (std::size_t i = 0; i < 3; ++i) {
    exact[i] = way[i];
    exact[i + 3] = moment[i];
  }
  Integer multiple = 1;
  for (const Rational& x : exact) {
    multiple = lcm(multiple, static_cast<Integer>(denominator(x)));
  }
  std::array<Integer, 6> whole;
  Integer divisor = 0;
  bool negative = false;
  for (std::size_t i = 0; i < 6; ++i) {
    const Integer over = static_cast<Integer>(numerator(exact[i]));
    whole[i] = over * (multiple / static_cast<Integer>(denominator(exact[i])));
    if (divisor == 0) negative = whole[i] < 0;
    divisor = gcd(divisor, whole[i]);
  }
  LineName name;
  for (const Integer& x : whole)
    append(name, negative ? Integer(-x / divisor) : Integer(x / divisor));
  return name;
}

}  // namespace sightline::internal
