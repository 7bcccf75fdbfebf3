#include "skeleton/skeleton.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>

#include "skeleton/eee_skeleton_internal.h"
#include "skeleton/parallel_internal.h"
#include "skeleton/vertex_view_internal.h"

namespace sightline {
namespace {

using Clock = std::chrono::steady_clock;
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
void build_ev(const Generators& generators, const SkeletonRequest& request,
              Clock::time_point start, double progress_share, Skeleton& skeleton) {
  const std::vector<int> stars = selected_stars(generators, request);
  const Selection selection = selected_ridges(generators, request);
  skeleton.vertices_asked = stars.size();
  Joiner joiner(skeleton);
  internal::for_each_parallel(
      stars.size(), request, start, {0, progress_share}, skeleton.predicates,
      [&] { return std::make_unique<VertexViewer>(generators, selection); },
      [&](VertexViewer& viewer, std::size_t i) { return viewer.view(stars[i]); },
      [&](std::size_t, VertexView&& view) {
        joiner.add(view);
        ++skeleton.vertices_done;
      });
  skeleton.complete = skeleton.vertices_done == skeleton.vertices_asked;
}

}  // namespace

Skeleton build_ev_skeleton(const Scene& scene, const SkeletonRequest& request) {
  const auto start = Clock::now();
  Skeleton skeleton;
  const StageCounts before = thread_stage_counts();
  const Generators generators(scene, internal::threads_of(request));
  skeleton.predicates = internal::difference(thread_stage_counts(), before);
  build_ev(generators, request, start, 1, skeleton);
  return skeleton;
}

Skeleton build_skeleton(const Scene& scene, const SkeletonRequest& request) {
  const auto start = Clock::now();
  Skeleton skeleton;
  const StageCounts before = thread_stage_counts();
  const Generators generators(scene, internal::threads_of(request));
  skeleton.predicates = internal::difference(thread_stage_counts(), before);
  const double share = !request.ev ? 0 : request.eee ? 0.3 : 1;
  if (request.ev) build_ev(generators, request, start, share, skeleton);
  if (request.eee) internal::add_eee(generators, request, start, {share, 1}, skeleton);
  return skeleton;
}

}  // namespace sightline
