// Cells of an arrangement by their sign vectors: on which side of each surface they lie.

#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace sightline::internal {

/// Sign vectors of one length, each with a number, in the order in which they came.
class SignTable {
 public:
  using Word = std::uint64_t;

  explicit SignTable(int surfaces) : words_((surfaces + 63) / 64), slots_(64, -1) {}

  [[nodiscard]] int words() const { return words_; }
  [[nodiscard]] int size() const { return static_cast<int>(signs_.size()) / words_; }
  /// Bit i of it is set where the cell lies on the positive side of surface i.
  [[nodiscard]] std::span<const Word> signs(int cell) const {
    return {signs_.data() + static_cast<std::ptrdiff_t>(cell) * words_,
            static_cast<std::size_t>(words_)};
  }
  [[nodiscard]] bool positive(int cell, int surface) const {
    return (signs(cell)[surface / 64] >> (surface % 64) & 1) != 0;
  }

  static void set(std::vector<Word>& signs, int surface, bool positive) {
    const Word bit = Word{1} << (surface % 64);
    Word& word = signs[surface / 64];
    word = positive ? word | bit : word & ~bit;
  }

  /// The number of that sign vector, which becomes the next one when it is new.
  int number_of(std::span<const Word> signs) {
    if (2 * static_cast<std::size_t>(size()) >= slots_.size()) grow();
    int& slot = slots_[slot_of(signs)];
    if (slot < 0) {
      slot = size();
      signs_.insert(signs_.end(), signs.begin(), signs.end());
    }
    return slot;
  }
  /// Sets the sign of one surface and gives the number of the vector.
  int number_with(std::vector<Word>& signs, int surface, bool positive) {
    set(signs, surface, positive);
    return number_of(signs);
  }

 private:
  // Where it is, or the free place where it belongs.
  [[nodiscard]] std::size_t slot_of(std::span<const Word> signs) const {
    Word hash = 0x9E3779B97F4A7C15u;
    for (const Word w : signs) {
      hash ^= w;
      hash *= 0xBF58476D1CE4E5B9u;
      hash ^= hash >> 31;
    }
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = hash & mask;
    while (slots_[at] >= 0 && !std::ranges::equal(this->signs(slots_[at]), signs))
      at = (at + 1) & mask;
    return at;
  }
  void grow() {
    slots_.assign(4 * slots_.size(), -1);
    for (int cell = 0; cell < size(); ++cell) slots_[slot_of(signs(cell))] = cell;
  }

  int words_;
  std::vector<Word> signs_;
  std::vector<int> slots_;  // of an open hash table, a power of two
};

}  // namespace sightline::internal
