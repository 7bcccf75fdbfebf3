#include "linespace/between/emptiness.h"

#include <algorithm>
#include <cmath>

#include "linespace/between/concurrent_lines.h"
#include "linespace/numbers/matrix_game.h"
#include "linespace/numbers/predicates.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// Values of games are of order 1 and pass a few hundred roundings: below this, the exact
// game decides.
constexpr double kDoubtful = 0x1p-36;
// A proof is accepted as soon as it has a margin that rounding does not eat up.
constexpr double kEnough = -0x1p-30;
// From this many halvings on, proofs of second order are tried.
constexpr int kSecondOrder = 8;
// Exact proofs of second order with longer numbers than kLongNumbers bits wait for
// kPatience halvings: they cost up to a second.
constexpr std::size_t kLongNumbers = 128;
constexpr int kPatience = 40;

}  // namespace

class Emptiness::Proofs {
 public:
  Proofs(const SightSpace& space, const CellPath& path, Domains& domains,
         CoverWriter& writer, Precision precision, VisibilityCost& counts)
      : space_(space),
        path_(path),
        domains_(domains),
        writer_(writer),
        precision_(precision),
        counts_(counts) {}

  // Proves the cell empty and notes the proof, or gives a point to start from.
  bool first_order(Domain& d, LocalPoint& start) {
    game_.clear();
    rows_.clear();
    for (const Step& step : path_.steps) {
      const Domain::Live& f = domains_.live(d, step.form);
      if (f.constant == step.sign) continue;
      if (f.constant != 0) {  // the opposite sign, or zero everywhere
        writer_.empty({CoverShare{step.form}});
        return true;
      }
      add_rows(d, step);
    }
    if (rows_.empty()) {
      start.alpha = start.beta = {1.0 / 3, 1.0 / 3, 1.0 / 3};
      margin_ = 1;
      return false;
    }
    ++counts_.games;
    game_.solve(kEnough);
    Game::Row gamma = game_.gamma();
    if (game_.value() <= kDoubtful) {
      if (precision_ == Precision::Double) return true;
      if (proves_empty(d) || exactly_empty(d, gamma)) return true;
    }
    start = marginals(gamma);
    margin_ = game_.value();
    return false;
  }
  [[nodiscard]] double margin() const { return margin_; }

  // Three lines of the path through one point rule each other out: outlines are full of
  // such corners, and there halving never ends.
  bool at_a_corner(Domain& d) {
    constexpr std::size_t kMostTriples = 64;
    std::vector<SignedLine> lines;
    std::vector<int> forms;
    for (const Step& step : path_.steps) {
      if (space_.forms()[step.form].name.kind != FormKind::EdgeSide) continue;
      if (domains_.live(d, step.form).constant != 0) continue;
      lines.push_back({space_.points(step.form), step.sign});
      forms.push_back(step.form);
    }
    if (lines.size() < 3) return false;
    const Triangle a = corners(space_.a(), d.from), b = corners(space_.b(), d.to);
    for (const auto& [i, j, k] : concurrent_triples(lines, kMostTriples)) {
      const std::array<SignedLine, 3> triple{lines[i], lines[j], lines[k]};
      if (!may_have_concurrent_weights(triple, a, b)) continue;
      if (precision_ == Precision::Double) return true;
      const auto weights = concurrent_weights(triple, exact_corners(space_.a(), d.from),
                                              exact_corners(space_.b(), d.to));
      if (!weights) continue;
      writer_.empty(shares_of({forms[i], forms[j], forms[k]}, *weights));
      return true;
    }
    return false;
  }

  bool second_order(Domain& d) {
    if (d.halvings() < kSecondOrder) return false;
    second_game_.clear();
    rows_.clear();
    std::vector<int> forms;
    for (const Step& step : path_.steps) {
      if (domains_.live(d, step.form).constant == 0) forms.push_back(step.form);
    }
    for (std::size_t i = 0; i < forms.size(); ++i) {
      add_products_with_weights(d, forms[i]);
      for (std::size_t j = i + 1; j < forms.size(); ++j) {
        add_second_row(d, {forms[i], forms[j]});
      }
    }
    if (rows_.empty()) return false;
    ++counts_.games;
    second_game_.solve(kEnough);
    if (second_game_.value() > kDoubtful) return false;
    if (precision_ == Precision::Double) return true;
    return second_order_proof(d);
  }

 private:
  using Game = MatrixGame<9>;
  using ExactGame = ExactMatrixGame<9>;

  // ---- first order

  // Rows of the relaxation: functions that are positive in the cell, at the nine corner
  // pairs.  A path form of p alone also holds times each weight of q, which says more
  // than itself, and times each path form of q alone.
  void add_rows(Domain& d, const Step& step) {
    const Dependence depends = space_.forms()[step.form].depends;
    if (depends == Dependence::Both) return add_row(d, {step.form});
    for (std::int8_t corner = 0; corner < 3; ++corner) {
      CoverShare row{step.form};
      (depends == Dependence::From ? row.beta : row.alpha)[0] = corner;
      add_row(d, row);
    }
    if (depends == Dependence::To) return;
    for (const Step& other : path_.steps) {
      if (space_.forms()[other.form].depends == Dependence::To &&
          domains_.live(d, other.form).constant == 0)
        add_row(d, {step.form, other.form});
    }
  }

  void add_row(Domain& d, CoverShare row) {
    row.weight = normalising(domains_.live(d, row.form).at);
    if (row.other >= 0) row.weight *= normalising(domains_.live(d, row.other).at);
    Game::Row values;
    for (int i = 0; i < 9; ++i) values[i] = row_value(d, row, i).value;
    game_.add(values);
    rows_.push_back(row);
  }

  // Has corner pair i a part in the row?
  static bool in_row(const CoverShare& row, int i) {
    return (row.alpha[0] < 0 || row.alpha[0] == i / 3) &&
           (row.beta[0] < 0 || row.beta[0] == i % 3);
  }

  // Scaled, and with the path's signs.
  BoundedValue row_value(Domain& d, const CoverShare& row, int i) const {
    if (!in_row(row, i)) return {0, 0};
    const CornerValues& at = domains_.live(d, row.form).at;
    const double scale = path_.sign[row.form] * row.weight;
    if (row.other < 0) return {scale * at.value[i], row.weight * at.error[i]};
    const double x = at.value[i], dx = at.error[i];
    const CornerValues& other = domains_.live(d, row.other).at;
    const double y = other.value[i], dy = other.error[i];
    const double error = std::abs(x) * dy + dx * std::abs(y) + dx * dy;
    return {scale * path_.sign[row.other] * (x * y),
            row.weight * (error + kUnit * std::abs(x * y)) * (1 + 8 * kUnit)};
  }

  std::array<Rational, 9> exact_row(Domain& d, const CoverShare& row) {
    std::array<Rational, 9> values = domains_.exact_values(d, row.form);
    const Rational scale = Rational(row.weight) * int{path_.sign[row.form]};
    for (int i = 0; i < 9; ++i) {
      values[i] = in_row(row, i) ? Rational(values[i] * scale) : Rational(0);
    }
    if (row.other >= 0) {
      const std::array<Rational, 9> other = domains_.exact_values(d, row.other);
      for (int i = 0; i < 9; ++i) values[i] *= other[i] * int{path_.sign[row.other]};
    }
    return values;
  }

  // sum_r lambda_r row_r <= 0 in every column, for certain: by its rounded value and a
  // bound, or else by its exact one.
  bool proves_empty(Domain& d) {
    const std::vector<double>& lambda = game_.lambda();
    std::array<double, 9> sum{}, bound{};
    int rows = 0;
    for (std::size_t r = 0; r < lambda.size(); ++r) {
      if (lambda[r] == 0) continue;
      ++rows;
      for (int i = 0; i < 9; ++i) {
        const auto [value, error] = row_value(d, rows_[r], i);
        const double term = lambda[r] * value;
        sum[i] += term;
        bound[i] += lambda[r] * error + kUnit * std::abs(term);
      }
    }
    std::vector<int> open;
    for (int i = 0; i < 9; ++i) {
      // `bound` holds the rows' own errors plus kUnit times the terms' sizes: a term
      // passes 3 roundings and up to `rows` additions.
      if (!(sum[i] + (rows + 8) * bound[i] <= 0)) open.push_back(i);
    }
    if (!open.empty()) {
      if (rows > 4) return false;  // left to the exact game
      for (const int i : open) {
        if (exact_column(d, i) > 0) return false;
      }
    }
    std::vector<CoverShare> shares;
    for (std::size_t r = 0; r < lambda.size(); ++r) {
      if (lambda[r] == 0) continue;
      shares.push_back(rows_[r]);
      shares.back().weight *= lambda[r];
    }
    writer_.empty(shares);
    return true;
  }

  Rational exact_column(Domain& d, int i) {
    Rational sum = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      if (game_.lambda()[r] == 0) continue;
      sum += Rational(game_.lambda()[r]) * exact_row(d, rows_[r])[i];
    }
    return sum;
  }

  // The same question in exact numbers: first for the rows that mattered in doubles;
  // then, as long as the best gamma for these makes others fail, with those as well.
  bool exactly_empty(Domain& d, Game::Row& gamma) {
    std::vector<std::array<Rational, 9>> values;
    std::vector<int> rows, others;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      values.push_back(exact_row(d, rows_[r]));
      (game_.lambda()[r] != 0 ? rows : others).push_back(static_cast<int>(r));
    }
    while (true) {
      hear_stop_now();
      if (rows.empty()) rows.swap(others);
      ++counts_.exact_games;
      ExactGame game;
      for (const int r : rows) game.add(values[r]);
      game.solve();
      if (!game.positive()) {
        note_exactly_empty(rows, game.lambda());
        return true;
      }
      const ExactGame::Row exact = game.gamma();
      const auto failing = std::partition(others.begin(), others.end(), [&](int r) {
        Rational product = 0;
        for (int i = 0; i < 9; ++i) product += exact[i] * values[r][i];
        return product > 0;
      });
      if (failing == others.end()) {
        for (int i = 0; i < 9; ++i) gamma[i] = static_cast<double>(exact[i]);
        return false;
      }
      rows.insert(rows.end(), failing, others.end());
      others.erase(failing, others.end());
    }
  }

  // rows: positions in rows_.
  void note_exactly_empty(const std::vector<int>& rows,
                          const std::vector<Rational>& lambda) {
    if (!writer_.keeps()) return;
    std::vector<CoverShare> shares;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (lambda[i] == 0) continue;
      CoverShare share = rows_[rows[i]];
      const Rational weight = lambda[i] * Rational(share.weight);
      share.weight = static_cast<double>(weight);
      share.exact = writer_.exact_weight(weight);
      shares.push_back(share);
    }
    writer_.empty(shares);
  }

  // ---- second order

  // Where edges of several blockers meet in a point, or lie in a plane, all lines through
  // that point, or in that plane, are limits of lines that nearly pass: whole families of
  // them, of which no product of triangles can hold only one.  Constant factors cannot
  // rule such a cell out, but factors that vary linearly with p and with q can (for three
  // lines through one point they are those of Cramer's rule).  So the path forms are
  // multiplied by each corner's weights and by each other, which gives polynomials of
  // degree 2 in alpha and in beta, and the same game is played on their 36 coefficients.
  using SecondGame = MatrixGame<36>;
  using ExactSecondGame = ExactMatrixGame<36>;

  void add_products_with_weights(Domain& d, int form) {
    const Dependence depends = space_.forms()[form].depends;
    for (std::int8_t j = 0; j < 3; ++j) {
      for (std::int8_t k = 0; k < 3; ++k) {
        if (depends == Dependence::Both) {
          add_second_row(d, {form, -1, {j, -1}, {k, -1}});
          continue;
        }
        // Degree 1 in one of the weights, 0 in the other.
        for (std::int8_t l = k; l < 3; ++l) {
          if (depends == Dependence::From) {
            add_second_row(d, {form, -1, {j, -1}, {k, l}});
          } else {
            add_second_row(d, {form, -1, {k, l}, {j, -1}});
          }
        }
      }
    }
  }

  // Position of w_i w_j among the six products.
  static int pair_index(int i, int j) {
    constexpr int kIndex[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    return kIndex[i][j];
  }

  // sum over the 36 monomials; `value(form, i)` is sign * form at corner pair i.
  template <class T, class Value>
  std::array<T, 36> coefficients(const CoverShare& row, const T& scale,
                                 Value value) const {
    std::array<T, 36> out{};
    const auto add = [&](int j, int j2, int k, int k2, const T& x) {
      out[6 * pair_index(j, j2) + pair_index(k, k2)] += x * scale;
    };
    for (int i = 0; i < 9; ++i) {
      const int j = i / 3, k = i % 3;
      if (row.other >= 0) {
        for (int i2 = 0; i2 < 9; ++i2) {
          add(j, i2 / 3, k, i2 % 3, value(row.form, i) * value(row.other, i2));
        }
      } else if (row.alpha[1] >= 0) {  // of q alone, times two weights of p
        if (j == 0) add(row.alpha[0], row.alpha[1], k, row.beta[0], value(row.form, i));
      } else if (row.beta[1] >= 0) {
        if (k == 0) add(j, row.alpha[0], row.beta[0], row.beta[1], value(row.form, i));
      } else {
        add(j, row.alpha[0], k, row.beta[0], value(row.form, i));
      }
    }
    return out;
  }

  void add_second_row(Domain& d, CoverShare row) {
    row.weight = normalising(domains_.live(d, row.form).at);
    if (row.other >= 0) row.weight *= normalising(domains_.live(d, row.other).at) / 16;
    second_game_.add(coefficients(row, row.weight, [&](int form, int i) {
      return path_.sign[form] * domains_.live(d, form).at.value[i];
    }));
    rows_.push_back(row);
  }

  bool bounded_second_order_proof(Domain& d, const std::vector<int>& rows) {
    std::array<double, 36> sum{}, size{}, bound{};
    for (const int r : rows) {
      const CoverShare& row = rows_[r];
      const double factor = second_game_.lambda()[r] * row.weight;
      const auto plain = coefficients(row, factor, [&](int form, int i) {
        return path_.sign[form] * domains_.live(d, form).at.value[i];
      });
      const auto sizes = coefficients(row, factor, [&](int form, int i) {
        return std::abs(domains_.live(d, form).at.value[i]);
      });
      const auto widened = coefficients(row, factor, [&](int form, int i) {
        const CornerValues& at = domains_.live(d, form).at;
        return std::abs(at.value[i]) + at.error[i];
      });
      for (int i = 0; i < 36; ++i) {
        sum[i] += plain[i];
        bound[i] += widened[i] - sizes[i];
        size[i] += widened[i];
      }
    }
    // A term passes 4 roundings, at most 4 additions in its row and one per row; so do
    // those of the bound.
    const double roundings = 4 * static_cast<double>(rows.size() + 16) * kUnit;
    for (int i = 0; i < 36; ++i) {
      if (!(sum[i] + bound[i] + roundings * size[i] <= 0)) return false;
    }
    std::vector<CoverShare> shares;
    for (const int r : rows) {
      shares.push_back(rows_[r]);
      shares.back().weight *= second_game_.lambda()[r];
    }
    writer_.empty(shares);
    return true;
  }

  // With a margin, rounded sums and a bound prove it; where edges meet, proofs are tight
  // and are sought again in exact numbers, among the rows that mattered.
  bool second_order_proof(Domain& d) {
    std::vector<int> rows;
    const std::vector<double>& lambda = second_game_.lambda();
    for (std::size_t r = 0; r < lambda.size(); ++r) {
      if (lambda[r] > kDoubtful) rows.push_back(static_cast<int>(r));
    }
    if (rows.empty()) return false;
    if (bounded_second_order_proof(d, rows)) return true;
    // Long numbers are rarely tight: halving will do, and is cheaper.
    const bool patient = d.halvings() < kPatience;
    if (patient && std::ranges::any_of(rows, [&](int r) {
          return digits(rows_[r].form) > kLongNumbers;
        })) {
      return false;
    }
    std::unordered_map<int, std::array<Rational, 9>> values;
    ExactSecondGame game;
    for (const int r : rows) {
      const CoverShare& row = rows_[r];
      for (const int form : {row.form, row.other}) {
        if (form >= 0 && !values.contains(form))
          values[form] = domains_.exact_values(d, form);
      }
      game.add(coefficients(row, Rational(row.weight), [&](int form, int i) {
        return Rational(values[form][i] * int{path_.sign[form]});
      }));
    }
    if (patient && game.bits() > kLongNumbers) return false;
    ++counts_.exact_games;
    game.solve();
    if (game.positive()) return false;
    note_exactly_empty(rows, game.lambda());
    return true;
  }

  // Of the largest numerator among the form's values.
  std::size_t digits(int form) {
    using Integer = boost::multiprecision::mpz_int;
    std::size_t most = 0;
    for (const Rational& x : domains_.exact_values(form)) {
      const Integer size = abs(Integer(numerator(x)));
      if (size != 0) most = std::max<std::size_t>(most, msb(size));
    }
    return most;
  }

  // Weights of unscaled forms at corner pairs.
  std::vector<CoverShare> shares_of(
      const std::array<int, 3>& forms,
      const std::array<std::array<Rational, 9>, 3>& weights) {
    std::vector<CoverShare> shares;
    if (!writer_.keeps()) return shares;
    for (int i = 0; i < 3; ++i) {
      for (std::int8_t n = 0; n < 9; ++n) {
        if (weights[i][n] == 0) continue;
        CoverShare share{forms[i],
                         -1,
                         {static_cast<std::int8_t>(n / 3), -1},
                         {static_cast<std::int8_t>(n % 3), -1}};
        Rational weight = weights[i][n];
        scale(weight, space_.exponent(forms[i]));
        share.exact = writer_.exact_weight(weight);
        shares.push_back(share);
      }
    }
    return shares;
  }

  const SightSpace& space_;
  const CellPath& path_;
  Domains& domains_;
  CoverWriter& writer_;
  Precision precision_;
  VisibilityCost& counts_;
  double margin_ = 0;
  Game game_;
  SecondGame second_game_;
  std::vector<CoverShare> rows_;
};

Emptiness::Emptiness(const SightSpace& space, const CellPath& path, Domains& domains,
                     CoverWriter& writer, Precision precision, VisibilityCost& counts)
    : proofs_(std::make_unique<Proofs>(space, path, domains, writer, precision, counts)) {
}
Emptiness::~Emptiness() = default;
bool Emptiness::first_order(Domain& d, LocalPoint& start) {
  return proofs_->first_order(d, start);
}
double Emptiness::margin() const { return proofs_->margin(); }
bool Emptiness::at_a_corner(Domain& d) { return proofs_->at_a_corner(d); }
bool Emptiness::second_order(Domain& d) { return proofs_->second_order(d); }

}  // namespace sightline::internal
