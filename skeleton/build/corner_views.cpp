#include "skeleton/build/corner_views.h"

#include <cstdint>

namespace sightline::internal {
namespace {

// Speed only: what is between is listed so many times less often, and a stop or a budget
// waits for so many views.
constexpr std::size_t kTogether = 8;

}  // namespace

std::vector<std::span<const int>> near_each_other(const Silhouettes& silhouettes,
                                                  std::span<const int> stars) {
  const auto object = [&](int star) {
    return silhouettes.objects_at(silhouettes.stars()[star].point).front();
  };
  std::vector<std::span<const int>> runs;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const bool goes_on = !runs.empty() && runs.back().size() < kTogether &&
                         object(stars[i]) == object(stars[i - 1]);
    if (goes_on) {
      runs.back() = {runs.back().data(), runs.back().size() + 1};
    } else {
      runs.push_back(stars.subspan(i, 1));
    }
  }
  return runs;
}

CornerViews::CornerViews(const Silhouettes& silhouettes, const EvPart& part,
                         const SkeletonLines* lines, double feature_size)
    : g_(silhouettes),
      part_(part),
      lines_(lines),
      feature_size_(feature_size),
      around_(silhouettes) {}

std::vector<VertexView> CornerViews::views(std::span<const int> stars,
                                           const std::function<bool()>& stop) {
  while (viewers_.size() < stars.size()) {
    viewers_.emplace_back(g_, part_, lines_, feature_size_, around_, known_);
  }
  std::vector<Point> points;
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < stars.size(); ++k) {
    points.push_back(g_.scene().point(g_.stars()[stars[k]].point));
    viewers_[k].begin(stars[k]);
    if (!g_.inside_solid(stars[k])) all.push_back(k);
  }
  around_.begin(points);
  const Bvh& tree = g_.ridge_tree();
  struct Open {
    std::uint32_t node;
    std::vector<std::size_t> viewers;
  };
  std::vector<Open> stack;
  if (!tree.empty()) stack.push_back({0, all});
  while (!stack.empty() && !stop()) {
    Open at = std::move(stack.back());
    stack.pop_back();
    std::erase_if(at.viewers,
                  [&](std::size_t k) { return !viewers_[k].may_view(at.node); });
    if (at.viewers.empty()) continue;
    if (g_.ridge_group(at.node).begins) {
      around_.look_at(tree.node(at.node).box);
      for (const std::size_t k : at.viewers) viewers_[k].view_group(at.node);
      continue;
    }
    const std::uint32_t child = tree.node(at.node).first;
    stack.push_back({child + 1, at.viewers});
    stack.push_back({child, std::move(at.viewers)});
  }
  std::vector<VertexView> out;
  out.reserve(stars.size());
  for (std::size_t k = 0; k < stars.size(); ++k) out.push_back(viewers_[k].finish());
  return out;
}

}  // namespace sightline::internal
