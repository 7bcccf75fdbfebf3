#include "skeleton/build/eee_skeleton.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "linespace/work/large_arrays.h"
#include "linespace/work/parallel.h"
#include "skeleton/build/edge_pair.h"
#include "skeleton/request.h"
#include "skeleton/skeleton_lines.h"

namespace sightline::internal {
namespace {

std::span<const Generator> generators_of(const FoundNode& found) {
  if (!found.all.empty()) return found.all;
  return {found.generators.data(), found.count};
}

std::uint32_t join(const FoundNode& found, NodeJoiner& nodes) {
  SkeletonNode node;
  node.kind = found.kind;
  node.self = found.self;
  node.end = found.end || found.ends[0] || found.ends[1];
  node.ends = found.ends;
  node.second = found.rising;
  node.segment = found.segment;
  if (node.kind == NodeKind::EEEE && !found.elsewhere)
    return nodes.join_eeee(node, generators_of(found), found.grazes);
  return nodes.join(node, generators_of(found), found.grazes, found.line);
}

// All arcs of one first edge.
void add_arcs(std::vector<FoundArc>& arcs, NodeJoiner& nodes, Skeleton& out) {
  // Both arcs that end at such an EEEE are found between the same outer edges.
  nodes.forget_eeee();
  const auto end = [&](std::size_t i) -> const FoundNode& {
    return arcs[i / 2].ends[i % 2];
  };
  nodes.join_each(
      2 * arcs.size(),
      [&](std::size_t i) { return std::pair(end(i).kind, generators_of(end(i))); },
      [&](std::size_t i) { arcs[i / 2].arc.nodes[i % 2] = join(end(i), nodes); });
  make_room(out.arcs, arcs.size());
  for (const FoundArc& found : arcs) out.arcs.push_back(found.arc);
}

// Without the arcs that neither have an edge on the source nor lines that end there.
void drop_arcs_off_source(const Silhouettes& g, const EeePart& part,
                          const SkeletonLines& lines, std::vector<FoundArc>& arcs) {
  std::erase_if(arcs, [&](const FoundArc& found) {
    const auto& edges = found.arc.edges();
    if (std::any_of(edges.begin(), edges.end(),
                    [&](int e) { return part.goes_through(g.ridge_of_edge(e)); })) {
      return false;
    }
    return !any_ends_on(lines.ends(found.arc), part.source_faces);
  });
}

}  // namespace

void add_eee(const Silhouettes& silhouettes, const SkeletonRequest& request,
             const Deadline& deadline, Skeleton& skeleton, NodeJoiner& nodes) {
  const EeePart part = eee_part(silhouettes, request);
  const std::vector<int> firsts = asked_ridges(silhouettes, part);
  skeleton.edges_asked = firsts.size();
  if (firsts.empty() || skeleton.stopped_by != StoppedBy::Nothing) {
    skeleton.complete = skeleton.complete && firsts.empty();
    return;
  }
  const Stage stage(request, "EEE arcs", deadline);
  const Carriers carriers(silhouettes);
  std::optional<SkeletonLines> lines;
  if (part.by_lines) lines.emplace(silhouettes.scene(), deadline.what_is_left(request));
  skeleton.stopped_by = for_each_parallel(
      firsts.size(), request, deadline, "EEE arcs", skeleton.predicates,
      [&] { return std::make_unique<EdgePairs>(silhouettes, carriers, part); },
      [&](EdgePairs& pairs, std::size_t i) {
        std::vector<FoundArc> arcs;
        pairs.visit(
            firsts[i], [&] { return deadline.passed(); }, arcs);
        if (lines) drop_arcs_off_source(silhouettes, part, *lines, arcs);
        std::sort(arcs.begin(), arcs.end(), [](const FoundArc& a, const FoundArc& b) {
          return std::pair(a.arc.generators, a.arc.range) <
                 std::pair(b.arc.generators, b.arc.range);
        });
        return arcs;
      },
      [&](std::size_t, std::vector<FoundArc>&& arcs) {
        add_arcs(arcs, nodes, skeleton);
        ++skeleton.edges_done;
        return skeleton.bytes() < request.budget_bytes;
      });
  skeleton.complete = skeleton.complete && skeleton.edges_done == skeleton.edges_asked;
}

}  // namespace sightline::internal
