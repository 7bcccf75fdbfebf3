#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "linespace/concurrent_lines_internal.h"
#include "linespace/cover_search_internal.h"
#include "linespace/exact_numbers_internal.h"
#include "linespace/matrix_game_internal.h"

namespace sightline::internal {
namespace {

// Samples that are remembered, with what blocks them, to choose blockers by.
constexpr int kPool = 64;
using Bits = std::uint64_t;

// Values of games are of order 1 and pass a few hundred roundings: below this, the exact
// game decides.
constexpr double kDoubtful = 0x1p-36;
// A proof is accepted as soon as it has a margin that rounding does not eat up.
constexpr double kEnough = -0x1p-30;
// From this many halvings on, a cell with no segment to be found may well lie within one
// blocker.
constexpr int kSmall = 6;
// From this many halvings on, proofs of second order are tried.
constexpr int kSecondOrder = 8;
// Exact proofs of second order with longer numbers than kLongNumbers bits wait for
// kPatience halvings: they cost up to a second.
constexpr std::size_t kLongNumbers = 128;
constexpr int kPatience = 40;
// Weights of corners are multiples of 2^-halvings, and so exact in doubles.
constexpr int kMostHalvings = 50;

/// One corner of a triangle moved to the middle of its side to another one.
struct Halving {
  bool from;
  int moved, other;
};

/// A product of two smaller triangles: forms restricted to it, and the blockers that may
/// still block something there; both worked out when they are asked for.
struct Domain {
  struct Live {
    CornerValues at;
    std::int8_t constant;
  };
  Domain* whole = nullptr;  ///< of which this is a half; null: everything
  Halving cut{};
  std::array<Weights, 3> from, to;  ///< corners, by their weights in the whole triangles
  int halvings_from = 0, halvings_to = 0;
  std::size_t path_size = 0;  ///< of the cell it was made for
  std::vector<int> slots;     ///< per form: position in `live`, -1 for none
  std::vector<Live> live;
  std::vector<int> blockers;
  std::size_t blockers_known = 0;  ///< of those of the whole
};

std::int8_t certain_constant(const CornerValues& at) {
  const bool up = at.certainly(1), down = at.certainly(-1);
  return static_cast<std::int8_t>(up && down ? 2 : up ? 1 : down ? -1 : 0);
}

double value_at(const CornerValues& at, const Weights& alpha, const Weights& beta) {
  double sum = 0;
  for (int j = 0; j < 3; ++j) {
    sum += alpha[j] * (at.value[3 * j] * beta[0] + at.value[3 * j + 1] * beta[1] +
                       at.value[3 * j + 2] * beta[2]);
  }
  return sum;
}

// Times a power of two: the largest magnitude in [1/2, 1).
double normalising(const CornerValues& at) {
  double largest = 0;
  for (const double v : at.value) largest = std::max(largest, std::abs(v));
  if (largest == 0) return 1;
  int exponent;
  std::frexp(largest, &exponent);
  return std::ldexp(1.0, -exponent);
}

Weights mixed(const std::array<Weights, 3>& corners, const Weights& local) {
  Weights whole{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) whole[i] += local[j] * corners[j][i];
  }
  return whole;
}

// Rounded so that the weights are multiples of 2^-52 that sum to 1 exactly; nullopt when
// the point is not strictly inside then.
std::optional<Weights> exact_weights(Weights w) {
  constexpr double kScale = 0x1p52;
  w[0] = std::nearbyint(w[0] * kScale) / kScale;
  w[1] = std::nearbyint(w[1] * kScale) / kScale;
  w[2] = (1 - w[0]) - w[1];
  if (w[0] <= 0 || w[1] <= 0 || w[2] <= 0) return std::nullopt;
  return w;
}

class Search {
 public:
  Search(SightSpace& space, const SearchTerms& terms)
      : space_(space), terms_(terms), pool_(terms.pool) {
    if (pool_.size() > kPool) pool_.resize(kPool);
  }

  SearchResult run() {
    const bool free = !covered_by_one() && search();
    SearchResult result;
    result.counts = counts_;
    result.outcome = free                    ? SearchOutcome::Free
                     : counts_.undecided > 0 ? SearchOutcome::Undecided
                                             : SearchOutcome::Covered;
    if (free) result.segment = found_;
    if (result.outcome == SearchOutcome::Covered) result.cover = std::move(cover_);
    return result;
  }

 private:
  struct Step {
    int form;
    std::int8_t sign;
  };
  struct LocalPoint {
    Weights alpha, beta;
  };
  using Game = MatrixGame<9>;
  using ExactGame = ExactMatrixGame<9>;

  bool covered_by_one() {
    for (std::size_t b = 0; b < space_.blockers().size(); ++b) {
      if (space_.blockers()[b].count > 0) continue;
      sign_.resize(space_.forms().size(), 0);
      emit_blocked(static_cast<int>(b));
      return true;
    }
    return false;
  }

  Weights random_weights() {
    double s = std::ldexp(static_cast<double>(random_() >> 12), -52);
    double t = std::ldexp(static_cast<double>(random_() >> 12), -52);
    if (s + t > 1) {
      s = 1 - s;
      t = 1 - t;
    }
    return {(1 - s) - t, s, t};
  }

  bool confirmed(const SightPoint& s) {
    if (terms_.confirm && !terms_.confirm(s)) return false;
    found_ = s;
    return true;
  }

  // ---- the pool
  // ------------------------------------------------------------------------

  // positive_[f]: the samples at which form f is positive; blocked_[b]: those that
  // blocker b blocks.  Hints only: rounded.
  void index_pool() {
    for (std::size_t f = positive_.size(); f < space_.forms().size(); ++f) {
      Bits bits = 0;
      for (std::size_t n = 0; n < pool_.size(); ++n) {
        if (value_at(space_.forms()[f].at, pool_[n].alpha, pool_[n].beta) > 0)
          bits |= Bits{1} << n;
      }
      positive_.push_back(bits);
    }
    for (std::size_t b = blocked_.size(); b < space_.blockers().size(); ++b) {
      Bits bits = whole_pool();
      for (const auto& [form, sign] : space_.parts(space_.blockers()[b]))
        bits &= side(form, sign);
      blocked_.push_back(bits);
    }
    sign_.resize(space_.forms().size(), 0);
    position_.resize(space_.forms().size(), 0);
  }
  [[nodiscard]] Bits whole_pool() const {
    return pool_.size() == kPool ? ~Bits{0} : (Bits{1} << pool_.size()) - 1;
  }
  [[nodiscard]] Bits side(int form, int sign) const {
    return sign > 0 ? positive_[form] : ~positive_[form];
  }

  // ---- domains
  // -------------------------------------------------------------------------

  Domain& new_domain() {
    if (domains_used_ == domains_.size()) domains_.push_back(std::make_unique<Domain>());
    Domain& d = *domains_[domains_used_++];
    d.slots.assign(space_.forms().size(), -1);
    d.live.clear();
    d.blockers.clear();
    d.blockers_known = 0;
    d.path_size = path_.size();
    return d;
  }

  Domain& whole_domain() {
    Domain& d = new_domain();
    d.from = d.to = {Weights{1, 0, 0}, Weights{0, 1, 0}, Weights{0, 0, 1}};
    return d;
  }

  Domain& half(Domain& whole, const Halving& cut) {
    Domain& d = new_domain();
    d.whole = &whole;
    d.cut = cut;
    d.from = whole.from;
    d.to = whole.to;
    d.halvings_from = whole.halvings_from + (cut.from ? 1 : 0);
    d.halvings_to = whole.halvings_to + (cut.from ? 0 : 1);
    auto& corners = cut.from ? d.from : d.to;
    for (int i = 0; i < 3; ++i) {
      corners[cut.moved][i] = (corners[cut.moved][i] + corners[cut.other][i]) / 2;
    }
    return d;
  }

  const Domain::Live& live(Domain& d, int form) const {
    if (d.slots.size() <= static_cast<std::size_t>(form)) {
      d.slots.resize(space_.forms().size(), -1);
    }
    if (d.slots[form] < 0) {
      Domain::Live made;
      if (d.whole == nullptr) {
        made.at = space_.forms()[form].at;
        made.constant = certain_constant(made.at);
      } else {
        made = live(*d.whole, form);
        if (made.constant == 0) {
          made.at = halved(made.at, d.cut);
          made.constant = certain_constant(made.at);
        }
      }
      d.slots[form] = static_cast<int>(d.live.size());
      d.live.push_back(made);
    }
    return d.live[d.slots[form]];
  }

  // The blockers that neither the path with which the domain was made nor a sign that is
  // constant on it rule out.
  const std::vector<int>& blockers(Domain& d) const {
    if (d.whole == nullptr) {
      for (; d.blockers_known < space_.blockers().size(); ++d.blockers_known) {
        d.blockers.push_back(static_cast<int>(d.blockers_known));
      }
      return d.blockers;
    }
    const std::vector<int>& candidates = blockers(*d.whole);
    for (; d.blockers_known < candidates.size(); ++d.blockers_known) {
      const int b = candidates[d.blockers_known];
      const auto parts = space_.parts(space_.blockers()[b]);
      const bool out = std::ranges::any_of(parts, [&](const Blocker::Part& p) {
        return (sign_[p.form] == -p.sign && position_[p.form] < d.path_size) ||
               live(d, p.form).constant == -p.sign;
      });
      if (!out) d.blockers.push_back(b);
    }
    return d.blockers;
  }

  static CornerValues halved(const CornerValues& at, const Halving& cut) {
    CornerValues out = at;
    for (int i = 0; i < 3; ++i) {
      const int m = cut.from ? 3 * cut.moved + i : 3 * i + cut.moved;
      const int o = cut.from ? 3 * cut.other + i : 3 * i + cut.other;
      const auto [sum, rest] = two_sum(at.value[m], at.value[o]);
      out.value[m] = sum / 2;
      double error = (at.error[m] + at.error[o]) / 2;
      if (error != 0 || rest != 0) error = (error + std::abs(rest) / 2) * (1 + 4 * kUnit);
      out.error[m] = error;
    }
    return out;
  }

  // ---- the search
  // ----------------------------------------------------------------------

  bool search() {
    index_pool();
    return cell(whole_domain(), whole_pool());
  }

  // True when a free segment was found; otherwise the cell is covered or given up.
  bool cell(Domain& d, Bits samples) {
    ++counts_.cells;
    if (stopped_ || ((counts_.cells & 63) == 0 && terms_.stop && terms_.stop())) {
      stopped_ = true;
      ++counts_.undecided;
      return false;
    }
    LocalPoint start;
    if (is_empty(d, start)) return false;
    int blocker = samples != 0 ? popular_blocker(d, samples) : -1;
    if (blocker < 0) {
      const auto point = find_point(d, start);
      if (!point) return divide(d);
      const Verdict verdict = judge(d, *point);
      if (verdict.free) return true;
      if (verdict.blocker < 0) return divide(d);
      blocker = verdict.blocker;
    }
    return subtract(d, blocker, samples);
  }

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
    for (const Step& other : path_) {
      if (space_.forms()[other.form].depends == Dependence::To &&
          live(d, other.form).constant == 0)
        add_row(d, {step.form, other.form});
    }
  }

  void add_row(Domain& d, CoverShare row) {
    row.weight = normalising(live(d, row.form).at);
    if (row.other >= 0) row.weight *= normalising(live(d, row.other).at);
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
    const CornerValues& at = live(d, row.form).at;
    const double scale = sign_[row.form] * row.weight;
    if (row.other < 0) return {scale * at.value[i], row.weight * at.error[i]};
    const double x = at.value[i], dx = at.error[i];
    const CornerValues& other = live(d, row.other).at;
    const double y = other.value[i], dy = other.error[i];
    const double error = std::abs(x) * dy + dx * std::abs(y) + dx * dy;
    return {scale * sign_[row.other] * (x * y),
            row.weight * (error + kUnit * std::abs(x * y)) * (1 + 8 * kUnit)};
  }

  std::array<Rational, 9> exact_row(Domain& d, const CoverShare& row) {
    std::array<Rational, 9> values = exact_values(d, row.form);
    const Rational scale = Rational(row.weight) * int{sign_[row.form]};
    for (int i = 0; i < 9; ++i) {
      values[i] = in_row(row, i) ? Rational(values[i] * scale) : Rational(0);
    }
    if (row.other >= 0) {
      const std::array<Rational, 9> other = exact_values(d, row.other);
      for (int i = 0; i < 9; ++i) values[i] *= other[i] * int{sign_[row.other]};
    }
    return values;
  }

  // Proves the cell empty and notes the proof, or gives a point to start from.
  bool is_empty(Domain& d, LocalPoint& start) {
    game_.clear();
    rows_.clear();
    for (const Step& step : path_) {
      const Domain::Live& f = live(d, step.form);
      if (f.constant == step.sign) continue;
      if (f.constant != 0) {  // the opposite sign, or zero everywhere
        note_empty({CoverShare{step.form}});
        return true;
      }
      add_rows(d, step);
    }
    if (rows_.empty()) {
      start.alpha = start.beta = {1.0 / 3, 1.0 / 3, 1.0 / 3};
      return false;
    }
    ++counts_.games;
    game_.solve(kEnough);
    Game::Row gamma = game_.gamma();
    if (game_.value() <= kDoubtful) {
      if (terms_.precision == Precision::Double) return true;
      if (proves_empty(d) || exactly_empty(d, gamma)) return true;
    }
    start = marginals(gamma);
    return false;
  }

  static LocalPoint marginals(const Game::Row& gamma) {
    LocalPoint p{};
    double sum = 0;
    for (const double g : gamma) sum += g;
    for (int i = 0; i < 9; ++i) {
      p.alpha[i / 3] += gamma[i] / sum;
      p.beta[i % 3] += gamma[i] / sum;
    }
    return p;
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
    note_empty(shares);
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
      const auto failing = std::ranges::partition(others, [&](int r) {
        Rational product = 0;
        for (int i = 0; i < 9; ++i) product += exact[i] * values[r][i];
        return product > 0;
      });
      if (failing.empty()) {
        for (int i = 0; i < 9; ++i) gamma[i] = static_cast<double>(exact[i]);
        return false;
      }
      rows.insert(rows.end(), failing.begin(), failing.end());
      others.erase(failing.begin(), failing.end());
    }
  }

  // rows: positions in rows_.
  void note_exactly_empty(const std::vector<int>& rows,
                          const std::vector<Rational>& lambda) {
    if (!terms_.keep_cover) return;
    std::vector<CoverShare> shares;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (lambda[i] == 0) continue;
      CoverShare share = rows_[rows[i]];
      const Rational weight = lambda[i] * Rational(share.weight);
      share.weight = static_cast<double>(weight);
      share.exact = static_cast<int>(cover_.exact_weights.size());
      cover_.exact_weights.push_back(weight);  // unscaled by note_empty
      shares.push_back(share);
    }
    note_empty(shares);
  }

  // ---- proofs of second order
  // ----------------------------------------------------------

  // Where edges of several blockers meet in a point, or lie in a plane, all lines through
  // that point, or in that plane, are limits of lines that nearly pass: whole families of
  // them, of which no product of triangles can hold only one.  Constant factors cannot
  // rule such a cell out, but factors that vary linearly with p and with q can (for three
  // lines through one point they are those of Cramer's rule).  So the path forms are
  // multiplied by each corner's weights and by each other, which gives polynomials of
  // degree 2 in alpha and in beta, and the same game is played on their 36 coefficients.
  using SecondGame = MatrixGame<36>;
  using ExactSecondGame = ExactMatrixGame<36>;

  bool is_empty_to_second_order(Domain& d) {
    if (d.halvings_from + d.halvings_to < kSecondOrder) return false;
    second_game_.clear();
    rows_.clear();
    std::vector<int> forms;
    for (const Step& step : path_) {
      if (live(d, step.form).constant == 0) forms.push_back(step.form);
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
    if (terms_.precision == Precision::Double) return true;
    return second_order_proof(d);
  }

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
    row.weight = normalising(live(d, row.form).at);
    if (row.other >= 0) row.weight *= normalising(live(d, row.other).at) / 16;
    second_game_.add(coefficients(row, row.weight, [&](int form, int i) {
      return sign_[form] * live(d, form).at.value[i];
    }));
    rows_.push_back(row);
  }

  bool bounded_second_order_proof(Domain& d, const std::vector<int>& rows) {
    std::array<double, 36> sum{}, size{}, bound{};
    for (const int r : rows) {
      const CoverShare& row = rows_[r];
      const double factor = second_game_.lambda()[r] * row.weight;
      const auto plain = coefficients(row, factor, [&](int form, int i) {
        return sign_[form] * live(d, form).at.value[i];
      });
      const auto sizes = coefficients(row, factor, [&](int form, int i) {
        return std::abs(live(d, form).at.value[i]);
      });
      const auto widened = coefficients(row, factor, [&](int form, int i) {
        const CornerValues& at = live(d, form).at;
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
    note_empty(shares);
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
    const bool patient = d.halvings_from + d.halvings_to < kPatience;
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
        if (form >= 0 && !values.contains(form)) values[form] = exact_values(d, form);
      }
      game.add(coefficients(row, Rational(row.weight), [&](int form, int i) {
        return Rational(values[form][i] * int{sign_[form]});
      }));
    }
    if (patient && game.bits() > kLongNumbers) return false;
    ++counts_.exact_games;
    game.solve();
    if (game.positive()) return false;
    note_exactly_empty(rows, game.lambda());
    return true;
  }

  const std::array<Rational, 9>& exact_values(int form) {
    auto [entry, is_new] = exact_.try_emplace(form);
    if (is_new) entry->second = space_.exact(form);
    return entry->second;
  }

  // Of the largest numerator among the form's values.
  std::size_t digits(int form) {
    using Integer = boost::multiprecision::mpz_int;
    std::size_t most = 0;
    for (const Rational& x : exact_values(form)) {
      const Integer size = abs(Integer(numerator(x)));
      if (size != 0) most = std::max<std::size_t>(most, msb(size));
    }
    return most;
  }

  std::array<Rational, 9> exact_values(Domain& d, int form) {
    const std::array<Rational, 9>& whole = exact_values(form);
    if (d.halvings_from + d.halvings_to == 0) return whole;
    std::array<Rational, 9> half, out;
    for (int j = 0; j < 3; ++j) {
      for (int v = 0; v < 3; ++v) {
        half[3 * j + v] = Rational(d.from[j][0]) * whole[v] +
                          Rational(d.from[j][1]) * whole[3 + v] +
                          Rational(d.from[j][2]) * whole[6 + v];
      }
    }
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        out[3 * j + k] = Rational(d.to[k][0]) * half[3 * j] +
                         Rational(d.to[k][1]) * half[3 * j + 1] +
                         Rational(d.to[k][2]) * half[3 * j + 2];
      }
    }
    return out;
  }

  // ---- a segment in the cell
  // -----------------------------------------------------------

  // The smallest path form at a point, each on its own scale.
  double margin(Domain& d, const LocalPoint& p) const {
    double smallest = 1;
    for (const Step& step : path_) {
      const Domain::Live& f = live(d, step.form);
      if (f.constant == step.sign) continue;
      smallest = std::min(
          smallest, step.sign * normalising(f.at) * value_at(f.at, p.alpha, p.beta));
    }
    return smallest;
  }

  // Makes the margin positive by linear programs around the point: the forms' linear
  // parts there, over the domain shrunk towards the point.
  std::optional<LocalPoint> find_point(Domain& d, LocalPoint p) {
    constexpr int kRounds = 8;
    double best = margin(d, p);
    double reach = 1;
    for (int round = 0; round < kRounds && best <= 0; ++round) {
      game_.clear();
      for (const Step& step : path_) {
        const Domain::Live& f = live(d, step.form);
        if (f.constant == step.sign) continue;
        game_.add(linear_part(f.at, step.sign * normalising(f.at), p, reach));
      }
      ++counts_.games;
      game_.solve(kEnough);
      if (game_.value() <= 0) return std::nullopt;
      LocalPoint next = marginals(game_.gamma());
      for (int i = 0; i < 3; ++i) {
        next.alpha[i] = p.alpha[i] + reach * (next.alpha[i] - p.alpha[i]);
        next.beta[i] = p.beta[i] + reach * (next.beta[i] - p.beta[i]);
      }
      const double there = margin(d, next);
      if (there > best) {
        best = there;
        p = next;
      } else {
        reach /= 4;
      }
    }
    if (best <= 0) return std::nullopt;
    return p;
  }

  static Game::Row linear_part(const CornerValues& at, double scale, const LocalPoint& p,
                               double reach) {
    std::array<double, 3> along_a, along_b;
    double here = 0;
    for (int i = 0; i < 3; ++i) {
      along_a[i] = at.value[3 * i] * p.beta[0] + at.value[3 * i + 1] * p.beta[1] +
                   at.value[3 * i + 2] * p.beta[2];
      along_b[i] = at.value[i] * p.alpha[0] + at.value[3 + i] * p.alpha[1] +
                   at.value[6 + i] * p.alpha[2];
      here += p.alpha[i] * along_a[i];
    }
    Game::Row row;
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) {
        const double x = here + reach * ((along_a[j] - here) + (along_b[k] - here));
        row[3 * j + k] = std::clamp(scale * x / 3, -1.0, 1.0);
      }
    }
    return row;
  }

  struct Verdict {
    bool free = false;
    int blocker = -1;
  };

  Verdict judge(Domain& d, const LocalPoint& p) {
    Verdict verdict;
    verdict.blocker = blocker_at(d, p);
    if (verdict.blocker >= 0) return verdict;
    // Where the point itself will not do, a touching occluder say, one beside it may.
    LocalPoint tried = p;
    for (int attempt = 0; attempt < 16; ++attempt) {
      const auto alpha = exact_weights(mixed(d.from, tried.alpha));
      const auto beta = exact_weights(mixed(d.to, tried.beta));
      if (alpha && beta) {
        const SightPoint s{*alpha, *beta};
        int b = exact_blocker(s);
        if (b < 0) {
          if (confirmed(s)) return {true, -1};
          index_pool();
          b = exact_blocker(s);  // unless one was found now, the point only touches
        }
        if (b >= 0) {
          const int better = blocker_at(d, tried);
          if (better >= 0 || can_subtract(d, b)) return {false, better >= 0 ? better : b};
        }
      }
      tried = nudged(d, p, attempt);
    }
    return {};
  }

  LocalPoint nudged(Domain& d, const LocalPoint& p, int attempt) {
    const LocalPoint target{random_weights(), random_weights()};
    double reach = std::ldexp(1.0, -1 - attempt);
    for (int i = 0; i < 30; ++i, reach /= 2) {
      LocalPoint q = p;
      for (int k = 0; k < 3; ++k) {
        q.alpha[k] += reach * (target.alpha[k] - p.alpha[k]);
        q.beta[k] += reach * (target.beta[k] - p.beta[k]);
      }
      if (margin(d, q) > 0) return q;
    }
    return p;
  }

  int exact_blocker(const SightPoint& s) const {
    for (std::size_t b = 0; b < space_.blockers().size(); ++b) {
      if (space_.blocks(space_.blockers()[b], s.alpha, s.beta))
        return static_cast<int>(b);
    }
    return -1;
  }

  // ---- subtracting
  // ---------------------------------------------------------------------

  // No part is known to fail in the cell.
  [[nodiscard]] bool can_subtract(Domain& d, int b) const {
    return std::ranges::none_of(
        space_.parts(space_.blockers()[b]), [&](const Blocker::Part& p) {
          return sign_[p.form] == -p.sign || live(d, p.form).constant == -p.sign;
        });
  }

  [[nodiscard]] bool is_open(Domain& d, const Blocker::Part& part) const {
    const std::int8_t constant = live(d, part.form).constant;
    return sign_[part.form] == 0 && constant != part.sign && constant != 2;
  }

  int open_parts(Domain& d, int b) const {
    return static_cast<int>(std::ranges::count_if(
        space_.parts(space_.blockers()[b]),
        [&](const Blocker::Part& part) { return is_open(d, part); }));
  }

  // Blocks most of the samples; among equals, leaves fewest cells.
  int popular_blocker(Domain& d, Bits samples) const {
    int best = -1;
    double best_score = 0;
    for (const int b : blockers(d)) {
      const int count = std::popcount(samples & blocked_[b]);
      if (count == 0 || count + 1 < best_score || !can_subtract(d, b)) continue;
      const double score = count - 0.1 * open_parts(d, b);
      if (best < 0 || score > best_score) {
        best = b;
        best_score = score;
      }
    }
    return best;
  }

  // Blocks the point; the one that leaves fewest cells, and of these the one into which
  // the point is deepest.
  int blocker_at(Domain& d, const LocalPoint& p) const {
    int best = -1;
    double best_score = 0;
    for (const int b : blockers(d)) {
      double depth = 1;
      for (const auto& [form, sign] : space_.parts(space_.blockers()[b])) {
        depth = std::min(depth, sign * value_at(live(d, form).at, p.alpha, p.beta));
        if (depth < 0) break;
      }
      if (depth < 0 || !can_subtract(d, b)) continue;
      const double score = depth - open_parts(d, b);
      if (best < 0 || score > best_score) {
        best = b;
        best_score = score;
      }
    }
    return best;
  }

  bool subtract(Domain& d, int blocker, Bits samples) {
    // By value: a new blocker may move the table.
    std::vector<Blocker::Part> parts;
    for (const Blocker::Part& part : space_.parts(space_.blockers()[blocker])) {
      if (is_open(d, part)) parts.push_back(part);
    }
    // Planes first: on which side of an edge a line passes says little while p or q may
    // be on either side of the edge's plane.  Then what cuts off most.
    const auto rank = [&](const Blocker::Part& part) {
      const bool plane = space_.forms()[part.form].depends != Dependence::Both;
      return std::pair(!plane, -std::popcount(samples & side(part.form, -part.sign)));
    };
    std::ranges::stable_sort(parts, {}, rank);
    const std::size_t depth = path_.size();
    bool free = false;
    for (const auto& [form, sign] : parts) {
      emit({CoverNode::Kind::Split, static_cast<std::int8_t>(-sign), form, 0});
      position_[form] = path_.size();
      path_.push_back({form, static_cast<std::int8_t>(-sign)});
      sign_[form] = static_cast<std::int8_t>(-sign);
      free = cell(d, samples & side(form, -sign));
      path_.back().sign = sign;
      sign_[form] = sign;
      if (free) break;
      samples &= side(form, sign);
    }
    emit_blocked(blocker);
    while (path_.size() > depth) {
      sign_[path_.back().form] = 0;
      path_.pop_back();
    }
    return free;
  }

  // A cell in which no segment was found, nor a proof that there is none.
  bool divide(Domain& d) {
    if (d.halvings_from + d.halvings_to >= kSmall) {
      const Verdict around = judge_middle(d);
      if (around.free) return true;
      if (around.blocker >= 0) {
        emit_blocked(around.blocker);
        return false;
      }
    }
    if (is_empty_at_a_corner(d) || is_empty_to_second_order(d)) return false;
    return halve(d);
  }

  // Whatever the cell is, all of the domain around it may be blocked; or its middle free.
  Verdict judge_middle(Domain& d) {
    const LocalPoint middle{{1.0 / 3, 1.0 / 3, 1.0 / 3}, {1.0 / 3, 1.0 / 3, 1.0 / 3}};
    const auto known = [&]() -> Verdict {
      const int b = blocker_at(d, middle);
      return {false, b >= 0 && open_parts(d, b) == 0 ? b : -1};
    };
    const Verdict verdict = known();
    const auto alpha = exact_weights(mixed(d.from, middle.alpha));
    const auto beta = exact_weights(mixed(d.to, middle.beta));
    if (verdict.blocker >= 0 || !alpha || !beta) return verdict;
    const SightPoint s{*alpha, *beta};
    if (exact_blocker(s) >= 0) return verdict;
    if (confirmed(s)) return {true, -1};
    index_pool();
    return known();
  }

  // Three lines of the path through one point rule each other out: outlines are full of
  // such corners, and there halving never ends.
  bool is_empty_at_a_corner(Domain& d) {
    constexpr std::size_t kMostTriples = 64;
    std::vector<SignedLine> lines;
    std::vector<int> forms;
    for (const Step& step : path_) {
      if (space_.forms()[step.form].name.kind != FormKind::EdgeSide) continue;
      if (live(d, step.form).constant != 0) continue;
      lines.push_back({space_.points(step.form), step.sign});
      forms.push_back(step.form);
    }
    if (lines.size() < 3) return false;
    const Triangle a = corners(space_.a(), d.from), b = corners(space_.b(), d.to);
    for (const auto& [i, j, k] : concurrent_triples(lines, kMostTriples)) {
      const std::array<SignedLine, 3> triple{lines[i], lines[j], lines[k]};
      if (!may_have_concurrent_weights(triple, a, b)) continue;
      if (terms_.precision == Precision::Double) return true;
      const auto weights = concurrent_weights(triple, exact_corners(space_.a(), d.from),
                                              exact_corners(space_.b(), d.to));
      if (!weights) continue;
      note_empty(shares_of({forms[i], forms[j], forms[k]}, *weights));
      return true;
    }
    return false;
  }

  // Weights of unscaled forms at corner pairs.
  std::vector<CoverShare> shares_of(
      const std::array<int, 3>& forms,
      const std::array<std::array<Rational, 9>, 3>& weights) {
    std::vector<CoverShare> shares;
    if (!terms_.keep_cover) return shares;
    for (int i = 0; i < 3; ++i) {
      for (std::int8_t n = 0; n < 9; ++n) {
        if (weights[i][n] == 0) continue;
        CoverShare share{forms[i],
                         -1,
                         {static_cast<std::int8_t>(n / 3), -1},
                         {static_cast<std::int8_t>(n % 3), -1}};
        share.exact = static_cast<int>(cover_.exact_weights.size());
        cover_.exact_weights.push_back(weights[i][n]);
        scale(cover_.exact_weights.back(), space_.exponent(forms[i]));
        shares.push_back(share);
      }
    }
    return shares;
  }

  static Triangle corners(const Triangle& t, const std::array<Weights, 3>& weights) {
    Triangle out;
    for (int j = 0; j < 3; ++j) {
      out[j] = weights[j][0] * t[0] + weights[j][1] * t[1] + weights[j][2] * t[2];
    }
    return out;
  }

  static std::array<ExactPoint, 3> exact_corners(const Triangle& t,
                                                 const std::array<Weights, 3>& weights) {
    std::array<ExactPoint, 3> out;
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          out[j][axis] += Rational(weights[j][i]) * Rational(t[i][axis]);
        }
      }
    }
    return out;
  }

  bool halve(Domain& d) {
    const auto longest = [](const Triangle& t, const std::array<Weights, 3>& weights) {
      const Triangle p = corners(t, weights);
      std::pair<double, int> best{-1, 0};
      for (int i = 0; i < 3; ++i) {
        best = std::max(best, {(p[(i + 1) % 3] - p[i]).norm(), -i});
      }
      return best;
    };
    const auto [from_length, from_side] = longest(space_.a(), d.from);
    const auto [to_length, to_side] = longest(space_.b(), d.to);
    const bool from = from_length >= to_length;
    if ((from ? d.halvings_from : d.halvings_to) >= kMostHalvings) {
      ++counts_.undecided;
      return false;
    }
    ++counts_.halvings;
    const int i = -(from ? from_side : to_side), next = (i + 1) % 3;
    emit({from ? CoverNode::Kind::HalveFrom : CoverNode::Kind::HalveTo, 0, i, 0});
    for (const Halving& h : {Halving{from, i, next}, Halving{from, next, i}}) {
      const bool free = cell(half(d, h), 0);
      --domains_used_;
      if (free) return true;
    }
    return false;
  }

  // ---- the proof
  // -----------------------------------------------------------------------

  void emit(const CoverNode& node) {
    if (terms_.keep_cover) cover_.nodes.push_back(node);
  }

  // Two blockers in one: on either side of their common edge, one of them.
  void emit_blocked(int blocker) {
    if (!terms_.keep_cover) return;
    const Blocker& b = space_.blockers()[blocker];
    if (b.halves[0] < 0) return emit({CoverNode::Kind::Blocked, 0, blocker, 0});
    const auto [form, sign] = b.shared;
    if (sign_[form] != 0) return emit_blocked(b.halves[sign_[form] == sign ? 0 : 1]);
    emit({CoverNode::Kind::Split, sign, form, 0});
    for (const int half : {0, 1}) {
      sign_[form] = static_cast<std::int8_t>(half == 0 ? sign : -sign);
      emit_blocked(b.halves[half]);
    }
    sign_[form] = 0;
  }

  void note_empty(const std::vector<CoverShare>& shares) {
    if (!terms_.keep_cover) return;
    emit({CoverNode::Kind::Empty, 0, static_cast<std::int32_t>(cover_.shares.size()),
          static_cast<std::int32_t>(shares.size())});
    for (CoverShare share : shares) {
      const int exponent = -space_.exponent(share.form) -
                           (share.other >= 0 ? space_.exponent(share.other) : 0);
      share.weight = std::ldexp(share.weight, exponent);
      if (share.exact >= 0) scale(cover_.exact_weights[share.exact], exponent);
      cover_.shares.push_back(share);
    }
  }

  static void scale(Rational& x, int exponent) {
    const Rational power(boost::multiprecision::mpz_int(1) << std::abs(exponent));
    x = exponent > 0 ? Rational(x * power) : Rational(x / power);
  }

  SightSpace& space_;
  const SearchTerms& terms_;
  std::mt19937_64 random_{terms_.seed};
  std::vector<SightPoint> pool_;
  std::vector<Bits> positive_, blocked_;
  std::vector<Step> path_;
  std::vector<std::int8_t> sign_;      // per form: its sign in the cell, 0 unknown
  std::vector<std::size_t> position_;  // and its position in the path
  std::vector<std::unique_ptr<Domain>> domains_;  // a stack: the first domains_used_
  std::size_t domains_used_ = 0;
  Game game_;
  SecondGame second_game_;
  std::vector<CoverShare> rows_;
  std::unordered_map<int, std::array<Rational, 9>> exact_;
  Cover cover_;
  SightPoint found_{};
  VisibilityCost counts_;
  bool stopped_ = false;
};

}  // namespace

SearchResult search_cover(SightSpace& space, const SearchTerms& terms) {
  return Search(space, terms).run();
}

}  // namespace sightline::internal
