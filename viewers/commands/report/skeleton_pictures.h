// What a report draws of a skeleton: the vertex, the edge, the pair of objects with most
// events, EEE surfaces, and all nodes.

#pragma once

#include <array>
#include <optional>
#include <vector>

#include "linespace/request.h"
#include "skeleton/graph.h"
#include "skeleton/skeleton_lines.h"
#include "viewers/drawing.h"
#include "viewers/page.h"

namespace sightline::viewers {

/// Of the vertex, the edge, the pair of inner objects that has most arcs.
struct Highlights {
  std::vector<int> vertex, edge, pair;
  /// The EEE arc with the most to see, of inner objects where there is one; those from
  /// one EEEE line to another are favoured.
  std::optional<int> eee;
  /// The EEEE line at whose EEE surfaces there is most to see.
  std::optional<int> eeee;
};

[[nodiscard]] Highlights find_highlights(const Scene& scene, const Skeleton& skeleton);

/// The first of these EV arcs, as many as a picture takes, drawn out to their far ends.
[[nodiscard]] std::vector<RuledStrip> strips_of(const Scene& scene,
                                                const SkeletonLines& lines,
                                                const Skeleton& skeleton,
                                                const std::vector<int>& arcs);

/// A picture for each highlight that there is, and one of the nodes.  `region`: a box
/// that is framed and drawn; up_axis: 0 to 2, or -1 for a guess.  Throws Stopped.
[[nodiscard]] std::vector<PagePicture> draw_pictures(
    const Scene& scene, const SkeletonLines& lines, const Skeleton& skeleton,
    const Highlights& highlights, const std::optional<std::array<Point, 2>>& region,
    int up_axis, const Request& request);

}  // namespace sightline::viewers
