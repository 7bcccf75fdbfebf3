// Euler's dilogarithm of complex numbers.

#pragma once

#include <complex>

namespace sightline::internal {

/// Li2(z) = z + z^2 / 2^2 + z^3 / 3^2 + ..., continued to all z but the cut from 1
/// upwards along the real axis.  Within some 1e-15 of its size.
/// Lewin, Polylogarithms and associated functions, 1981.
[[nodiscard]] std::complex<double> dilogarithm(std::complex<double> z);

}  // namespace sightline::internal
