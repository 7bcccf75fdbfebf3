#include "shadows/seen/seen_part.h"

#include <algorithm>
#include <map>

#include "linespace/view/piece_joiner.h"

namespace sightline::internal {

SeenPart seen_part(const SourceView& view) {
  JoinedPieces joined = join_ends(view.eye(), view.pieces(), Doubles::Keep);
  SeenPart part;
  part.points = std::move(joined.points);
  std::map<std::array<int, 2>, std::vector<JoinedEdge>> doubles;
  for (const JoinedEdge& e : joined.edges) {
    const bool seen_on_left = !view.pieces()[e.piece].left.blocked;
    doubles[seen_on_left ? e.ends : std::array{e.ends[1], e.ends[0]}].push_back(e);
  }
  for (auto& [ends, edges] : doubles) {
    const auto carries = [&](const JoinedEdge& e) { return view.only_carries(e.piece); };
    if (!std::ranges::all_of(edges, carries)) std::erase_if(edges, carries);
    std::ranges::sort(edges, {}, &JoinedEdge::line);
    SeenPart::Edge edge{ends[0], ends[1], {}, {}, edges.front().ends == ends};
    for (const JoinedEdge& e : edges) {
      edge.lines.push_back(e.line);
      edge.pieces.push_back(e.piece);
    }
    part.edges.push_back(std::move(edge));
  }
  return part;
}

}  // namespace sightline::internal
