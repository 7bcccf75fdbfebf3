#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "skeleton/edge_pair_internal.h"
#include "skeleton/eee_skeleton_internal.h"
#include "skeleton/parallel_internal.h"
#include "skeleton/skeleton_lines.h"

namespace sightline::internal {
namespace {

// What tells a node of general position from all others: its kind, which generator is a
// face, which of two lines, and the generators' ids.
struct LineKey {
  std::array<std::int32_t, 4> ids;
  std::uint32_t tag;
  friend bool operator==(const LineKey&, const LineKey&) = default;
};

LineKey key_of(NodeKind kind, bool second, std::span<const Generator> generators) {
  LineKey key{{-1, -1, -1, -1}, static_cast<std::uint32_t>(kind) | (second ? 256u : 0u)};
  if (kind == NodeKind::FvE) {  // told from its vertex or from its edge
    for (const Generator& x : generators) key.ids[static_cast<int>(x.kind)] = x.id;
    return key;
  }
  for (std::size_t i = 0; i < generators.size() && i < 4; ++i) {
    key.ids[i] = generators[i].id;
    if (generators[i].kind == GeneratorKind::Face) key.tag |= 1024u << i;
  }
  return key;
}

struct LineHash {
  std::size_t operator()(const LineKey& k) const {
    std::uint64_t h = k.tag;
    for (const std::int32_t id : k.ids) {
      h = (h ^ static_cast<std::uint32_t>(id)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
    return h;
  }
};

// One node for each line, also for those that the EV part has found.
class LineJoiner {
 public:
  explicit LineJoiner(Skeleton& skeleton) : out_(skeleton) {
    for (std::uint32_t i = 0; i < out_.nodes.size(); ++i) {
      const SkeletonNode& node = out_.nodes[i];
      if (node.kind == NodeKind::Degenerate) {
        const auto generators = out_.generators(node);
        degenerate_.try_emplace({{generators.begin(), generators.end()}, node.second}, i);
      }
      if (node.kind != NodeKind::VEE && node.kind != NodeKind::EVE &&
          node.kind != NodeKind::FvE) {
        continue;
      }
      known_.try_emplace(key_of(node.kind, false, out_.generators(node)), i);
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
    if (found.kind == NodeKind::Degenerate) return add_degenerate(found);
    const std::span<const Generator> generators =
        found.all.empty()
            ? std::span<const Generator>(found.generators.data(), found.count)
            : std::span<const Generator>(found.all);
    // Both arcs that end at an EEEE are found between the same outer edges.
    auto& nodes = found.kind == NodeKind::EEEE ? local_ : known_;
    const auto [at, fresh] =
        nodes.try_emplace(key_of(found.kind, found.rising, generators),
                          static_cast<std::uint32_t>(out_.nodes.size()));
    if (fresh) append(found, generators);
    return at->second;
  }

  std::uint32_t add_degenerate(const FoundNode& found) {
    const auto [at, fresh] = degenerate_.try_emplace(
        {found.all, found.rising}, static_cast<std::uint32_t>(out_.nodes.size()));
    if (fresh) append(found, found.all);
    out_.nodes[at->second].end |= found.end;
    return at->second;
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
  }

  Skeleton& out_;
  std::unordered_map<LineKey, std::uint32_t, LineHash> known_, local_;
  // By all generators, and which of two lines.
  std::map<std::pair<std::vector<Generator>, bool>, std::uint32_t> degenerate_;
};

// Without the arcs that neither have an edge on the source nor lines that end there.
void drop_arcs_off_source(const Generators& g, const EeePart& part,
                          const SkeletonLines& lines, std::vector<FoundArc>& arcs) {
  const auto on_source = [&](const std::vector<int>& faces) {
    return std::any_of(faces.begin(), faces.end(),
                       [&](int f) { return part.source_faces[f] != 0; });
  };
  std::erase_if(arcs, [&](const FoundArc& found) {
    const auto& edges = found.arc.edges;
    if (std::any_of(edges.begin(), edges.end(),
                    [&](int e) { return part.goes_through(g.ridge_of_edge(e)); })) {
      return false;
    }
    const auto pieces = lines.ends(found.arc);
    return std::none_of(pieces.begin(), pieces.end(), [&](const auto& piece) {
      return on_source(piece.faces[0]) || on_source(piece.faces[1]);
    });
  });
}

}  // namespace

void add_eee(const Generators& generators, const SkeletonRequest& request,
             std::chrono::steady_clock::time_point start, std::array<double, 2> progress,
             Skeleton& skeleton) {
  const EeePart part = eee_part(generators, request);
  const std::vector<int> firsts = asked_ridges(generators, part);
  skeleton.edges_asked = firsts.size();
  if (firsts.empty() || skeleton.stopped_by != StoppedBy::Nothing) {
    skeleton.complete = skeleton.complete && firsts.empty();
    return;
  }
  const Carriers carriers(generators);
  LineJoiner joiner(skeleton);
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
