#include "aspect/sampled/sampled_aspects.h"

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "aspect/sampled/estimate.h"
#include "aspect/sampled/labels.h"
#include "aspect/sampled/sample_space.h"
#include "linespace/picture/classes.h"
#include "linespace/work/deadline.h"
#include "linespace/work/parallel.h"

namespace sightline::internal {
namespace {

// Of the seeds for what is sampled and what is checked.
constexpr std::uint64_t kOtherSeed = 0x9E3779B97F4A7C15u;

class Sampler {
 public:
  Sampler(const Scene& scene, const AspectRequest& request)
      : scene_(&scene),
        request_(&request),
        deadline_(request),
        index_(scene, request),
        samples_(samples_of(scene, request)) {}

  AspectGraph graph() {
    AspectGraph out;
    out.method = AspectMethod::Sampled;
    take(samples_.at, views_, out.complete);
    out.views = static_cast<std::size_t>(
        std::ranges::count_if(taken_, [](std::uint8_t t) { return t != 0; }));
    join();
    count(out);
    if (request_->sampling == Sampling::Random && out.complete)
      out.estimate = estimate_of(labels_seen());
    if (request_->check > 0 && out.complete) out.check = check();
    if (request_->list) list(out);
    return out;
  }

 private:
  [[nodiscard]] Viewpoint viewpoint(const Point& at) const {
    return request_->projection == Projection::Orthographic ? eye_far_along(at)
                                                            : eye_at(at);
  }

  // Views of all; where time is over, of those that were done.
  void take(const std::vector<Point>& at, std::vector<std::optional<ViewLabels>>& views,
            bool& complete) {
    views.assign(at.size(), std::nullopt);
    taken_.assign(at.size(), 0);
    const Request left = deadline_.what_is_left(*request_);
    try {
      Stage stage(left, "views");
      for_each_of(0, at.size(), at.size(), left, stage, [&](std::size_t i) {
        views[i] = labels_of(index_, viewpoint(at[i]), *request_);
        taken_[i] = 1;
      });
    } catch (const Stopped&) {
      complete = false;
    }
  }

  void join() {
    Classes classes(views_.size());
    for (const auto& [a, b] : samples_.neighbours) {
      if (views_[a] && views_[b] && views_[a]->label == views_[b]->label)
        classes.join(a, b);
    }
    number_.assign(views_.size(), -1);
    std::map<int, int> numbers;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (!views_[i]) continue;
      const int root = classes.root(static_cast<int>(i));
      const auto [it, is_new] = numbers.emplace(root, static_cast<int>(numbers.size()));
      number_[i] = it->second;
      if (is_new) members_.emplace_back();
      members_[it->second].push_back(static_cast<int>(i));
    }
    for (const auto& [a, b] : samples_.neighbours) {
      if (number_[a] < 0 || number_[b] < 0 || number_[a] == number_[b]) continue;
      adjacent_.insert(
          {std::min(number_[a], number_[b]), std::max(number_[a], number_[b])});
    }
  }

  void count(AspectGraph& out) const {
    out.aspects = members_.size();
    out.adjacencies = adjacent_.size();
    std::unordered_set<std::string> labels, faces, shapes;
    for (const auto& view : views_) {
      if (!view) continue;
      labels.insert(view->label);
      faces.insert(view->faces);
      shapes.insert(view->shape);
    }
    out.distinct = labels.size();
    out.by_visible_faces = faces.size();
    out.by_shape = shapes.size();
  }

  [[nodiscard]] std::vector<int> labels_seen() const {
    std::unordered_map<std::string, int> seen;
    for (const auto& view : views_) {
      if (view) ++seen[view->label];
    }
    std::vector<int> out;
    for (const auto& [label, times] : seen) out.push_back(times);
    return out;
  }

  AspectCheck check() {
    std::unordered_set<std::string> known;
    for (const auto& view : views_) {
      if (view) known.insert(view->label);
    }
    const std::vector<Point> at =
        random_samples(*scene_, *request_, request_->check, request_->seed ^ kOtherSeed);
    std::vector<std::optional<ViewLabels>> fresh;
    bool complete = true;
    take(at, fresh, complete);
    AspectCheck out;
    for (const auto& view : fresh) {
      if (!view) continue;
      ++out.views;
      if (!known.contains(view->label)) ++out.not_in_graph;
    }
    out.interval = share_interval(out.not_in_graph, out.views);
    return out;
  }

  // The sample of an aspect with the most steps to samples of other aspects.
  [[nodiscard]] std::vector<int> deepest() const {
    std::vector<std::vector<int>> beside(views_.size());
    for (const auto& [a, b] : samples_.neighbours) {
      beside[a].push_back(b);
      beside[b].push_back(a);
    }
    std::vector<int> depth(views_.size(), -1), front;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const bool border =
          std::ranges::any_of(beside[i], [&](int j) { return number_[j] != number_[i]; });
      if (!border) continue;
      depth[i] = 0;
      front.push_back(static_cast<int>(i));
    }
    for (std::size_t k = 0; k < front.size(); ++k) {
      for (const int j : beside[front[k]]) {
        if (depth[j] >= 0) continue;
        depth[j] = depth[front[k]] + 1;
        front.push_back(j);
      }
    }
    std::vector<int> out;
    for (const auto& members : members_) {
      out.push_back(
          *std::ranges::max_element(members, {}, [&](int i) { return depth[i]; }));
    }
    return out;
  }

  void list(AspectGraph& out) const {
    const std::vector<int> at = deepest();
    std::size_t counted = 0;
    for (const auto& members : members_) counted += members.size();
    for (std::size_t a = 0; a < members_.size(); ++a) {
      Aspect& aspect = out.list.emplace_back();
      aspect.at = viewpoint(samples_.at[at[a]]);
      aspect.weight = samples_.weight * static_cast<double>(members_[a].size()) /
                      static_cast<double>(counted);
      aspect.facets = views_[at[a]]->facets;
      aspect.structure = views_[at[a]]->structure;
    }
    for (const auto& [a, b] : adjacent_) {
      out.list[a].neighbours.push_back({b, {}});
      out.list[b].neighbours.push_back({a, {}});
    }
    for (Aspect& aspect : out.list)
      std::ranges::sort(aspect.neighbours, {}, &AspectNeighbour::aspect);
  }

  const Scene* scene_;
  const AspectRequest* request_;
  Deadline deadline_;
  PointViewIndex index_;
  Samples samples_;
  std::vector<std::optional<ViewLabels>> views_;
  std::vector<std::uint8_t> taken_;
  std::vector<int> number_;                // of aspects, by sample
  std::vector<std::vector<int>> members_;  // samples, by aspect
  std::set<std::array<int, 2>> adjacent_;
};

}  // namespace

AspectGraph sampled_aspects(const Scene& scene, const AspectRequest& request) {
  return Sampler(scene, request).graph();
}

}  // namespace sightline::internal
