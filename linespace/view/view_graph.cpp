#include "linespace/view/view_graph.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "linespace/picture/turning.h"
#include "linespace/view/first_seen.h"
#include "linespace/view/piece_joiner.h"
#include "linespace/view/region_links.h"

namespace sightline::internal {
namespace {

class GraphBuilder {
 public:
  GraphBuilder(const EyeSpace& eye, const EyeStar& star,
               const std::vector<LinePiece>& pieces,
               std::span<const std::uint8_t> possibly_seen)
      : eye_(&eye), star_(&star), pieces_(&pieces), possibly_seen_(possibly_seen) {}

  ViewGraph build() {
    JoinedPieces joined = join_ends(*eye_, *pieces_);
    graph_.points = std::move(joined.points);
    graph_.scene_points = std::move(joined.scene_points);
    for (const JoinedEdge& e : joined.edges) {
      const LinePiece& piece = (*pieces_)[e.piece];
      const auto first = [](const SeenBeside& s) {
        return s.faces.empty() ? -1 : s.faces.front();
      };
      graph_.edges.push_back({e.line, e.ends, {first(piece.left), first(piece.right)}});
      piece_of_.push_back(e.piece);
    }
    walk_around();
    label_regions();
    return std::move(graph_);
  }

 private:
  void walk_around();
  void turn_around(int point, std::vector<int>& leaving) const;
  void label_regions();
  [[nodiscard]] FacetSides label(const std::vector<int>& faces) const;
  [[nodiscard]] const SeenBeside& told_beside(int half_edge) const;
  [[nodiscard]] PicturePoint far_end(int half_edge) const;

  const EyeSpace* eye_;
  const EyeStar* star_;
  const std::vector<LinePiece>* pieces_;
  std::span<const std::uint8_t> possibly_seen_;
  ViewGraph graph_;
  std::vector<int> piece_of_;  // of edges
  WalkedGraph walked_;
};

// The end of its line towards which a half-edge runs.
PicturePoint GraphBuilder::far_end(int half_edge) const {
  const auto& ends = eye_->scene().lines()[graph_.edges[half_edge / 2].line].ends;
  return {*eye_, ends[half_edge % 2 == 0 ? 1 : 0]};
}

// Half-edges that leave a point, counter-clockwise.
void GraphBuilder::turn_around(int point, std::vector<int>& leaving) const {
  if (leaving.size() < 3) return;
  std::vector<PicturePoint> far;
  std::vector<int> lines;
  for (const int h : leaving) {
    far.push_back(far_end(h));
    lines.push_back(graph_.edges[h / 2].line);
  }
  std::vector<int> turned;
  for (const std::size_t i : order_around(graph_.points[point], far, lines))
    turned.push_back(leaving[i]);
  leaving = std::move(turned);
}

void GraphBuilder::walk_around() {
  const auto n = static_cast<int>(2 * graph_.edges.size());
  std::vector<std::vector<int>> leaving(graph_.points.size());
  for (int h = 0; h < n; ++h) leaving[graph_.origin(h)].push_back(h);
  graph_.next.assign(n, -1);
  for (int p = 0; p < static_cast<int>(leaving.size()); ++p) {
    turn_around(p, leaving[p]);
    // Arriving against leaving[i], one goes on along its neighbour clockwise.
    const std::size_t k = leaving[p].size();
    for (std::size_t i = 0; i < k; ++i) {
      graph_.next[leaving[p][i] ^ 1] = leaving[p][(i + k - 1) % k];
    }
  }
  walked_.walks.assign(n, -1);
  for (int h = 0; h < n; ++h) {
    if (walked_.walks[h] >= 0) continue;
    for (int x = h; walked_.walks[x] < 0; x = graph_.next[x])
      walked_.walks[x] = walked_.walk_count;
    ++walked_.walk_count;
  }
}

// Faces that the half-edge's piece tells of its left; empty when that lies behind it.
const SeenBeside& GraphBuilder::told_beside(int half_edge) const {
  const LinePiece& piece = (*pieces_)[piece_of_[half_edge / 2]];
  return half_edge % 2 == 0 ? piece.left : piece.right;
}

FacetSides GraphBuilder::label(const std::vector<int>& faces) const {
  FacetSides sides;
  for (const int f : faces) {
    const bool front = eye_->front(f) == Sign::Positive;
    sides.push_back(2 * eye_->scene().scene().faces()[f].facet + (front ? 0 : 1));
  }
  std::ranges::sort(sides);
  sides.erase(std::ranges::unique(sides).begin(), sides.end());
  return sides;
}

void GraphBuilder::label_regions() {
  walked_.points = &graph_.points;
  for (const ViewGraph::Edge& e : graph_.edges) walked_.ends.push_back(e.ends);
  RegionLinks links = link_regions(*eye_, walked_);
  graph_.components = links.components;
  std::vector<int> number(static_cast<std::size_t>(walked_.walk_count), -1);
  std::vector<std::uint8_t> known;
  std::vector<int> some_edge;
  graph_.region.resize(walked_.walks.size());
  for (std::size_t h = 0; h < walked_.walks.size(); ++h) {
    int& region = number[links.walks.root(walked_.walks[h])];
    if (region < 0) {
      region = static_cast<int>(known.size());
      known.push_back(0);
      some_edge.push_back(static_cast<int>(h));
      graph_.regions.emplace_back();
    }
    graph_.region[h] = region;
    const SeenBeside& told = told_beside(static_cast<int>(h));
    if (told.faces.empty() && !told.blocked) continue;
    FacetSides sides = told.blocked ? FacetSides{kNoSight} : label(told.faces);
    if (known[region] == 0) {
      known[region] = 1;
      graph_.regions[region] = std::move(sides);
    } else if (graph_.regions[region] != sides && thread_precision == Precision::Exact) {
      throw std::logic_error("point view: two labels for one region");
    }
  }
  for (std::size_t r = 0; r < known.size(); ++r) {
    if (known[r] != 0) continue;
    const int h = some_edge[r];
    const auto [a, b] = eye_->scene().lines()[graph_.edges[h / 2].line].ends;
    ExactPoint left = exact_cross(eye_->exact_vector(a), eye_->exact_vector(b));
    if (h % 2 == 1) left = {-left[0], -left[1], -left[2]};
    const auto [p, q] = graph_.edges[h / 2].ends;
    const PicturePoint inside = point_inside(*eye_, graph_.points[p], graph_.points[q]);
    graph_.regions[r] = label(first_seen(*eye_, {inside, {left}}, possibly_seen_));
  }
  if (!graph_.regions.empty()) return;
  // All is background; or all is material, where the eye lies on one object within
  // another.
  const ExactPoint some_way{Rational(0.61803), Rational(-0.31831), Rational(0.57722)};
  graph_.regions.push_back(star_->blocked(some_way, {}) ? FacetSides{kNoSight}
                                                        : FacetSides{});
}

}  // namespace

ViewGraph join_pieces(const EyeSpace& eye, const EyeStar& star,
                      const std::vector<LinePiece>& pieces,
                      std::span<const std::uint8_t> possibly_seen) {
  return GraphBuilder(eye, star, pieces, possibly_seen).build();
}

}  // namespace sightline::internal
