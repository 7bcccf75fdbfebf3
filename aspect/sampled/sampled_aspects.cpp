#include "aspect/sampled/sampled_aspects.h"

#include <algorithm>

#include "aspect/views/estimate.h"
#include "aspect/views/label_graph.h"
#include "aspect/views/labels.h"
#include "aspect/views/sample_space.h"
#include "linespace/picture/view_scene.h"
#include "linespace/work/deadline.h"

namespace sightline::internal {
namespace {

// Of the seeds for what is sampled and what is checked.
constexpr std::uint64_t kOtherSeed = 0x9E3779B97F4A7C15u;

}  // namespace

AspectCheck check_labels(const PointViewIndex& index, const AspectRequest& request,
                         const std::set<std::string>& labels) {
  const std::vector<Point> at = random_samples(index.shared().scene(), request,
                                               request.check, request.seed ^ kOtherSeed);
  AspectCheck out;
  for (const auto& fresh : take_views(index, at, request, request).labels) {
    if (!fresh) continue;
    ++out.views;
    if (!labels.contains(fresh->label)) ++out.not_in_graph;
  }
  out.interval = share_interval(out.not_in_graph, out.views);
  return out;
}

AspectGraph sampled_aspects(const Scene& scene, const AspectRequest& request) {
  const Deadline deadline(request);
  const PointViewIndex index(scene, request);
  const Samples samples = samples_of(scene, request);
  TakenViews taken =
      take_views(index, samples.at, request, deadline.what_is_left(request));
  auto& labels = taken.labels;
  LabelGraph graph(request, view_weight(scene, request));
  std::vector<int> node(labels.size(), -1);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (!labels[i]) continue;
    node[i] =
        graph.add(viewpoint_at(samples.at[i], request.projection), std::move(*labels[i]));
  }
  std::vector<std::array<int, 2>> neighbours;
  for (const auto& [a, b] : samples.neighbours) {
    if (node[a] >= 0 && node[b] >= 0) neighbours.push_back({node[a], node[b]});
  }
  graph.join(std::move(neighbours));
  AspectGraph out = graph.answer();
  out.method = AspectMethod::Sampled;
  out.complete = taken.complete;
  out.views = taken.views;
  if (!taken.complete || graph.size() == 0) return out;
  if (request.sampling == Sampling::Random)
    out.estimate = estimate_of(graph.labels_met());
  if (request.check > 0) out.check = check_labels(index, request, graph.labels());
  return out;
}

}  // namespace sightline::internal
