// What random samples say of what they did not meet.

#pragma once

#include <vector>

#include "aspect/aspect_graph.h"

namespace sightline::internal {

/// `seen`: how often each label was met by independent samples, all of them together.
/// The unseen share: Good 1953, its interval by Esty 1983 and, where that is narrower
/// than chance allows, by the rule of three; the number of labels: Chao 1984, its
/// interval by Chao 1987.
[[nodiscard]] AspectEstimate estimate_of(const std::vector<int>& seen);

/// The interval of 95 % of a share of which `hits` of `trials` were met: Clopper and
/// Pearson 1934.
[[nodiscard]] std::array<double, 2> share_interval(int hits, int trials);

}  // namespace sightline::internal
