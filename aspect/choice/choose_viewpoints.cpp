// From where to look: best_views() and next_view().

#include <algorithm>
#include <limits>
#include <set>

#include "aspect/choice/apart.h"
#include "aspect/choice/candidates.h"
#include "aspect/choice/set_cover.h"
#include "aspect/choice/view_bounds.h"
#include "aspect/viewpoints.h"
#include "linespace/picture/view_scene.h"
#include "linespace/work/stage.h"

namespace sightline {

using namespace internal;

namespace {

void check(const ViewpointRequest& request) {
  if (request.samples < 1) throw InvalidInput("samples: at least one is needed");
  if (request.bounds &&
      !((*request.bounds)[0].array() < (*request.bounds)[1].array()).all()) {
    throw InvalidInput("bounds: the first corner must be below the second on all axes");
  }
}

ViewpointRequest left_of(ViewpointRequest request, const Deadline& deadline) {
  request.budget_seconds -= deadline.seconds();
  return request;
}

// Numbers of views by worth, the best first, and no two of one label.
std::vector<int> best_of(const Candidates& candidates, const Candidates::Worth& worth,
                         int count) {
  const auto& views = candidates.views();
  std::vector<int> order(views.size());
  std::vector<double> values(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    order[i] = static_cast<int>(i);
    values[i] = worth(views[i]);
  }
  std::ranges::stable_sort(order, std::greater{}, [&](int i) { return values[i]; });
  std::set<std::string> labels;
  std::vector<int> out;
  for (const int i : order) {
    if (static_cast<int>(out.size()) == count) break;
    if (labels.insert(views[i].label).second) out.push_back(i);
  }
  return out;
}

// Improves the best views, and their neighbours in rank, since one step on the way may
// lead into another aspect.
void improve_best(Candidates& candidates, const Candidates::Worth& worth, int faces) {
  const int starts = std::clamp(600 / std::max(faces, 1), 2, 5);
  std::vector<int> from = best_of(candidates, worth, starts);
  const auto by_worth = [&] {
    std::vector<int> order(candidates.views().size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
    std::ranges::stable_sort(order, std::greater{},
                             [&](int i) { return worth(candidates.views()[i]); });
    order.resize(std::min<std::size_t>(order.size(), starts));
    return order;
  }();
  from.insert(from.end(), by_worth.begin(), by_worth.end());
  std::set<int> done;
  for (const int i : from) {
    if (done.insert(i).second) candidates.improve(i, worth);
  }
}

ChosenView chosen(const SeenParts& view, double value) {
  return {view.at, view.facets, value};
}

// No view yet, and no bound.
BestViews none_of(const Candidates& candidates) {
  return {{},
          std::numeric_limits<double>::infinity(),
          candidates.certified(),
          candidates.taken(),
          candidates.complete()};
}

double best_bound(const PointViewIndex& index, const ViewpointRequest& request,
                  const std::vector<PatchSide>& sides, const Candidates& candidates,
                  ViewMeasure measure, double reached, const Deadline& deadline) {
  try {
    const Stage stage(request, "bound", deadline);
    const double bound = measure_bound(index, request, sides, measure, reached);
    if (!candidates.certified()) return bound;
    return std::max(reached, std::min(bound, graph_bound(candidates.views(), sides,
                                                         request, measure)));
  } catch (const Stopped&) {
    return std::numeric_limits<double>::infinity();
  }
}

}  // namespace

BestViews best_views(const Scene& scene, const ViewpointRequest& request,
                     ViewMeasure measure, int count) {
  check(request);
  if (count < 1) throw InvalidInput("best: at least one view is asked for");
  const bool perspective = request.projection == Projection::Perspective;
  if (measure == ViewMeasure::Entropy && !perspective)
    throw InvalidInput("entropy: is of eyes, so of perspective views");
  const PrecisionScope precision(request.precision);
  const Deadline deadline(request);
  const PointViewIndex index(scene, request);
  const std::vector<PatchSide> sides = patch_sides(index, request);
  Candidates candidates(index, left_of(request, deadline), sides, false);
  const auto worth = [measure](const SeenParts& view) {
    return view.value[static_cast<int>(measure)];
  };
  improve_best(candidates, worth, static_cast<int>(scene.faces().size()));
  BestViews out = none_of(candidates);
  for (const int i : best_of(candidates, worth, count))
    out.views.push_back(chosen(candidates.views()[i], worth(candidates.views()[i])));
  out.bound = best_bound(index, request, sides, candidates, measure,
                         out.views.empty() ? 0 : out.views[0].value, deadline);
  if (deadline.passed()) out.complete = false;
  return out;
}

BestViews next_view(const Scene& scene, const ViewpointRequest& request,
                    std::span<const Viewpoint> seen) {
  check(request);
  const PrecisionScope precision(request.precision);
  const Deadline deadline(request);
  const PointViewIndex index(scene, request);
  const std::vector<PatchSide> sides = patch_sides(index, request);
  std::set<int> known;
  for (const Viewpoint& at : seen) {
    const SeenParts view = parts_of(index.view(at, request), scene, request, false);
    known.insert(view.patches.begin(), view.patches.end());
  }
  Candidates candidates(index, left_of(request, deadline), sides, false);
  const auto worth = [&known](const SeenParts& view) {
    return static_cast<double>(std::ranges::count_if(
        view.patches, [&](int patch) { return !known.contains(patch); }));
  };
  improve_best(candidates, worth, static_cast<int>(scene.faces().size()));
  BestViews out = none_of(candidates);
  for (const int i : best_of(candidates, worth, 1)) {
    const SeenParts& view = candidates.views()[i];
    if (worth(view) > 0) out.views.push_back(chosen(view, worth(view)));
  }
  const double reached = out.views.empty() ? 0 : out.views[0].value;
  std::vector<bool> counts;
  for (const PatchSide& side : sides) counts.push_back(!known.contains(side.patch));
  try {
    const Stage stage(request, "bound", deadline);
    out.bound =
        candidates.certified()
            ? reached
            : measure_bound(index, request, sides, ViewMeasure::Faces, reached, counts);
  } catch (const Stopped&) {
    out.complete = false;
  }
  if (deadline.passed()) out.complete = false;
  return out;
}

}  // namespace sightline
