// One pair of sides: what it exchanges, and whether that is exactly nothing.

#pragma once

#include <vector>

#include "shadows/factors/exchange_area.h"
#include "shadows/factors/pair_blockers.h"
#include "shadows/hiding/sender_parts.h"

namespace sightline::internal {

struct PairCounts {
  std::int64_t pairs = 0, open = 0, partial = 0, decided = 0, evaluations = 0;
};

/// Scratch, one a thread; keeps a reference to the blockers.
class PairFactor {
 public:
  explicit PairFactor(const PairBlockers& blockers) : blockers_(blockers) {}

  /// Of two sides that face each other.  0 iff nothing of one sees anything of the other,
  /// decided exactly where all of both lies before the other's plane.
  [[nodiscard]] ExchangeArea of(const SenderPart& from, const PreparedSide& b,
                                double tolerance);
  /// Of what a sends to b, the part that rises along `up`.
  [[nodiscard]] ExchangeArea rising(const SenderPart& from, const PreparedSide& b,
                                    const Eigen::Vector3d& up, double tolerance);
  [[nodiscard]] const PairCounts& counts() const { return counts_; }

 private:
  /// How often a pair may be cut in two where a crowd stands between.
  static constexpr int kMostCuts = 12;

  /// Of a pair that is partly hidden by between_, which is changed.  In a crowd of
  /// blockers, the sum over halves of the larger one.
  ExchangeArea among_blockers(const PreparedSide& a, const PreparedSide& b,
                              const std::vector<char>& hidden, double tolerance,
                              int cuts);
  void decide(const PreparedSide& a, const PreparedSide& b, ExchangeArea& sum);

  const PairBlockers& blockers_;
  std::vector<int> between_;
  std::vector<std::span<const Point>> polygons_;
  PairCounts counts_;
};

}  // namespace sightline::internal
