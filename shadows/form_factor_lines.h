// Form factors by random lines: the fast end of the dial whose slow end is
// form_factors.h.
//
// Lines through the scene are drawn uniformly, each is followed through everything it
// meets, and every two neighbours on it that show each other their fronts are counted
// (Sbert, The use of global random directions to compute radiosity, 1997).  Every line
// serves all pairs at once, so that the whole matrix costs as much as one entry.
//
//   const FormFactorLines f = form_factors_by_lines(scene, surfaces, {.lines =
//   1'000'000}); std::cout << f.factors.at(0, 1) << " +- " << f.errors[0].factor[0] <<
//   '\n';
//
// Neighbours: form_factors.h is exact to what is asked; line_sampling.h draws the lines.

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "shadows/form_factors.h"

namespace sightline {

struct FormFactorLinesRequest : Request {
  std::int64_t lines = 1'000'000;  ///< at least 2
  std::uint64_t seed = 1;
  /// As in FormFactorRequest.
  std::optional<Eigen::Vector3d> up;
};

/// Standard deviations of the errors of one row, as the lines show them.
struct FormFactorErrors {
  std::vector<double> factor;  ///< of the entries, in the order of the row's `to`
  double others = 0, outside = 0, backs = 0, sky = 0;
};

struct FormFactorLines {
  /// An entry that no line found is left out.  error_bound, pairs, open and partial are
  /// 0: nothing is bounded, and no pair is looked at.
  FormFactors factors;
  std::vector<FormFactorErrors> errors;  ///< of each row
  std::int64_t lines = 0;                ///< drawn; fewer than asked for if not complete
  /// What one line that joins two surfaces adds to A_i F_ij, in scene units squared. With
  /// 95 % confidence, a pair that no line found has less than 3 of these.
  double area_per_line = 0;
};

/// Laws: every number is an unbiased estimate of what form_factors() finds, definitions
/// included; A_i F_ij = A_j F_ji but for rounding; n lines are the first n of more; the
/// same seed gives the same answer whatever the number of threads.  What a line meets is
/// decided in doubles, which sends a line astray once in some 10^12.
/// When the budget ends or a stop is asked for, the lines drawn so far answer; throws
/// Stopped when these are less than 2, InvalidInput for fewer than 2 lines asked for.
/// Cost: a microsecond or some a line; 24 bytes for each pair found, some times.
[[nodiscard]] FormFactorLines form_factors_by_lines(
    const Scene& scene, std::span<const FormFactorSurface> surfaces,
    const FormFactorLinesRequest& request = {});

}  // namespace sightline
