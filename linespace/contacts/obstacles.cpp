#include "linespace/contacts/obstacles.h"

#include <utility>

#include "linespace/work/stop_scope.h"

namespace sightline::internal::contacts {

bool covers(std::span<const SectorAt> sectors) {
  if (sectors.size() < 2) return false;
  return std::all_of(sectors.begin(), sectors.end(), [&](const SectorAt& s) {
    return std::any_of(sectors.begin(), sectors.end(), [&](const SectorAt& other) {
      return contains_after(other, s.end->u);
    });
  });
}

bool sealed(std::span<const SectorAt> sectors) {
  return std::all_of(sectors.begin(), sectors.end(), [&](const SectorAt& s) {
    return std::any_of(sectors.begin(), sectors.end(), [&](const SectorAt& other) {
      return other.start == s.end || contains_inside(other, s.end->u);
    });
  });
}

Openings openings(int sense, const Ray& ray, const Rational& t,
                  std::span<const SectorAt> sectors, std::span<const Fin* const> fins,
                  const CornerTimes& corner_time, bool exact) {
  // 1. What bounds k: it must be less than the slopes to the corners in `less`, and
  // greater than the slopes to those in `greater`.  A sector with the ray inside leaves
  // no k at all.
  std::vector<const Corner*> less, greater;
  for (const SectorAt& s : sectors) {
    if (contains_inside(s, ray)) return {};
    if (same_direction(s.end->u, ray)) less.push_back(s.end);
    if (same_direction(s.start->u, ray)) greater.push_back(s.start);
  }
  // Turning clockwise, w leaves the side that it would enter turning the other way.
  if (sense < 0) std::swap(less, greater);
  // A fin that begins at t bounds k from above, one that ends at t from below; one that
  // is up before and after leaves no k.  A fin that meets L in a corner is up in a wedge:
  // between the slopes of its two sides.
  std::vector<const Fin*> wedges;
  for (const Fin* f : fins) {
    if (t < f->from || f->to < t) continue;
    if (f->from == f->to) {
      wedges.push_back(f);
    } else if (f->from == t) {
      if (f->from_side != nullptr) less.push_back(f->from_side);
    } else if (f->to == t) {
      if (f->to_side != nullptr) greater.push_back(f->to_side);
    } else {
      return {};
    }
  }
  // A corner in both leaves no k: two obstacles share the side to it.
  for (const Corner* c : less) {
    if (std::find(greater.begin(), greater.end(), c) != greater.end()) return {};
  }
  // 2. Bounds on one side only leave some k, whatever the slopes are: no need of them.
  Openings out;
  out.bounded = !less.empty() || !greater.empty() || !wedges.empty();
  if (!exact && (less.empty() || greater.empty())) {
    out.intervals.emplace_back();
    return out;
  }
  // Time per distance along the side from (t, L) to a corner on this ray.
  const auto slope = [&](const Corner* c) {
    return Rational(Rational(corner_time(*c) - t) / measure(c->u));
  };
  // 3. The interval between all bounds.
  Opening all;
  for (const Corner* c : less) {
    const Rational s = slope(c);
    if (!all.high || s < *all.high) all.high = s;
  }
  for (const Corner* c : greater) {
    const Rational s = slope(c);
    if (!all.low || s > *all.low) all.low = s;
  }
  if (all.low && all.high && *all.low >= *all.high) return {};
  // 4. That interval without the wedges, from low to high: `all` is what is left of it.
  std::vector<std::pair<Rational, Rational>> closed;
  for (const Fin* f : wedges) {
    const Rational p = slope(f->from_side), q = slope(f->to_side);
    closed.emplace_back(std::min(p, q), std::max(p, q));
  }
  std::sort(closed.begin(), closed.end());
  // What lies below a wedge is an interval of its own; then `all` begins above the wedge.
  for (const auto& [low, high] : closed) {
    if (all.high && low >= *all.high) break;
    if (!all.low || low > *all.low) out.intervals.push_back({all.low, low});
    if (!all.low || high > *all.low) all.low = high;
  }
  // The last one, above all wedges, unless these reach up to its end.
  if (!all.high || !all.low || *all.low < *all.high) {
    out.intervals.push_back(std::move(all));
  }
  return out;
}

std::vector<std::vector<const Fin*>> by_direction(std::span<const Fin> fins) {
  std::vector<std::vector<const Fin*>> directions;
  for (const Fin& f : fins) {
    hear_stop();
    const auto known = std::find_if(
        directions.begin(), directions.end(),
        [&](const auto& d) { return same_direction(*d.front()->ray, *f.ray); });
    if (known == directions.end()) {
      directions.push_back({&f});
    } else {
      known->push_back(&f);
    }
  }
  return directions;
}

bool add_instants(std::span<const Fin* const> along, const CornerTimes& corner_time,
                  std::vector<Rational>& instants) {
  std::vector<Rational> ends;
  for (const Fin* f : along) {
    if (f->from == f->to) continue;
    ends.push_back(f->from);
    ends.push_back(f->to);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (const Rational& end : ends) {
    bool before = false, after = false;
    for (const Fin* f : along) {
      hear_stop();
      before |= f->from < end && end <= f->to;
      after |= f->from <= end && end < f->to;
    }
    if (before && after &&
        openings(1, *along.front()->ray, end, {}, along, corner_time, false)
            .intervals.empty()) {
      continue;
    }
    instants.push_back(end);
  }
  return !ends.empty();
}

}  // namespace sightline::internal::contacts
