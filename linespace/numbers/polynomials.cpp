#include "linespace/numbers/polynomials.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

void trim(Polynomial1& f) {
  while (!f.empty() && f.back() == 0) f.pop_back();
}
void trim(Polynomial2& f) {
  while (!f.empty() && f.back().empty()) f.pop_back();
}

Polynomial1 difference(Polynomial1 f, const Polynomial1& g) {
  if (f.size() < g.size()) f.resize(g.size());
  for (std::size_t i = 0; i < g.size(); ++i) f[i] -= g[i];
  trim(f);
  return f;
}

// f times a power of g's leading coefficient, less a multiple of g: of lower degree.
Polynomial1 pseudo_remainder(Polynomial1 f, const Polynomial1& g) {
  while (f.size() >= g.size()) {
    const Integer lead = f.back();
    const std::size_t shift = f.size() - g.size();
    for (Integer& x : f) x *= g.back();
    for (std::size_t i = 0; i < g.size(); ++i) f[i + shift] -= lead * g[i];
    trim(f);
  }
  return f;
}

// f / g, which is known to be a polynomial with integer coefficients.
Polynomial1 exact_quotient(Polynomial1 f, const Polynomial1& g) {
  if (f.size() < g.size()) return {};
  Polynomial1 quotient(f.size() - g.size() + 1);
  while (f.size() >= g.size()) {
    const std::size_t shift = f.size() - g.size();
    quotient[shift] = f.back() / g.back();
    for (std::size_t i = 0; i < g.size(); ++i) f[i + shift] -= quotient[shift] * g[i];
    trim(f);
  }
  return quotient;
}

Polynomial1 derivative(const Polynomial1& f) {
  Polynomial1 d;
  for (std::size_t i = 1; i < f.size(); ++i) d.push_back(f[i] * static_cast<int>(i));
  return d;
}

// ---- roots in an interval

// An open interval from n / 2^k to m / 2^k.
struct Interval {
  Integer n, m;
  int k;
};

// Sign changes of the coefficients once the interval is mapped to the positive numbers:
// the number of roots in it or more by an even number.
int variations(const Polynomial1& f, const Interval& i) {
  const int degree = static_cast<int>(f.size()) - 1;
  // c(t) = f(n + (m - n) t), all times 2^(k degree).
  std::vector<Integer> c = f;
  for (int j = 0; j < degree; ++j) c[j] <<= i.k * (degree - j);
  for (int j = 0; j < degree; ++j) {
    for (int l = degree - 1; l >= j; --l) c[l] += i.n * c[l + 1];
  }
  Integer power = 1;
  const Integer width = i.m - i.n;
  for (int j = 1; j <= degree; ++j) c[j] *= (power *= width);
  // t = 1 / (1 + s).
  std::ranges::reverse(c);
  for (int j = 0; j < degree; ++j) {
    for (int l = degree - 1; l >= j; --l) c[l] += c[l + 1];
  }
  int changes = 0, last = 0;
  for (const Integer& x : c) {
    const int sign = x.sign();
    if (sign == 0) continue;
    changes += last == -sign;
    last = sign;
  }
  return changes;
}

class Separation {
 public:
  Separation(const std::vector<Polynomial1>& fs, const Dyadic& low, const Dyadic& high) {
    for (const Polynomial1& f : fs) {
      if (f.size() > 1) fs_.push_back(primitive(f));
    }
    std::ranges::sort(fs_);
    fs_.erase(std::unique(fs_.begin(), fs_.end()), fs_.end());
    const int k = std::max(low.k, high.k);
    whole_ = {low.n << (k - low.k), high.n << (k - high.k), k};
    std::vector<int> all;
    for (std::size_t i = 0; i < fs_.size(); ++i) {
      if (variations(fs_[i], whole_) == 0) continue;
      fs_[i] = with_simple_roots(fs_[i]);
      all.push_back(static_cast<int>(i));
    }
    divide(whole_, all, 0);
  }

  // Of the points between two roots the one with fewest digits.
  std::vector<Dyadic> take() {
    std::vector<Dyadic> chosen;
    bool after_root = true;
    for (const std::optional<Dyadic>& x : points_) {
      if (!x) {
        after_root = true;
      } else if (after_root) {
        chosen.push_back(*x);
        after_root = false;
      } else if (x->k < chosen.back().k) {
        chosen.back() = *x;
      }
    }
    return chosen;
  }

 private:
  // Appends points of the interval, with a gap where a root is, and its upper end, but
  // for the last interval's.
  void divide(const Interval& i, std::vector<int> fs, int depth) {
    constexpr int kCompareEvery = 16;
    std::vector<int> roots;
    std::erase_if(fs, [&](int f) {
      hear_stop_now();
      const int count = variations(fs_[f], i);
      if (count > 0) roots.push_back(count);
      return count == 0;
    });
    const bool first = i.n == whole_.n << (i.k - whole_.k);
    const bool last = i.m == whole_.m << (i.k - whole_.k);
    if (fs.empty()) {
      if (first || last) add(middle(i, {}));
      if (!last) add({i.m, i.k});
      return;
    }
    const bool one_each = std::ranges::all_of(roots, [](int n) { return n == 1; });
    if (one_each && fs.size() > 1 && depth % kCompareEvery == kCompareEvery - 1) {
      keep_different(fs, i);
    }
    if (one_each && fs.size() == 1 && !first && !last) {
      points_.emplace_back();
      add({i.m, i.k});
      return;
    }
    const Dyadic m = middle(i, fs);
    const int shift = m.k - i.k;
    divide({i.n << shift, m.n, m.k}, fs, depth + 1);
    divide({m.n, i.m << shift, m.k}, fs, depth + 1);
  }

  void add(const Dyadic& x) { points_.emplace_back(x); }

  // Each has one root in the interval: of those with the same one, one is enough.
  void keep_different(std::vector<int>& fs, const Interval& i) const {
    std::vector<int> different;
    for (const int f : fs) {
      const bool known = std::ranges::any_of(different, [&](int g) {
        const Polynomial1 common = greatest_divisor(fs_[f], fs_[g]);
        return common.size() > 1 && variations(common, i) == 1;
      });
      if (!known) different.push_back(f);
    }
    fs = different;
  }

  // A point near the middle of the interval that is no root.
  [[nodiscard]] Dyadic middle(const Interval& i, const std::vector<int>& fs) const {
    for (int more = 1;; ++more) {
      // Odd numerators from the middle downwards: 1/2, 1/4, 3/8, 7/16, ...
      const Integer half = (Integer(1) << (more - 1)) - (more > 1 ? 1 : 0);
      const Dyadic x{(i.n << more) + (i.m - i.n) * (more == 1 ? Integer(1) : half),
                     i.k + more};
      if (std::ranges::none_of(fs, [&](int f) { return sign_at(fs_[f], x) == 0; })) {
        return x;
      }
    }
  }

  std::vector<Polynomial1> fs_;
  Interval whole_{};
  std::vector<std::optional<Dyadic>> points_;  // nullopt: a root
};

// ---- two variables

Polynomial1 content(const Polynomial2& f) {
  Polynomial1 common;
  for (const Polynomial1& c : f) {
    if (c.empty()) continue;
    common = common.empty() ? primitive(c) : greatest_divisor(common, c);
    if (common.size() == 1) break;
  }
  return common;
}

// Without factors in x alone, and the integers' common factor.
Polynomial2 primitive(Polynomial2 f) {
  const Polynomial1 common = content(f);
  if (common.size() > 1) {
    for (Polynomial1& c : f) c = exact_quotient(c, common);
  }
  Integer divisor = 0;
  for (const Polynomial1& c : f) {
    for (const Integer& x : c) divisor = gcd(divisor, x);
  }
  if (divisor > 1) {
    for (Polynomial1& c : f) {
      for (Integer& x : c) x /= divisor;
    }
  }
  return f;
}

Polynomial2 pseudo_remainder(Polynomial2 f, const Polynomial2& g) {
  while (f.size() >= g.size()) {
    hear_stop_now();
    const Polynomial1 lead = f.back();
    const std::size_t shift = f.size() - g.size();
    for (Polynomial1& c : f) c = product(c, g.back());
    for (std::size_t i = 0; i < g.size(); ++i) {
      f[i + shift] = difference(f[i + shift], product(lead, g[i]));
    }
    trim(f);
  }
  return f;
}

// The primitive common factor in which y occurs; {{1}} for none.
Polynomial2 common_factor(Polynomial2 f, Polynomial2 g) {
  f = primitive(std::move(f));
  g = primitive(std::move(g));
  if (f.size() < g.size()) std::swap(f, g);
  while (!g.empty()) {
    if (g.size() == 1) return {{1}};
    Polynomial2 rest = primitive(pseudo_remainder(f, g));
    f = std::exchange(g, std::move(rest));
  }
  return f;
}

// f / g up to a factor in x alone, where g is a factor of f.
Polynomial2 quotient(Polynomial2 f, const Polynomial2& g) {
  Polynomial2 result(f.size() - g.size() + 1);
  while (f.size() >= g.size()) {
    const Polynomial1 lead = f.back();
    const std::size_t shift = f.size() - g.size();
    for (Polynomial1& c : f) c = product(c, g.back());
    for (Polynomial1& c : result) c = product(c, g.back());
    result[shift] = sum(result[shift], lead);
    for (std::size_t i = 0; i < g.size(); ++i) {
      f[i + shift] = difference(f[i + shift], product(lead, g[i]));
    }
    trim(f);
  }
  return primitive(std::move(result));
}

// Certainly no common factor: none where x has some value.
bool certainly_coprime(const Polynomial2& f, const Polynomial2& g) {
  const Dyadic x{Integer(982451653), 29};
  const Polynomial1 u = at_x(f, x), v = at_x(g, x);
  return u.size() == f.size() && v.size() == g.size() &&
         greatest_divisor(u, v).size() == 1;
}

}  // namespace

Polynomial1 sum(const Polynomial1& f, const Polynomial1& g) {
  Polynomial1 s = f;
  if (s.size() < g.size()) s.resize(g.size());
  for (std::size_t i = 0; i < g.size(); ++i) s[i] += g[i];
  trim(s);
  return s;
}

Polynomial1 product(const Polynomial1& f, const Polynomial1& g) {
  if (f.empty() || g.empty()) return {};
  Polynomial1 p(f.size() + g.size() - 1);
  for (std::size_t i = 0; i < f.size(); ++i) {
    for (std::size_t j = 0; j < g.size(); ++j) p[i + j] += f[i] * g[j];
  }
  return p;
}

Polynomial1 primitive(Polynomial1 f) {
  if (f.empty()) return f;
  Integer divisor = 0;
  for (const Integer& x : f) divisor = gcd(divisor, x);
  if (f.back() < 0) divisor = -divisor;
  if (divisor != 1) {
    for (Integer& x : f) x /= divisor;
  }
  return f;
}

Polynomial1 greatest_divisor(Polynomial1 f, Polynomial1 g) {
  f = primitive(std::move(f));
  g = primitive(std::move(g));
  if (f.size() < g.size()) std::swap(f, g);
  while (!g.empty()) {
    if (g.size() == 1) return {1};
    Polynomial1 rest = primitive(pseudo_remainder(f, g));
    f = std::exchange(g, std::move(rest));
  }
  return f;
}

Polynomial1 with_simple_roots(const Polynomial1& f) {
  if (f.size() < 3) return primitive(f);
  return exact_quotient(primitive(f), greatest_divisor(f, derivative(f)));
}

int sign_at(const Polynomial1& f, const Dyadic& x) {
  Integer value = 0;
  int power = 0;
  for (std::size_t i = f.size(); i-- > 0; power += x.k) {
    value = value * x.n + (f[i] << power);
  }
  return value.sign();
}

std::vector<Dyadic> separating_points(const std::vector<Polynomial1>& fs,
                                      const Dyadic& low, const Dyadic& high) {
  return Separation(fs, low, high).take();
}

Polynomial2 sum(const Polynomial2& f, const Polynomial2& g) {
  Polynomial2 s = f;
  if (s.size() < g.size()) s.resize(g.size());
  for (std::size_t i = 0; i < g.size(); ++i) s[i] = sum(s[i], g[i]);
  trim(s);
  return s;
}

Polynomial2 product(const Polynomial2& f, const Polynomial2& g) {
  if (f.empty() || g.empty()) return {};
  Polynomial2 p(f.size() + g.size() - 1);
  for (std::size_t i = 0; i < f.size(); ++i) {
    for (std::size_t j = 0; j < g.size(); ++j) {
      p[i + j] = sum(p[i + j], product(f[i], g[j]));
    }
  }
  trim(p);
  return p;
}

Polynomial2 negative(Polynomial2 f) {
  for (Polynomial1& c : f) {
    for (Integer& x : c) x = -x;
  }
  return f;
}

Polynomial1 at_x(const Polynomial2& f, const Dyadic& x) {
  std::size_t most = 0;
  for (const Polynomial1& c : f) most = std::max(most, c.size());
  Polynomial1 values;
  for (const Polynomial1& c : f) {
    Integer value = 0;
    for (std::size_t i = most; i-- > 0;) {
      value *= x.n;
      if (i < c.size()) value += c[i] << (x.k * static_cast<int>(most - 1 - i));
    }
    values.push_back(value);
  }
  trim(values);
  return values;
}

Polynomial2 derivative_by_y(const Polynomial2& f) {
  Polynomial2 d;
  for (std::size_t i = 1; i < f.size(); ++i) {
    d.push_back(product(f[i], {Integer(static_cast<int>(i))}));
  }
  return d;
}

// Sylvester's determinant by Bareiss's elimination, in which all divisions are exact.
Polynomial1 resultant(const Polynomial2& f, const Polynomial2& g) {
  const std::size_t m = f.size() - 1, n = g.size() - 1, size = m + n;
  std::vector<Polynomial2> rows(size, Polynomial2(size));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= m; ++j) rows[i][i + j] = f[m - j];
  }
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j <= n; ++j) rows[n + i][i + j] = g[n - j];
  }
  Polynomial1 last{1};
  for (std::size_t c = 0; c + 1 < size; ++c) {
    const auto pivot =
        std::find_if(rows.begin() + static_cast<std::ptrdiff_t>(c), rows.end(),
                     [&](const Polynomial2& row) { return !row[c].empty(); });
    if (pivot == rows.end()) return {};
    std::swap(rows[c], *pivot);
    for (std::size_t i = c + 1; i < size; ++i) {
      hear_stop_now();
      for (std::size_t j = c + 1; j < size; ++j) {
        rows[i][j] = exact_quotient(
            difference(product(rows[c][c], rows[i][j]), product(rows[i][c], rows[c][j])),
            last);
      }
    }
    last = rows[c][c];
  }
  return size == 0 ? Polynomial1{1} : rows[size - 1][size - 1];
}

void CurveBasis::add(const Polynomial2& f) {
  const Polynomial1 common = content(f);
  if (common.size() > 1) in_x.push_back(common);
  Polynomial2 rest = primitive(f);
  if (rest.size() < 2) return;
  if (rest.size() > 2) {
    const Polynomial2 repeated = common_factor(rest, derivative_by_y(rest));
    if (repeated.size() > 1) rest = quotient(rest, repeated);
  }
  for (std::size_t i = 0; i < curves.size() && rest.size() > 1; ++i) {
    hear_stop_now();
    if (certainly_coprime(curves[i], rest)) continue;
    const Polynomial2 shared = common_factor(curves[i], rest);
    if (shared.size() < 2) continue;
    rest = quotient(rest, shared);
    if (curves[i].size() == shared.size()) continue;
    const Polynomial2 other = quotient(curves[i], shared);
    curves[i] = shared;
    curves.push_back(other);
  }
  if (rest.size() > 1) curves.push_back(rest);
}

}  // namespace sightline::internal
