#include "shadows/radiometry/dilogarithm.h"

#include <array>
#include <numbers>

namespace sightline::internal {
namespace {

using Complex = std::complex<double>;

constexpr double kPiPi6 = std::numbers::pi * std::numbers::pi / 6;

/// For |z| <= 1 and Re z <= 1/2: in powers of u = -ln(1 - z), |u| < 1.3, the coefficients
/// are Bernoulli's numbers over factorials.
Complex series(const Complex& z) {
  // B_2k / (2k + 1)!
  static constexpr std::array<double, 11> kCoefficients{
      1. / 36.,
      -1. / 3600.,
      1. / 211680.,
      -1. / 10886400.,
      1. / 526901760.,
      -691. / 16999766784000.,
      1. / 1120863744000.,
      -3617. / 181400588328960000.,
      43867. / 97072790126247936000.,
      -174611. / 16860010916664115200000.,
      77683. / 324325300906011525120000.};
  const Complex u = -std::log(1. - z);
  const Complex uu = u * u;
  Complex sum = 0;
  for (std::size_t k = kCoefficients.size(); k-- > 0;)
    sum = uu * (sum + kCoefficients[k]);
  return u * (1. + sum) - 0.25 * uu;
}

/// For |z| <= 1, but for rounding.
Complex inside(const Complex& z) {
  if (z == 1.) return kPiPi6;
  if (z.real() > 0.5) return kPiPi6 - std::log(z) * std::log(1. - z) - series(1. - z);
  return series(z);
}

}  // namespace

Complex dilogarithm(Complex z) {
  if (std::norm(z) <= 1) return inside(z);
  const Complex l = std::log(-z);
  return -inside(1. / z) - kPiPi6 - 0.5 * l * l;
}

}  // namespace sightline::internal
