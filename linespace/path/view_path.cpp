#include "linespace/view_path.h"

#include <algorithm>
#include <cmath>

#include "linespace/numbers/exact_position.h"
#include "linespace/path/path_names.h"
#include "linespace/path/path_walk.h"
#include "linespace/work/stage.h"

namespace sightline {

using namespace internal;

namespace {

void check(std::span<const Viewpoint> path) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    const std::string segment =
        "viewpoints " + std::to_string(i - 1) + " and " + std::to_string(i);
    if (path[i].kind != path[i - 1].kind) {
      throw InvalidInput(segment + ": one is an eye, the other a direction");
    }
    if (path[i].kind == Viewpoint::Kind::Eye) continue;
    const ExactPoint d = exact_point(path[i - 1].at), e = exact_point(path[i].at);
    if (exact_cross(d, e) == ExactPoint{} && exact_dot(d, e) < 0) {
      throw InvalidInput(segment + " are opposite directions");
    }
  }
}

double size_of(const Scene& scene, std::span<const Viewpoint> path) {
  double size = std::max(scene.bounds()[0].cwiseAbs().maxCoeff(),
                         scene.bounds()[1].cwiseAbs().maxCoeff());
  for (const Viewpoint& v : path) {
    if (v.kind == Viewpoint::Kind::Eye)
      size = std::max(size, v.at.nearest.cwiseAbs().maxCoeff());
  }
  return size;
}

class Walker {
 public:
  Walker(const PointViewIndex& index, std::span<const Viewpoint> path, bool keep_views,
         const Request& request)
      : path_(path),
        keep_views_(keep_views),
        stage_(request, "path"),
        deadline_(request),
        scene_(index.shared(), size_of(index.shared().scene(), path)) {
    look_ = [this, &index, &request](const Viewpoint& eye) {
      Request one = deadline_.what_is_left(request);
      one.precision = Precision::Exact;
      one.progress = nullptr;
      return index.view(eye, one);
    };
  }

  ViewPath walk() {
    try {
      for (int s = 0; s + 1 < static_cast<int>(path_.size()); ++s) walk_segment(s);
    } catch (const Stopped&) {
      found_.complete = false;
    }
    return std::move(found_);
  }

 private:
  void walk_segment(int segment);
  void meet(int segment, const WalkViewPtr& before, const WalkViewPtr& after);
  void add_change(int segment, double u, std::vector<PathEvent> events,
                  const PointView& before, const PointView& after);
  void add_stretch(int segment, double from, double to, const WalkViewPtr& view);

  std::span<const Viewpoint> path_;
  bool keep_views_;
  Stage stage_;
  Deadline deadline_;
  PathScene scene_;
  Look look_;
  WalkViewPtr last_;  // of the segment before
  ViewPath found_;
};

void Walker::walk_segment(int segment) {
  const SightPath path(path_[segment].kind, exact_point(path_[segment].at),
                       exact_point(path_[segment + 1].at), scene_.size());
  PathWalk walk(scene_, path, look_);
  WalkViewPtr now = walk.first();
  if (last_) meet(segment - 1, last_, now);
  double from = 0;
  while (auto step = walk.next()) {
    const double u = step->at.rounded();
    stage_.check((segment + u) / static_cast<double>(path_.size() - 1));
    add_stretch(segment, from, u, now);
    add_change(segment, u, std::move(step->events), now->view, step->after->view);
    now = step->after;
    from = u;
  }
  add_stretch(segment, from, 1, now);
  last_ = now;
}

// Where a segment ends and the next begins.
void Walker::meet(int segment, const WalkViewPtr& before, const WalkViewPtr& after) {
  if (same_structure(scene_, before->view, after->view)) return;
  const PointView at = look_(path_[segment + 1]);
  const Scene& scene = scene_.scene().scene();
  std::vector<PathEvent> events = events_of(scene, at, before->view, after->view);
  // One event surface is left for another: both go on at this eye.
  if (events.empty()) events = events_of(scene, at, PointView{}, PointView{});
  add_change(segment, 1, std::move(events), before->view, after->view);
}

void Walker::add_change(int segment, double u, std::vector<PathEvent> events,
                        const PointView& before, const PointView& after) {
  PathChange change{segment,
                    u,
                    std::move(events),
                    seen_only_in(after, before),
                    seen_only_in(before, after),
                    map_counts(after)};
  const MapCounts less = map_counts(before);
  for (const auto member :
       {&MapCounts::corners, &MapCounts::t_vertices, &MapCounts::touches,
        &MapCounts::accident_vertices, &MapCounts::edges, &MapCounts::regions,
        &MapCounts::components}) {
    change.difference.*member -= less.*member;
  }
  found_.changes.push_back(std::move(change));
}

void Walker::add_stretch(int segment, double from, double to, const WalkViewPtr& view) {
  found_.stretches.push_back({segment, from, to, std::nullopt});
  if (keep_views_) found_.stretches.back().view = view->view;
}

}  // namespace

MapCounts map_counts(const PointView& view) {
  MapCounts counts;
  for (const MapVertex& v : view.vertices) {
    switch (v.kind) {
      case MapVertexKind::Corner:
        ++counts.corners;
        break;
      case MapVertexKind::T:
        ++counts.t_vertices;
        break;
      case MapVertexKind::Touch:
        ++counts.touches;
        break;
      case MapVertexKind::Accident:
        ++counts.accident_vertices;
        break;
    }
  }
  counts.edges = static_cast<int>(view.edges.size());
  counts.regions = static_cast<int>(view.regions.size());
  counts.components = view.components;
  return counts;
}

ViewPath view_path(const PointViewIndex& index, std::span<const Viewpoint> path,
                   bool keep_views, const Request& request) {
  check(path);
  const PrecisionScope precision(Precision::Exact);
  try {
    return Walker(index, path, keep_views, request).walk();
  } catch (const Stopped&) {
    ViewPath nothing;
    nothing.complete = false;
    return nothing;
  }
}

}  // namespace sightline
