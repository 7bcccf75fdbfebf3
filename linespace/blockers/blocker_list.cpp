#include "linespace/blockers/blocker_list.h"

namespace sightline::internal {
namespace {

// Speed only: longer lists are not kept: the tree is asked for each edge of the group.
constexpr std::size_t kLongest = 512;

}  // namespace

void BlockerList::list(const Shaft& hull, const Point& toward) {
  listed_ = true;
  list_.clear();
  toward_ = toward;
  too_many_ = g_->blocker_tree().any_towards(
      toward_, [&](const Box& box) { return hull.may_meet(box); },
      [&](std::uint32_t item) {
        const std::int32_t blocker = g_->blockers()[item];
        const Box& box = g_->blocker_box(blocker);
        if (hull.may_meet(box)) list_.push_back({box, blocker});
        return list_.size() > kLongest;
      });
}

}  // namespace sightline::internal
