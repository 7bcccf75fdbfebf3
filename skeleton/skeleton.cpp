#include "skeleton/skeleton.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>

#include "skeleton/eee_skeleton_internal.h"
#include "skeleton/face_pairs_internal.h"
#include "skeleton/line_key_internal.h"
#include "skeleton/node_ends_internal.h"
#include "skeleton/parallel_internal.h"
#include "skeleton/vertex_view_internal.h"

namespace sightline {
namespace {

using Clock = std::chrono::steady_clock;
using internal::EvPart;
using internal::Generators;
using internal::LineHash;
using internal::LineKey;
using internal::NodeEnds;
using internal::VertexView;
using internal::VertexViewer;

// Joins views, one node for each line: VV nodes are found from both ends, degenerate ones
// from every generator.
class Joiner {
 public:
  Joiner(Skeleton& skeleton, NodeEnds& ends) : out_(skeleton), ends_(ends) {}

  void add(const VertexView& view) {
    std::vector<std::uint32_t> number(view.nodes.size());
    for (std::size_t i = 0; i < view.nodes.size(); ++i) {
      number[i] = add_node(view, view.nodes[i], view.grazes[i] != 0);
    }
    for (SkeletonArc arc : view.arcs) {
      for (auto& node : arc.nodes) node = number[node];
      out_.arcs.push_back(arc);
    }
    auto& short_arcs = out_.simplified.arcs;
    short_arcs.insert(short_arcs.end(), view.short_arcs.begin(), view.short_arcs.end());
  }

 private:
  std::uint32_t add_node(const VertexView& view, SkeletonNode node, bool grazes) {
    const std::span<const Generator> generators(view.pool.data() + node.first_generator,
                                                node.generator_count);
    const auto next = static_cast<std::uint32_t>(out_.nodes.size());
    const bool solid = out_.events == EventMode::Solid;
    std::uint32_t known = next;
    if (node.kind == NodeKind::FvE) {
      const LineKey key = internal::face_line_key(solid && node.end, generators);
      known = face_lines_.try_emplace(key, next).first->second;
    } else if (node.kind == NodeKind::VV || node.kind == NodeKind::Degenerate) {
      std::vector<Generator> key(generators.begin(), generators.end());
      const std::vector<Generator> reversed(key.rbegin(), key.rend());
      key = std::min(key, reversed);
      if (node.kind == NodeKind::VV) {
        const std::uint64_t pair = (static_cast<std::uint64_t>(key[0].id) << 32) |
                                   static_cast<std::uint32_t>(key[1].id);
        known = (solid && node.end ? end_pairs_ : pairs_)
                    .try_emplace(pair, next)
                    .first->second;
      } else {
        known = lines_.try_emplace(std::move(key), next).first->second;
      }
    }
    if (known != next) {
      ends_.found(known, grazes, node.end, node.ends, generators);
      return known;
    }
    node.first_generator = static_cast<std::uint32_t>(out_.generator_pool.size());
    out_.generator_pool.insert(out_.generator_pool.end(), generators.begin(),
                               generators.end());
    if (node.kind == NodeKind::VV && generators[1] < generators[0]) {
      // One direction, whichever end it was found from.
      std::iter_swap(out_.generator_pool.end() - 2, out_.generator_pool.end() - 1);
      std::swap(node.segment[0], node.segment[1]);
      std::swap(node.ends[0], node.ends[1]);
    }
    out_.nodes.push_back(node);
    ends_.add(grazes);
    return next;
  }

  Skeleton& out_;
  NodeEnds& ends_;
  std::unordered_map<std::uint64_t, std::uint32_t> pairs_, end_pairs_;
  std::map<std::vector<Generator>, std::uint32_t> lines_;
  // FvE: several arcs may end at one line.
  std::unordered_map<LineKey, std::uint32_t, LineHash> face_lines_;
};

void build_ev(const Generators& generators, const SkeletonRequest& request,
              Clock::time_point start, double progress_share, Skeleton& skeleton,
              NodeEnds& ends) {
  const EvPart part = internal::ev_part(generators, request);
  const std::vector<int> stars = internal::asked_stars(generators, part);
  skeleton.vertices_asked = stars.size();
  Joiner joiner(skeleton, ends);
  std::optional<SkeletonLines> lines;
  if (part.by_lines) lines.emplace(generators.scene());
  const SkeletonLines* pieces = lines ? &*lines : nullptr;
  skeleton.stopped_by = internal::for_each_parallel(
      stars.size(), request, start, {0, progress_share}, skeleton.predicates,
      [&] {
        return std::make_unique<VertexViewer>(generators, part, pieces,
                                              request.feature_size);
      },
      [&](VertexViewer& viewer, std::size_t i) { return viewer.view(stars[i]); },
      [&](std::size_t, VertexView&& view) {
        joiner.add(view);
        ++skeleton.vertices_done;
        return skeleton.bytes() < request.budget_bytes;
      });
  skeleton.complete = skeleton.vertices_done == skeleton.vertices_asked;
}

}  // namespace

Skeleton build_ev_skeleton(const Scene& scene, const SkeletonRequest& request) {
  const auto start = Clock::now();
  Skeleton skeleton;
  const StageCounts before = thread_stage_counts();
  const Generators generators(scene, internal::threads_of(request), request.events);
  skeleton.predicates = internal::difference(thread_stage_counts(), before);
  skeleton.events = request.events;
  skeleton.simplified = internal::simplified_by(scene, request.feature_size);
  NodeEnds ends(skeleton);
  build_ev(generators, request, start, 1, skeleton, ends);
  ends.finish();
  return skeleton;
}

Skeleton build_skeleton(const Scene& scene, const SkeletonRequest& request) {
  const auto start = Clock::now();
  Skeleton skeleton;
  const StageCounts before = thread_stage_counts();
  const Generators generators(scene, internal::threads_of(request), request.events);
  skeleton.predicates = internal::difference(thread_stage_counts(), before);
  skeleton.events = request.events;
  skeleton.simplified = internal::simplified_by(scene, request.feature_size);
  const double share = !request.ev ? 0 : request.eee ? 0.3 : request.ff ? 0.9 : 1;
  const double last = request.ff ? (request.ev || request.eee ? 0.9 : 0) : 1;
  NodeEnds ends(skeleton);
  if (request.ev) build_ev(generators, request, start, share, skeleton, ends);
  if (request.eee) {
    internal::add_eee(generators, request, start, {share, last}, skeleton, ends);
  }
  ends.finish();
  if (request.ff)
    internal::add_face_pairs(generators, request, start, {last, 1}, skeleton);
  return skeleton;
}

}  // namespace sightline
