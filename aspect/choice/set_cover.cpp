#include "aspect/choice/set_cover.h"

#include <algorithm>
#include <boost/dynamic_bitset.hpp>

#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

using Bits = boost::dynamic_bitset<>;

class Search {
 public:
  Search(const std::vector<std::vector<int>>& sets, int elements, int lower,
         std::size_t most_steps)
      : holders_(elements), lower_(lower), most_steps_(most_steps) {
    for (const auto& s : sets) {
      Bits& bits = sets_.emplace_back(elements);
      for (const int e : s) bits.set(e);
    }
    drop_dominated();
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const Bits& bits = sets_[order_[i]];
      for (std::size_t e = bits.find_first(); e != Bits::npos; e = bits.find_next(e))
        holders_[e].push_back(order_[i]);
    }
    for (int e = 0; e < elements; ++e) {
      Bits& bits = together_.emplace_back(elements);
      for (const int s : holders_[e]) bits |= sets_[s];
      lonely_.push_back(e);
    }
    std::ranges::stable_sort(lonely_, {}, [&](int e) { return together_[e].count(); });
  }

  SetCover run() {
    greedy();
    std::vector<int> chosen;
    Bits left(holders_.size());
    left.set();
    branch(left, chosen);
    best_.steps = steps_;
    best_.finished = static_cast<int>(best_.sets.size()) <= lower_ || !stopped_;
    std::ranges::sort(best_.sets);
    return best_;
  }

 private:
  // Largest first; of sets within others nothing is kept.
  void drop_dominated() {
    std::vector<int> by_size(sets_.size());
    for (std::size_t i = 0; i < by_size.size(); ++i) by_size[i] = static_cast<int>(i);
    std::ranges::stable_sort(
        by_size, [&](int a, int b) { return sets_[a].count() > sets_[b].count(); });
    for (const int s : by_size) {
      hear_stop();
      const bool within = std::ranges::any_of(
          order_, [&](int larger) { return sets_[s].is_subset_of(sets_[larger]); });
      if (!within) order_.push_back(s);
    }
  }

  void greedy() {
    Bits left(holders_.size());
    left.set();
    while (left.any()) {
      const int s = *std::ranges::max_element(
          order_, {}, [&](int i) { return (sets_[i] & left).count(); });
      best_.sets.push_back(s);
      left -= sets_[s];
    }
  }

  // Elements no two of which one set holds: first those that share sets with fewest.
  [[nodiscard]] int apart(Bits left) const {
    int count = 0;
    for (const int e : lonely_) {
      if (!left.test(e)) continue;
      left -= together_[e];
      ++count;
    }
    return count;
  }

  void branch(const Bits& left, std::vector<int>& chosen) {
    if (left.none()) {
      if (chosen.size() < best_.sets.size()) best_.sets = chosen;
      return;
    }
    if (static_cast<int>(best_.sets.size()) <= lower_ || stopped_) return;
    if (++steps_ > most_steps_) {
      stopped_ = true;
      return;
    }
    hear_stop();
    if (chosen.size() + apart(left) >= best_.sets.size()) return;
    std::size_t rarest = left.find_first();
    for (std::size_t e = rarest; e != Bits::npos; e = left.find_next(e)) {
      if (holders_[e].size() < holders_[rarest].size()) rarest = e;
    }
    std::vector<int> holders = holders_[rarest];
    std::ranges::stable_sort(holders, std::greater{},
                             [&](int s) { return (sets_[s] & left).count(); });
    for (const int s : holders) {
      chosen.push_back(s);
      branch(left - sets_[s], chosen);
      chosen.pop_back();
    }
  }

  std::vector<Bits> sets_;
  std::vector<int> order_;                 // sets that no other holds, largest first
  std::vector<std::vector<int>> holders_;  // of each element
  std::vector<Bits> together_;             // with each element in some set
  std::vector<int> lonely_;                // elements, those together with few first
  int lower_;
  std::size_t most_steps_, steps_ = 0;
  bool stopped_ = false;
  SetCover best_;
};

}  // namespace

SetCover least_cover(std::vector<std::vector<int>> sets, int elements, int lower,
                     std::size_t most_steps) {
  return Search(sets, elements, lower, most_steps).run();
}

}  // namespace sightline::internal
