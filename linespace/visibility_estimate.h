// How much of B do points of A see, by random segments: the fast end of the dial.
//
// An estimate, never a proof.  A fraction of 0 does not say hidden, since an opening may
// be smaller than any number of samples can find; a free segment found is a candidate for
// a witness, since its ends are rounded points and its end faces were left out.
// Neighbours: line_sampling.h draws the segments; occlusion.h owns the Embree scene.

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "linespace/occlusion.h"
#include "linespace/request.h"

namespace sightline {

struct EstimateOptions {
  std::int64_t samples = 10'000;  ///< at least 1
  std::uint64_t seed = 1;
};

/// A number with the standard deviation of its error, as the samples show it.
struct Estimate {
  double value = 0;
  /// Infinite when there are fewer than two samples.
  double standard_error = 0;
};

/// A sampled segment that is free, its two end faces left out.
struct FreePair {
  Point a, b;
  int face_a, face_b;
  std::int64_t sample;  ///< its number, from 0
};

struct VisibilityEstimate {
  std::int64_t samples = 0;  ///< drawn; fewer than asked for when not complete
  std::int64_t free = 0;     ///< of these
  /// Of the pairs of a uniform point of A and a uniform point of B, the share that sees
  /// each other, in [0, 1]; 0 when nothing was drawn.
  Estimate fraction;
  /// Wilson's interval of 95 % for the fraction; [0, 1] when nothing was drawn.  Never of
  /// length 0.
  std::array<double, 2> interval{0, 1};
  /// Measure of the oriented lines that run free from A to B, each as often as it joins
  /// the two, in scene units squared: pi times A's area times the form factor from A to
  /// B, where fronts face each other.  The standard error means little where A and B
  /// touch: the variance is infinite there.
  Estimate line_measure;
  /// The free sample of the smallest number.
  std::optional<FreePair> candidate;
  /// Samples on which double arithmetic could not decide: decided exactly, or counted as
  /// blocked under Precision::Double.
  std::int64_t doubtful = 0;
  bool complete = false;
  double seconds = 0;  ///< wall-clock, all stages
};

/// Joins uniform points of faces_a and of faces_b (by area, each face as often as listed)
/// and asks for each segment whether any face but the two it ends on blocks it.
///
/// Laws: the same seed gives the same answer whatever the number of threads, and n
/// samples are the first n of more; each segment, its ends as rounded to doubles, is
/// judged exactly in the scene without its two end faces (Precision::Exact).  An end face
/// never blocks, so that both sides of it see; behind a closed solid's face its other
/// faces block.  Pairs in one plane are judged as rounding left them.
///
/// Throws InvalidInput for fewer than one sample, no faces, or a face the scene lacks.
/// When the budget ends or a stop is asked for, the samples drawn so far answer.
/// Cost: a ray and two points a sample (docs/line_sampling.md); 64 bytes per 2048
/// samples. Source: points and measure, Santalo 1976; interval, Wilson 1927.
[[nodiscard]] VisibilityEstimate estimate_visibility(const OcclusionIndex& index,
                                                     std::span<const int> faces_a,
                                                     std::span<const int> faces_b,
                                                     const EstimateOptions& options = {},
                                                     const Request& request = {});

}  // namespace sightline
