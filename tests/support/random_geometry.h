// Points aimed at trouble: nearly and exactly coplanar, on grids, over many decades, at
// the ends of the admissible range, shared, one ulp off.  Same seed, same points,
// anywhere.

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "linespace/predicates.h"

namespace sightline::testing {

/// Where coordinates come from.
enum class Terrain {
  Uniform,  ///< [-1, 1]
  Shifted,  ///< a millionth of that, far from the origin: differences lose no bits
  Grid,     ///< integers in [-8, 8]: exact coplanarity and coincidence are common
  Tenths,   ///< multiples of 0.1 rounded: coplanar by intent, an ulp off in fact
  Decades,  ///< signs times 10^k, k uniform in [-10, 10]
  Extreme,  ///< a random mantissa times 2^140, 2^-140, 1 or 0
};
inline constexpr std::array kTerrains = {Terrain::Uniform, Terrain::Shifted,
                                         Terrain::Grid,    Terrain::Tenths,
                                         Terrain::Decades, Terrain::Extreme};

class RandomGeometry {
 public:
  explicit RandomGeometry(std::uint64_t seed) : rng_(seed) {}

  double uniform(double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(rng_() >> 11) * 0x1p-53);
  }
  /// Uniform on lo, ..., hi, both included.
  int integer(int lo, int hi) {
    return lo + static_cast<int>(rng_() % static_cast<std::uint64_t>(hi - lo + 1));
  }
  bool one_in(int n) { return integer(1, n) == 1; }

  double coordinate(Terrain terrain) {
    switch (terrain) {
      case Terrain::Uniform:
        return uniform(-1, 1);
      case Terrain::Shifted:
        return 4.8e5 + uniform(-1, 1);
      case Terrain::Grid:
        return integer(-8, 8);
      case Terrain::Tenths:
        return 0.1 * integer(-20, 20);
      case Terrain::Decades:
        return (one_in(2) ? 1 : -1) * std::pow(10.0, uniform(-10, 10));
      case Terrain::Extreme: {
        const int which = integer(0, 4);
        if (which == 0) return 0;
        const double m = (one_in(2) ? 1 : -1) * uniform(1, 2);
        return std::ldexp(m, which == 1 ? 139 : which == 2 ? -140 : integer(-3, 3));
      }
    }
    return 0;
  }
  Eigen::Vector3d point(Terrain terrain) {
    const double x = coordinate(terrain), y = coordinate(terrain);
    return {x, y, coordinate(terrain)};
  }

  /// On the line pq up to rounding; near one end, past it, or anywhere.
  Eigen::Vector3d near_line(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
    return admissible(p + weight() * (q - p));
  }
  /// On the plane pqr up to rounding.
  Eigen::Vector3d near_plane(const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                             const Eigen::Vector3d& r) {
    const double s = weight();
    return admissible(p + s * (q - p) + weight() * (r - p));
  }
  /// One coordinate moved to a neighbouring double.
  Eigen::Vector3d nudged(Eigen::Vector3d p) {
    double& x = p[integer(0, 2)];
    x = std::nextafter(x, one_in(2) ? 2 * std::abs(x) + 1 : -2 * std::abs(x) - 1);
    return admissible(p);
  }

  /// Four points: general, coplanar up to rounding, with coincidences, with one axis
  /// held, or one ulp off any of these.
  std::array<Eigen::Vector3d, 4> quadruple(Terrain terrain) {
    std::array<Eigen::Vector3d, 4> p;
    for (auto& x : p) x = point(terrain);
    switch (integer(0, 5)) {
      case 0:
      case 1:
        p[3] = near_plane(p[0], p[1], p[2]);
        break;
      case 2:
        p[2] = near_line(p[0], p[1]);
        break;
      case 3:
        p[integer(0, 1)] = p[integer(2, 3)];
        break;
      case 4: {
        const int axis = integer(0, 2);
        for (auto& x : p) x[axis] = p[0][axis];
        break;
      }
      default:
        break;
    }
    if (one_in(4)) {
      auto& x = p[integer(0, 3)];
      x = nudged(x);
    }
    for (int i = 3; i > 0; --i) std::swap(p[i], p[integer(0, i)]);
    return p;
  }

  std::uint64_t bits() { return rng_(); }

 private:
  double weight() {
    switch (integer(0, 3)) {
      case 0:
        return uniform(-1e-3, 1e-3);
      case 1:
        return 0.5 * integer(-4, 4);
      default:
        return uniform(-2, 2);
    }
  }
  static Eigen::Vector3d admissible(Eigen::Vector3d p) {
    for (double& x : p) {
      if (!is_admissible(x)) {
        x = std::abs(x) > 1 ? std::copysign(kLargestCoordinate, x) : 0;
      }
    }
    return p;
  }

  std::mt19937_64 rng_;
};

}  // namespace sightline::testing
