// The blockers (silhouettes/silhouettes.h) between some viewpoints or an edge and a group
// of edges, listed once for all of them.

#pragma once

#include <cstdint>
#include <vector>

#include "linespace/silhouettes/silhouettes.h"
#include "linespace/space/shaft.h"

namespace sightline::internal {

class BlockerList {
 public:
  /// Keeps a reference.
  explicit BlockerList(const Silhouettes& silhouettes) : g_(&silhouettes) {}

  /// Another group: what was listed is forgotten.
  void forget() { listed_ = false; }
  [[nodiscard]] bool listed() const { return listed_; }
  /// Lists the blockers whose boxes may meet the hull, those that are less far `toward`
  /// some direction mostly first; when they are too many to be worth it, some.
  void list(const Shaft& hull, const Point& toward);
  /// Those listed.
  [[nodiscard]] std::size_t size() const { return list_.size(); }

  /// visit(blocker) -> bool for each whose box may meet a hull within that of list(),
  /// until one returns true, which is returned.  Requires listed().
  template <class Visit>
  bool any_of(const Shaft& hull, Visit&& visit) const {
    if (too_many_) {
      return g_->blocker_tree().any_towards(
          toward_, [&](const Box& box) { return hull.may_meet(box); },
          [&](std::uint32_t item) {
            const std::int32_t blocker = g_->blockers()[item];
            return hull.may_meet(g_->blocker_box(blocker)) && visit(blocker);
          });
    }
    for (const Listed& l : list_) {
      if (hull.may_meet(l.box) && visit(l.blocker)) return true;
    }
    return false;
  }

 private:
  struct Listed {
    Box box;
    std::int32_t blocker;
  };

  const Silhouettes* g_;
  bool listed_ = false, too_many_ = false;
  Point toward_;
  std::vector<Listed> list_;
};

}  // namespace sightline::internal
