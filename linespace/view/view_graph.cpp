#include "linespace/view/view_graph.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "linespace/picture/classes.h"
#include "linespace/picture/picture_tree.h"
#include "linespace/view/first_seen.h"
#include "linespace/view/piece_joiner.h"

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
    find_components();
    join_cycles();
    label_regions();
    return std::move(graph_);
  }

 private:
  void walk_around();
  void turn_around(int point, std::vector<int>& leaving) const;
  void find_components();
  void join_cycles();
  void link_component(int edge, const PictureTree& tree, bool to_the_end);
  bool try_link(int edge, int weight, const PictureTree& tree, const PicturePoint& pole,
                bool to_the_end);
  void label_regions();
  [[nodiscard]] FacetSides label(const std::vector<int>& faces) const;
  [[nodiscard]] const SeenBeside& told_beside(int half_edge) const;
  [[nodiscard]] PicturePoint middle(int edge, int weight = 1) const;
  [[nodiscard]] PicturePoint far_end(int half_edge) const;

  const EyeSpace* eye_;
  const EyeStar* star_;
  const std::vector<LinePiece>* pieces_;
  std::span<const std::uint8_t> possibly_seen_;
  ViewGraph graph_;
  std::vector<int> piece_of_;   // of edges
  std::vector<int> cycles_;     // of half-edges
  std::vector<int> component_;  // of points
  int cycle_count_ = 0;
  std::optional<Classes> cycle_classes_;
  std::optional<Classes> linked_;              // components that some link joins
  int pole_cycle_ = -1, pole_component_ = -1;  // of the region where ways end
};

// The end of its line towards which a half-edge runs.
PicturePoint GraphBuilder::far_end(int half_edge) const {
  const auto& ends = eye_->scene().lines()[graph_.edges[half_edge / 2].line].ends;
  return {*eye_, ends[half_edge % 2 == 0 ? 1 : 0]};
}

// Half-edges that leave a point, counter-clockwise.
void GraphBuilder::turn_around(int point, std::vector<int>& leaving) const {
  if (leaving.size() < 3) return;
  const PicturePoint& at = graph_.points[point];
  std::vector<PicturePoint> far;
  for (const int h : leaving) far.push_back(far_end(h));
  const auto line = [&](std::size_t i) { return graph_.edges[leaving[i] / 2].line; };
  // One line leaves a point only both ways.
  const auto turn = [&](std::size_t i, std::size_t j) {
    return line(i) == line(j) ? Sign::Zero : orient(at, far[i], far[j]);
  };
  // From the first: 0 itself, 1 less than half a turn, 2 half a turn, 3 more.
  std::vector<int> sector(leaving.size());
  for (std::size_t i = 1; i < leaving.size(); ++i) {
    const Sign s = turn(0, i);
    sector[i] = s == Sign::Positive ? 1 : s == Sign::Zero ? 2 : 3;
  }
  std::vector<std::size_t> order(leaving.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, [&](std::size_t i, std::size_t j) {
    if (sector[i] != sector[j]) return sector[i] < sector[j];
    return i != j && turn(i, j) == Sign::Positive;
  });
  std::vector<int> turned;
  for (const std::size_t i : order) turned.push_back(leaving[i]);
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
  cycles_.assign(n, -1);
  for (int h = 0; h < n; ++h) {
    if (cycles_[h] >= 0) continue;
    for (int x = h; cycles_[x] < 0; x = graph_.next[x]) cycles_[x] = cycle_count_;
    ++cycle_count_;
  }
}

void GraphBuilder::find_components() {
  Classes classes(graph_.points.size());
  for (const auto& e : graph_.edges) classes.join(e.ends[0], e.ends[1]);
  component_.assign(graph_.points.size(), -1);
  for (int p = 0; p < static_cast<int>(component_.size()); ++p) {
    int& number = component_[classes.root(p)];
    if (number < 0) number = graph_.components++;
    component_[p] = number;
  }
}

// A point inside an edge, another for each weight.
PicturePoint GraphBuilder::middle(int edge, int weight) const {
  const auto [from, to] = graph_.edges[edge].ends;
  const PicturePoint &p = graph_.points[from], &q = graph_.points[to];
  // Of vectors of like length, their weighted sum.
  const auto scale = [](const PicturePoint& x) {
    const ExactPoint& v = x.exact();
    const Rational size = abs(v[0]) + abs(v[1]) + abs(v[2]);
    return Rational(std::ldexp(1.0, -std::ilogb(static_cast<double>(size))));
  };
  const Rational s = scale(p), t = weight * scale(q);
  ExactPoint sum;
  for (int i = 0; i < 3; ++i) sum[i] = s * p.exact()[i] + t * q.exact()[i];
  return {*eye_, sum};
}

// Which walks bound one region?  A region between components of the graph has a walk on
// each of them.  A way from a component to somewhere else crosses edges; between two
// neighbouring crossings it runs in one region.
void GraphBuilder::join_cycles() {
  cycle_classes_.emplace(static_cast<std::size_t>(cycle_count_));
  if (graph_.components < 2) return;
  linked_.emplace(static_cast<std::size_t>(graph_.components));
  std::vector<PictureTree::Piece> spans;
  for (const auto& e : graph_.edges) {
    spans.push_back({&graph_.points[e.ends[0]], &graph_.points[e.ends[1]]});
  }
  const PictureTree tree(spans, eye_->is_direction());
  // Mostly the first other component on the way is enough; where components link in a
  // circle, ways to the very end join them all.
  for (const bool to_the_end : {false, true}) {
    std::vector<std::uint8_t> done(static_cast<std::size_t>(graph_.components), 0);
    for (int e = 0; e < static_cast<int>(graph_.edges.size()); ++e) {
      const int c = component_[graph_.edges[e].ends[0]];
      if (done[c]++ != 0) continue;
      if (to_the_end && linked_->root(c) == linked_->root(0) && c != 0) continue;
      link_component(e, tree, to_the_end);
    }
  }
}

void GraphBuilder::link_component(int edge, const PictureTree& tree, bool to_the_end) {
  // All ways end at one point of the picture, which is in line with nothing.
  const PicturePoint pole(
      *eye_, eye_->is_direction()
                 ? ExactPoint{Rational(3.3137), Rational(-5.8572), 1}
                 : ExactPoint{Rational(0.4142), Rational(-0.7321), Rational(0.5391)});
  // From some point of the edge; from another if that way passes a point of the graph.
  for (int weight = 1; weight < 64; ++weight) {
    if (try_link(edge, weight, tree, pole, to_the_end)) return;
  }
  throw std::logic_error("point view: no way out of a component");
}

bool GraphBuilder::try_link(int edge, int weight, const PictureTree& tree,
                            const PicturePoint& pole, bool to_the_end) {
  const PicturePoint start = middle(edge, weight);
  const auto& e0 = graph_.edges[edge];
  const Sign first = orient(graph_.points[e0.ends[0]], graph_.points[e0.ends[1]], pole);
  if (first == Sign::Zero) return false;

  // The edges that the way crosses, with the half-edge whose left it comes from.
  struct Crossing {
    int half_edge;
    long double at, error;
    std::optional<Rational> exact_at;
  };
  std::vector<Crossing> crossings;
  bool generic = true;
  tree.across(start, pole, [&](int e) {
    if (e == edge || !generic) return;
    const PicturePoint& p = graph_.points[graph_.edges[e].ends[0]];
    const PicturePoint& q = graph_.points[graph_.edges[e].ends[1]];
    const Sign at_p = orient(start, pole, p);
    const Sign at_q = orient(start, pole, q);
    if (at_p == Sign::Zero || at_q == Sign::Zero) {
      generic = false;
      return;
    }
    if (at_p == at_q) return;
    const Sign from = orient(p, q, start);
    const Sign to = orient(p, q, pole);
    // In line with the start, which is on another edge: the way leaves that line at once.
    if (from == Sign::Zero) return;
    if (to == Sign::Zero) {
      generic = false;
      return;
    }
    // Opposite sides both ways; and not on the other side of the sphere.
    if (from == to || from == at_p) return;
    // Where on the way, as a ratio of the distances of its ends from the edge's line.  An
    // edge is at least as long as its ends' errors are small.
    const LongVector n = cross(p.vector(), q.vector());
    const long double a = dot(n, start.vector()), b = dot(n, pole.vector());
    const long double off = 8 * (p.error() + q.error() + start.error() + 0x1p-60L);
    const long double size = std::abs(a) + std::abs(b);
    crossings.push_back({from == Sign::Positive ? 2 * e : 2 * e + 1,
                         std::abs(a) / size,
                         size > 4 * off ? 4 * off / size : 1,
                         {}});
  });
  if (!generic) return false;
  const auto exact_at = [&](Crossing& c) -> const Rational& {
    if (!c.exact_at) {
      const auto& ends = graph_.edges[c.half_edge / 2].ends;
      const ExactPoint n =
          exact_cross(graph_.points[ends[0]].exact(), graph_.points[ends[1]].exact());
      const Rational a = exact_dot(n, start.exact()), b = exact_dot(n, pole.exact());
      c.exact_at = quotient(a, Rational(a - b));
    }
    return *c.exact_at;
  };
  std::sort(crossings.begin(), crossings.end(), [&](Crossing& x, Crossing& y) {
    if (std::abs(x.at - y.at) > x.error + y.error) return x.at < y.at;
    return exact_at(x) < exact_at(y);
  });

  int here = first == Sign::Positive ? cycles_[2 * edge] : cycles_[2 * edge + 1];
  int component = component_[e0.ends[0]];
  for (const Crossing& c : crossings) {
    const int other = component_[graph_.edges[c.half_edge / 2].ends[0]];
    if (other != component) {
      cycle_classes_->join(here, cycles_[c.half_edge]);
      linked_->join(component, other);
      if (!to_the_end) return true;
    }
    here = cycles_[c.half_edge ^ 1];
    component = other;
  }
  // Those whose ways end here lie in one region with the pole.
  if (pole_cycle_ >= 0) {
    cycle_classes_->join(here, pole_cycle_);
    linked_->join(component, pole_component_);
  }
  pole_cycle_ = here;
  pole_component_ = component;
  return true;
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
  std::vector<int> number(static_cast<std::size_t>(cycle_count_), -1);
  std::vector<std::uint8_t> known;
  std::vector<int> some_edge;
  graph_.region.resize(cycles_.size());
  for (std::size_t h = 0; h < cycles_.size(); ++h) {
    int& region = number[cycle_classes_->root(cycles_[h])];
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
    graph_.regions[r] = label(first_seen(*eye_, {middle(h / 2), {left}}, possibly_seen_));
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
