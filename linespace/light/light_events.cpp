#include "linespace/light/light_events.h"

#include <algorithm>
#include <memory>

#include "linespace/light/event_finder.h"
#include "linespace/light/horizon_events.h"
#include "linespace/light/patch_space.h"
#include "linespace/work/parallel.h"

namespace sightline::internal {

LightEvents light_events(const LightSpace& space, const LightEventsRequest& request) {
  const Deadline deadline(request);
  LightEvents out;
  const std::size_t n = space.faces().size();
  std::vector<std::uint8_t> front(n, request.receivers.empty() ? 1 : 0);
  std::vector<std::uint8_t> back(n, 0);
  for (const int f : request.receivers) front[f] = 1;
  for (const int f : request.receive_behind) back[f] = 1;
  out.patches = source_patches(space.scene(), request.source_faces);
  Stage stage(request, "events of the source", deadline);
  const HidingSolids solids(space);
  for (std::size_t k = 0; k < out.patches.size() && out.complete; ++k) {
    const PatchSpace at(space, out.patches[k], static_cast<int>(k));
    const std::vector<PencilPoint>& points = at.points;
    const std::vector<int> horizons = horizon_facets(at, front, back);
    const std::size_t edges_end = points.size() + at.front_edges.size();
    const SourceSight sight(at, solids, request, stage);
    StageCounts counts;
    struct Found {
      std::vector<LightTrace> traces;
      std::size_t families;
    };
    const StoppedBy stopped = for_each_parallel(
        edges_end + horizons.size(), request, deadline, "events of the source", counts,
        [&] { return std::make_unique<EventFinder>(at, sight, front, back); },
        [&](EventFinder& finder, std::size_t i) {
          const std::size_t before = finder.families();
          Found found;
          if (i < points.size()) {
            found.traces = finder.of_point(points[i], i >= at.own_points);
          } else if (i < edges_end) {
            found.traces = finder.of_edge(at.front_edges[i - points.size()]);
          } else {
            found.traces = horizon_events(at, horizons[i - edges_end], front, back);
          }
          found.families = finder.families() - before;
          return found;
        },
        [&](std::size_t, Found&& found) {
          out.families += found.families;
          std::ranges::move(found.traces, std::back_inserter(out.traces));
          return true;
        });
    out.complete = stopped == StoppedBy::Nothing;
  }
  return out;
}

}  // namespace sightline::internal
