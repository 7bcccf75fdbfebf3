#include "linespace/light/light_events.h"

#include <algorithm>
#include <memory>

#include "linespace/light/event_finder.h"
#include "linespace/light/hiding_solids.h"
#include "linespace/light/horizon_events.h"
#include "linespace/light/patch_space.h"
#include "linespace/light/source_sight.h"
#include "linespace/work/parallel.h"

namespace sightline::internal {

namespace {

/// Faces on whose fronts, and on whose backs, lines may end.
struct Wanted {
  std::vector<std::uint8_t> front, back;

  Wanted(std::size_t faces, const LightEventsRequest& request)
      : front(faces, request.receivers.empty() ? 1 : 0), back(faces, 0) {
    for (const int f : request.receivers) front[f] = 1;
    for (const int f : request.receive_behind) back[f] = 1;
  }
};

// Appends the events of one patch; why not all were found, or Nothing.
StoppedBy add_events(const PatchSpace& at, const SourceSight& sight, const Wanted& wanted,
                     const LightEventsRequest& request, const Deadline& deadline,
                     LightEvents& out) {
  const std::vector<HorizonPlane> horizons =
      horizon_planes(at, wanted.front, wanted.back);
  const std::size_t points = at.points.size();
  const std::size_t edges_end = points + at.front_edges.size();
  struct Found {
    std::vector<LightTrace> traces;
    std::size_t families = 0;
  };
  const auto find = [&](EventFinder& finder, std::size_t i) {
    if (i < points) return finder.of_point(at.points[i], i >= at.own_points);
    if (i < edges_end) return finder.of_edge(at.front_edges[i - points]);
    return horizon_events(at, horizons[i - edges_end], wanted.front, wanted.back);
  };
  StageCounts counts;
  return for_each_parallel(
      edges_end + horizons.size(), request, deadline, "events of the source", counts,
      [&] { return std::make_unique<EventFinder>(at, sight, wanted.front, wanted.back); },
      [&](EventFinder& finder, std::size_t i) {
        const std::size_t before = finder.families();
        Found found{find(finder, i), 0};
        found.families = finder.families() - before;
        return found;
      },
      [&](std::size_t, Found&& found) {
        out.families += found.families;
        std::ranges::move(found.traces, std::back_inserter(out.traces));
        return true;
      });
}

}  // namespace

LightEvents light_events(const LightSpace& space, const LightEventsRequest& request) {
  const Deadline deadline(request);
  LightEvents out;
  const Wanted wanted(space.faces().size(), request);
  out.patches = source_patches(space.scene(), request.source_faces);
  std::ranges::move(source_patches(space.scene(), request.source_backs, FaceSide::Back),
                    std::back_inserter(out.patches));
  try {
    Stage stage(request, "events of the source", deadline);
    const HidingSolids solids(space);
    for (std::size_t k = 0; k < out.patches.size() && out.complete; ++k) {
      const PatchSpace at(space, out.patches[k], static_cast<int>(k));
      const SourceSight sight(at, solids, request, stage);
      const StoppedBy stopped = add_events(at, sight, wanted, request, deadline, out);
      out.complete = stopped == StoppedBy::Nothing;
    }
  } catch (const Stopped&) {
    out.complete = false;
  }
  return out;
}

}  // namespace sightline::internal
