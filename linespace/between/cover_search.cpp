#include "linespace/between/cover_search.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <set>

#include "linespace/between/bilinear_cell.h"
#include "linespace/between/cover_cell.h"
#include "linespace/between/cover_writer.h"
#include "linespace/between/emptiness.h"
#include "linespace/numbers/matrix_game.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// Samples that are remembered, with what blocks them, to choose blockers by.
constexpr int kPool = 64;
using Bits = std::uint64_t;

// Games stop as soon as their value is surely below this.
constexpr double kEnough = -0x1p-30;
// From this many halvings on, a cell with no segment to be found may well lie within one
// blocker.
constexpr int kSmall = 6;
// Cells with a smaller margin are probed in exact numbers: there may be a segment between
// two edges that doubles hardly tell apart.
constexpr double kThin = 0x1p-12;
// From this many halvings on, cells are decided in exact numbers.  That leaves no proof
// for a cover: when one is wanted, other proofs are given more time.
constexpr int kDecided = 8, kDecidedWithCover = 24;
// Weights of corners are multiples of 2^-halvings, and so exact in doubles.
constexpr int kMostHalvings = 50;

class Search {
 public:
  Search(SightSpace& space, const SearchTerms& terms)
      : space_(space),
        terms_(terms),
        pool_(terms.pool),
        writer_(space, path_, terms.keep_cover),
        emptiness_(space, path_, domains_, writer_, terms.precision, counts_) {
    if (pool_.size() > kPool) pool_.resize(kPool);
  }

  SearchResult run() {
    const bool free = !covered_by_one() && search_until_stopped();
    SearchResult result;
    result.counts = counts_;
    result.outcome = free                    ? SearchOutcome::Free
                     : counts_.undecided > 0 ? SearchOutcome::Undecided
                                             : SearchOutcome::Covered;
    result.out_of_effort = out_of_effort_ && !free;
    if (free) result.segment = found_;
    result.stuck_between = std::move(stuck_between_);
    result.stuck_width = stuck_width_;
    if (result.outcome == SearchOutcome::Covered && certified_) {
      result.cover = writer_.take();
    }
    result.certified = certified_;
    return result;
  }

 private:
  using Game = MatrixGame<9>;

  bool covered_by_one() {
    for (std::size_t b = 0; b < space_.blockers().size(); ++b) {
      if (space_.blockers()[b].count > 0) continue;
      path_.make_room(space_.forms().size());
      writer_.blocked(static_cast<int>(b));
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
    path_.make_room(space_.forms().size());
  }
  [[nodiscard]] Bits whole_pool() const {
    return pool_.size() == kPool ? ~Bits{0} : (Bits{1} << pool_.size()) - 1;
  }
  [[nodiscard]] Bits side(int form, int sign) const {
    return sign > 0 ? positive_[form] : ~positive_[form];
  }

  // ---- the search

  bool search_until_stopped() {
    const StopScope scope(terms_.stop);
    try {
      index_pool();
      return cell(domains_.push_whole(), whole_pool());
    } catch (const Stopped&) {
      give_up(std::numeric_limits<double>::infinity());
      return false;
    }
  }

  // True when a free segment was found; otherwise the cell is covered or given up.
  bool cell(Domain& d, Bits samples) {
    ++counts_.cells;
    out_of_effort_ |= counts_.cells > terms_.most_cells;
    // A cell takes tens of microseconds, with exact numbers milliseconds.
    if (stopped_ || out_of_effort_ ||
        ((counts_.cells & 7) == 0 && terms_.stop && terms_.stop())) {
      stopped_ = true;
      give_up(std::numeric_limits<double>::infinity());
      return false;
    }
    LocalPoint start;
    if (emptiness_.first_order(d, start)) return false;
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

  // ---- a segment in the cell

  // The smallest path form at a point, each on its own scale.
  double margin(Domain& d, const LocalPoint& p) const {
    double smallest = 1;
    for (const Step& step : path_.steps) {
      const Domain::Live& f = domains_.live(d, step.form);
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
      for (const Step& step : path_.steps) {
        const Domain::Live& f = domains_.live(d, step.form);
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
      if (space_.blocks(space_.blockers()[b], s)) return static_cast<int>(b);
    }
    return -1;
  }

  // ---- subtracting

  // No part is known to fail in the cell.
  [[nodiscard]] bool can_subtract(Domain& d, int b) const {
    return std::ranges::none_of(space_.parts(space_.blockers()[b]),
                                [&](const Blocker::Part& p) {
                                  return path_.sign[p.form] == -p.sign ||
                                         domains_.live(d, p.form).constant == -p.sign;
                                });
  }

  [[nodiscard]] bool is_open(Domain& d, const Blocker::Part& part) const {
    const std::int8_t constant = domains_.live(d, part.form).constant;
    return path_.sign[part.form] == 0 && constant != part.sign && constant != 2;
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
    for (int b = 0; b < static_cast<int>(blocked_.size()); ++b) {
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
    // Most are ruled out in the whole space already, where their forms are at hand.
    constexpr double kCertainlyOutside = -0x1p-36;
    const Weights alpha = mixed(d.from, p.alpha), beta = mixed(d.to, p.beta);
    int best = -1;
    double best_score = 0;
    for (int b = 0; b < static_cast<int>(space_.blockers().size()); ++b) {
      const auto parts = space_.parts(space_.blockers()[b]);
      if (std::ranges::any_of(parts, [&](const Blocker::Part& part) {
            return part.sign * value_at(space_.forms()[part.form].at, alpha, beta) <
                   kCertainlyOutside;
          }))
        continue;
      double depth = 1;
      for (const auto& [form, sign] : parts) {
        depth =
            std::min(depth, sign * value_at(domains_.live(d, form).at, p.alpha, p.beta));
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
    const std::size_t depth = path_.steps.size();
    bool free = false;
    for (const auto& [form, sign] : parts) {
      writer_.node({CoverNode::Kind::Split, static_cast<std::int8_t>(-sign), form, 0});
      path_.push({form, static_cast<std::int8_t>(-sign)});
      free = cell(d, samples & side(form, -sign));
      path_.flip_last();
      if (free) break;
      samples &= side(form, sign);
    }
    writer_.blocked(blocker);
    while (path_.steps.size() > depth) path_.pop();
    return free;
  }

  // A cell in which no segment was found, nor a proof that there is none.
  bool divide(Domain& d) {
    const double margin = emptiness_.margin();
    if (d.halvings() >= kSmall) {
      const Verdict around = judge_middle(d);
      if (around.free) return true;
      if (around.blocker >= 0) {
        writer_.blocked(around.blocker);
        return false;
      }
    }
    if (emptiness_.at_a_corner(d) || emptiness_.second_order(d)) return false;
    if (const auto known = decide_exactly(d, margin)) return *known;
    return halve(d);
  }

  // What cell() returns; nullopt where that would cost more than halving.
  std::optional<bool> decide_exactly(Domain& d, double margin) {
    if (terms_.precision == Precision::Double) return std::nullopt;
    const int halvings = d.halvings();
    const bool decided = halvings >= (terms_.keep_cover ? kDecidedWithCover : kDecided);
    if (!decided && margin > kThin) return std::nullopt;
    std::vector<PositiveForm> forms;
    for (const Step& step : path_.steps) {
      if (domains_.live(d, step.form).constant != 0) continue;
      PositiveForm& form = forms.emplace_back(domains_.exact_values(d, step.form));
      for (Rational& x : form) x *= int{step.sign};
    }
    if (const auto s = probe_cell(forms)) return settle(d, *s);
    if (!decided) return std::nullopt;
    ++counts_.exact_cells;
    const int most_curves = halvings < 16 ? 24 : halvings < 32 ? 96 : 10'000;
    const CellDecision decision = decide_cell(forms, most_curves);
    if (decision.segment) return settle(d, *decision.segment);
    if (decision.outcome == CellDecision::Outcome::TooDear) return std::nullopt;
    certified_ = false;
    return false;
  }

  // A segment of the cell: it is free, or some blocker is to be subtracted.
  std::optional<bool> settle(Domain& d, const ExactSegment& local) {
    std::array<ExactWeights, 2> whole;
    SightPoint s;
    for (int end = 0; end < 2; ++end) {
      const std::array<Weights, 3>& corners = end == 0 ? d.from : d.to;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          whole[end][i] += local[end][j] * Rational(corners[j][i]);
        }
        (end == 0 ? s.alpha : s.beta)[i] = static_cast<double>(whole[end][i]);
      }
    }
    s.exact = std::make_shared<const std::array<ExactWeights, 2>>(std::move(whole));
    int b = exact_blocker(s);
    if (b < 0) {
      if (confirmed(s)) return true;
      index_pool();
      b = exact_blocker(s);
    }
    if (b < 0) return std::nullopt;  // refused for another reason
    return subtract(d, b, 0);
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

  void give_up(double width) {
    if (counts_.undecided++ > 0) return;
    stuck_width_ = width;
    std::set<int> pieces;
    for (const Step& step : path_.steps) {
      pieces.insert(space_.forms()[step.form].name.piece);
    }
    stuck_between_.assign(pieces.begin(), pieces.end());
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
      give_up(std::max(from_length, to_length));
      return false;
    }
    ++counts_.halvings;
    const int i = -(from ? from_side : to_side), next = (i + 1) % 3;
    writer_.node({from ? CoverNode::Kind::HalveFrom : CoverNode::Kind::HalveTo, 0, i, 0});
    for (const Halving& h : {Halving{from, i, next}, Halving{from, next, i}}) {
      const bool free = cell(domains_.push_half(d, h), 0);
      domains_.pop();
      if (free) return true;
    }
    return false;
  }

  SightSpace& space_;
  const SearchTerms& terms_;
  std::mt19937_64 random_{terms_.seed};
  std::vector<SightPoint> pool_;
  std::vector<Bits> positive_, blocked_;
  VisibilityCost counts_;
  CellPath path_;
  Domains domains_{space_};
  CoverWriter writer_;
  Emptiness emptiness_;
  Game game_;
  SightPoint found_{};
  bool stopped_ = false, out_of_effort_ = false;
  std::vector<int> stuck_between_;
  double stuck_width_ = std::numeric_limits<double>::infinity();
  bool certified_ = true;  // each cell that was found empty has a proof for the cover
};

}  // namespace

SearchResult search_cover(SightSpace& space, const SearchTerms& terms) {
  return Search(space, terms).run();
}

}  // namespace sightline::internal
