// All lines that meet four of n segments.
//
// For each pair i < j of skew segments, a line that meets both is a point (u, v) of the
// unit square, and a third segment k is met along a piece or two of a Moebius curve:
// where F_k(u, v) = 0 and the contact lies on k.  Both conditions, v in [0, 1] and the
// contact in [0, 1], change only where one of four functions linear in u is zero.  Two
// such curves meet where the quadratic H of lines/transversals.h vanishes, so the
// lines of i, j, k, l are the roots of H over the common part of two intervals.  They are
// counted by the signs of H's Bernstein coefficients, in doubles with bounds; quadruples
// where a bound does not suffice, for a near tangency or any degeneracy, go to the exact
// components_of().
//
// The bounds.  e = 2^-53.  A corner value is off by at most its own `error`; a form by E,
// the largest of its four, and it is at most M.  Sums of few rounded terms are given
// twice the roundings they can have, so that second-order terms need no mention.

#include "linespace/segment_transversals.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <string>

#include "linespace/lines/segment_transversals.h"
#include "linespace/lines/transversals.h"
#include "linespace/scene.h"
#include "linespace/work/deadline.h"
#include "linespace/work/stop_scope.h"

namespace sightline {
namespace internal {
namespace {

using Quadruple = std::array<int, 4>;

struct DoubleForm {
  double f[2][2];
  double size = 0;   // M
  double error = 0;  // E
};

struct Interval {
  double lo, hi;
  double lo_error, hi_error;
};

// The parameters on segment i of the lines that meet j and k too.
struct Curve {
  enum State : std::uint8_t { Empty, Known, Unsure } state = Empty;
  int count = 0;
  std::array<Interval, 4> intervals;
};

enum class Outcome { None, Found, Unsure };

DoubleForm double_form(const LineThrough& l, const LineThrough& m, const LineThrough& k) {
  DoubleForm out{};
  const Eigen::Vector3d* p[2] = {&l.from, &l.to};
  const Eigen::Vector3d* q[2] = {&m.from, &m.to};
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) {
      const auto [value, error] = orient3d_value(*p[a], *q[b], k.from, k.to);
      out.f[a][b] = value;
      out.size = std::max(out.size, std::abs(value));
      out.error = std::max(out.error, error);
    }
  }
  return out;
}

// All four corners clearly on one side: the form has no zero over the square.
bool one_sided(const DoubleForm& f) {
  const double least = std::min({f.f[0][0], f.f[0][1], f.f[1][0], f.f[1][1]});
  const double most = std::max({f.f[0][0], f.f[0][1], f.f[1][0], f.f[1][1]});
  return least > f.error || most < -f.error;
}

// A function linear in u, by its values at 0 and 1: the sign at 0, and where it changes.
struct Linear {
  bool positive, changes, sure;
  double root, root_error;
};
// The root f0 / (f0 - f1) has partial derivatives -f1 / (f0 - f1)^2 and f0 / (f0 - f1)^2.
Linear linear(double f0, double f1, double error) {
  if (std::min(std::abs(f0), std::abs(f1)) <= error) return {false, false, false, 0, 0};
  if ((f0 > 0) == (f1 > 0)) return {f0 > 0, false, true, 0, 0};
  const double d = f0 - f1;
  return {f0 > 0, true, true, f0 / d, 2 * error / std::abs(d) + 8 * kUnit};
}

// f over (i, j), g over (i, k): both vanish on the lines that meet all three.
Curve curve_of(const DoubleForm& f, const DoubleForm& g) {
  if (one_sided(f) || one_sided(g)) return {};
  Curve out;
  out.state = Curve::Unsure;
  const std::array<Linear, 4> all{
      linear(f.f[0][0], f.f[1][0], f.error), linear(f.f[0][1], f.f[1][1], f.error),
      linear(g.f[0][0], g.f[1][0], g.error), linear(g.f[0][1], g.f[1][1], g.error)};
  for (const Linear& l : all) {
    if (!l.sure) return out;
  }
  // v in [0, 1] where the first two differ in sign, the contact where the last two do.
  struct Break {
    double at, error;
    int condition;
  };
  std::array<Break, 4> breaks;
  int n = 0;
  for (int i = 0; i < 4; ++i) {
    if (!all[i].changes) continue;
    int k = n++;
    for (; k > 0 && breaks[k - 1].at > all[i].root; --k) breaks[k] = breaks[k - 1];
    breaks[k] = {all[i].root, all[i].root_error, i / 2};
  }
  for (int k = 1; k < n; ++k) {
    if (breaks[k].at - breaks[k - 1].at <= 2 * (breaks[k].error + breaks[k - 1].error)) {
      return out;
    }
  }
  std::array<bool, 2> holds{all[0].positive != all[1].positive,
                            all[2].positive != all[3].positive};
  Interval current{0, 1, 0, 0};
  for (int k = 0; k <= n; ++k) {
    const bool inside = holds[0] && holds[1];
    current.hi = k < n ? breaks[k].at : 1;
    current.hi_error = k < n ? breaks[k].error : 0;
    if (inside) out.intervals[out.count++] = current;
    if (k < n) holds[breaks[k].condition] = !holds[breaks[k].condition];
    current.lo = current.hi;
    current.lo_error = current.hi_error;
  }
  out.state = out.count > 0 ? Curve::Known : Curve::Empty;
  return out;
}

struct Root {
  double u, error;
};

// The roots of H over one interval.  h: its Bernstein coefficients over [0, 1] (h[1] is
// half of h1), each off by `error`, at most `size`.
Outcome roots_over(const std::array<double, 3>& h, double size, double error,
                   const Interval& on, std::array<Root, 2>& roots, int& count) {
  const double lo = on.lo, hi = on.hi, lo1 = 1 - lo, hi1 = 1 - hi;
  double b0 = (h[0] * lo1 + h[1] * lo) * lo1 + (h[1] * lo1 + h[2] * lo) * lo;
  double b1 = (h[0] * lo1 + h[1] * lo) * hi1 + (h[1] * lo1 + h[2] * lo) * hi;
  double b2 = (h[0] * hi1 + h[1] * hi) * hi1 + (h[1] * hi1 + h[2] * hi) * hi;
  // Moving an end by d moves the first and last by at most 4 d M (1 + d), and b1 by 2 d
  // M.
  const double off = error + size * (16 * kUnit + 5 * (on.lo_error + on.hi_error));
  if (std::min(std::abs(b0), std::abs(b2)) <= off) return Outcome::Unsure;
  const bool opposite = (b0 > 0) != (b2 > 0);
  if (!opposite && (b0 > 0) == (b1 > 0)) return Outcome::None;
  if (b0 < 0) {
    b0 = -b0;
    b1 = -b1;
    b2 = -b2;
  }
  const double discriminant = b1 * b1 - b0 * b2;
  const double magnitude = std::abs(b1) + std::max(b0, std::abs(b2));
  const double discriminant_error =
      2 * off * (magnitude + off) + 8 * kUnit * magnitude * magnitude;
  if (!opposite && discriminant < -discriminant_error) return Outcome::None;
  // A root is off by at most off / sqrt(discriminant) of the interval if H's second
  // coefficient a = b0 - 2 b1 + b2 cannot bend it away before: |a| off <= discriminant
  // / 4.
  const double bend = (b0 + std::abs(b2) + 2 * std::abs(b1)) * off;
  if (discriminant <= discriminant_error || bend > discriminant / 8) {
    return Outcome::Unsure;
  }
  const double root = std::sqrt(discriminant);
  const double width = hi - lo;
  const double root_error =
      width * (4 * off / root + 64 * kUnit) + 2 * (on.lo_error + on.hi_error) + 8 * kUnit;
  roots[count++] = {lo + width * (b0 / ((b0 - b1) + root)), root_error};
  if (!opposite) roots[count++] = {hi - width * (b2 / ((b2 - b1) + root)), root_error};
  return Outcome::Found;
}

// Where the line at u meets segment j.
Root other_root(const DoubleForm& f, const Root& u) {
  const double p = f.f[0][0] * (1 - u.u) + f.f[1][0] * u.u;
  const double q = f.f[0][1] * (1 - u.u) + f.f[1][1] * u.u;
  const double off = f.error + f.size * (2 * u.error + 8 * kUnit);
  const double d = std::abs(p - q);
  return {p / (p - q), 4 * off / d + 8 * kUnit};
}

bool may_vanish(const DoubleForm& f, const Root& u, const Root& v) {
  const double u1 = 1 - u.u;
  const double p = f.f[0][0] * u1 + f.f[1][0] * u.u;
  const double q = f.f[0][1] * u1 + f.f[1][1] * u.u;
  const double value = p * (1 - v.u) + q * v.u;
  // Not "<=" turned round: a NaN must say yes.
  return !(std::abs(value) > f.error + f.size * (4 * (u.error + v.error) + 16 * kUnit));
}

// What a thread finds for one i.
struct Findings {
  std::vector<IsolatedTransversal> lines;
  std::uint64_t count = 0;
  std::vector<Quadruple> unsure;
  StageCounts predicates;
};

class Search {
 public:
  Search(std::span<const LineThrough> segments, std::span<const LineThrough> lines,
         const TransversalRequest& request)
      : request_(request), deadline_(request) {
    for (const LineThrough& l : segments) elements_.push_back({l, true});
    for (const LineThrough& l : lines) elements_.push_back({l, false});
    n_ = static_cast<int>(elements_.size());
    bounded_ = static_cast<int>(segments.size());
  }

  SegmentTransversals run() {
    SegmentTransversals out;
    std::vector<Findings> found(static_cast<std::size_t>(std::max(n_, 0)));
    std::atomic<int> done = 0;
    tbb::task_arena arena(request_.threads > 0 ? request_.threads
                                               : tbb::task_arena::automatic);
    arena.execute([&] {
      tbb::parallel_for(0, n_, [&](int i) {
        if (stopped()) return;
        const PrecisionScope precision(request_.precision);
        const StageCounts before = thread_stage_counts();
        until_stopped([&] { from(i, found[static_cast<std::size_t>(i)]); });
        add_difference(found[static_cast<std::size_t>(i)].predicates, before);
        report(0.9 * ++done / n_);
      });
    });
    std::vector<Quadruple> unsure;
    std::size_t kept = 0;
    for (const Findings& f : found) kept += f.lines.size();
    out.lines.reserve(kept);
    for (const Findings& f : found) {
      out.line_count += f.count;
      out.lines.insert(out.lines.end(), f.lines.begin(), f.lines.end());
      if (!stopped_) unsure.insert(unsure.end(), f.unsure.begin(), f.unsure.end());
      add(out.predicates, f.predicates);
    }
    if (request_.precision == Precision::Exact) {
      const StageCounts before = thread_stage_counts();
      until_stopped([&] { resolve(unsure, out); });
      add_difference(out.predicates, before);
    }
    for (const Element& e : elements_) out.elements.push_back(e.line);
    out.complete = !stopped_;
    return out;
  }

 private:
  static void add(StageCounts& sum, const StageCounts& x) {
    sum.by_double += x.by_double;
    sum.by_interval += x.by_interval;
    sum.by_exact += x.by_exact;
  }
  static void add_difference(StageCounts& sum, const StageCounts& before) {
    const StageCounts now = thread_stage_counts();
    add(sum, {now.by_double - before.by_double, now.by_interval - before.by_interval,
              now.by_exact - before.by_exact});
  }

  bool stopped() {
    stopped_ = stopped_ || deadline_.passed();
    return stopped_;
  }
  // The work hears a stop.
  template <class Work>
  void until_stopped(Work&& work) {
    const std::function<bool()> stop = [this] { return stopped(); };
    const StopScope scope(stop);
    try {
      work();
    } catch (const Stopped&) {
      stopped_ = true;
    }
  }
  void report(double fraction) {
    if (!request_.progress) return;
    const std::scoped_lock lock(reporting_);
    request_.progress("transversals", fraction);
  }

  const LineThrough& line(int i) const {
    return elements_[static_cast<std::size_t>(i)].line;
  }

  // All quadruples whose least element is i.
  void from(int i, Findings& out) {
    if (i >= bounded_) {
      for (int j = i + 1; j < n_; ++j) all_unsure(i, j, out);
      return;
    }
    // forms[j][k] over the pair (i, j), j > i, for every k.
    const auto n = static_cast<std::size_t>(bounded_);
    std::vector<DoubleForm> forms(n * n);
    for (int j = i + 1; j < bounded_; ++j) {
      hear_stop_now();
      for (int k = 0; k < bounded_; ++k) {
        if (k != i && k != j) forms[j * n + k] = double_form(line(i), line(j), line(k));
      }
    }
    std::vector<Curve> curves(n);
    std::vector<int> met, near;
    for (int j = i + 1; j < bounded_; ++j) {
      hear_stop_now();
      const BoundedValue skew =
          orient3d_value(line(i).from, line(i).to, line(j).from, line(j).to);
      if (std::abs(skew.value) <= skew.error) {
        all_unsure(i, j, out);
        continue;
      }
      met.clear();
      near.clear();
      for (int k = 0; k < bounded_; ++k) {
        if (k == i || k == j) continue;
        const DoubleForm& f = forms[j * n + k];
        if (!one_sided(f)) near.push_back(k);
        if (k < j) continue;
        curves[k] = curve_of(f, forms[k * n + j]);
        if (curves[k].state != Curve::Empty) met.push_back(k);
      }
      for (std::size_t a = 0; a < met.size(); ++a) {
        hear_stop();
        for (std::size_t b = a + 1; b < met.size(); ++b) {
          quadruple({i, j, met[a], met[b]}, &forms[j * n], curves, near, out);
        }
        for (int l = bounded_; l < n_; ++l) out.unsure.push_back({i, j, met[a], l});
      }
      for (int k = bounded_; k < n_; ++k) {
        for (int l = k + 1; l < n_; ++l) out.unsure.push_back({i, j, k, l});
      }
    }
    for (int j = bounded_; j < n_; ++j) all_unsure(i, j, out);
  }
  void all_unsure(int i, int j, Findings& out) const {
    for (int k = j + 1; k < n_; ++k) {
      hear_stop();
      for (int l = k + 1; l < n_; ++l) out.unsure.push_back({i, j, k, l});
    }
  }

  void quadruple(const Quadruple& q, const DoubleForm* forms,
                 const std::vector<Curve>& curves, const std::vector<int>& near,
                 Findings& out) {
    const Curve& k = curves[q[2]];
    const Curve& l = curves[q[3]];
    if (k.state == Curve::Unsure || l.state == Curve::Unsure) {
      out.unsure.push_back(q);
      return;
    }
    std::array<Root, 2> roots;
    int count = 0;
    switch (roots_of(forms[q[2]], forms[q[3]], k, l, roots, count)) {
      case Outcome::None:
        ++out.predicates.by_double;
        return;
      case Outcome::Unsure:
        out.unsure.push_back(q);
        return;
      case Outcome::Found:
        break;
    }
    std::array<double, 2> others{};
    for (int r = 0; r < count; ++r) {
      const Root v = other_root(forms[q[2]], roots[r]);
      for (const int m : near) {
        if (m != q[2] && m != q[3] && may_vanish(forms[m], roots[r], v)) {
          out.unsure.push_back(q);
          return;
        }
      }
      others[r] = v.u;
    }
    ++out.predicates.by_double;
    out.count += static_cast<std::uint64_t>(count);
    if (request_.only_count) return;
    for (int r = 0; r < count; ++r) out.lines.push_back({q, {roots[r].u, others[r]}, -1});
  }

  // Of all common parts of the two curves' intervals, at most two roots in all.
  static Outcome roots_of(const DoubleForm& f, const DoubleForm& g, const Curve& k,
                          const Curve& l, std::array<Root, 2>& roots, int& count) {
    std::array<double, 3> h;
    double size = 0;
    double error = 0;
    bool ready = false;
    Outcome outcome = Outcome::None;
    for (int a = 0; a < k.count; ++a) {
      for (int b = 0; b < l.count; ++b) {
        const Interval& x = k.intervals[a];
        const Interval& y = l.intervals[b];
        const bool lo_x = x.lo > y.lo;
        const bool hi_x = x.hi < y.hi;
        const Interval common{lo_x ? x.lo : y.lo, hi_x ? x.hi : y.hi,
                              std::max(x.lo_error, y.lo_error),
                              std::max(x.hi_error, y.hi_error)};
        const double off = 2 * (common.lo_error + common.hi_error) + 4 * kUnit;
        if (common.hi - common.lo < -off) continue;
        if (common.hi - common.lo <= off) return Outcome::Unsure;
        if (!ready) {
          const BilinearForm<double> ff{{{f.f[0][0], f.f[0][1]}, {f.f[1][0], f.f[1][1]}}};
          const BilinearForm<double> gg{{{g.f[0][0], g.f[0][1]}, {g.f[1][0], g.f[1][1]}}};
          const Quadratic<double> q = resultant(ff, gg);
          h = {q.h0, q.h1 / 2, q.h2};
          // Two products in the outer coefficients, two in the halved middle one.
          const double product = f.size * g.size;
          error = 2 * (f.size * g.error + g.size * f.error + f.error * g.error) +
                  16 * kUnit * product + 0x1p-900;
          size = 2 * product;
          ready = true;
        }
        std::array<Root, 2> here;
        int n = 0;
        const Outcome o = roots_over(h, size, error, common, here, n);
        if (o == Outcome::Unsure || count + n > 2) return Outcome::Unsure;
        if (o == Outcome::Found) outcome = o;
        for (int r = 0; r < n; ++r) roots[count++] = here[r];
      }
    }
    return outcome;
  }

  // ---- exact --------------------------------------------------------------------------

  // No line through i and j meets k's support, by exact signs of the square's corners.
  bool never(int i, int j, int k) {
    if (!elements_[i].bounded || !elements_[j].bounded) return false;
    const std::size_t n = elements_.size();
    if (never_.empty()) never_.assign(n * n * n, -1);
    std::int8_t& known = never_[(i * n + j) * n + k];
    if (known < 0) {
      const auto at = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
        return orient3d(p, q, line(k).from, line(k).to);
      };
      const Sign s = at(line(i).from, line(j).from);
      known = s != Sign::Zero && at(line(i).from, line(j).to) == s &&
              at(line(i).to, line(j).from) == s && at(line(i).to, line(j).to) == s;
    }
    return known != 0;
  }
  bool never(const Quadruple& q) {
    for (int a = 0; a < 4; ++a) {
      for (int b = a + 1; b < 4; ++b) {
        for (int k = 0; k < 4; ++k) {
          if (k != a && k != b && never(q[a], q[b], q[k])) return true;
        }
      }
    }
    return false;
  }

  void resolve(const std::vector<Quadruple>& unsure, SegmentTransversals& out) {
    std::map<std::vector<int>, std::vector<ExactLine>> lines;
    std::vector<ExactFamily> families;
    std::size_t done = 0;
    for (const Quadruple& q : unsure) {
      hear_stop();
      if (++done % 1024 == 0) {
        report(0.9 +
               0.1 * static_cast<double>(done) / static_cast<double>(unsure.size()));
      }
      if (never(q)) continue;
      hear_stop_now();
      const FourComponents four = components_of(FourElements{
          elements_[q[0]], elements_[q[1]], elements_[q[2]], elements_[q[3]]});
      for (const ExactLine& l : four.isolated) add_line(q, l, lines, out);
      for (const ExactFamily& f : four.families) {
        if (std::ranges::none_of(
                families, [&f](const ExactFamily& g) { return same_family(f, g); })) {
          families.push_back(f);
        }
      }
    }
    for (const ExactFamily& f : families) {
      std::vector<int> met;
      for (int m = 0; m < n_; ++m) {
        hear_stop_now();
        if (all_meet(f, elements_[m])) met.push_back(m);
      }
      out.families.push_back({f.kind, f.dimension, std::move(met), f.samples.front()});
    }
    std::ranges::sort(out.families, [](const auto& a, const auto& b) {
      return std::tie(a.dimension, a.kind, a.elements) <
             std::tie(b.dimension, b.kind, b.elements);
    });
  }

  void add_line(const Quadruple& q, const ExactLine& l,
                std::map<std::vector<int>, std::vector<ExactLine>>& lines,
                SegmentTransversals& out) const {
    std::vector<int> met;
    for (int m = 0; m < n_; ++m) {
      if (meets(l, elements_[m])) met.push_back(m);
    }
    std::vector<ExactLine>& same = lines[met];
    if (std::ranges::any_of(same, [&l](const ExactLine& k) { return same_line(k, l); })) {
      return;
    }
    same.push_back(l);
    ++out.line_count;
    if (request_.only_count) return;
    out.lines.push_back({q, {}, static_cast<int>(out.exact_lines.size())});
    out.exact_lines.push_back({l, std::move(met)});
  }

  const TransversalRequest& request_;
  const Deadline deadline_;
  std::vector<Element> elements_;
  int n_ = 0, bounded_ = 0;
  std::atomic<bool> stopped_ = false;
  std::mutex reporting_;
  std::vector<std::int8_t> never_;
};

void check(std::span<const LineThrough> all, const std::string& what) {
  const auto refuse = [&what](std::size_t i, const char* why) {
    throw InvalidInput(what + "[" + std::to_string(i) + "]: " + why);
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const Eigen::Vector3d* p : {&all[i].from, &all[i].to}) {
      if (std::ranges::all_of(*p, [](double x) { return is_admissible(x); })) continue;
      refuse(i, "a coordinate is neither 0 nor of magnitude from 2^-140 to 2^140");
    }
    if (all[i].from == all[i].to) {
      refuse(i, "its two points are the same");
    }
  }
}

}  // namespace
}  // namespace internal

std::string_view family_name(FamilyKind kind) {
  switch (kind) {
    case FamilyKind::Pencil:
      return "pencil";
    case FamilyKind::JoinedPencils:
      return "joined_pencils";
    case FamilyKind::Regulus:
      return "regulus";
    case FamilyKind::Star:
      return "star";
    case FamilyKind::Plane:
      return "plane";
    case FamilyKind::StarPlane:
      return "star_plane";
    case FamilyKind::Congruence:
      return "congruence";
    case FamilyKind::Complex:
      return "complex";
  }
  return "";
}

// A line found in doubles alone is one of two: the one nearer to where it was found.
ExactLine SegmentTransversals::exact(std::size_t i) const {
  const IsolatedTransversal& line = lines[i];
  if (line.exact >= 0) return exact_lines[static_cast<std::size_t>(line.exact)].line;
  const auto& g = line.generators;
  const LineTransversals both =
      transversals(elements[g[0]], elements[g[1]], elements[g[2]], elements[g[3]]);
  const auto distance = [&](const ExactLine& l) {
    double sum = 0;
    for (int k = 0; k < 2; ++k) {
      const LineThrough& e = elements[g[k]];
      const Eigen::Vector3d there = e.from + line.at[k] * (e.to - e.from);
      sum += (l.contact(e).point - there).squaredNorm();
    }
    return sum;
  };
  return *std::ranges::min_element(both.lines, {}, distance);
}

SegmentTransversals transversals_of_segments(std::span<const LineThrough> segments,
                                             std::span<const LineThrough> lines,
                                             const TransversalRequest& request) {
  internal::check(segments, "segments");
  internal::check(lines, "lines");
  return internal::Search(segments, lines, request).run();
}

}  // namespace sightline
