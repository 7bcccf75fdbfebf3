#include "linespace/view_path.h"

#include <algorithm>
#include <iterator>

#include "linespace/numbers/exact_position.h"
#include "linespace/path/path_names.h"
#include "linespace/path/path_walk.h"
#include "linespace/work/parallel.h"

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

// A part of a segment, from u to u.  Its walk has the events after `from`, up to and at
// `to`.
struct Part {
  int segment;
  Rational from, to;
};

// As many whatever the number of threads, so that the answer is the same.  The ends are
// short binary fractions, so that eyes between doubles remain doubles.
std::vector<Part> parts_of(std::size_t segments) {
  constexpr int kParts = 8;
  std::vector<Part> parts;
  int of_one = 1;
  while (segments > 0 && of_one * static_cast<int>(segments) < kParts) of_one *= 2;
  for (int s = 0; s < static_cast<int>(segments); ++s) {
    for (int k = 0; k < of_one; ++k)
      parts.push_back({s, Rational(k) / of_one, Rational(k + 1) / of_one});
  }
  return parts;
}

// What is found on a part, or on the parts so far.
struct Found {
  ViewPath path;
  // Told of the first stretch, of the second and of the last.
  WalkViewPtr first, second, last;
  // Accidents that last where a segment begins and where it ends.
  std::vector<Accident> beginning, ending;
};

class Walker {
 public:
  Walker(const PointViewIndex& index, std::span<const Viewpoint> path, bool keep_views,
         const Request& request)
      : path_(path),
        keep_views_(keep_views),
        request_(request),
        deadline_(request),
        scene_(index.shared(), size_of(index.shared().scene(), path)) {
    look_ = [this, &index](const Viewpoint& eye) {
      Request one = deadline_.what_is_left(request_);
      one.precision = Precision::Exact;
      one.progress = nullptr;
      one.threads = 1;
      return index.view(eye, one);
    };
  }

  ViewPath walk();

 private:
  void walk_part(const Part& part, Found& found) const;
  [[nodiscard]] PathChange change(int segment, double u, std::vector<PathEvent> events,
                                  const PointView& before, const PointView& after) const;
  void add_stretch(Found& found, int segment, double from, double to,
                   const WalkViewPtr& view) const;
  void append(const Part& part, Found next, Found& all) const;

  std::span<const Viewpoint> path_;
  bool keep_views_;
  Request request_;
  Deadline deadline_;
  PathScene scene_;
  Look look_;
};

ViewPath Walker::walk() {
  const std::vector<Part> parts = parts_of(path_.size() < 2 ? 0 : path_.size() - 1);
  std::vector<Found> found(parts.size());
  for (Found& f : found) f.path.complete = false;
  const auto step = [&](int&, std::size_t i) {
    walk_part(parts[i], found[i]);
    return 0;
  };
  Request request = request_;
  request.precision = Precision::Exact;
  const StageCounts before = thread_stage_counts();
  StageCounts counts;
  (void)for_each_parallel(
      parts.size(), request, deadline_, "path", counts,
      [] { return std::optional<int>(0); }, step, [](std::size_t, int) { return true; });
  thread_stage_counts() = {before.by_double + counts.by_double,
                           before.by_interval + counts.by_interval,
                           before.by_exact + counts.by_exact};
  // Up to where the work was stopped.
  Found all;
  try {
    for (std::size_t i = 0; i < parts.size() && all.path.complete; ++i)
      append(parts[i], std::move(found[i]), all);
  } catch (const Stopped&) {
    all.path.complete = false;
  }
  return std::move(all.path);
}

// Until it is done the part is not complete.
void Walker::walk_part(const Part& part, Found& found) const {
  const ExactPoint from = exact_point(path_[part.segment].at);
  const ExactPoint to = exact_point(path_[part.segment + 1].at);
  // On a little beyond the end, so that what happens there is inside.
  const Rational length = part.to - part.from;
  const Rational end = part.to == 1 ? part.to : Rational(part.to + length / 16);
  const SightPath path(path_[part.segment].kind, along(from, to, part.from),
                       along(from, to, end), scene_.size());
  const auto u_of = [&](double t) {
    return static_cast<double>(part.from) + t * static_cast<double>(end - part.from);
  };
  PathWalk walk(scene_, path, look_, PathRoot(length / (end - part.from)));
  WalkViewPtr now = found.first = found.last = walk.first();
  if (part.from == 0) found.beginning = walk.lasting_after(PathRoot(part.from), *now);
  double u = static_cast<double>(part.from);
  while (auto step = walk.next()) {
    const double next = u_of(step->at.rounded());
    add_stretch(found, part.segment, u, next, now);
    found.path.changes.push_back(change(part.segment, next, std::move(step->events),
                                        now->view, step->after->view));
    now = found.last = step->after;
    if (!found.second) found.second = now;
    u = next;
  }
  add_stretch(found, part.segment, u, static_cast<double>(part.to), now);
  if (part.to == 1) found.ending = walk.lasting_before(PathRoot(part.to), *now);
  found.path.complete = true;
}

// Where one part ends and the next begins: mostly with one view, but where an event
// surface is left, or touched, at a viewpoint of the path.
void Walker::append(const Part& part, Found next, Found& all) const {
  ViewPath &path = all.path, &more = next.path;
  const bool within = part.from != 0;
  if (all.last && next.first &&
      !same_structure(scene_, all.last->view, next.first->view)) {
    const SightPath segment(path_[part.segment].kind, exact_point(path_[part.segment].at),
                            exact_point(path_[part.segment + 1].at), scene_.size());
    const PointView at = look_(segment.eye(part.from));
    const Scene& scene = scene_.scene().scene();
    std::vector<PathEvent> events = events_of(scene, at, all.ending, next.beginning);
    // One event surface is left for another: both go on at this eye.
    if (events.empty()) events = events_of(scene, at, {}, {});
    path.changes.push_back(change(within ? part.segment : part.segment - 1,
                                  within ? static_cast<double>(part.from) : 1,
                                  std::move(events), all.last->view, next.first->view));
  } else if (within && all.last && !more.stretches.empty()) {
    path.stretches.back().u_to = more.stretches.front().u_to;
    more.stretches.erase(more.stretches.begin());
    // One structure may show other facets of a patch: changes are told between the views
    // that are told.
    if (next.second) {
      PathChange& c = more.changes.front();
      c = change(c.segment, c.u, std::move(c.events), all.last->view, next.second->view);
    } else {
      next.last = all.last;
    }
  }
  std::ranges::move(more.changes, std::back_inserter(path.changes));
  std::ranges::move(more.stretches, std::back_inserter(path.stretches));
  if (next.last) all.last = std::move(next.last);
  all.ending = std::move(next.ending);
  path.complete = more.complete;
}

PathChange Walker::change(int segment, double u, std::vector<PathEvent> events,
                          const PointView& before, const PointView& after) const {
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
  return change;
}

void Walker::add_stretch(Found& found, int segment, double from, double to,
                         const WalkViewPtr& view) const {
  found.path.stretches.push_back({segment, from, to, std::nullopt});
  if (keep_views_) found.path.stretches.back().view = view->view;
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
  if (index.shared().cut() != nullptr)
    throw InvalidInput("a path: not through a scene that a box cuts");
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
