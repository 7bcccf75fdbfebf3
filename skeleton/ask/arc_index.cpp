#include "skeleton/ask/arc_index.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "linespace/work/parallel.h"

namespace sightline::internal {
namespace {

constexpr double kBoxesAnArc = 4;

// How fine the boxes may be so that there are kBoxesAnArc of them for an arc, on average:
// told from arcs evenly spaced in their order.
double fineness(const Scene& scene, const Skeleton& skeleton, const EndIndex& ends,
                const Frame& frame, std::size_t count) {
  constexpr std::size_t kSamples = 2000;
  constexpr double kStep = 0.5;
  constexpr double kFinest = kFineGrain * kFineGrain * kFineGrain;
  const std::size_t stride = std::max<std::size_t>(1, count / kSamples);
  const auto boxes_at = [&](double fine) {
    std::vector<ChartBox> found;
    std::size_t arcs = 0;
    for (std::size_t i = 0; i < count; i += stride, ++arcs) {
      viewing_boxes(scene, skeleton, ends, frame, static_cast<std::uint32_t>(i), fine,
                    found);
    }
    return static_cast<double>(found.size()) / static_cast<double>(arcs);
  };
  double fine = 1;
  while (fine > kFinest && boxes_at(fine * kStep) <= kBoxesAnArc) fine *= kStep;
  return fine;
}

// The part of a path on which all of some linear functions are not negative.
class Part {
 public:
  void keep(double at_from, double at_to) {
    if (at_from < 0 && at_to < 0) to_ = -1;
    if ((at_from < 0) == (at_to < 0)) return;
    const double t = at_from / (at_from - at_to);
    if (at_from < 0) {
      from_ = std::max(from_, t);
    } else {
      to_ = std::min(to_, t);
    }
  }
  [[nodiscard]] bool empty() const { return from_ > to_; }
  [[nodiscard]] std::array<Point, 2> of(const Point& a, const Point& b) const {
    return {from_ > 0 ? Point(a + from_ * (b - a)) : a,
            to_ < 1 ? Point(a + to_ * (b - a)) : b};
  }

 private:
  double from_ = 0, to_ = 1;
};

}  // namespace

ArcIndex::ArcIndex(const Scene& scene, const Skeleton& skeleton, const EndIndex& ends)
    : frame_(scene) {
  const std::size_t count = skeleton.arcs.size();
  if (count == 0) return;
  const double fine = fineness(scene, skeleton, ends, frame_, count);
  constexpr std::size_t kArcsAtOnce = 256;
  struct Nothing {};
  struct Found {
    std::int32_t chart;
    BoxItem item;
  };
  std::array<std::vector<BoxItem>, kCharts> items;
  StageCounts counts;
  const Request request;
  for_each_parallel(
      (count + kArcsAtOnce - 1) / kArcsAtOnce, request, Deadline(request),
      "boxes of arcs", counts, [] { return std::make_unique<Nothing>(); },
      [&](Nothing&, std::size_t batch) {
        std::vector<Found> found;
        std::vector<ChartBox> boxes;
        const std::size_t from = batch * kArcsAtOnce;
        for (std::size_t i = from; i < std::min(count, from + kArcsAtOnce); ++i) {
          boxes.clear();
          viewing_boxes(scene, skeleton, ends, frame_, static_cast<std::uint32_t>(i),
                        fine, boxes);
          for (const ChartBox& b : boxes) {
            found.push_back({b.chart, {b.box, b.slab, static_cast<std::uint32_t>(i)}});
          }
        }
        return found;
      },
      [&](std::size_t, std::vector<Found>&& found) {
        for (const Found& f : found) items[f.chart].push_back(f.item);
        return true;
      });
  for (int chart = 0; chart < kCharts; ++chart) {
    trees_[chart] = BoxTree(std::move(items[chart]));
  }
}

std::optional<std::vector<std::uint32_t>> ArcIndex::near(const Point& a,
                                                         const Point& b) const {
  // Points of the path are then off by less than 2^-30 in each chart.
  constexpr double kFar = 0x1p20;
  const Point from = frame_(a);
  const Point to = frame_(b);
  if (!(from.cwiseAbs().maxCoeff() < kFar && to.cwiseAbs().maxCoeff() < kFar)) {
    return std::nullopt;
  }
  std::vector<std::uint32_t> found;
  // A little more than the chart: the ends are rounded.
  constexpr double kCube = 1.01;
  Part within;
  for (int i = 0; i < 3; ++i) {
    within.keep(kCube - from[i], kCube - to[i]);
    within.keep(kCube + from[i], kCube + to[i]);
  }
  if (!within.empty()) {
    const auto [p, q] = within.of(from, to);
    trees_[0].meeting(p, q, found);
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool negative : {false, true}) {
      const double sigma = negative ? -1 : 1;
      Part beyond;
      beyond.keep(sigma * from[axis] - 0.99, sigma * to[axis] - 0.99);
      for (int i = 0; i < 3; ++i) {
        if (i == axis) continue;
        for (const double tau : {-1.0, 1.0}) {
          const auto in_chart = [&](const Point& x) {
            return 2 * sigma * x[axis] - tau * x[i];
          };
          beyond.keep(in_chart(from), in_chart(to));
        }
      }
      if (beyond.empty()) continue;
      auto ends = beyond.of(from, to);
      for (Point& p : ends) {
        const double front = sigma * p[axis];
        p[axis] = 1;
        p /= front;
      }
      trees_[chart_of(axis, negative)].meeting(ends[0], ends[1], found);
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::size_t ArcIndex::boxes() const {
  std::size_t sum = 0;
  for (const BoxTree& tree : trees_) sum += tree.size();
  return sum;
}

std::size_t ArcIndex::bytes() const {
  std::size_t sum = sizeof *this;
  for (const BoxTree& tree : trees_) sum += tree.bytes();
  return sum;
}

}  // namespace sightline::internal
