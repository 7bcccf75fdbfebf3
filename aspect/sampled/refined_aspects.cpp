#include "aspect/sampled/refined_aspects.h"

#include <algorithm>
#include <map>
#include <set>

#include "aspect/sampled/sampled_aspects.h"
#include "aspect/views/label_graph.h"
#include "aspect/views/labels.h"
#include "aspect/views/sample_space.h"
#include "linespace/picture/view_scene.h"
#include "linespace/view_path.h"
#include "linespace/work/deadline.h"
#include "linespace/work/parallel.h"

namespace sightline::internal {
namespace {

class Refiner {
 public:
  Refiner(const Scene& scene, const AspectRequest& request)
      : scene_(&scene),
        request_(&request),
        deadline_(request),
        index_(scene, request),
        graph_(request, view_weight(scene, request)) {}

  AspectGraph graph() {
    bool complete = true;
    std::vector<AspectGraph::Round> rounds;
    try {
      take_samples();
      for (bool any_new = true; any_new;) {
        const auto neighbours = graph_.neighbours(request_->projection);
        graph_.join(neighbours);
        rounds.push_back({views_, graph_.aspects()});
        any_new = explain(neighbours);
      }
      graph_.join(graph_.neighbours(request_->projection));
      unite();
    } catch (const Stopped&) {
      complete = false;
    }
    graph_.join(graph_.neighbours(request_->projection));
    AspectGraph out = graph_.answer();
    out.method = AspectMethod::Refined;
    out.complete = complete;
    out.views = views_;
    out.rounds = std::move(rounds);
    if (complete && request_->check > 0)
      out.check = check_labels(index_, *request_, graph_.labels());
    return out;
  }

 private:
  // Throws Stopped, after what is done has joined the graph.
  void take_samples() {
    const std::vector<Point> at = samples_of(*scene_, *request_).at;
    TakenViews taken =
        take_views(index_, at, *request_, deadline_.what_is_left(*request_));
    views_ = taken.views;
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (taken.labels[i]) {
        graph_.add(viewpoint_at(at[i], request_->projection),
                   std::move(*taken.labels[i]));
      }
    }
    if (!taken.complete)
      throw Stopped("views",
                    static_cast<double>(views_) / static_cast<double>(at.size()));
  }

  // What a viewpoint sees between two changes of its label; nothing inside an object.
  struct Stretch {
    std::optional<Viewpoint> at;
    ViewLabels labels;
    std::vector<PathEvent> before;  // events between the last one and this
  };

  [[nodiscard]] std::vector<Stretch> stretches(int a, int b, const Request& left) const {
    const std::vector<Viewpoint> ends{graph_.node(a).at, graph_.node(b).at};
    const ViewPath path = view_path(index_, ends, true, left);
    std::vector<Stretch> out;
    for (std::size_t k = 0; k < path.stretches.size(); ++k) {
      const PointView& view = *path.stretches[k].view;
      Stretch next;
      if (view.place == EyePlace::Free && view.general) {
        next.at = view.eye;
        next.labels = labels_of(view, *scene_, *request_);
      }
      if (k > 0) next.before = path.changes[k - 1].events;
      if (!out.empty() && out.back().at && next.at &&
          out.back().labels.label == next.labels.label) {
        continue;
      }
      out.push_back(std::move(next));
    }
    return out;
  }

  // Asks pairs of different labels that were not asked before.  True where a viewpoint
  // was added.
  bool explain(const std::vector<std::array<int, 2>>& neighbours) {
    std::vector<std::array<int, 2>> pairs;
    for (const auto& pair : neighbours) {
      if (graph_.node(pair[0]).labels.label != graph_.node(pair[1]).labels.label &&
          asked_.insert(pair).second) {
        pairs.push_back(pair);
      }
    }
    std::vector<std::vector<Stretch>> found(pairs.size());
    const Request left = deadline_.what_is_left(*request_);
    Stage stage(left, "events between views");
    Request one_thread = left;
    one_thread.progress = nullptr;
    for_each_of(0, pairs.size(), pairs.size(), left, stage, [&](std::size_t i) {
      found[i] = stretches(pairs[i][0], pairs[i][1], one_thread);
    });
    // Labels beside each viewpoint, and one that has it.
    std::vector<std::map<std::string, int>> beside(graph_.size());
    for (const auto& [a, b] : neighbours) {
      beside[a].emplace(graph_.node(b).labels.label, b);
      beside[b].emplace(graph_.node(a).labels.label, a);
    }
    bool any_new = false;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (found[i].size() > 2) views_ += found[i].size() - 2;
      any_new |= add(pairs[i], found[i], beside);
    }
    return any_new;
  }

  // Viewpoints for the stretches of a pair, and the walls between them.
  bool add(const std::array<int, 2>& pair, std::vector<Stretch>& way,
           std::vector<std::map<std::string, int>>& beside) {
    bool any_new = false;
    int last = -1;
    for (std::size_t k = 0; k < way.size(); ++k) {
      int node = -1;
      if (k == 0) {
        node = pair[0];
      } else if (k + 1 == way.size()) {
        node = pair[1];
      } else if (way[k].at) {
        for (const int end : pair) {
          const auto known = beside[end].find(way[k].labels.label);
          if (node < 0 && known != beside[end].end()) node = known->second;
          if (graph_.node(end).labels.label == way[k].labels.label) node = end;
        }
        if (node < 0) {
          const std::string label = way[k].labels.label;
          node = graph_.add(*way[k].at, std::move(way[k].labels));
          for (const int end : pair) beside[end].emplace(label, node);
          any_new = true;
        }
      }
      if (last >= 0 && node >= 0) graph_.add_wall(last, node, way[k].before);
      last = node;
    }
    return any_new;
  }

  // Parts of one label that no neighbours connect, but a way without change does.
  void unite() {
    const std::vector<std::array<int, 2>> pairs = graph_.nearest_of_one_label();
    std::vector<std::uint8_t> one(pairs.size(), 0);
    const Request left = deadline_.what_is_left(*request_);
    Stage stage(left, "ways between views of one label");
    Request one_thread = left;
    one_thread.progress = nullptr;
    for_each_of(0, pairs.size(), pairs.size(), left, stage, [&](std::size_t i) {
      const auto way = stretches(pairs[i][0], pairs[i][1], one_thread);
      one[i] = way.size() == 1 && way[0].at ? 1 : 0;
    });
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (one[i] != 0) graph_.add_wall(pairs[i][0], pairs[i][1], {});
    }
  }

  const Scene* scene_;
  const AspectRequest* request_;
  Deadline deadline_;
  PointViewIndex index_;
  LabelGraph graph_;
  std::set<std::array<int, 2>> asked_;
  std::size_t views_ = 0;
};

}  // namespace

AspectGraph refined_aspects(const Scene& scene, const AspectRequest& request) {
  return Refiner(scene, request).graph();
}

}  // namespace sightline::internal
