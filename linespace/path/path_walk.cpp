#include "linespace/path/path_walk.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "linespace/path/path_names.h"

namespace sightline::internal {

PathWalk::PathWalk(const PathScene& scene, const SightPath& path, const Look& look,
                   PathRoot end)
    : scene_(&scene),
      path_(&path),
      look_(&look),
      candidates_(scene, path),
      end_(std::move(end)) {
  now_ = look_after(here_);
}

bool PathWalk::may_change(const PathCandidates::ByRoot::value_type& candidates,
                          const WalkView& view) const {
  return std::ranges::any_of(candidates.second, [&](const Candidate& c) {
    return candidates_.may_change(c, candidates.first, view.seen);
  });
}

// From some eye between the two; if that is on an accident that changes nothing, and is
// not there all the way, from another.
PathWalk::Looked PathWalk::look_between(const PathRoot& from, const PathRoot& to) const {
  const auto look = [&](const PathRoot& limit) {
    const Rational u = between(from, limit);
    return Looked{PathRoot(u),
                  std::make_shared<const WalkView>(*scene_, (*look_)(path_->eye(u)))};
  };
  const auto new_accidents = [&](const Looked& looked) {
    return std::ranges::any_of(looked.view->view.accidents, [&](const Accident& a) {
      return !now_ || !std::ranges::binary_search(now_->view.accidents, a);
    });
  };
  Looked first = look(to);
  if (!new_accidents(first)) return first;
  Looked second = look(first.at);
  return second.view->view.accidents.size() < first.view->view.accidents.size() ? second
                                                                                : first;
}

// The view that holds from just after the root on.
WalkViewPtr PathWalk::look_after(const PathRoot& root) {
  const auto& by_root = candidates_.by_root();
  const auto after = by_root.upper_bound(root);
  PathRoot limit = after == by_root.end() ? PathRoot(Rational(1)) : after->first;
  while (true) {
    const auto [at, view] = look_between(root, limit);
    if (now_ && same_structure(*scene_, now_->view, view->view)) return view;
    candidates_.add(view->seen);
    // Is what it sees the same from the root up to here, and here?
    const auto from = by_root.upper_bound(root), to = by_root.upper_bound(at);
    const bool holds = std::none_of(
        from, to, [&](const auto& candidates) { return may_change(candidates, *view); });
    if (holds) return view;
    limit = from->first;
  }
}

std::vector<Accident> PathWalk::common_accidents(const Rational& u,
                                                 const Rational& v) const {
  const PointView at_u = (*look_)(path_->eye(u)), at_v = (*look_)(path_->eye(v));
  std::vector<Accident> common;
  std::ranges::set_intersection(at_u.accidents, at_v.accidents,
                                std::back_inserter(common));
  return common;
}

// Those that two eyes see after the last candidate before the root.
std::vector<Accident> PathWalk::lasting_before(const PathRoot& root,
                                               const WalkView& view) const {
  if (view.view.general) return {};
  const auto& by_root = candidates_.by_root();
  const auto it = by_root.lower_bound(root);
  const PathRoot from =
      it == by_root.begin() ? PathRoot(Rational(0)) : std::prev(it)->first;
  const Rational u = between(from, root);
  return common_accidents(u, between(PathRoot(u), root));
}

std::vector<Accident> PathWalk::lasting_after(const PathRoot& root,
                                              const WalkView& view) const {
  if (view.view.general) return {};
  const auto& by_root = candidates_.by_root();
  const auto it = by_root.upper_bound(root);
  const PathRoot to = it == by_root.end() ? PathRoot(Rational(1)) : it->first;
  const Rational u = between(root, to);
  return common_accidents(between(root, PathRoot(u)), u);
}

std::vector<PathEvent> PathWalk::name(
    const PathCandidates::ByRoot::value_type& candidates, const WalkView& before,
    const WalkView& after) const {
  const auto& [root, all] = candidates;
  std::vector<PathEvent> events;
  if (root.is_rational()) {
    events = events_of(scene_->scene().scene(), (*look_)(path_->eye(root.rational())),
                       lasting_before(root, before), lasting_after(root, after));
  }
  if (!events.empty()) return events;
  for (const bool sure : {true, false}) {
    for (const Candidate& c : all) {
      if (!candidates_.may_change(c, root, before.seen)) continue;
      if (sure && !is_seen(c, *scene_, before.seen, after.seen)) continue;
      events.push_back(event_of(*scene_, c));
    }
    if (!events.empty()) break;
  }
  std::ranges::sort(events);
  events.erase(std::ranges::unique(events).begin(), events.end());
  return events;
}

std::optional<WalkStep> PathWalk::next() {
  const auto& by_root = candidates_.by_root();
  for (auto it = by_root.upper_bound(here_); it != by_root.end() && it->first <= end_;
       ++it) {
    here_ = it->first;
    if (!may_change(*it, *now_)) continue;
    const WalkViewPtr after = look_after(here_);
    if (same_structure(*scene_, now_->view, after->view)) continue;
    const WalkViewPtr before = std::exchange(now_, after);
    return WalkStep{here_, name(*it, *before, *after), after};
  }
  return std::nullopt;
}

}  // namespace sightline::internal
