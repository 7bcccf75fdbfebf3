#include "linespace/space/box_tree.h"

#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sightline::internal {
namespace {

constexpr double kReach = 1.001;  // the grid covers [-kReach, kReach]
constexpr double kCells = 65535;
constexpr double kScale = kCells / (2 * kReach);
constexpr std::size_t kArity = 8;

double on_grid(double x) { return (x + kReach) * kScale; }

// Every third bit of the result is one of x.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 16) & 0x0000ff0000ffULL;
  x = (x | x << 8) & 0x00f00f00f00fULL;
  x = (x | x << 4) & 0x0c30c30c30c3ULL;
  x = (x | x << 2) & 0x249249249249ULL;
  return x;
}

std::uint64_t morton_code(const GridBox& box) {
  std::uint64_t code = 0;
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t middle = (std::uint64_t{box.min[i]} + box.max[i]) / 2;
    code |= spread(middle) << i;
  }
  return code;
}

GridBox around(const GridBox& a, const GridBox& b) {
  GridBox out = a;
  for (int i = 0; i < 3; ++i) {
    out.min[i] = std::min(out.min[i], b.min[i]);
    out.max[i] = std::max(out.max[i], b.max[i]);
  }
  return out;
}

// A segment on the grid, by its middle and half of its extent, for the test by separating
// axes: those of the box, and their cross products with the segment.
class GridSegment {
 public:
  GridSegment(const Point& from, const Point& to) : from_(from), to_(to) {
    for (int i = 0; i < 3; ++i) {
      const double a = on_grid(from[i]);
      const double b = on_grid(to[i]);
      middle_[i] = 0.5 * (a + b);
      half_[i] = 0.5 * (b - a);
      reach_[i] = std::abs(half_[i]);
      cells_.min[i] = cell(std::floor(std::min(a, b) - kGrow));
      cells_.max[i] = cell(std::ceil(std::max(a, b) + kGrow));
    }
  }

  // The box is not beside the segment's own.
  [[nodiscard]] bool may_overlap(const GridBox& box) const {
    bool meets = true;
    for (int i = 0; i < 3; ++i) {
      meets &= (box.min[i] <= cells_.max[i]) & (box.max[i] >= cells_.min[i]);
    }
    return meets;
  }

  [[nodiscard]] bool may_meet(const GridBox& box) const {
    std::array<double, 3> apart, size;
    for (int i = 0; i < 3; ++i) {
      const double low = box.min[i];
      const double high = box.max[i];
      apart[i] = middle_[i] - 0.5 * (low + high);
      size[i] = 0.5 * (high - low) + kGrow;
      if (std::abs(apart[i]) > size[i] + reach_[i]) return false;
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const int k = (i + 2) % 3;
      if (std::abs(half_[j] * apart[k] - half_[k] * apart[j]) >
          size[j] * reach_[k] + size[k] * reach_[j]) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] bool may_meet(const Slab& slab) const {
    const Point n = slab.normal();
    // The ends' slack is 0.002 steps, and rounding less.
    const double a = Slab::kSteps * n.dot(from_);
    const double b = Slab::kSteps * n.dot(to_);
    return std::min(a, b) <= slab.high + 0.5 && std::max(a, b) >= slab.low - 0.5;
  }

 private:
  // Points of the true segment and of this one at the same parameter are less than 0.01
  // cells apart: kSegmentSlack, and roundings on a grid of 2^18 cells at most.  So the
  // true one meets a box only where this one meets it grown by that much.  A product
  // reach_j |apart_k| rounds by at most 2^-35 reach_j, a comparison of sums by less than
  // that of the sizes; both are small parts of kGrow reach_j, and of kGrow.
  static constexpr double kGrow = 0.5;

  Point from_, to_;
  static std::uint16_t cell(double x) {
    return static_cast<std::uint16_t>(std::clamp(x, 0.0, kCells));
  }

  std::array<double, 3> middle_, half_, reach_;
  GridBox cells_{};
};

}  // namespace

Point Slab::normal() const {
  const double x = u / 127.0;
  const double y = v / 127.0;
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z >= 0) return {x, y, z};
  return {std::copysign(1 - std::abs(y), x), std::copysign(1 - std::abs(x), y), z};
}

Slab Slab::across(const Point& direction) {
  Slab out;
  const double size = direction.cwiseAbs().sum();
  if (!(size > 0)) return out;
  const Point n = direction / (direction[2] < 0 ? -size : size);
  out.u = static_cast<std::int8_t>(std::lround(127 * std::clamp(n[0], -1.0, 1.0)));
  out.v = static_cast<std::int8_t>(std::lround(127 * std::clamp(n[1], -1.0, 1.0)));
  return out;
}

void Slab::set(double lowest, double highest) {
  low = static_cast<std::int16_t>(
      std::clamp(std::floor(lowest * kSteps), -32768.0, 32767.0));
  high = static_cast<std::int16_t>(
      std::clamp(std::ceil(highest * kSteps), -32768.0, 32767.0));
}

std::optional<GridBox> grid_box(const Box& box) {
  GridBox out{};
  for (int i = 0; i < 3; ++i) {
    const double low = std::floor(on_grid(box.min[i]));
    const double high = std::ceil(on_grid(box.max[i]));
    if (!(low <= kCells && high >= 0)) return std::nullopt;
    out.min[i] = static_cast<std::uint16_t>(std::max(low, 0.0));
    out.max[i] = static_cast<std::uint16_t>(std::min(high, kCells));
  }
  return out;
}

BoxTree::BoxTree(std::vector<BoxItem> items) {
  if (items.empty()) return;
  struct Key {
    std::uint64_t code;
    std::size_t position;
  };
  std::vector<Key> order(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    order[i] = {morton_code(items[i].box), i};
  }
  oneapi::tbb::parallel_sort(order.begin(), order.end(), [](const Key& a, const Key& b) {
    return a.code != b.code ? a.code < b.code : a.position < b.position;
  });
  items_.resize(items.size());
  slabs_.resize(items.size());
  std::vector<GridBox> level(items.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    items_[i] = items[order[i].position].item;
    slabs_[i] = items[order[i].position].slab;
    level[i] = items[order[i].position].box;
  }
  levels_.push_back(std::move(level));
  while (levels_.back().size() > 1) {
    const std::vector<GridBox>& below = levels_.back();
    std::vector<GridBox> above;
    above.reserve(below.size() / kArity + 1);
    for (std::size_t i = 0; i < below.size(); ++i) {
      if (i % kArity == 0) {
        above.push_back(below[i]);
      } else {
        above.back() = around(above.back(), below[i]);
      }
    }
    levels_.push_back(std::move(above));
  }
}

void BoxTree::meeting(const Point& from, const Point& to,
                      std::vector<std::uint32_t>& items) const {
  if (items_.empty()) return;
  const GridSegment segment(from, to);
  struct Node {
    std::size_t level, position;
  };
  // At most kArity - 1 siblings wait on each level.  The box around all is not asked.
  std::array<Node, 8 * 32> stack;
  std::size_t top = 0;
  stack[top++] = {levels_.size() - 1, 0};
  while (top > 0) {
    const Node n = stack[--top];
    if (n.level == 0) {
      if (segment.may_meet(slabs_[n.position])) items.push_back(items_[n.position]);
      continue;
    }
    const std::vector<GridBox>& below = levels_[n.level - 1];
    const std::size_t first = n.position * kArity;
    const std::size_t end = std::min(first + kArity, below.size());
    for (std::size_t i = first; i < end; ++i) {
      if (segment.may_overlap(below[i]) && segment.may_meet(below[i])) {
        stack[top++] = {n.level - 1, i};
      }
    }
  }
}

std::size_t BoxTree::bytes() const {
  std::size_t sum = sizeof *this + items_.capacity() * sizeof(std::uint32_t) +
                    slabs_.capacity() * sizeof(Slab);
  for (const auto& level : levels_) sum += level.capacity() * sizeof(GridBox);
  return sum;
}

}  // namespace sightline::internal
