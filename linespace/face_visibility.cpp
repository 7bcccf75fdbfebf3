#include "linespace/face_visibility.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>

#include "linespace/occluder_source_internal.h"
#include "linespace/polygon_visibility_internal.h"
#include "linespace/scene_internal.h"

namespace sightline {
namespace {

std::vector<Polygon> polygons_of(const Scene& scene) {
  std::vector<Polygon> polygons(scene.faces().size());
  for (std::size_t f = 0; f < polygons.size(); ++f) {
    for (const int p : scene.face_points(static_cast<int>(f))) {
      polygons[f].push_back(scene.point(p));
    }
  }
  return polygons;
}

}  // namespace

using namespace internal;

struct FaceVisibility::Impl {
  const Scene& scene;
  OccluderSet faces;

  explicit Impl(const Scene& s) : scene(s), faces(polygons_of(s)) {}

  void check(int face) const {
    if (face < 0 || face >= static_cast<int>(scene.faces().size())) {
      throw InvalidInput("there is no face " + std::to_string(face));
    }
  }
};

namespace {

bool in_one_plane(const Scene& scene, int a, int b) {
  const auto [u, v, w] = plane_points(scene, a);
  return std::ranges::all_of(scene.face_points(b), [&](int p) {
    return orient3d(u, v, w, scene.point(p)) == Sign::Zero;
  });
}

// `recent`: what was found for the last target of the same source is tried first.
FacePairAnswer decide_pair(const Scene& scene, const OccluderSet& faces, int a, int b,
                           std::vector<int>& recent, const VisibilityRequest& request) {
  constexpr std::size_t kRemembered = 64;
  FacePairAnswer pair{a, b, {}, {}};
  if (in_one_plane(scene, a, b)) {
    pair.answer.verdict = Verdict::Hidden;
    return pair;
  }
  OccluderSource source(faces, OccluderSource::Numbers::AsFound, [&](int face) {
    return face == a || face == b || in_one_plane(scene, a, face) ||
           in_one_plane(scene, b, face);
  });
  pair.answer = decide(fan(faces[a]), fan(faces[b]), {source, recent, {}}, request);
  pair.occluders = source.found();
  recent = pair.occluders;
  if (recent.size() > kRemembered)
    recent.erase(recent.begin(), recent.end() - kRemembered);
  return pair;
}

}  // namespace

FaceVisibility::FaceVisibility(const Scene& scene)
    : impl_(std::make_unique<Impl>(scene)) {}
FaceVisibility::~FaceVisibility() = default;
FaceVisibility::FaceVisibility(FaceVisibility&&) noexcept = default;

FacePairAnswer FaceVisibility::between(int a, int b,
                                       const VisibilityRequest& request) const {
  impl_->check(a);
  impl_->check(b);
  const PrecisionScope precision(request.precision);
  std::vector<int> recent;
  return decide_pair(impl_->scene, impl_->faces, a, b, recent, request);
}

// A row of pairs, all those of one face of `as`, is one task, and what was found for one
// pair helps the next.  Rows after the first visible pair are dropped.
GroupAnswer FaceVisibility::between(std::span<const int> as, std::span<const int> bs,
                                    bool all_pairs,
                                    const VisibilityRequest& request) const {
  for (const int a : as) impl_->check(a);
  for (const int b : bs) impl_->check(b);
  const auto started = std::chrono::steady_clock::now();
  GroupAnswer answer;
  std::vector<std::vector<FacePairAnswer>> rows(as.size());
  std::atomic<std::size_t> first_visible = as.size();
  std::atomic<std::size_t> done = 0;
  std::mutex mutex;
  const auto row = [&](std::size_t i) {
    const PrecisionScope precision(request.precision);
    const StageCounts before = thread_stage_counts();
    std::vector<int> recent;
    for (const int b : bs) {
      if (!all_pairs && first_visible < i) break;
      VisibilityRequest left = request;
      left.budget_seconds -=
          std::chrono::duration<double>(std::chrono::steady_clock::now() - started)
              .count();
      FacePairAnswer pair =
          decide_pair(impl_->scene, impl_->faces, as[i], b, recent, left);
      const bool visible = pair.answer.verdict == Verdict::Visible;
      rows[i].push_back(std::move(pair));
      if (visible && !all_pairs) {
        std::size_t known = first_visible;
        while (i < known && !first_visible.compare_exchange_weak(known, i)) {
        }
        break;
      }
    }
    const std::scoped_lock lock(mutex);
    const StageCounts& after = thread_stage_counts();
    answer.predicates.by_double += after.by_double - before.by_double;
    answer.predicates.by_interval += after.by_interval - before.by_interval;
    answer.predicates.by_exact += after.by_exact - before.by_exact;
    ++done;
    if (request.progress) {
      request.progress("pairs of faces",
                       static_cast<double>(done) / static_cast<double>(as.size()));
    }
  };
  tbb::task_arena arena(request.threads > 0 ? request.threads
                                            : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, as.size(), row, tbb::simple_partitioner());
  });
  // Rows behind the first visible one were dropped or not, as it happened.
  if (!all_pairs) rows.resize(std::min(rows.size(), first_visible + 1));
  bool undecided = false;
  for (std::vector<FacePairAnswer>& pairs : rows) {
    for (FacePairAnswer& pair : pairs) {
      answer.cost += pair.answer.cost;
      if (pair.answer.verdict == Verdict::Visible && !answer.visible) {
        answer.visible = pair;
      }
      answer.pairs_hidden += pair.answer.verdict == Verdict::Hidden;
      answer.pairs_undecided += pair.answer.verdict == Verdict::Undecided;
      undecided |= pair.answer.verdict == Verdict::Undecided;
      if (all_pairs) answer.pairs.push_back(std::move(pair));
    }
  }
  answer.verdict = answer.visible ? Verdict::Visible
                   : undecided    ? Verdict::Undecided
                                  : Verdict::Hidden;
  return answer;
}

VisibilityQuestion FaceVisibility::question_of(const FacePairAnswer& pair) const {
  VisibilityQuestion question{impl_->faces[pair.a], impl_->faces[pair.b], {}};
  for (const int face : pair.occluders) {
    question.occluders.push_back(impl_->faces[face]);
  }
  return question;
}

}  // namespace sightline
