#include "linespace/between/patch_growth.h"

#include <Eigen/Geometry>

namespace sightline::internal {
namespace {

// Members that need conditions of their own add two forms each.
constexpr int kMostDivided = 8;

double side(const Point& a, const Point& b, const Point& c, const Point& d) {
  return (b - a).cross(c - a).dot(d - a);
}

Point mean(const Triangle& t, const Weights& w) {
  return w[0] * t[0] + w[1] * t[1] + w[2] * t[2];
}

}  // namespace

PatchGrowth::PatchGrowth(const OccluderSet& set, const SightSpace& space,
                         const SightPoint& s, const std::function<bool(int)>& skip)
    : set_(set),
      space_(space),
      skip_(skip),
      p_(mean(space.a(), s.alpha)),
      q_(mean(space.b(), s.beta)) {}

std::vector<PatchGrowth::Member> PatchGrowth::around(int polygon) {
  const int front = front_of(polygon);
  if (front == 0) return {};
  add({polygon, static_cast<std::int8_t>(front)});
  for (std::size_t next = 0; next < members_.size(); ++next) {
    const Member from = members_[next];
    const int n = static_cast<int>(set_[from.polygon].size());
    for (int k = 0; k < n; ++k) {
      // One that did not fit is asked again when another of its neighbours joins.
      const auto other = set_.neighbour({from.polygon, k});
      if (!other || front_.contains(other->polygon)) continue;
      const Member member{other->polygon,
                          static_cast<std::int8_t>(front_of(other->polygon))};
      if (fits(member)) add(member);
    }
  }
  return members_;
}

// The direction of crossing: on which side of the plane p is, seen from q.
int PatchGrowth::front_of(int polygon) const {
  const Polygon& c = set_[polygon];
  const double turn = (c[1] - c[0]).cross(c[2] - c[0]).dot(p_ - q_);
  return turn > 0 ? 1 : turn < 0 ? -1 : 0;
}

// Each of its sides leaves the segment on the inner hand, or cancels with a member's.
bool PatchGrowth::fits(const Member& member) const {
  if (member.front == 0 || (skip_ && skip_(member.polygon))) return false;
  const Polygon& c = set_[member.polygon];
  const int n = static_cast<int>(c.size());
  for (int k = 0; k < n; ++k) {
    const Point& here = c[k];
    const Point& next = c[(k + 1) % n];
    const auto other = set_.neighbour({member.polygon, k});
    const auto known = other ? front_.find(other->polygon) : front_.end();
    if (known != front_.end()) {
      // Passed in the same direction by both: they face differently.
      const bool same_way = set_[other->polygon][other->corner] == here;
      if ((known->second == member.front) == same_way) return false;
      continue;
    }
    if (!(member.front * side(p_, q_, here, next) < 0)) return false;
  }
  const auto between = space_.between({0, c}, member.front);
  if (between == SightSpace::Between::Always) return true;
  const bool divides = member.front * side(c[0], c[1], c[2], p_) > 0 &&
                       member.front * side(c[0], c[1], c[2], q_) < 0;
  return between == SightSpace::Between::WhereItsPlaneDivides && divides &&
         divided_ < kMostDivided;
}

void PatchGrowth::add(const Member& member) {
  members_.push_back(member);
  front_[member.polygon] = member.front;
  if (space_.between({0, set_[member.polygon]}, member.front) !=
      SightSpace::Between::Always)
    ++divided_;
}

}  // namespace sightline::internal
