#include "skeleton/ev_skeleton.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <unordered_map>

#include "skeleton/degenerate_pair_internal.h"
#include "skeleton/vertex_view_internal.h"

namespace sightline {
namespace {

using internal::Generators;
using internal::Selection;
using internal::VertexView;
using internal::VertexViewer;

bool in_box(const std::array<Point, 2>& box, const Point& p) {
  return (p.array() >= box[0].array()).all() && (p.array() <= box[1].array()).all();
}

// Stars whose views are asked for, in order of point id.
std::vector<int> selected_stars(const Generators& g, const SkeletonRequest& request) {
  std::vector<int> stars;
  for (std::size_t i = 0; i < g.stars().size(); ++i) {
    const int p = g.stars()[i].point;
    if (request.region && !in_box(*request.region, g.scene().point(p))) continue;
    if (!request.vertex_objects.empty()) {
      const auto here = g.objects_at(p);
      const auto& wanted = request.vertex_objects;
      const bool asked = std::any_of(here.begin(), here.end(), [&](int o) {
        return std::find(wanted.begin(), wanted.end(), o) != wanted.end();
      });
      if (!asked) continue;
    }
    stars.push_back(static_cast<int>(i));
  }
  return stars;
}

Selection selected_ridges(const Generators& g, const SkeletonRequest& request) {
  Selection selection;
  if (request.edge_objects.empty() && !request.region) return selection;
  const Scene& scene = g.scene();
  for (const auto& ridge : g.ridges()) {
    const auto& wanted = request.edge_objects;
    bool asked = wanted.empty() ||
                 std::any_of(ridge.objects.begin(), ridge.objects.end(), [&](int o) {
                   return std::find(wanted.begin(), wanted.end(), o) != wanted.end();
                 });
    if (request.region) {
      asked = asked && in_box(*request.region, scene.point(ridge.points[0])) &&
              in_box(*request.region, scene.point(ridge.points[1]));
    }
    selection.ridges.push_back(asked);
  }
  return selection;
}

StageCounts operator-(const StageCounts& a, const StageCounts& b) {
  return {a.by_double - b.by_double, a.by_interval - b.by_interval,
          a.by_exact - b.by_exact};
}

// Joins views, one node for each line: VV nodes are found from both ends, degenerate ones
// from every generator.
class Joiner {
 public:
  explicit Joiner(Skeleton& skeleton) : out_(skeleton) {}

  void add(const VertexView& view) {
    std::vector<std::uint32_t> number(view.nodes.size());
    for (std::size_t i = 0; i < view.nodes.size(); ++i) {
      number[i] = add_node(view, view.nodes[i]);
    }
    for (SkeletonArc arc : view.arcs) {
      for (auto& node : arc.nodes) node = number[node];
      out_.arcs.push_back(arc);
    }
  }

 private:
  std::uint32_t add_node(const VertexView& view, SkeletonNode node) {
    const std::span<const Generator> generators(view.pool.data() + node.first_generator,
                                                node.generator_count);
    const auto next = static_cast<std::uint32_t>(out_.nodes.size());
    if (node.kind == NodeKind::VV || node.kind == NodeKind::Degenerate) {
      std::vector<Generator> key(generators.begin(), generators.end());
      const std::vector<Generator> reversed(key.rbegin(), key.rend());
      key = std::min(key, reversed);
      if (node.kind == NodeKind::VV) {
        const std::uint64_t pair = (static_cast<std::uint64_t>(key[0].id) << 32) |
                                   static_cast<std::uint32_t>(key[1].id);
        auto& known = node.end ? ends_ : pairs_;
        const auto [at, fresh] = known.try_emplace(pair, next);
        if (!fresh) return at->second;
      } else {
        const auto [at, fresh] = lines_.try_emplace(std::move(key), next);
        if (!fresh) {
          // Found again from another contact: that the line ends at one of them counts.
          out_.nodes[at->second].end |= node.end;
          return at->second;
        }
      }
    }
    node.first_generator = static_cast<std::uint32_t>(out_.generator_pool.size());
    out_.generator_pool.insert(out_.generator_pool.end(), generators.begin(),
                               generators.end());
    out_.nodes.push_back(node);
    return next;
  }

  Skeleton& out_;
  std::unordered_map<std::uint64_t, std::uint32_t> pairs_, ends_;
  std::map<std::vector<Generator>, std::uint32_t> lines_;
};

}  // namespace

Skeleton build_ev_skeleton(const Scene& scene, const SkeletonRequest& request) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const int threads = request.threads > 0
                          ? request.threads
                          : static_cast<int>(std::thread::hardware_concurrency());
  Skeleton skeleton;
  const StageCounts before = thread_stage_counts();
  const Generators generators(scene, threads);
  const StageCounts prepared = thread_stage_counts() - before;
  const std::vector<int> stars = selected_stars(generators, request);
  const Selection selection = selected_ridges(generators, request);
  skeleton.vertices_asked = stars.size();

  std::vector<std::optional<VertexView>> views(stars.size());
  std::atomic<bool> stopped{false};
  std::atomic<std::size_t> done{0};
  std::mutex progress_mutex;
  std::mutex count_mutex;
  StageCounts counts = prepared;

  oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  oneapi::tbb::task_arena arena(threads);
  oneapi::tbb::enumerable_thread_specific<std::unique_ptr<VertexViewer>> viewers;
  arena.execute([&] {
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::size_t>(0, stars.size(), 8),
        [&](const auto& range) {
          const PrecisionScope scope(request.precision);
          const StageCounts at_first = thread_stage_counts();
          auto& viewer = viewers.local();
          if (!viewer) viewer = std::make_unique<VertexViewer>(generators, selection);
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            if (stopped.load(std::memory_order_relaxed)) break;
            const std::chrono::duration<double> elapsed = Clock::now() - start;
            if (request.stop.stop_requested() ||
                elapsed.count() > request.budget_seconds) {
              stopped = true;
              break;
            }
            views[i] = viewer->view(stars[i]);
            ++done;
          }
          if (request.progress) {
            const std::lock_guard lock(progress_mutex);
            request.progress(static_cast<double>(done.load()) /
                             static_cast<double>(std::max<std::size_t>(1, stars.size())));
          }
          const StageCounts used = thread_stage_counts() - at_first;
          const std::lock_guard lock(count_mutex);
          counts.by_double += used.by_double;
          counts.by_interval += used.by_interval;
          counts.by_exact += used.by_exact;
        });
  });
  Joiner joiner(skeleton);
  for (auto& view : views) {
    if (!view) continue;
    joiner.add(*view);
    view.reset();
    ++skeleton.vertices_done;
  }
  skeleton.complete = skeleton.vertices_done == skeleton.vertices_asked;
  skeleton.predicates = counts;
  return skeleton;
}

}  // namespace sightline
