// Segments of a sight space tried in batches against many occluders, in floats.
//
// Where much is visible, some random segment is free, and to find it quickly is all there
// is to do.  What comes out here is a proposal: whoever asks confirms it exactly.

#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "linespace/between/cover_search.h"
#include "linespace/between/sight_space.h"

namespace sightline::internal {

class SegmentSampler {
 public:
  SegmentSampler(const Triangle& a, const Triangle& b, std::uint64_t seed);

  /// A convex planar occluder.  Numbers count from 0 in order of adding.
  void add(std::span<const Point> corners);
  [[nodiscard]] int size() const { return static_cast<int>(polygons_.size()); }

  /// Has the last word on a segment that seems free.  May add occluders.
  using Confirm = std::function<bool(const SightPoint&)>;

  /// Up to `count` segments, evenly spread (a Kronecker sequence), until one is
  /// confirmed.  The occluders that block most are asked first.
  [[nodiscard]] std::optional<SightPoint> spread(int count, const Confirm& confirm);

  /// Up to `count` more: walks from the least blocked of the first segments, by random
  /// steps to those beside them that are not blocked by more.
  [[nodiscard]] std::optional<SightPoint> descend(int count, const Confirm& confirm);

  /// The first segments, at most 64, strictly inside.
  [[nodiscard]] std::vector<SightPoint> first() const;
  /// Occluders that block one of the first segments, those that block most first.
  [[nodiscard]] const std::vector<int>& heavy() const { return heavy_; }
  [[nodiscard]] std::int64_t tried() const { return tried_; }

  /// Segments tested at once.
  static constexpr int kBatch = 16;
  /// Of each segment: the weights of p's second and third corner, then of q's.
  using Batch = std::array<std::array<float, kBatch>, 4>;
  using Counts = std::array<std::int32_t, kBatch>;

  /// Where an occluder's linear functions start in the table, and how many sides it has.
  struct Entry {
    int first, sides;
  };

 private:
  Batch next_batch();
  Batch around(const std::array<float, 4>& at);
  float uniform();
  // One occluder blocks all that was tried, or what seems free never is.
  [[nodiscard]] bool hopeless() const;
  void weigh();
  std::optional<SightPoint> confirmed(const Batch& x, const Counts& counts,
                                      const Confirm& confirm);

  Triangle a_, b_;
  std::vector<float> functions_;
  std::vector<Entry> polygons_;
  std::vector<Entry> order_;  // those that block most first
  std::vector<int> heavy_;
  std::vector<Batch> first_;
  std::vector<Counts> first_counts_;
  std::array<std::uint32_t, 4> state_;
  std::uint64_t random_;
  std::int64_t tried_ = 0;
  bool all_blocked_by_one_ = false;
  int refused_ = 0;  // proposals in a row that were not confirmed and taught nothing
};

}  // namespace sightline::internal
