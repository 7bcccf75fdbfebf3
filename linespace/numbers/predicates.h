// The stages of linespace/predicates.h, exposed for tests and benchmarks only.
//
// In the order in which they are tried:
//   double    rounded arithmetic with an a-priori bound (inline in predicates.h)
//   integer 1 exact, if each coordinate axis fits 61 bits: most scenes do, and it costs
//             less than an enclosure
//   interval  a double-double value with a radius
//   integer 2 exact, 125 bits an axis
//   integer 6 exact, any admissible coordinates
// nullopt means "undecided" and, of the integers, "does not fit".

#pragma once

#include <optional>

#include "linespace/numbers/exact_numbers.h"
#include "linespace/predicates.h"

namespace sightline::internal {

using Point3 = Eigen::Vector3d;

/// The determinant whose sign orient3d() gives.
[[nodiscard]] BallNumber ball_orient3d(const Point3& a, const Point3& b, const Point3& c,
                                       const Point3& d);

[[nodiscard]] std::optional<Sign> double_orient3d(const Point3& a, const Point3& b,
                                                  const Point3& c, const Point3& d);
[[nodiscard]] std::optional<Sign> interval_orient3d(const Point3& a, const Point3& b,
                                                    const Point3& c, const Point3& d);
template <int Limbs>  // 1, 2, 6
[[nodiscard]] std::optional<Sign> integer_orient3d(const Point3& a, const Point3& b,
                                                   const Point3& c, const Point3& d);

[[nodiscard]] std::optional<Sign> double_compare_crossings(const LineThrough& edge,
                                                           const PlaneThrough& p,
                                                           const PlaneThrough& q);
[[nodiscard]] std::optional<Sign> interval_compare_crossings(const LineThrough& edge,
                                                             const PlaneThrough& p,
                                                             const PlaneThrough& q);
template <int Limbs>  // 1, 2, 6
[[nodiscard]] std::optional<Sign> integer_compare_crossings(const LineThrough& edge,
                                                            const PlaneThrough& p,
                                                            const PlaneThrough& q);

[[nodiscard]] std::optional<bool> double_collinear(const Point3& a, const Point3& b,
                                                   const Point3& c);
[[nodiscard]] std::optional<bool> interval_collinear(const Point3& a, const Point3& b,
                                                     const Point3& c);
template <int Limbs>  // 1, 2, 6
[[nodiscard]] std::optional<bool> integer_collinear(const Point3& a, const Point3& b,
                                                    const Point3& c);

}  // namespace sightline::internal
