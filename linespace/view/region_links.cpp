#include "linespace/view/region_links.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include "linespace/picture/picture_tree.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// A way from a component to somewhere else crosses edges; between two neighbouring
// crossings it runs in one region.
class Linker {
 public:
  Linker(const EyeSpace& eye, const WalkedGraph& graph)
      : eye_(&eye),
        graph_(&graph),
        walks_(static_cast<std::size_t>(graph.walk_count)),
        linked_(0) {}

  RegionLinks link();

 private:
  // Where a way crosses an edge: the half-edge on whose left it comes from.
  struct Crossing {
    int half_edge;
    long double at, error;  // along the way
    std::optional<Rational> exact_at;
  };
  struct Way {
    PicturePoint from, to;
  };

  void find_components();
  void link_component(int edge, const PictureTree& tree, bool to_the_end);
  [[nodiscard]] bool find_crossings(int edge, const Way& way, const PictureTree& tree,
                                    std::vector<Crossing>& crossings) const;
  [[nodiscard]] std::optional<Crossing> crossing(int edge, const Way& way,
                                                 bool& generic) const;
  void sort_along(const Way& way, std::vector<Crossing>& crossings) const;
  void follow(int edge, Sign start_side, const std::vector<Crossing>& crossings,
              bool to_the_end);
  [[nodiscard]] const PicturePoint& end(int edge, int which) const {
    return (*graph_->points)[graph_->ends[edge][which]];
  }

  const EyeSpace* eye_;
  const WalkedGraph* graph_;
  Classes walks_;
  std::vector<int> component_;  // of points
  int components_ = 0;
  Classes linked_;                            // components that some way joins
  int last_walk_ = -1, last_component_ = -1;  // of the region where ways end
};

void Linker::find_components() {
  Classes classes(graph_->points->size());
  for (const auto& [from, to] : graph_->ends) classes.join(from, to);
  component_.assign(graph_->points->size(), -1);
  for (int p = 0; p < static_cast<int>(component_.size()); ++p) {
    int& number = component_[classes.root(p)];
    if (number < 0) number = components_++;
    component_[p] = number;
  }
}

RegionLinks Linker::link() {
  find_components();
  if (components_ > 1) {
    linked_ = Classes(static_cast<std::size_t>(components_));
    std::vector<PictureTree::Piece> spans;
    for (int e = 0; e < static_cast<int>(graph_->ends.size()); ++e)
      spans.push_back({&end(e, 0), &end(e, 1)});
    const PictureTree tree(spans, eye_->is_direction());
    // Mostly the first other component on the way is enough; where components link in a
    // circle, ways to the very end join them all.
    for (const bool to_the_end : {false, true}) {
      std::vector<std::uint8_t> done(static_cast<std::size_t>(components_), 0);
      for (int e = 0; e < static_cast<int>(graph_->ends.size()); ++e) {
        const int c = component_[graph_->ends[e][0]];
        if (done[c]++ != 0) continue;
        if (to_the_end && linked_.root(c) == linked_.root(0) && c != 0) continue;
        hear_stop();
        link_component(e, tree, to_the_end);
      }
    }
  }
  return {std::move(walks_), components_};
}

void Linker::link_component(int edge, const PictureTree& tree, bool to_the_end) {
  // All ways end at one point of the picture, which is in line with nothing.
  const PicturePoint pole(
      *eye_, eye_->is_direction()
                 ? ExactPoint{Rational(3.3137), Rational(-5.8572), 1}
                 : ExactPoint{Rational(0.4142), Rational(-0.7321), Rational(0.5391)});
  const Sign side = orient(end(edge, 0), end(edge, 1), pole);
  // From some point of the edge; from another if that way passes a point of the graph.
  for (int weight = 1; weight < 64 && side != Sign::Zero; ++weight) {
    const Way way{point_inside(*eye_, end(edge, 0), end(edge, 1), weight), pole};
    std::vector<Crossing> crossings;
    if (!find_crossings(edge, way, tree, crossings)) continue;
    sort_along(way, crossings);
    follow(edge, side, crossings, to_the_end);
    return;
  }
  throw std::logic_error("point view: no way out of a component");
}

// False when the way passes a point of the graph.
bool Linker::find_crossings(int edge, const Way& way, const PictureTree& tree,
                            std::vector<Crossing>& crossings) const {
  bool generic = true;
  tree.across(way.from, way.to, [&](int e) {
    if (e == edge || !generic) return;
    if (auto c = crossing(e, way, generic)) crossings.push_back(std::move(*c));
  });
  return generic;
}

std::optional<Linker::Crossing> Linker::crossing(int edge, const Way& way,
                                                 bool& generic) const {
  const PicturePoint &p = end(edge, 0), &q = end(edge, 1);
  const Sign at_p = orient(way.from, way.to, p), at_q = orient(way.from, way.to, q);
  generic = at_p != Sign::Zero && at_q != Sign::Zero;
  if (!generic || at_p == at_q) return std::nullopt;
  const Sign from = orient(p, q, way.from), to = orient(p, q, way.to);
  // In line with the start, which is on another edge: the way leaves that line at once.
  if (from == Sign::Zero) return std::nullopt;
  generic = to != Sign::Zero;
  // Opposite sides both ways; and not on the other side of the sphere.
  if (!generic || from == to || from == at_p) return std::nullopt;
  // The distances of the way's ends from the edge's line give where it is crossed.
  const LongVector n = cross(p.vector(), q.vector());
  const long double a = std::abs(dot(n, way.from.vector()));
  const long double size = a + std::abs(dot(n, way.to.vector()));
  const long double off = 32 * (p.error() + q.error() + way.from.error() + 0x1p-60L);
  return Crossing{from == Sign::Positive ? 2 * edge : 2 * edge + 1, a / size,
                  size > off ? off / size : 1, std::nullopt};
}

void Linker::sort_along(const Way& way, std::vector<Crossing>& crossings) const {
  const auto exact_at = [&](Crossing& c) -> const Rational& {
    if (!c.exact_at) {
      const ExactPoint n =
          exact_cross(end(c.half_edge / 2, 0).exact(), end(c.half_edge / 2, 1).exact());
      const Rational a = exact_dot(n, way.from.exact()), b = exact_dot(n, way.to.exact());
      c.exact_at = quotient(a, Rational(a - b));
    }
    return *c.exact_at;
  };
  std::sort(crossings.begin(), crossings.end(), [&](Crossing& x, Crossing& y) {
    if (std::abs(x.at - y.at) > x.error + y.error) return x.at < y.at;
    return exact_at(x) < exact_at(y);
  });
}

void Linker::follow(int edge, Sign start_side, const std::vector<Crossing>& crossings,
                    bool to_the_end) {
  int here = graph_->walks[start_side == Sign::Positive ? 2 * edge : 2 * edge + 1];
  int component = component_[graph_->ends[edge][0]];
  for (const Crossing& c : crossings) {
    const int other = component_[graph_->ends[c.half_edge / 2][0]];
    if (other != component) {
      walks_.join(here, graph_->walks[c.half_edge]);
      linked_.join(component, other);
      if (!to_the_end) return;
    }
    here = graph_->walks[c.half_edge ^ 1];
    component = other;
  }
  // All whose ways come to the end lie in one region there.
  if (last_walk_ >= 0) {
    walks_.join(here, last_walk_);
    linked_.join(component, last_component_);
  }
  last_walk_ = here;
  last_component_ = component;
}

}  // namespace

RegionLinks link_regions(const EyeSpace& eye, const WalkedGraph& graph) {
  return Linker(eye, graph).link();
}

PicturePoint point_inside(const EyeSpace& eye, const PicturePoint& p,
                          const PicturePoint& q, int weight) {
  // Of vectors of like length, their weighted sum.
  const auto scale = [](const PicturePoint& x) {
    const ExactPoint& v = x.exact();
    const Rational size = abs(v[0]) + abs(v[1]) + abs(v[2]);
    return Rational(std::ldexp(1.0, -std::ilogb(static_cast<double>(size))));
  };
  const Rational s = scale(p), t = weight * scale(q);
  ExactPoint sum;
  for (int i = 0; i < 3; ++i) sum[i] = s * p.exact()[i] + t * q.exact()[i];
  return {eye, sum};
}

}  // namespace sightline::internal
