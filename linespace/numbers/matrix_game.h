// Small matrix games, solved by the simplex method in doubles and in exact numbers.
//
// A game is a list of rows of C numbers.  The column player mixes columns, gamma >= 0,
// sum 1, to make the smallest row product large; the row player mixes rows, lambda >= 0,
// sum 1, to make the largest column product small.  Both reach the same value v (von
// Neumann).  Here a row is a linear condition "row . gamma > 0": v > 0 says that all can
// hold at once, and gamma does it with the largest margin; v <= 0 that they cannot, and
// lambda proves it, for then sum_i lambda_i row_i <= 0 in every column (Gordan, Ville).

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "linespace/numbers/rational.h"

namespace sightline::internal {

/// row -= factor * other, n numbers; they must not overlap.
void subtract_multiple(double* row, const double* other, double factor, int n);

/// In doubles: the outcome is a proposal, and the caller checks lambda.  Keeps its memory
/// between games; not for sharing between threads.
template <int Columns>
class MatrixGame {
 public:
  using Row = std::array<double, Columns>;

  void clear() { rows_.clear(); }
  /// Entries must lie in [-1, 1].
  void add(const Row& row) { rows_.push_back(row); }
  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] const Row& row(std::size_t i) const { return rows_[i]; }

  /// Requires a row.  Stops as soon as lambda proves a value below `enough`, which must
  /// be in (-1, 0]; value() is then an upper bound and gamma() not meaningful.
  void solve(double enough) {
    start();
    const double last = 1 / (enough + kShift);
    while (objective_ < last) {
      const int entering = entering_column();
      if (entering < 0) break;
      const int leaving = leaving_row(entering);
      if (leaving < 0) break;  // all candidates were rounded away
      pivot(leaving, entering);
      if (--patience_ < 0) break;
    }
    finish();
  }

  [[nodiscard]] double value() const { return value_; }
  [[nodiscard]] const std::vector<double>& lambda() const { return lambda_; }
  [[nodiscard]] const Row& gamma() const { return gamma_; }

 private:
  // Rows are shifted by kShift, to [1, 3], so that the value is positive and the game is
  // the linear program  max sum x,  sum_i x_i (row_i + shift)[k] <= 1 for all k,  x >= 0
  // with v + shift = 1 / sum x, lambda = x / sum x, and gamma the dual solution, scaled.
  static constexpr int kShift = 2;
  // Entries are of order 1: smaller pivots and gains are rounding.
  static constexpr double kNoise = 0x1p-40;

  double& at(int k, int i) { return tableau_[k * stride_ + i]; }

  // Condensed tableau: constraint k in row k, the objective in row Columns; a column per
  // variable that is 0 now.  row_names_, column_names_: i is x_i, ~k the slack of k.
  void start() {
    const int m = static_cast<int>(rows_.size());
    stride_ = m;
    tableau_.resize(static_cast<std::size_t>(Columns + 1) * m);
    column_names_.resize(m);
    for (int i = 0; i < m; ++i) {
      for (int k = 0; k < Columns; ++k) at(k, i) = rows_[i][k] + kShift;
      at(Columns, i) = -1;
      column_names_[i] = i;
    }
    for (int k = 0; k < Columns; ++k) {
      bounds_[k] = 1;
      row_names_[k] = ~k;
    }
    objective_ = 0;
    patience_ = 20 * (Columns + m);
  }

  // The steepest column.
  int entering_column() {
    int best = -1;
    for (int i = 0; i < stride_; ++i) {
      const double reduced = at(Columns, i);
      if (reduced < -kNoise && (best < 0 || reduced < at(Columns, best))) best = i;
    }
    return best;
  }

  int leaving_row(int entering) {
    int best = -1;
    for (int k = 0; k < Columns; ++k) {
      if (at(k, entering) <= kNoise) continue;
      if (best < 0 || bounds_[k] * at(best, entering) < bounds_[best] * at(k, entering))
        best = k;
    }
    return best;
  }

  void pivot(int r, int e) {
    const double inverse = 1 / at(r, e);
    for (int i = 0; i < stride_; ++i) at(r, i) *= inverse;
    bounds_[r] *= inverse;
    for (int k = 0; k <= Columns; ++k) {
      if (k == r) continue;
      const double factor = at(k, e);
      if (factor == 0) continue;
      subtract_multiple(&at(k, 0), &at(r, 0), factor, stride_);
      at(k, e) = -factor * inverse;
      (k == Columns ? objective_ : bounds_[k]) -= factor * bounds_[r];
    }
    at(r, e) = inverse;
    std::swap(row_names_[r], column_names_[e]);
  }

  void finish() {
    const double scale = 1 / objective_;
    value_ = scale - kShift;
    lambda_.assign(rows_.size(), 0);
    gamma_.fill(0);
    for (int k = 0; k < Columns; ++k) {
      if (row_names_[k] >= 0 && bounds_[k] > 0)
        lambda_[row_names_[k]] = bounds_[k] * scale;
    }
    for (int i = 0; i < stride_; ++i) {
      const int name = column_names_[i];
      if (name < 0 && at(Columns, i) > 0) gamma_[~name] = at(Columns, i) * scale;
    }
  }

  std::vector<Row> rows_;
  std::vector<double> tableau_;
  std::vector<int> column_names_;
  std::array<int, Columns> row_names_{};
  std::array<double, Columns> bounds_{};
  double objective_ = 0;
  int stride_ = 0;
  int patience_ = 0;
  double value_ = 0;
  std::vector<double> lambda_;
  Row gamma_{};
};

/// The same game in exact numbers: is its value positive?  Integer pivoting (Edmonds):
/// all entries are integers over one common denominator, so that nothing is ever
/// cancelled.
template <int Columns>
class ExactMatrixGame {
 public:
  using Row = std::array<Rational, Columns>;

  void add(const Row& row) { rows_.push_back(row); }

  /// Digits of the largest entry once all are integers: what a game costs.
  [[nodiscard]] std::size_t bits() const {
    const Integer common = common_denominator();
    std::size_t largest = 0;
    for (const Row& row : rows_) {
      for (const Rational& x : row) {
        if (x == 0) continue;
        const Integer numerator_size = abs(Integer(numerator(x)));
        largest = std::max<std::size_t>(
            largest, msb(numerator_size) + msb(common) - msb(Integer(denominator(x))));
      }
    }
    return largest;
  }

  /// Requires a row.  Either lambda proves that the value is at most 0, or gamma makes
  /// all row products positive, with the largest margin on the rows' own scales.
  void solve() {
    start();
    while (objective_ * shift_ < denominator_) {
      const int entering = entering_column();
      if (entering < 0) break;
      pivot(leaving_row(entering), entering);
      ++pivots_;
    }
  }

  [[nodiscard]] bool positive() const { return objective_ * shift_ < denominator_; }

  [[nodiscard]] std::vector<Rational> lambda() const {
    std::vector<Rational> lambda(rows_.size());
    for (int k = 0; k < Columns; ++k) {
      if (row_names_[k] >= 0) lambda[row_names_[k]] = Rational(bounds_[k], objective_);
    }
    return lambda;
  }
  [[nodiscard]] Row gamma() const {
    Row gamma;
    for (std::size_t i = 0; i < column_names_.size(); ++i) {
      if (column_names_[i] < 0) {
        gamma[~column_names_[i]] = Rational(tableau_[Columns][i], objective_);
      }
    }
    return gamma;
  }

 private:
  using Integer = boost::multiprecision::number<boost::multiprecision::gmp_int,
                                                boost::multiprecision::et_off>;

  Integer common_denominator() const {
    Integer common = 1;
    for (const Row& row : rows_) {
      for (const Rational& x : row) common = lcm(common, Integer(denominator(x)));
    }
    return common;
  }

  void start() {
    const Integer common = common_denominator();
    shift_ = 1;
    for (int k = 0; k < Columns; ++k) {
      tableau_[k].clear();
      for (const Row& row : rows_) {
        tableau_[k].push_back(Integer(numerator(row[k])) *
                              (common / Integer(denominator(row[k]))));
        shift_ = std::max<Integer>(shift_, 2 * abs(tableau_[k].back()));
      }
      bounds_[k] = 1;
      row_names_[k] = ~k;
    }
    for (int k = 0; k < Columns; ++k) {
      for (Integer& x : tableau_[k]) x += shift_;
    }
    tableau_[Columns].assign(rows_.size(), Integer(-1));
    column_names_.resize(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) column_names_[i] = static_cast<int>(i);
    objective_ = 0;
    denominator_ = 1;
    pivots_ = 0;
  }

  // The steepest column; after many pivots Bland's rule, which never cycles.
  int entering_column() const {
    constexpr int kSteepest = 100;
    int best = -1;
    for (std::size_t i = 0; i < column_names_.size(); ++i) {
      const Integer& reduced = tableau_[Columns][i];
      if (reduced >= 0) continue;
      if (best < 0 ||
          (pivots_ < kSteepest ? reduced < tableau_[Columns][best]
                               : order(column_names_[i]) < order(column_names_[best])))
        best = static_cast<int>(i);
    }
    return best;
  }

  int leaving_row(int entering) const {
    int best = -1;
    for (int k = 0; k < Columns; ++k) {
      const Integer& here = tableau_[k][entering];
      if (here <= 0) continue;
      if (best >= 0) {
        const Integer a = bounds_[k] * tableau_[best][entering], b = bounds_[best] * here;
        if (a > b || (a == b && order(row_names_[k]) > order(row_names_[best]))) continue;
      }
      best = k;
    }
    return best;
  }

  [[nodiscard]] static int order(int name) { return name < 0 ? 2 * ~name + 1 : 2 * name; }

  void pivot(int r, int e) {
    const Integer p = tableau_[r][e];
    for (int k = 0; k <= Columns; ++k) {
      if (k == r) continue;
      const Integer factor = tableau_[k][e];
      for (std::size_t i = 0; i < column_names_.size(); ++i) {
        if (static_cast<int>(i) == e) continue;
        tableau_[k][i] = (p * tableau_[k][i] - factor * tableau_[r][i]) / denominator_;
      }
      Integer& bound = k == Columns ? objective_ : bounds_[k];
      bound = (p * bound - factor * bounds_[r]) / denominator_;
      tableau_[k][e] = -factor;
    }
    tableau_[r][e] = denominator_;
    denominator_ = p;
    std::swap(row_names_[r], column_names_[e]);
  }

  std::vector<Row> rows_;
  std::array<std::vector<Integer>, Columns + 1> tableau_;
  std::array<Integer, Columns> bounds_;
  std::array<int, Columns> row_names_{};
  std::vector<int> column_names_;
  Integer shift_, objective_, denominator_;
  int pivots_ = 0;
};

}  // namespace sightline::internal
