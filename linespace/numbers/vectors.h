// Vectors of three numbers of any kind: exact rings and surds, rationals, balls, fixed
// integers.

#pragma once

#include <array>

namespace sightline::internal {

template <class S, class T>
[[nodiscard]] auto dot(const std::array<S, 3>& u, const std::array<T, 3>& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

template <class S, class T>
[[nodiscard]] auto cross(const std::array<S, 3>& u, const std::array<T, 3>& v) {
  return std::array{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                    u[0] * v[1] - u[1] * v[0]};
}

}  // namespace sightline::internal
