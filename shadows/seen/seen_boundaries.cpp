#include "shadows/seen/seen_boundaries.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "linespace/picture/turning.h"
#include "shadows/seen/plane_frame.h"

namespace sightline::internal {
namespace {

// The edge that follows each edge around the part seen.
std::vector<int> next_edges(const EyeSpace& eye, const SeenPart& part) {
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
  return next;
}

class Namer {
 public:
  Namer(const SourceScene& source, const SourcePlane& plane, const SourceView& view)
      : source_(&source), view_(&view) {
    for (std::size_t i = 0; i < plane.sides.size(); ++i) {
      for (const SourcePlane::Side& side : plane.sides[i])
        source_sides_[side.line] = &side;
    }
  }

  /// Of one or more lines that are seen in one; ascending.  Of a diagonal of a bent
  /// polygon only where there is nothing else.
  [[nodiscard]] std::vector<SeenSide> names(const std::vector<int>& lines) const {
    std::vector<SeenSide> names;
    for (const int line : lines) {
      if (lines.size() == 1 || !is_diagonal(line)) names.push_back(name(line));
    }
    if (names.empty()) names.push_back(name(lines.front()));
    if (along_touching_horizon(lines.front()))
      names.push_back({SeenSide::Kind::Horizon, 0});
    std::ranges::sort(names);
    names.erase(std::ranges::unique(names).begin(), names.end());
    return names;
  }

 private:
  // The whole line lies in the plane of the horizon, which has no line of its own where
  // it only touches the source.
  [[nodiscard]] bool along_touching_horizon(int line) const {
    const Horizon* horizon = view_->horizon();
    if (horizon == nullptr || view_->horizon_line() >= 0) return false;
    const ViewScene& scene = view_->eye().scene();
    return std::ranges::all_of(scene.lines()[line].ends, [&](int p) {
      return horizon->height(scene.exact(p)) == 0;
    });
  }
  [[nodiscard]] bool is_diagonal(int line) const {
    const auto it = source_sides_.find(line);
    return it != source_sides_.end() && it->second->twin_line >= 0;
  }
  [[nodiscard]] SeenSide name(int line) const {
    if (line == view_->horizon_line()) return {SeenSide::Kind::Horizon, 0};
    if (line >= view_->first_cut_line()) {
      const int face = view_->cut_face(line - view_->first_cut_line());
      return {SeenSide::Kind::Cut, source_->scene().scene().faces()[face].facet};
    }
    if (const auto it = source_sides_.find(line); it != source_sides_.end())
      return {SeenSide::Kind::Source, it->second->name};
    return {SeenSide::Kind::Edge, source_->scene().whole_line(line)};
  }

  const SourceScene* source_;
  const SourceView* view_;
  std::map<int, const SourcePlane::Side*> source_sides_;  // by line
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

// The boundaries of all planes, as cycles of edges that can be joined.
class Boundaries {
 public:
  explicit Boundaries(std::span<const SeenPlane> planes) : planes_(planes) {
    for (std::size_t k = 0; k < planes.size(); ++k) {
      const SeenPlane& seen = planes[k];
      const auto first = static_cast<int>(next_.size());
      const std::vector<int> next = next_edges(seen.view->eye(), seen.part);
      for (std::size_t e = 0; e < next.size(); ++e) {
        edges_.push_back({static_cast<int>(k), static_cast<int>(e)});
        next_.push_back(first + next[e]);
      }
      first_.push_back(first);
    }
    before_.resize(next_.size());
    for (std::size_t e = 0; e < next_.size(); ++e)
      before_[next_[e]] = static_cast<int>(e);
    joined_.resize(next_.size(), false);
  }

  // What is seen goes on across a diagonal: the two boundaries along it become one.
  void join_diagonals() {
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      for (const SourcePlane::Side& side : planes_[i].plane->sides.front()) {
        if (side.twin_line < side.line) continue;  // none, or done from there
        const auto here = along(i, side.line);
        for (std::size_t j = 0; j < planes_.size(); ++j) {
          const auto there = along(j, side.twin_line);
          // They run against each other.  On an event of the light they may differ.
          if (here.size() != there.size()) continue;
          for (std::size_t k = 0; k < here.size(); ++k)
            join(here[k], there[here.size() - 1 - k]);
        }
      }
    }
  }

  [[nodiscard]] std::vector<std::vector<int>> walks() const {
    std::vector<std::vector<int>> walks;
    std::vector<bool> walked = joined_;
    for (std::size_t e = 0; e < next_.size(); ++e) {
      if (walked[e]) continue;
      auto& walk = walks.emplace_back();
      for (int x = static_cast<int>(e); !walked[x]; x = next_[x]) {
        walked[x] = true;
        walk.push_back(x);
      }
    }
    return walks;
  }

  [[nodiscard]] int plane_of(int edge) const { return edges_[edge].plane; }
  [[nodiscard]] const SeenPart::Edge& at(int edge) const {
    return planes_[plane_of(edge)].part.edges[edges_[edge].number];
  }

  /// On which a walk lies.
  [[nodiscard]] int source_face(const std::vector<int>& walk) const {
    for (const int e : walk) {
      const SourcePlane& plane = *planes_[plane_of(e)].plane;
      for (std::size_t i = 0; i < plane.faces.size(); ++i) {
        for (const SourcePlane::Side& side : plane.sides[i]) {
          if (std::ranges::binary_search(at(e).lines, side.line))
            return plane.source_face[i];
        }
      }
    }
    // A hole in the middle of a face.
    const auto& [plane, view, part] = planes_[plane_of(walk.front())];
    const PicturePoint& p = part.points[at(walk.front()).from];
    for (std::size_t i = 0; i < plane->faces.size(); ++i) {
      const bool inside =
          std::ranges::all_of(plane->sides[i], [&](const SourcePlane::Side& side) {
            return orient(PicturePoint(view->eye(), side.ends[0]),
                          PicturePoint(view->eye(), side.ends[1]), p) != Sign::Negative;
          });
      if (inside) return plane->source_face[i];
    }
    return plane->source_face.front();
  }

 private:
  struct Edge {
    int plane, number;  // of planes_, of its part
  };

  // The edges of a plane along a line, in the line's order.
  [[nodiscard]] std::vector<int> along(int plane, int line) const {
    std::vector<std::array<int, 2>> found;  // piece, edge
    const auto& edges = planes_[plane].part.edges;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto at = std::ranges::lower_bound(edges[e].lines, line);
      if (at == edges[e].lines.end() || *at != line) continue;
      found.push_back({edges[e].pieces[at - edges[e].lines.begin()],
                       first_[plane] + static_cast<int>(e)});
    }
    std::ranges::sort(found);
    std::vector<int> out;
    for (const auto& [piece, edge] : found) out.push_back(edge);
    return out;
  }

  // Takes two edges that run against each other out, and joins their ends.
  void join(int e, int f) {
    joined_[e] = joined_[f] = true;
    const int to_e = before_[e], from_e = next_[e], to_f = before_[f], from_f = next_[f];
    if (from_e == f && from_f == e) return;
    if (from_e == f) return follow(to_e, from_f);
    if (from_f == e) return follow(to_f, from_e);
    follow(to_e, from_f);
    follow(to_f, from_e);
  }
  void follow(int e, int f) {
    next_[e] = f;
    before_[f] = e;
  }

  std::span<const SeenPlane> planes_;
  std::vector<Edge> edges_;  // of all parts, one plane after the other
  std::vector<int> first_;   // by plane, in edges_
  std::vector<int> next_, before_;
  std::vector<bool> joined_;
};

}  // namespace

std::vector<SeenBoundary> seen_boundaries(const SourceScene& source,
                                          std::span<const SeenPlane> planes) {
  std::vector<Namer> namers;
  std::vector<PlaneFrame> frames;
  for (const SeenPlane& seen : planes) {
    namers.emplace_back(source, *seen.plane, *seen.view);
    frames.emplace_back(source, *seen.plane, seen.view->eye());
  }
  Boundaries all(planes);
  all.join_diagonals();
  std::vector<SeenBoundary> boundaries;
  for (const auto& walk : all.walks()) {
    std::vector<std::vector<SeenSide>> sides;
    std::vector<Point> corners;
    for (const int e : walk) {
      const std::size_t k = all.plane_of(e);
      std::vector<SeenSide> names = namers[k].names(all.at(e).lines);
      // A side that goes on straight is one.
      if (!sides.empty() && sides.back() == names) continue;
      sides.push_back(std::move(names));
      corners.push_back(frames[k].on_plane(planes[k].part.points[all.at(e).from]));
    }
    if (sides.size() > 1 && sides.front() == sides.back()) {
      sides.erase(sides.begin());
      corners.erase(corners.begin());
    }
    const auto first = static_cast<std::ptrdiff_t>(least_rotation(sides));
    std::ranges::rotate(sides, sides.begin() + first);
    std::ranges::rotate(corners, corners.begin() + first);
    boundaries.push_back({all.source_face(walk), std::move(sides), std::move(corners)});
  }
  std::ranges::sort(boundaries, [](const SeenBoundary& x, const SeenBoundary& y) {
    return std::tie(x.source_face, x.sides) < std::tie(y.source_face, y.sides);
  });
  return boundaries;
}

}  // namespace sightline::internal
