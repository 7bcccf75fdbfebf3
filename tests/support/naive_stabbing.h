// A naive enumeration of extremal stabbing lines, to test linespace/portals.h against.
//
// Every set of generators that could fix a line is solved as linear algebra on Pluecker
// coordinates in rationals and Q(sqrt D); every line found is tested against every
// portal, and is extremal when the generators it touches leave it isolated by rank.
// Shares no code with the library.

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace sightline::testing {

/// Corners without repeats or flat corners, exactly planar; two make a slit, one a point.
using NaivePortal = std::vector<Eigen::Vector3d>;

/// One string a line: its kind, what it touches in each place from the first portal to
/// the last ("V0.2", "E1.3"; portal and corner or edge), and the planes it lies in.
/// Sorted; lines that touch the same are repeated.  Which end is first is left open when
/// the line stabs both ways: the smaller string is taken.
[[nodiscard]] std::vector<std::string> naive_extremal_lines(
    const std::vector<NaivePortal>& portals);

}  // namespace sightline::testing
