#include "linespace/between/bilinear_cell.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "linespace/numbers/matrix_game.h"
#include "linespace/numbers/polynomials.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

/// A form's values at the corner pairs, times what makes them integers.
using IntegerForm = std::array<Integer, 9>;
/// Weights of a point, not scaled to sum 1.
using IntegerWeights = std::array<Integer, 3>;

IntegerForm integer_form(const PositiveForm& form) {
  Integer common = 1;
  for (const Rational& x : form) common = lcm(common, Integer(denominator(x)));
  IntegerForm out;
  for (int i = 0; i < 9; ++i) {
    out[i] = Integer(numerator(form[i])) * (common / Integer(denominator(form[i])));
  }
  return out;
}

// The double nearest to x / 2^shift, up to 2 roundings.
double rounded(const Integer& x, int shift) {
  const int drop = x == 0 ? 0 : std::max(0, static_cast<int>(msb(abs(x))) - 60);
  return std::ldexp(static_cast<double>(Integer(x >> drop)), drop - shift);
}

ExactWeights weights_of(const std::array<Rational, 3>& w) {
  const Rational sum = w[0] + w[1] + w[2];
  return {w[0] / sum, w[1] / sum, w[2] / sum};
}

/// Conditions on q, row . q > 0: those of the forms for a fixed p, then those of being
/// inside the triangle.
class Fibre {
 public:
  struct Outcome {
    std::optional<std::array<Rational, 3>> q;
    /// No q: positions of conditions that rule each other out.
    std::vector<int> culprits;
  };

  [[nodiscard]] Outcome solve(std::span<const IntegerForm> forms,
                              const IntegerWeights& p) {
    rows_.clear();
    for (const IntegerForm& form : forms) {
      auto& row = rows_.emplace_back();
      for (int k = 0; k < 3; ++k) {
        for (int j = 0; j < 3; ++j) row[k] += p[j] * form[3 * j + k];
      }
    }
    for (int k = 0; k < 3; ++k) rows_.emplace_back()[k] = 1;
    Outcome outcome;
    return solved_in_doubles(outcome) ? outcome : solve_exactly();
  }

 private:
  // Rows are scaled to entries of at most 1, rounded to within 2^-50 of these: a value
  // below -2^-40 proves that the exact one is negative.
  bool solved_in_doubles(Outcome& outcome) {
    constexpr double kCertain = -0x1p-40;
    game_.clear();
    for (const auto& row : rows_) {
      int bits = 0;
      for (const Integer& x : row) {
        if (x != 0) bits = std::max(bits, static_cast<int>(msb(abs(x))) + 1);
      }
      game_.add({rounded(row[0], bits), rounded(row[1], bits), rounded(row[2], bits)});
    }
    game_.solve(kCertain);
    if (game_.value() < kCertain) {
      std::array<double, 3> sum{};
      for (std::size_t r = 0; r < rows_.size(); ++r) {
        const double lambda = game_.lambda()[r];
        if (lambda == 0) continue;
        outcome.culprits.push_back(static_cast<int>(r));
        for (int k = 0; k < 3; ++k) sum[k] += lambda * game_.row(r)[k];
      }
      return std::ranges::all_of(sum, [](double x) { return x < kCertain / 2; });
    }
    std::array<Rational, 3> q;
    for (int k = 0; k < 3; ++k) q[k] = game_.gamma()[k];
    const bool all_positive = std::ranges::all_of(rows_, [&](const auto& row) {
      return Rational(row[0]) * q[0] + Rational(row[1]) * q[1] + Rational(row[2]) * q[2] >
             0;
    });
    if (all_positive) outcome.q = q;
    return all_positive;
  }

  Outcome solve_exactly() {
    ExactMatrixGame<3> game;
    for (const auto& row : rows_) {
      Integer largest = 1;
      for (const Integer& x : row) largest = std::max<Integer>(largest, abs(x));
      const int bits = static_cast<int>(msb(largest));
      const Rational scale(1, Integer(Integer(1) << bits));
      game.add({row[0] * scale, row[1] * scale, row[2] * scale});
    }
    game.solve();
    Outcome outcome;
    if (game.positive()) {
      const auto gamma = game.gamma();
      outcome.q = {gamma[0], gamma[1], gamma[2]};
      return outcome;
    }
    const std::vector<Rational> lambda = game.lambda();
    for (std::size_t r = 0; r < lambda.size(); ++r) {
      if (lambda[r] > 0) outcome.culprits.push_back(static_cast<int>(r));
    }
    return outcome;
  }

  std::vector<std::array<Integer, 3>> rows_;
  MatrixGame<3> game_;
};

// ---- curves

/// A polynomial in p: by its weights, homogeneous (their sum counts as 1), and with the
/// third weight as 1 - x - y.  The two are computed side by side: the first shows at a
/// glance that there is no zero in the triangle.
struct Curve {
  Polynomial2 homogeneous;  // the third weight is 1
  Polynomial2 affine;
};

Curve sum(const Curve& f, const Curve& g) {
  return {internal::sum(f.homogeneous, g.homogeneous), internal::sum(f.affine, g.affine)};
}
Curve product(const Curve& f, const Curve& g) {
  return {internal::product(f.homogeneous, g.homogeneous),
          internal::product(f.affine, g.affine)};
}
Curve negative(const Curve& f) {
  return {internal::negative(f.homogeneous), internal::negative(f.affine)};
}

Polynomial1 trimmed(Polynomial1 f) {
  while (!f.empty() && f.back() == 0) f.pop_back();
  return f;
}

// u x + v y + w z.
Curve linear(const Integer& u, const Integer& v, const Integer& w) {
  const auto polynomial = [](const Integer& x, const Integer& y, const Integer& one) {
    return internal::sum(Polynomial2{trimmed({one, x})}, Polynomial2{{}, trimmed({y})});
  };
  return {polynomial(u, v, w), polynomial(u - w, v - w, w)};
}

// Its coefficients as a homogeneous polynomial of the weights have one sign: so it is
// zero everywhere or nowhere inside the triangle.
bool has_no_zero(const Curve& f) {
  bool up = false, down = false;
  for (const Polynomial1& c : f.homogeneous) {
    for (const Integer& x : c) {
      up |= x > 0;
      down |= x < 0;
    }
  }
  return !(up && down);
}

using Row = std::array<Curve, 3>;

Curve minor2(const Row& u, const Row& v, int j, int k) {
  return sum(product(u[j], v[k]), negative(product(u[k], v[j])));
}

Curve determinant(const Row& u, const Row& v, const Row& w) {
  Curve d = product(u[0], minor2(v, w, 1, 2));
  d = sum(d, product(u[1], minor2(v, w, 2, 0)));
  return sum(d, product(u[2], minor2(v, w, 0, 1)));
}

/// The determinants of all triples of conditions, those of the triangle included.
std::vector<Polynomial2> curves_of(std::span<const IntegerForm> forms) {
  std::vector<Row> rows;
  for (const IntegerForm& f : forms) {
    Row& row = rows.emplace_back();
    for (int k = 0; k < 3; ++k) row[k] = linear(f[k], f[3 + k], f[6 + k]);
  }
  const Curve one{{{1}}, {{1}}};
  for (int k = 0; k < 3; ++k) rows.emplace_back()[k] = one;
  std::vector<Polynomial2> curves;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    for (std::size_t j = i + 1; j < rows.size(); ++j) {
      for (std::size_t k = j + 1; k < rows.size(); ++k) {
        hear_stop();
        const Curve f = determinant(rows[i], rows[j], rows[k]);
        if (!has_no_zero(f)) curves.push_back(f.affine);
      }
    }
  }
  return curves;
}

// ---- one point per cell of the arrangement

/// Calls visit(p) for a point of each cell until it returns false.
class Arrangement {
 public:
  explicit Arrangement(std::span<const Polynomial2> curves) {
    basis_.add({{}, {1}});       // y = 0
    basis_.add({{-1, 1}, {1}});  // x + y = 1
    for (const Polynomial2& f : curves) basis_.add(f);
  }

  template <class Visit>
  void sample(Visit visit) const {
    const std::vector<Polynomial1> critical = critical_x();
    for (const Dyadic& x : separating_points(critical, {0, 0}, {1, 0})) {
      std::vector<Polynomial1> along_y;
      for (const Polynomial2& f : basis_.curves) along_y.push_back(at_x(f, x));
      const Integer one = Integer(1) << x.k;
      for (const Dyadic& y : separating_points(along_y, {0, 0}, {one - x.n, x.k})) {
        const int k = std::max(x.k, y.k);
        const Integer u = x.n << (k - x.k), v = y.n << (k - y.k);
        hear_stop_now();
        if (!visit(IntegerWeights{u, v, (Integer(1) << k) - u - v})) return;
      }
    }
  }

 private:
  // Where curves meet each other, the triangle's sides among them, or have a vertical
  // tangent or a double point.
  [[nodiscard]] std::vector<Polynomial1> critical_x() const {
    std::vector<Polynomial1> critical = basis_.in_x;
    for (std::size_t i = 0; i < basis_.curves.size(); ++i) {
      const Polynomial2& f = basis_.curves[i];
      if (f.size() > 2) critical.push_back(resultant(f, derivative_by_y(f)));
      for (std::size_t j = 0; j < i; ++j) {
        critical.push_back(resultant(f, basis_.curves[j]));
      }
    }
    return critical;
  }

  CurveBasis basis_;
};

ExactSegment segment(const IntegerWeights& p, const std::array<Rational, 3>& q) {
  return {weights_of({Rational(p[0]), Rational(p[1]), Rational(p[2])}), weights_of(q)};
}

std::vector<IntegerForm> integer_forms(std::span<const PositiveForm> forms) {
  std::vector<IntegerForm> out;
  for (const PositiveForm& form : forms) out.push_back(integer_form(form));
  return out;
}

// p and q exchanged.
std::vector<IntegerForm> transposed(std::span<const IntegerForm> forms) {
  std::vector<IntegerForm> out(forms.begin(), forms.end());
  for (IntegerForm& f : out) {
    std::swap(f[1], f[3]);
    std::swap(f[2], f[6]);
    std::swap(f[5], f[7]);
  }
  return out;
}

}  // namespace

std::optional<ExactSegment> probe_cell(std::span<const PositiveForm> positive) {
  static const std::array<IntegerWeights, 4> kPoints{
      {{1, 1, 2}, {2, 3, 11}, {3, 11, 2}, {11, 2, 3}}};
  const std::vector<IntegerForm> forms = integer_forms(positive);
  const std::vector<IntegerForm> exchanged = transposed(forms);
  Fibre fibre;
  for (const IntegerWeights& w : kPoints) {
    if (const auto q = fibre.solve(forms, w).q) return segment(w, *q);
    if (const auto p = fibre.solve(exchanged, w).q) {
      const ExactSegment s = segment(w, *p);
      return ExactSegment{s[1], s[0]};
    }
  }
  return std::nullopt;
}

// Only forms that have ruled something out are looked at; a segment for these that
// another form forbids brings that form in.
CellDecision decide_cell(std::span<const PositiveForm> positive, int most_curves) {
  const std::vector<IntegerForm> forms = integer_forms(positive);
  Fibre fibre;
  CellDecision decision{CellDecision::Outcome::Empty, {}};
  std::set<int> chosen;
  // True when there is a segment with that p, or a form was chosen that forbids it.
  const auto settled = [&](const IntegerWeights& p) {
    const Fibre::Outcome outcome = fibre.solve(forms, p);
    if (outcome.q) {
      decision = {CellDecision::Outcome::Found, segment(p, *outcome.q)};
      return true;
    }
    const std::size_t before = chosen.size();
    for (const int c : outcome.culprits) {
      if (c < static_cast<int>(forms.size())) chosen.insert(c);
    }
    return chosen.size() > before;
  };
  if (!settled({1, 1, 2})) return decision;
  while (!decision.segment) {
    std::vector<IntegerForm> some;
    for (const int c : chosen) some.push_back(forms[c]);
    const std::vector<Polynomial2> curves = curves_of(some);
    if (static_cast<int>(curves.size()) > most_curves) {
      return {CellDecision::Outcome::TooDear, {}};
    }
    bool again = false;
    Arrangement(curves).sample([&](const IntegerWeights& p) {
      if (!fibre.solve(some, p).q) return true;
      again = settled(p);
      return !again;
    });
    if (!again) return decision;
  }
  return decision;
}

}  // namespace sightline::internal
