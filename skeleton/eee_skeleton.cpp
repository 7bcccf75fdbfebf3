#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "skeleton/edge_pair_internal.h"
#include "skeleton/eee_skeleton_internal.h"
#include "skeleton/line_key_internal.h"
#include "skeleton/parallel_internal.h"
#include "skeleton/skeleton_lines.h"

namespace sightline::internal {
namespace {

// One node for each line, also for those that the EV part has found.
class LineJoiner {
 public:
  LineJoiner(Skeleton& skeleton, NodeEnds& ends)
      : out_(skeleton), ends_(ends), solid_(skeleton.events == EventMode::Solid) {
    for (std::uint32_t i = 0; i < out_.nodes.size(); ++i) {
      const SkeletonNode& node = out_.nodes[i];
      if (node.kind == NodeKind::Degenerate) {
        const auto generators = out_.generators(node);
        degenerate_.try_emplace({{generators.begin(), generators.end()}, node.second}, i);
      }
      const auto generators = out_.generators(node);
      if (node.kind == NodeKind::FvE) {
        known_.try_emplace(face_line_key(solid_ && node.end, generators), i);
      } else if (node.kind == NodeKind::VEE || node.kind == NodeKind::EVE) {
        known_.try_emplace(line_key(node.kind, false, generators), i);
      }
    }
  }

  /// All arcs of one first edge.
  void add(std::vector<FoundArc>& arcs) {
    local_.clear();
    for (FoundArc& found : arcs) {
      for (int k = 0; k < 2; ++k) found.arc.nodes[k] = add_node(found.ends[k]);
      out_.eee_arcs.push_back(found.arc);
    }
  }

 private:
  std::uint32_t add_node(const FoundNode& found) {
    const std::span<const Generator> generators =
        found.all.empty()
            ? std::span<const Generator>(found.generators.data(), found.count)
            : std::span<const Generator>(found.all);
    const auto next = static_cast<std::uint32_t>(out_.nodes.size());
    const bool end = found.end || found.ends[0] || found.ends[1];
    const std::uint32_t node = numbered(found, generators, end, next);
    if (node == next) {
      append(found, generators);
    } else {
      ends_.found(node, found.grazes, end, found.ends, generators);
    }
    return node;
  }

  // The number under which the node is known, or becomes known.
  std::uint32_t numbered(const FoundNode& found, std::span<const Generator> generators,
                         bool end, std::uint32_t next) {
    if (found.kind == NodeKind::Degenerate) {
      return degenerate_.try_emplace({found.all, found.rising}, next).first->second;
    }
    // Both arcs that end at an EEEE are found between the same outer edges.
    auto& nodes = found.kind == NodeKind::EEEE ? local_ : known_;
    const LineKey key = found.kind == NodeKind::FvE
                            ? face_line_key(solid_ && end, generators)
                            : line_key(found.kind, found.rising, generators);
    return nodes.try_emplace(key, next).first->second;
  }

  void append(const FoundNode& found, std::span<const Generator> generators) {
    SkeletonNode node;
    node.kind = found.kind;
    node.self = found.self;
    node.end = found.end || found.ends[0] || found.ends[1];
    node.ends = found.ends;
    node.second = found.rising;
    node.first_generator = static_cast<std::uint32_t>(out_.generator_pool.size());
    node.generator_count = static_cast<std::uint32_t>(generators.size());
    node.segment = found.segment;
    out_.generator_pool.insert(out_.generator_pool.end(), generators.begin(),
                               generators.end());
    out_.nodes.push_back(node);
    ends_.add(found.grazes);
  }

  Skeleton& out_;
  NodeEnds& ends_;
  bool solid_;
  std::unordered_map<LineKey, std::uint32_t, LineHash> known_, local_;
  // By all generators, and which of two lines.
  std::map<std::pair<std::vector<Generator>, bool>, std::uint32_t> degenerate_;
};

// Without the arcs that neither have an edge on the source nor lines that end there.
void drop_arcs_off_source(const Generators& g, const EeePart& part,
                          const SkeletonLines& lines, std::vector<FoundArc>& arcs) {
  std::erase_if(arcs, [&](const FoundArc& found) {
    const auto& edges = found.arc.edges;
    if (std::any_of(edges.begin(), edges.end(),
                    [&](int e) { return part.goes_through(g.ridge_of_edge(e)); })) {
      return false;
    }
    return !any_ends_on(lines.ends(found.arc), part.source_faces);
  });
}

}  // namespace

void add_eee(const Generators& generators, const SkeletonRequest& request,
             std::chrono::steady_clock::time_point start, std::array<double, 2> progress,
             Skeleton& skeleton, NodeEnds& ends) {
  const EeePart part = eee_part(generators, request);
  const std::vector<int> firsts = asked_ridges(generators, part);
  skeleton.edges_asked = firsts.size();
  if (firsts.empty() || skeleton.stopped_by != StoppedBy::Nothing) {
    skeleton.complete = skeleton.complete && firsts.empty();
    return;
  }
  const Carriers carriers(generators);
  LineJoiner joiner(skeleton, ends);
  std::optional<SkeletonLines> lines;
  if (part.by_lines) lines.emplace(generators.scene());
  skeleton.stopped_by = for_each_parallel(
      firsts.size(), request, start, progress, skeleton.predicates,
      [&] { return std::make_unique<EdgePairs>(generators, carriers, part); },
      [&](EdgePairs& pairs, std::size_t i) {
        std::vector<FoundArc> arcs;
        pairs.visit(
            firsts[i], [&] { return must_stop(request, start); }, arcs);
        if (lines) drop_arcs_off_source(generators, part, *lines, arcs);
        std::sort(arcs.begin(), arcs.end(), [](const FoundArc& a, const FoundArc& b) {
          return std::pair(a.arc.edges, a.arc.range) <
                 std::pair(b.arc.edges, b.arc.range);
        });
        return arcs;
      },
      [&](std::size_t, std::vector<FoundArc>&& arcs) {
        joiner.add(arcs);
        ++skeleton.edges_done;
        return skeleton.bytes() < request.budget_bytes;
      });
  skeleton.complete = skeleton.complete && skeleton.edges_done == skeleton.edges_asked;
}

}  // namespace sightline::internal
