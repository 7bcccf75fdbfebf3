#include "linespace/lines/line_name.h"

#include <gmp.h>

#include <cstddef>

namespace sightline::internal {
namespace {

// An integer that keeps its memory.
struct Integer {
  Integer() { mpz_init(value); }
  ~Integer() { mpz_clear(value); }
  Integer(const Integer&) = delete;
  Integer& operator=(const Integer&) = delete;
  mpz_t value;
};

// Two bytes tell how many follow and the sign.
void append(LineName& name, const mpz_t x) {
  const std::size_t count = mpz_sgn(x) == 0 ? 0 : (mpz_sizeinbase(x, 2) + 7) / 8;
  const std::size_t head = 2 * count + (mpz_sgn(x) < 0 ? 1 : 0);
  name.push_back(static_cast<char>(head >> 8));
  name.push_back(static_cast<char>(head & 255));
  const std::size_t start = name.size();
  name.resize(start + count);
  mpz_export(name.data() + start, nullptr, 1, 1, 0, 0, x);
}

// A point with one denominator.
struct Whole {
  std::array<Integer, 3> point;
  Integer denominator;

  void set(const ExactPoint& p) {
    mpz_set_ui(denominator.value, 1);
    for (const Rational& x : p) {
      mpz_lcm(denominator.value, denominator.value, mpq_denref(x.backend().data()));
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const mpq_t& x = p[i].backend().data();
      mpz_divexact(point[i].value, denominator.value, mpq_denref(x));
      mpz_mul(point[i].value, point[i].value, mpq_numref(x));
    }
  }
};

// What one call needs, kept by the thread: allocating it took longer than the arithmetic.
struct Scratch {
  Whole a, b;
  std::array<Integer, 3> way;
  std::array<Integer, 6> whole;
  Integer divisor;
};

}  // namespace

// With points A / alpha and B / beta the direction is w = alpha B - beta A and the moment
// A x w / alpha, up to one factor: all times alpha they are integers.
LineName name_of_line(const std::array<ExactPoint, 2>& line) {
  thread_local Scratch scratch;
  auto& [a, b, way, whole, divisor] = scratch;
  a.set(line[0]);
  b.set(line[1]);
  for (std::size_t i = 0; i < 3; ++i) {
    mpz_mul(way[i].value, a.denominator.value, b.point[i].value);
    mpz_submul(way[i].value, b.denominator.value, a.point[i].value);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    mpz_mul(whole[i].value, a.denominator.value, way[i].value);
    mpz_mul(whole[i + 3].value, a.point[j].value, way[k].value);
    mpz_submul(whole[i + 3].value, a.point[k].value, way[j].value);
  }
  mpz_set_ui(divisor.value, 0);
  bool negative = false;
  for (const Integer& x : whole) {
    if (mpz_sgn(divisor.value) == 0) negative = mpz_sgn(x.value) < 0;
    mpz_gcd(divisor.value, divisor.value, x.value);
  }
  if (negative) mpz_neg(divisor.value, divisor.value);
  LineName name;
  for (Integer& x : whole) {
    mpz_divexact(x.value, x.value, divisor.value);
    append(name, x.value);
  }
  return name;
}

}  // namespace sightline::internal
