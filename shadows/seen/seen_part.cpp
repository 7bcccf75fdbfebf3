#include "shadows/seen/seen_part.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "linespace/picture/turning.h"
#include "linespace/view/piece_joiner.h"
#include "shadows/seen/plane_frame.h"

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
    SeenPart::Edge edge{ends[0], ends[1], {}, edges.front().ends == ends};
    for (const JoinedEdge& e : edges) edge.lines.push_back(e.line);
    part.edges.push_back(std::move(edge));
  }
  return part;
}

std::vector<std::vector<int>> boundary_walks(const EyeSpace& eye, const SeenPart& part) {
  const auto n = static_cast<int>(part.edges.size());
  std::vector<std::vector<int>> leaving(
      part.points.size());  // half-edges, as in ViewGraph
  for (int e = 0; e < n; ++e) {
    leaving[part.edges[e].from].push_back(2 * e);
    leaving[part.edges[e].to].push_back(2 * e + 1);
  }
  // From an edge that arrives, against half-edge 2 e + 1, one goes on along the next
  // half-edge clockwise.
  std::vector<int> next(part.edges.size(), -1);
  for (std::size_t p = 0; p < leaving.size(); ++p) {
    const auto& around = leaving[p];
    std::vector<std::size_t> order(around.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (around.size() > 2) {
      std::vector<PicturePoint> far;
      std::vector<int> lines;
      for (const int h : around) {
        const SeenPart::Edge& edge = part.edges[h / 2];
        const bool to_second = (h % 2 == 0) == edge.forward;
        lines.push_back(edge.lines.front());
        far.emplace_back(eye, eye.scene().lines()[lines.back()].ends[to_second ? 1 : 0]);
      }
      order = order_around(part.points[p], far, lines);
    }
    const std::size_t k = order.size();
    for (std::size_t i = 0; i < k; ++i) {
      const int arriving = around[order[i]];
      if (arriving % 2 == 1) next[arriving / 2] = around[order[(i + k - 1) % k]] / 2;
    }
  }
  std::vector<std::vector<int>> walks;
  std::vector<bool> walked(part.edges.size(), false);
  for (int e = 0; e < n; ++e) {
    if (walked[e]) continue;
    auto& walk = walks.emplace_back();
    for (int x = e; x >= 0 && !walked[x]; x = next[x]) {
      walked[x] = true;
      walk.push_back(x);
    }
  }
  return walks;
}

namespace {

class Namer {
 public:
  Namer(const SourceScene& source, const SourcePlane& plane, const SourceView& view)
      : source_(&source), view_(&view) {
    for (std::size_t i = 0; i < plane.sides.size(); ++i) {
      for (const SourcePlane::Side& side : plane.sides[i])
        source_sides_[side.line] = {side.name, plane.source_face[i]};
    }
  }

  [[nodiscard]] SeenSide name(int line) const {
    if (line == view_->horizon_line()) return {SeenSide::Kind::Horizon, 0};
    if (line >= view_->first_cut_line()) {
      const int face = view_->cut_face(line - view_->first_cut_line());
      return {SeenSide::Kind::Cut, source_->scene().scene().faces()[face].facet};
    }
    if (const auto it = source_sides_.find(line); it != source_sides_.end())
      return {SeenSide::Kind::Source, it->second[0]};
    return {SeenSide::Kind::Edge, source_->scene().whole_line(line)};
  }

  /// The whole line lies in the plane of the horizon, which has no line of its own where
  /// it only touches the source.
  [[nodiscard]] bool along_touching_horizon(int line) const {
    const Horizon* horizon = view_->horizon();
    if (horizon == nullptr || view_->horizon_line() >= 0) return false;
    const ViewScene& scene = view_->eye().scene();
    return std::ranges::all_of(scene.lines()[line].ends, [&](int p) {
      return horizon->height(scene.exact(p)) == 0;
    });
  }

  /// The source face that has the line as a side; -1 where none has.
  [[nodiscard]] int source_face(int line) const {
    const auto it = source_sides_.find(line);
    return it == source_sides_.end() ? -1 : it->second[1];
  }

 private:
  const SourceScene* source_;
  const SourceView* view_;
  std::map<int, std::array<int, 2>> source_sides_;  // name, source face
};

// The rotation of a cyclic list that is the smallest.
template <class T>
std::size_t least_rotation(const std::vector<T>& cycle) {
  std::size_t best = 0;
  const std::size_t n = cycle.size();
  for (std::size_t start = 1; start < n; ++start) {
    for (std::size_t i = 0; i < n; ++i) {
      const T &x = cycle[(start + i) % n], &y = cycle[(best + i) % n];
      if (x == y) continue;
      if (x < y) best = start;
      break;
    }
  }
  return best;
}

// The source face on which a walk of the part's edges lies.
int source_face_at(const SourcePlane& plane, const EyeSpace& eye, const SeenPart& part,
                   const std::vector<int>& walk) {
  const auto& faces = plane.source_face;
  for (const int e : walk) {
    for (std::size_t i = 0; i < faces.size(); ++i) {
      for (const SourcePlane::Side& side : plane.sides[i]) {
        if (std::ranges::binary_search(part.edges[e].lines, side.line)) return faces[i];
      }
    }
  }
  const PicturePoint& p = part.points[part.edges[walk.front()].from];
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const bool inside =
        std::ranges::all_of(plane.sides[i], [&](const SourcePlane::Side& side) {
          return orient(PicturePoint(eye, side.ends[0]), PicturePoint(eye, side.ends[1]),
                        p) != Sign::Negative;
        });
    if (inside) return faces[i];
  }
  return faces.front();
}

}  // namespace

std::vector<SeenBoundary> seen_boundaries(const SourceScene& source,
                                          const SourcePlane& plane,
                                          const SourceView& view, const SeenPart& part) {
  const Namer namer(source, plane, view);
  const PlaneFrame frame(source, plane, view.eye());
  std::vector<SeenBoundary> boundaries;
  for (const auto& walk : boundary_walks(view.eye(), part)) {
    std::vector<std::vector<SeenSide>> sides;
    std::vector<Point> corners;
    for (const int e : walk) {
      std::vector<SeenSide> names;
      for (const int line : part.edges[e].lines) names.push_back(namer.name(line));
      if (namer.along_touching_horizon(part.edges[e].lines.front()))
        names.push_back({SeenSide::Kind::Horizon, 0});
      std::ranges::sort(names);
      names.erase(std::ranges::unique(names).begin(), names.end());
      // A side that goes on straight is one.
      if (!sides.empty() && sides.back() == names) continue;
      sides.push_back(std::move(names));
      corners.push_back(frame.on_plane(part.points[part.edges[e].from]));
    }
    if (sides.size() > 1 && sides.front() == sides.back()) {
      sides.erase(sides.begin());
      corners.erase(corners.begin());
    }
    const auto first = static_cast<std::ptrdiff_t>(least_rotation(sides));
    std::ranges::rotate(sides, sides.begin() + first);
    std::ranges::rotate(corners, corners.begin() + first);
    boundaries.push_back({source_face_at(plane, view.eye(), part, walk), std::move(sides),
                          std::move(corners)});
  }
  std::ranges::sort(boundaries, [](const SeenBoundary& x, const SeenBoundary& y) {
    return std::tie(x.source_face, x.sides) < std::tie(y.source_face, y.sides);
  });
  return boundaries;
}

}  // namespace sightline::internal
