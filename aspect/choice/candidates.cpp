#include "aspect/choice/candidates.h"

#include <algorithm>
#include <set>

#include "aspect/convex/convex_aspects.h"
#include "aspect/views/labels.h"
#include "aspect/views/sample_space.h"
#include "linespace/picture/view_scene.h"
#include "linespace/work/parallel.h"
#include "linespace/work/stage.h"

namespace sightline::internal {

Point place_on(const Scene& scene, const PatchSide& side) {
  Point sum = Point::Zero();
  const auto p = scene.face_points(side.faces[0]);
  for (const int i : p) sum += scene.point(i);
  return sum / static_cast<double>(p.size());
}

Candidates::Candidates(const PointViewIndex& index, const ViewpointRequest& request,
                       const std::vector<PatchSide>& sides, bool regions)
    : index_(&index),
      request_(request),
      scene_(&index.shared().scene()),
      deadline_(request_),
      regions_(regions),
      random_(request.seed) {
  extent_ = (scene_->bounds()[1] - scene_->bounds()[0]).norm();
  if (request.method == AspectMethod::Exact && request.of.empty() &&
      convex_solid(*scene_)) {
    take_graph();
    if (certified_ || !complete_) return;
  }
  take_samples();
  // What nobody sees yet.
  std::set<int> seen;
  for (const SeenParts& view : views_)
    seen.insert(view.patches.begin(), view.patches.end());
  const std::size_t most = taken_ + 4 * static_cast<std::size_t>(request_.samples);
  for (const PatchSide& side : sides) {
    if (time_is_over() || taken_ > most) return;
    if (seen.contains(side.patch)) continue;
    const int found = look_at(side, place_on(*scene_, side), [&](const SeenParts& view) {
      return std::ranges::binary_search(view.patches, side.patch);
    });
    if (found >= 0)
      seen.insert(views_[found].patches.begin(), views_[found].patches.end());
  }
}

void Candidates::take_graph() {
  AspectRequest wish = request_;
  wish.list = true;
  wish.budget_seconds = request_.budget_seconds - deadline_.seconds();
  const AspectGraph graph = find_aspects(*scene_, wish);
  complete_ = graph.complete;
  certified_ = graph.certified && graph.complete;
  std::vector<Viewpoint> at;
  for (const Aspect& aspect : graph.list) at.push_back(aspect.at);
  take(at);
}

void Candidates::take_samples() {
  std::vector<Viewpoint> at = request_.first;
  for (const Point& p : samples_of(*scene_, request_).at)
    at.push_back(viewpoint_at(p, request_.projection));
  take(at);
}

void Candidates::take(const std::vector<Viewpoint>& at) {
  std::vector<std::optional<SeenParts>> seen(at.size());
  std::vector<std::uint8_t> done(at.size(), 0);
  try {
    Stage stage(request_, "views", deadline_);
    for_each_of(0, at.size(), at.size(), request_, stage, [&](std::size_t i) {
      seen[i] = seen_parts(*index_, at[i], request_, regions_);
      done[i] = 1;
    });
  } catch (const Stopped&) {
    complete_ = false;
  }
  taken_ += static_cast<std::size_t>(std::ranges::count(done, 1));
  for (auto& view : seen) {
    if (view) views_.push_back(std::move(*view));
  }
}

bool Candidates::allowed(const Point& at) const {
  if (request_.projection == Projection::Orthographic) return at.norm() > 0;
  if (!request_.bounds) return true;
  const auto& [low, high] = *request_.bounds;
  return (at.array() > low.array()).all() && (at.array() < high.array()).all();
}

bool Candidates::time_is_over() {
  if (deadline_.passed()) complete_ = false;
  return !complete_;
}

std::optional<SeenParts> Candidates::see(const Point& at) {
  if (!allowed(at) || time_is_over()) return std::nullopt;
  try {
    const Stage stage(request_, "views", deadline_);
    ++taken_;
    return seen_parts(*index_, viewpoint_at(at, request_.projection), request_, regions_);
  } catch (const Stopped&) {
    complete_ = false;
    return std::nullopt;
  }
}

// Steps grow after each success and shrink after failures (Rechenberg's rule).
int Candidates::improve(int i, const Worth& worth) {
  const bool sphere = request_.projection == Projection::Orthographic;
  const int faces = static_cast<int>(scene_->faces().size());
  const int steps = std::clamp(10'000 / std::max(faces, 1), 20, 250);
  std::optional<SeenParts> best;
  double value = worth(views_[i]);
  Point at = sphere ? Point(views_[i].point.normalized()) : views_[i].point;
  double step = sphere ? 0.2 : extent_ / 10;
  std::normal_distribution<double> normal;
  for (int k = 0; k < steps && !time_is_over(); ++k) {
    const Point to = at + step * Point(normal(random_), normal(random_), normal(random_));
    std::optional<SeenParts> view = see(sphere ? Point(to.normalized()) : to);
    if (view && worth(*view) > value) {
      value = worth(*view);
      at = view->point;
      best = std::move(view);
      step *= 1.6;
    } else {
      step *= 0.92;
    }
  }
  if (!best) return i;
  views_.push_back(std::move(*best));
  return static_cast<int>(views_.size()) - 1;
}

int Candidates::look_at(const PatchSide& side, const Point& place,
                        const std::function<bool(const SeenParts&)>& passes) {
  std::normal_distribution<double> normal;
  const Eigen::Vector3d n = side.normal.normalized();
  const auto turned = [&](double by) {
    return Eigen::Vector3d(n +
                           by * Point(normal(random_), normal(random_), normal(random_)));
  };
  constexpr int kTries = 24;
  for (int k = 0; k < kTries && !time_is_over(); ++k) {
    Point at;
    if (request_.projection == Projection::Orthographic) {
      at = turned(0.03 + 0.06 * k);
    } else if (request_.bounds && k % 3 == 2) {
      for (int i = 0; i < 3; ++i) {
        at[i] = std::uniform_real_distribution<double>((*request_.bounds)[0][i],
                                                       (*request_.bounds)[1][i])(random_);
      }
    } else {
      at = place + extent_ * std::pow(0.4, k % 12) * turned(0.1 + 0.02 * k);
    }
    std::optional<SeenParts> view = see(at);
    if (!view || !passes(*view)) continue;
    views_.push_back(std::move(*view));
    return static_cast<int>(views_.size()) - 1;
  }
  return -1;
}

}  // namespace sightline::internal
