#include "linespace/between/segment_sampler.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "linespace/numbers/cpu_dispatch.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

constexpr int kBatch = SegmentSampler::kBatch;
using Batch = SegmentSampler::Batch;
using Counts = SegmentSampler::Counts;
using Entry = SegmentSampler::Entry;

// Weights are multiples of 2^-24: exact as floats, and so is 1 minus two of them.
constexpr float kGrid = 0x1p24F;
// Segments whose blockers are all counted: they say which occluders block most, and where
// to start walking.
constexpr int kCounted = 256;
// Of these, the ones that are weighed and handed on.
constexpr int kFirst = 64;
constexpr int kMostRefused = 64;
constexpr int kNoLimit = std::numeric_limits<int>::max();

/// How many of the occluders block each segment; given up when all have more than
/// `limit`.
///
/// The occluder's plane has the values dp and dq at p and q, of opposite signs where the
/// segment crosses it, and one of its sides, positive inside, ep and eq: at the crossing
/// (ep dq - eq dp) / (dq - dp).
SIGHTLINE_WIDE_VECTORS void count_blockers(const float* functions, const Entry* entries,
                                           int n, const Batch& x, int limit,
                                           Counts& counts) {
  alignas(64) float dp[kBatch], dq[kBatch], inside[kBatch];
  alignas(64) float p1[kBatch], p2[kBatch], q1[kBatch], q2[kBatch];
  alignas(64) std::int32_t count[kBatch];
  for (int i = 0; i < kBatch; ++i) {
    p1[i] = x[0][i];
    p2[i] = x[1][i];
    q1[i] = x[2][i];
    q2[i] = x[3][i];
    count[i] = 0;
  }
  for (int k = 0; k < n; ++k) {
    const float* f = functions + entries[k].first;
    for (int i = 0; i < kBatch; ++i) {
      dp[i] = f[0] + f[1] * p1[i] + f[2] * p2[i];
      dq[i] = f[3] + f[4] * q1[i] + f[5] * q2[i];
      inside[i] = -dp[i] * dq[i];
    }
    for (int side = 0; side < entries[k].sides; ++side) {
      f += 6;
      for (int i = 0; i < kBatch; ++i) {
        const float ep = f[0] + f[1] * p1[i] + f[2] * p2[i];
        const float eq = f[3] + f[4] * q1[i] + f[5] * q2[i];
        const float at = (ep * dq[i] - eq * dp[i]) * dq[i];
        inside[i] = at < inside[i] ? at : inside[i];
      }
    }
    std::int32_t least = count[0] + 1;
    for (int i = 0; i < kBatch; ++i) {
      // As integers, which compilers compare side by side: positive floats are positive.
      count[i] += std::bit_cast<std::int32_t>(inside[i]) > 0 ? 1 : 0;
    }
    for (int i = 0; i < kBatch; ++i) least = count[i] < least ? count[i] : least;
    if (least > limit) break;
  }
  for (int i = 0; i < kBatch; ++i) counts[i] = count[i];
}

std::optional<SightPoint> segment(const Batch& x, int i) {
  const auto weights = [](double s, double t) -> Weights { return {(1 - s) - t, s, t}; };
  const SightPoint point{weights(x[0][i], x[1][i]), weights(x[2][i], x[3][i])};
  for (const Weights& w : {point.alpha, point.beta}) {
    if (w[0] <= 0 || w[1] <= 0 || w[2] <= 0) return std::nullopt;
  }
  return point;
}

}  // namespace

SegmentSampler::SegmentSampler(const Triangle& a, const Triangle& b, std::uint64_t seed)
    : a_(a), b_(b), random_(seed * 0x9e3779b97f4a7c15 + 0x2545f4914f6cdd1d) {
  for (int i = 0; i < 4; ++i) {
    state_[i] = static_cast<std::uint32_t>(random_ >> (8 * i));
  }
}

void SegmentSampler::add(std::span<const Point> c) {
  const int n = static_cast<int>(c.size());
  const Entry entry{static_cast<int>(functions_.size()), n};
  Point normal = Point::Zero();
  for (int i = 2; i < n; ++i) normal += (c[i - 1] - c[0]).cross(c[i] - c[0]);
  normal.normalize();
  // The function direction . (x - origin), by its value at a corner and its steps to the
  // other two; of p, then of q.
  const auto store = [&](const Point& direction, const Point& origin) {
    for (const Triangle* t : {&a_, &b_}) {
      functions_.push_back(static_cast<float>(direction.dot((*t)[0] - origin)));
      functions_.push_back(static_cast<float>(direction.dot((*t)[1] - (*t)[0])));
      functions_.push_back(static_cast<float>(direction.dot((*t)[2] - (*t)[0])));
    }
  };
  store(normal, c[0]);
  for (int i = 0; i < n; ++i) store(normal.cross(c[(i + 1) % n] - c[i]), c[i]);
  polygons_.push_back(entry);
  order_.insert(order_.begin(), entry);
}

// A step of the sequence is the fractional part of powers of 1 / g, g^5 = g + 1, in units
// of 2^-32 (Roberts 2018: the golden ratio in four dimensions).
SegmentSampler::Batch SegmentSampler::next_batch() {
  constexpr std::array<std::uint32_t, 4> kSteps{3679390609U, 3152041523U, 2700274806U,
                                                2313257605U};
  Batch x;
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i < kBatch; ++i) {
      x[k][i] = static_cast<float>(state_[k] >> 8) / kGrid;
      state_[k] += kSteps[k];
    }
  }
  for (const int k : {0, 2}) {
    for (int i = 0; i < kBatch; ++i) {
      const bool fold = x[k][i] + x[k + 1][i] > 1;
      x[k][i] = fold ? 1 - x[k][i] : x[k][i];
      x[k + 1][i] = fold ? 1 - x[k + 1][i] : x[k + 1][i];
    }
  }
  tried_ += kBatch;
  return x;
}

std::optional<SightPoint> SegmentSampler::confirmed(const Batch& x, const Counts& counts,
                                                    const Confirm& confirm) {
  for (int i = 0; i < kBatch && refused_ < kMostRefused; ++i) {
    if (counts[i] != 0) continue;
    const std::optional<SightPoint> s = segment(x, i);
    if (!s) continue;
    const int known = size();
    if (confirm(*s)) return s;
    if (size() > known) {
      // The rest of the batch was tested without what was found.
      refused_ = 0;
      return std::nullopt;
    }
    ++refused_;
  }
  return std::nullopt;
}

bool SegmentSampler::hopeless() const {
  return all_blocked_by_one_ || refused_ >= kMostRefused;
}

std::optional<SightPoint> SegmentSampler::spread(int count, const Confirm& confirm) {
  for (int done = 0; done < count && !hopeless(); done += kBatch) {
    hear_stop_now();
    const Batch x = next_batch();
    Counts counts;
    const bool counted = done < kCounted;
    count_blockers(functions_.data(), order_.data(), size(), x, counted ? kNoLimit : 0,
                   counts);
    if (counted) {
      first_.push_back(x);
      first_counts_.push_back(counts);
    }
    if (auto s = confirmed(x, counts, confirm)) return s;
    if (done + kBatch == std::min(kFirst, (count + kBatch - 1) / kBatch * kBatch))
      weigh();
  }
  return std::nullopt;
}

void SegmentSampler::weigh() {
  std::vector<std::pair<int, int>> blocked;
  for (int k = 0; k < size(); ++k) {
    int sum = 0;
    for (const Batch& x : first_) {
      Counts counts;
      count_blockers(functions_.data(), &polygons_[k], 1, x, kNoLimit, counts);
      for (const std::int32_t c : counts) sum += c;
    }
    blocked.emplace_back(-sum, k);
  }
  std::ranges::sort(blocked);
  all_blocked_by_one_ =
      first_.size() * kBatch == kFirst && !blocked.empty() && blocked[0].first == -kFirst;
  heavy_.clear();
  for (std::size_t i = 0; i < blocked.size(); ++i) {
    order_[i] = polygons_[blocked[i].second];
    if (blocked[i].first < 0) heavy_.push_back(blocked[i].second);
  }
}

// In [-1, 1]; xorshift.
float SegmentSampler::uniform() {
  random_ ^= random_ << 13;
  random_ ^= random_ >> 7;
  random_ ^= random_ << 17;
  return static_cast<float>(static_cast<std::int32_t>(random_ >> 32)) * 0x1p-31F;
}

// Steps of all sizes from 1/4 to 1/128; an end that would leave its triangle stays.
SegmentSampler::Batch SegmentSampler::around(const std::array<float, 4>& at) {
  static constexpr std::array<float, 8> kReach{0x1p-2F, 0x1p-2F, 0x1p-3F, 0x1p-4F,
                                               0x1p-5F, 0x1p-5F, 0x1p-6F, 0x1p-7F};
  Batch x;
  for (int i = 0; i < kBatch; ++i) {
    for (int k = 0; k < 4; ++k) {
      x[k][i] = std::nearbyint((at[k] + kReach[i % 8] * uniform()) * kGrid) / kGrid;
    }
    for (const int k : {0, 2}) {
      if (x[k][i] <= 0 || x[k + 1][i] <= 0 || x[k][i] + x[k + 1][i] >= 1) {
        x[k][i] = at[k];
        x[k + 1][i] = at[k + 1];
      }
    }
  }
  tried_ += kBatch;
  return x;
}

std::optional<SightPoint> SegmentSampler::descend(int count, const Confirm& confirm) {
  constexpr int kRounds = 16;
  struct Start {
    int blockers;
    std::array<float, 4> at;
  };
  std::vector<Start> starts;
  for (std::size_t b = 0; b < first_.size(); ++b) {
    for (int i = 0; i < kBatch; ++i) {
      const Batch& x = first_[b];
      starts.push_back({first_counts_[b][i], {x[0][i], x[1][i], x[2][i], x[3][i]}});
    }
  }
  std::ranges::stable_sort(starts, {}, &Start::blockers);
  starts.resize(std::min<std::size_t>(starts.size(), count / (kRounds * kBatch)));
  for (auto& [best, at] : starts) {
    for (int round = 0; round < kRounds && !hopeless(); ++round) {
      hear_stop_now();
      const Batch x = around(at);
      Counts counts;
      count_blockers(functions_.data(), order_.data(), size(), x, best, counts);
      if (auto s = confirmed(x, counts, confirm)) return s;
      const int lane =
          static_cast<int>(std::ranges::min_element(counts) - counts.begin());
      if (counts[lane] <= best) {  // sideways too
        best = counts[lane];
        for (int k = 0; k < 4; ++k) at[k] = x[k][lane];
      }
    }
  }
  return std::nullopt;
}

std::vector<SightPoint> SegmentSampler::first() const {
  std::vector<SightPoint> points;
  for (const Batch& x : first_) {
    for (int i = 0; i < kBatch && points.size() < kFirst; ++i) {
      if (const auto s = segment(x, i)) points.push_back(*s);
    }
  }
  return points;
}

}  // namespace sightline::internal
