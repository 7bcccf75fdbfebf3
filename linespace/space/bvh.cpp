// Top-down build of the box tree by binned surface area (Wald 2007, "On fast construction
// of SAH-based bounding volume hierarchies", section 3): 16 bins along the widest axis of
// the centres.

#include "linespace/space/bvh.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>

#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

constexpr int kBins = 16;
// Below this depth nodes are halved by count.  Fewer than 2^32 items can be halved fewer
// than 32 times, so that the depth stays under 100 whatever the boxes are.
constexpr int kMaxBinnedDepth = 64;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Box kEmptyBox{{kInfinity, kInfinity, kInfinity},
                        {-kInfinity, -kInfinity, -kInfinity}};

void extend(Box& box, const Box& other) {
  for (int k = 0; k < 3; ++k) {
    box.min[k] = std::min(box.min[k], other.min[k]);
    box.max[k] = std::max(box.max[k], other.max[k]);
  }
}

void include(Box& box, const std::array<double, 3>& p) {
  for (int k = 0; k < 3; ++k) {
    box.min[k] = std::min(box.min[k], p[k]);
    box.max[k] = std::max(box.max[k], p[k]);
  }
}

// Only compared, never decided on: rounding does not matter here.
double half_area(const Box& box) {
  const double x = box.max[0] - box.min[0];
  const double y = box.max[1] - box.min[1];
  const double z = box.max[2] - box.min[2];
  return x * y + y * z + z * x;
}

int widest_axis(const Box& box) {
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (box.max[k] - box.min[k] > box.max[axis] - box.min[axis]) axis = k;
  }
  return axis;
}

struct Work {
  std::uint32_t node, first, last;
  int depth;
};

struct Builder {
  std::span<const Box> boxes;
  std::vector<std::array<double, 3>> centres;
  std::vector<std::uint32_t>& items;

  // Reorders items [first, last) into two non-empty parts and returns where they meet.
  std::uint32_t split(const Work& w) {
    Box spread = kEmptyBox;
    for (std::uint32_t i = w.first; i < w.last; ++i) include(spread, centres[items[i]]);
    const int axis = widest_axis(spread);
    const double low = spread.min[axis];
    const double width = spread.max[axis] - low;
    if (w.depth < kMaxBinnedDepth && width > 0) {
      const auto bin_of = [&](std::uint32_t item) {
        return std::min(static_cast<int>((centres[item][axis] - low) / width * kBins),
                        kBins - 1);
      };
      const int cut = best_cut(w, bin_of);
      const auto middle =
          std::partition(items.begin() + w.first, items.begin() + w.last,
                         [&](std::uint32_t i) { return bin_of(i) < cut; });
      const auto at = static_cast<std::uint32_t>(middle - items.begin());
      if (at != w.first && at != w.last) return at;
    }
    const std::uint32_t at = w.first + (w.last - w.first) / 2;
    std::nth_element(items.begin() + w.first, items.begin() + at, items.begin() + w.last,
                     [&](std::uint32_t i, std::uint32_t j) {
                       return std::pair(centres[i][axis], i) <
                              std::pair(centres[j][axis], j);
                     });
    return at;
  }

  // The cut c, of 1..kBins-1, with the least sum of area times count on both sides of it.
  template <class BinOf>
  int best_cut(const Work& w, const BinOf& bin_of) const {
    std::array<Box, kBins> bin_boxes;
    bin_boxes.fill(kEmptyBox);
    std::array<std::uint32_t, kBins> counts{};
    for (std::uint32_t i = w.first; i < w.last; ++i) {
      const int bin = bin_of(items[i]);
      extend(bin_boxes[bin], boxes[items[i]]);
      ++counts[bin];
    }
    std::array<double, kBins> cost_left{};
    Box box = kEmptyBox;
    std::uint32_t count = 0;
    for (int cut = 1; cut < kBins; ++cut) {
      extend(box, bin_boxes[cut - 1]);
      count += counts[cut - 1];
      cost_left[cut] = count > 0 ? count * half_area(box) : 0;
    }
    box = kEmptyBox;
    count = 0;
    int best = 1;
    double best_cost = kInfinity;
    for (int cut = kBins - 1; cut > 0; --cut) {
      extend(box, bin_boxes[cut]);
      count += counts[cut];
      const double cost = cost_left[cut] + (count > 0 ? count * half_area(box) : 0);
      if (cost < best_cost) {
        best_cost = cost;
        best = cut;
      }
    }
    return best;
  }
};

}  // namespace

Box box_of(std::span<const Point> points) {
  Box box = kEmptyBox;
  for (const Point& p : points) include(box, {p.x(), p.y(), p.z()});
  return box;
}

bool boxes_meet(const Box& a, const Box& b) {
  for (int i = 0; i < 3; ++i) {
    if (a.min[i] > b.max[i] || a.max[i] < b.min[i]) return false;
  }
  return true;
}

Bvh::Bvh(std::span<const Box> boxes, int leaf_size) : items_(boxes.size()) {
  assert(leaf_size > 0 && boxes.size() < std::numeric_limits<std::uint32_t>::max());
  if (boxes.empty()) return;
  std::iota(items_.begin(), items_.end(), 0u);
  Builder builder{boxes, {}, items_};
  builder.centres.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      builder.centres[i][k] = 0.5 * boxes[i].min[k] + 0.5 * boxes[i].max[k];
    }
  }
  nodes_.reserve(boxes.size());
  nodes_.emplace_back();
  std::vector<Work> todo{{0, 0, static_cast<std::uint32_t>(boxes.size()), 0}};
  while (!todo.empty()) {
    hear_stop();
    const Work w = todo.back();
    todo.pop_back();
    Box box = kEmptyBox;
    for (std::uint32_t i = w.first; i < w.last; ++i) extend(box, boxes[items_[i]]);
    if (w.last - w.first <= static_cast<std::uint32_t>(leaf_size)) {
      nodes_[w.node] = {box, w.first, w.last - w.first};
      continue;
    }
    const std::uint32_t middle = builder.split(w);
    const auto left = static_cast<std::uint32_t>(nodes_.size());
    nodes_[w.node] = {box, left, 0};
    nodes_.resize(nodes_.size() + 2);
    todo.push_back({left + 1, middle, w.last, w.depth + 1});
    todo.push_back({left, w.first, middle, w.depth + 1});
  }
}

}  // namespace sightline::internal
