// Few viewpoints that together see everything: cover_views().

#include <algorithm>
#include <boost/dynamic_bitset.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "aspect/choice/apart.h"
#include "aspect/choice/candidates.h"
#include "aspect/choice/covered_area.h"
#include "aspect/choice/set_cover.h"
#include "aspect/choice/view_bounds.h"
#include "aspect/viewpoints.h"
#include "linespace/picture/view_scene.h"
#include "linespace/work/stage.h"

namespace sightline {

using namespace internal;

namespace {

// What has to be seen: a patch, by some of it or by this place.
struct Wanted {
  int side;
  std::optional<Point> place;
};

class Coverer {
 public:
  Coverer(const PointViewIndex& index, const std::vector<PatchSide>& sides,
          Candidates& candidates)
      : scene_(index.shared().scene()), sides_(sides), candidates_(candidates) {
    std::map<int, int> side_of;
    for (std::size_t s = 0; s < sides.size(); ++s)
      side_of[sides[s].patch] = static_cast<int>(s);
    std::set<int> seen;
    for (const SeenParts& view : candidates.views()) {
      for (const int patch : view.patches) seen.insert(side_of.at(patch));
    }
    seen_.assign(seen.begin(), seen.end());
    for (const int s : seen_) wanted_.push_back({s, std::nullopt});
  }

  [[nodiscard]] const std::vector<int>& seen() const { return seen_; }  // sides
  [[nodiscard]] const SetCover& cover() const { return cover_; }

  // Chooses views for all that is wanted so far.  `lower`: so many are needed.  `better`:
  // better viewpoints are looked for before.
  void choose(int lower, bool better) {
    if (better) improve_greedily();
    std::vector<std::vector<int>> sets;
    for (const SeenParts& view : candidates_.views()) sets.push_back(held_by(view));
    const std::size_t steps =
        std::clamp<std::size_t>(2'000'000 / wanted_.size(), 200, 20'000);
    cover_ = least_cover(std::move(sets), static_cast<int>(wanted_.size()), lower, steps);
  }

  // Places of which the chosen views show too little are wanted from now on; false if
  // there are none.  allowed: of the seen part of a patch this share may be missing.
  bool want_more(double allowed) {
    bool more = false;
    for (const int s : seen_) {
      hear_stop();
      PatchArea area(scene_, sides_[s]);
      take_away(area, s, cover_.sets);
      if (allowed > 0 && area.left() > PatchArea::kGrain && missing_share(s) <= allowed)
        continue;
      for (int tries = 0; tries < kPlaces && area.left() > PatchArea::kGrain; ++tries) {
        const Point place = area.place_left();
        if (want(s, place)) {
          more = true;
          break;
        }
        area.give_up_place();
      }
    }
    return more;
  }

  // Of what all viewpoints show of a side, the chosen ones do not show this share.
  [[nodiscard]] double missing_share(int s) const {
    PatchArea area(scene_, sides_[s]);
    const double whole = area.left();
    take_away(area, s, cover_.sets);
    const double without_chosen = area.left();
    std::vector<int> all(candidates_.views().size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    take_away(area, s, all);
    const double shown = whole - area.left();
    return shown > 0 ? (without_chosen - area.left()) / shown : 0;
  }

  [[nodiscard]] std::vector<ChosenView> chosen() const {
    std::vector<ChosenView> out;
    std::set<int> so_far;
    for (const int i : cover_.sets) {
      const SeenParts& view = candidates_.views()[i];
      const std::size_t before = so_far.size();
      so_far.insert(view.patches.begin(), view.patches.end());
      out.push_back({view.at, view.facets, static_cast<double>(so_far.size() - before)});
    }
    return out;
  }

 private:
  static constexpr int kPlaces = 12;  // of a patch that are looked at in one round

  [[nodiscard]] bool sees(const SeenParts& view, const Wanted& wanted) const {
    const PatchSide& side = sides_[wanted.side];
    if (!std::ranges::binary_search(view.patches, side.patch)) return false;
    return !wanted.place || shows(view, side, *wanted.place);
  }

  [[nodiscard]] std::vector<int> held_by(const SeenParts& view) const {
    std::vector<int> out;
    for (std::size_t w = 0; w < wanted_.size(); ++w) {
      if (sees(view, wanted_[w])) out.push_back(static_cast<int>(w));
    }
    return out;
  }

  // Greedy choices, each improved to see more of what the ones before leave; all views
  // found on the way are candidates.
  void improve_greedily() {
    std::vector<bool> left(wanted_.size(), true);
    const auto worth = [&](const SeenParts& view) {
      double sum = 0;
      for (const int w : held_by(view)) sum += left[w] ? 1 : 0;
      return sum;
    };
    // A view of a large scene takes a second.
    const int improved =
        std::clamp(6'000 / static_cast<int>(scene_.faces().size()), 1, 12);
    for (int k = 0; k < improved; ++k) {
      const auto& views = candidates_.views();
      int best = 0;
      double most = -1;
      for (std::size_t i = 0; i < views.size(); ++i) {
        const double value = worth(views[i]);
        if (value > most) {
          most = value;
          best = static_cast<int>(i);
        }
      }
      if (most <= 0) return;
      best = candidates_.improve(best, worth);
      for (const int w : held_by(candidates_.views()[best])) left[w] = false;
    }
  }

  void take_away(PatchArea& area, int s, const std::vector<int>& views) const {
    for (const int i : views) {
      for (const SeenRegion& region : candidates_.views()[i].regions) {
        if (region.patch == sides_[s].patch) area.take_away(region);
      }
    }
  }

  bool want(int s, const Point& place) {
    const auto passes = [&](const SeenParts& view) {
      return shows(view, sides_[s], place);
    };
    if (!std::ranges::any_of(candidates_.views(), passes) &&
        candidates_.look_at(sides_[s], place, passes) < 0) {
      return false;
    }
    wanted_.push_back({s, place});
    return true;
  }

  const Scene& scene_;
  const std::vector<PatchSide>& sides_;
  Candidates& candidates_;
  std::vector<int> seen_;
  std::vector<Wanted> wanted_;
  SetCover cover_;
};

// Sides no two of which any view sees: first those that are seen with fewest others.
std::vector<int> sides_apart(const Coverer& coverer, const Candidates& candidates,
                             const std::vector<PatchSide>& sides,
                             const SightProofs& proofs) {
  // 1. By side the views that show it; what few show comes first.
  const std::vector<int>& seen = coverer.seen();
  const std::size_t count = candidates.views().size();
  std::map<int, boost::dynamic_bitset<>> shown_by;  // by patch
  for (std::size_t v = 0; v < count; ++v) {
    for (const int p : candidates.views()[v].patches)
      shown_by.try_emplace(p, count).first->second.set(v);
  }
  const auto shown = [&](int s) -> const auto& { return shown_by.at(sides[s].patch); };
  std::vector<int> order = seen;
  std::ranges::stable_sort(order, {}, [&](int s) { return shown(s).count(); });
  // 2. What no view shows together with those before may be apart from them.  Some
  // seconds at most.
  const int most_regions =
      std::clamp(400'000 / static_cast<int>(sides.size()), 100, 3000);
  std::vector<int> out;
  int failures = std::clamp(60'000 / static_cast<int>(sides.size()), 4, 60);
  for (const int s : order) {
    const bool may = std::ranges::none_of(
        out, [&](int other) { return shown(s).intersects(shown(other)); });
    if (!may) continue;
    const bool apart = std::ranges::all_of(
        out, [&](int other) { return proofs.never_both(s, other, most_regions); });
    if (apart) {
      out.push_back(s);
    } else if (--failures == 0) {
      break;
    }
  }
  return out;
}

// Facets that no view shows: those that none can, and the others.
void name_unseen(const Scene& scene, const Candidates& candidates,
                 const std::vector<PatchSide>& sides, const SightProofs& proofs,
                 ViewCover& out) {
  std::set<int> seen;
  for (const SeenParts& view : candidates.views())
    seen.insert(view.facets.begin(), view.facets.end());
  std::map<int, bool> unseen;  // by facet: proved
  int proofs_left = std::clamp(500'000 / static_cast<int>(sides.size()), 10, 500);
  for (std::size_t s = 0; s < sides.size(); ++s) {
    hear_stop();
    for (const int facet : sides[s].facets) {
      if (seen.contains(facet)) continue;
      PatchSide alone = sides[s];
      alone.facets = {facet};
      alone.faces = scene.facets()[facet].faces;
      bool proved = proofs.buried(alone);
      if (!proved && sides[s].facets.size() == 1 && proofs_left-- > 0) {
        proved = proofs.never_both(static_cast<int>(s), static_cast<int>(s), 500);
      }
      const auto [it, is_new] = unseen.emplace(facet, proved);
      it->second = it->second && proved;
    }
  }
  for (const auto& [facet, proved] : unseen)
    (proved ? out.never_seen : out.unsettled).push_back(facet);
}

}  // namespace

ViewCover cover_views(const Scene& scene, const ViewpointRequest& request, CoverGoal goal,
                      std::optional<double> share) {
  if (share && !(*share > 0 && *share <= 1))
    throw InvalidInput("fraction: must be above 0 and at most 1");
  const PrecisionScope precision(request.precision);
  const Deadline deadline(request);
  const PointViewIndex index(scene, request);
  const std::vector<PatchSide> sides = patch_sides(index, request);
  const bool by_area = goal == CoverGoal::Whole || share.has_value();
  const double allowed = goal == CoverGoal::Whole ? 0 : 1 - share.value_or(0);
  ViewpointRequest left = request;
  // Half of the time is for choosing among them.
  left.budget_seconds = (left.budget_seconds - deadline.seconds()) / 2;
  Candidates candidates(index, left, sides, by_area);
  ViewCover out{};
  out.most_patches = std::numeric_limits<double>::infinity();
  out.certified = candidates.certified();
  if (candidates.views().empty()) {
    out.complete = candidates.complete() && sides.empty();
    return out;
  }
  Coverer coverer(index, sides, candidates);
  out.patches = coverer.seen().size();
  out.complete = true;
  try {
    const Stage stage(request, "cover", deadline);
    // 1. Few views that see some of all.
    out.lower_bound = 1;
    coverer.choose(out.lower_bound, true);
    // 2. How many are needed at least.
    const ViewSpace space(scene, request);
    const SightProofs proofs(scene, space, sides);
    double reached = 0;
    for (const SeenParts& view : candidates.views())
      reached = std::max(reached, view.value[static_cast<int>(ViewMeasure::Faces)]);
    out.most_patches = measure_bound(index, request, sides, ViewMeasure::Faces, reached);
    const auto by_number =
        static_cast<int>(std::ceil(static_cast<double>(out.patches) / out.most_patches));
    out.lower_bound = std::max(1, by_number);
    for (const int s : sides_apart(coverer, candidates, sides, proofs))
      out.apart.push_back(sides[s].facets[0]);
    out.lower_bound = std::max(out.lower_bound, static_cast<int>(out.apart.size()));
    // 3. Places that the views miss are wanted, too.
    constexpr int kRounds = 40;
    for (int round = 0; by_area && round < kRounds && coverer.want_more(allowed); ++round)
      coverer.choose(out.lower_bound, round % 8 == 7);
    // 4. What nobody sees.
    name_unseen(scene, candidates, sides, proofs, out);
  } catch (const Stopped&) {
    out.complete = false;
  }
  out.views = coverer.chosen();
  out.search_steps = coverer.cover().steps;
  out.search_finished = coverer.cover().finished;
  if (out.certified && out.search_finished && out.complete)
    out.lower_bound = static_cast<int>(out.views.size());
  out.optimal = out.complete && out.lower_bound == static_cast<int>(out.views.size());
  for (const int s : coverer.seen()) {
    if (by_area && coverer.missing_share(s) > allowed + PatchArea::kGrain)
      out.short_of.push_back(sides[s].facets[0]);
  }
  out.taken = candidates.taken();
  out.complete = out.complete && candidates.complete();
  return out;
}

}  // namespace sightline
