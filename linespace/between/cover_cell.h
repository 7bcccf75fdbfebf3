// A cell of a cover search: a part of a sight space.  A product of two smaller triangles,
// its domain, on which some forms have given signs, its path.

#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "linespace/between/sight_space.h"
#include "linespace/numbers/rational.h"

namespace sightline::internal {

struct Step {
  int form;
  std::int8_t sign;
};

/// The signs that a cell's forms have.
struct CellPath {
  std::vector<Step> steps;
  std::vector<std::int8_t> sign;  ///< per form: its sign in the cell, 0 unknown

  void make_room(std::size_t forms) { sign.resize(forms, 0); }
  void push(const Step& step) {
    sign[step.form] = step.sign;
    steps.push_back(step);
  }
  void flip_last() {
    steps.back().sign = static_cast<std::int8_t>(-steps.back().sign);
    sign[steps.back().form] = steps.back().sign;
  }
  void pop() {
    sign[steps.back().form] = 0;
    steps.pop_back();
  }
};

/// A point of a domain, by weights of its corners.
struct LocalPoint {
  Weights alpha, beta;
};

/// One corner of a triangle moved to the middle of its side to another one.
struct Halving {
  bool from;
  int moved, other;
};

/// A product of two smaller triangles, and forms restricted to it, worked out when they
/// are asked for.
struct Domain {
  struct Live {
    CornerValues at;
    std::int8_t constant;
  };
  Domain* whole = nullptr;  ///< of which this is a half; null: everything
  Halving cut{};
  std::array<Weights, 3> from, to;  ///< corners, by their weights in the whole triangles
  int halvings_from = 0, halvings_to = 0;
  [[nodiscard]] int halvings() const { return halvings_from + halvings_to; }
  std::vector<int> slots;  ///< per form: position in `live`, -1 for none
  std::vector<Live> live;
};

/// Domains of the cells from the whole space down to the one looked at, a stack.
class Domains {
 public:
  /// Keeps references.
  explicit Domains(const SightSpace& space) : space_(space) {}

  Domain& push_whole();
  Domain& push_half(Domain& whole, const Halving& cut);
  void pop() { --used_; }

  [[nodiscard]] const Domain::Live& live(Domain& d, int form) const;

  /// A form's corner values, on the scale of CornerValues; of the whole space, and of a
  /// domain.
  [[nodiscard]] const std::array<Rational, 9>& exact_values(int form);
  [[nodiscard]] std::array<Rational, 9> exact_values(Domain& d, int form);

 private:
  Domain& push();

  const SightSpace& space_;
  std::vector<std::unique_ptr<Domain>> domains_;  // the first used_
  std::size_t used_ = 0;
  std::unordered_map<int, std::array<Rational, 9>> exact_;
};

/// The form's value at a point, rounded.
[[nodiscard]] double value_at(const CornerValues& at, const Weights& alpha,
                              const Weights& beta);
/// A power of two that brings the largest magnitude into [1/2, 1).
[[nodiscard]] double normalising(const CornerValues& at);
/// The weights in the whole triangle.
[[nodiscard]] Weights mixed(const std::array<Weights, 3>& corners, const Weights& local);
/// Rounded so that the weights are multiples of 2^-52 that sum to 1 exactly; nullopt when
/// the point is not strictly inside then.
[[nodiscard]] std::optional<Weights> exact_weights(Weights w);
/// The point whose weights are sums of these over corner pairs.
[[nodiscard]] LocalPoint marginals(const std::array<double, 9>& gamma);
/// A domain's corners: rounded, and exact.
[[nodiscard]] Triangle corners(const Triangle& t, const std::array<Weights, 3>& weights);
[[nodiscard]] std::array<ExactPoint, 3> exact_corners(
    const Triangle& t, const std::array<Weights, 3>& weights);

}  // namespace sightline::internal
