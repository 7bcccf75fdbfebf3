// A walk along one segment: from event to event.
//
// Candidates (path_candidates.h) are all positions at which some element of a view lines
// up with anything of the scene:
//
//   a line beside which something lies behind, before a point where lines end or touch;
//   a seen corner or touch, before a line;
//   two lines that are seen to cross, before a third;
//   the plane of a facet.
//
// Why no event is missed: an event happens in points of the picture, in which things at
// different depths are seen in one, or at a facet seen edge-on.  In such a point, of all
// that lines up, the nearest is seen before the event as after it, for nothing hides it
// there; and where it is a line that goes straight on, one side of it is open, and what
// is seen there is the second in depth.  So the event is among the candidates of the view
// before it, and among those of the view after it too.
//
// So the walk keeps the view that holds now, with its candidates; goes to the next that
// may change this view; and looks just beyond it.  The view found there has candidates of
// its own: if one lies between the event and the eye that was taken, that eye was too far
// on, and one before it is taken.  When there is none, nothing changed on the way back to
// the event.  In this way both ends of every stretch are proven by the views themselves.

#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "linespace/path/path_candidates.h"
#include "linespace/path_events.h"

namespace sightline::internal {

/// A view on the walk, and what of it makes events.
struct WalkView {
  PointView view;
  SeenElements seen;
  WalkView(const PathScene& scene, PointView v) : view(std::move(v)), seen(scene, view) {}
  WalkView(const WalkView&) = delete;
  WalkView& operator=(const WalkView&) = delete;
};
using WalkViewPtr = std::shared_ptr<const WalkView>;

/// The view from an eye, in the way the caller wants it computed.
using Look = std::function<PointView(const Viewpoint&)>;

/// A change inside a segment, and the view after it.
struct WalkStep {
  PathRoot at;
  std::vector<PathEvent> events;
  WalkViewPtr after;
};

class PathWalk {
 public:
  /// Goes up to `end` on the path, changes there included.  Keeps references to the other
  /// three.
  PathWalk(const PathScene& scene, const SightPath& path, const Look& look, PathRoot end);

  /// The view just after the beginning.
  [[nodiscard]] WalkViewPtr first() const { return now_; }
  /// Goes on to the next change; nullopt: the structure stays up to the end.
  std::optional<WalkStep> next();

  /// Of a view that holds up to, or after, a root: the accidents that go on up to there,
  /// or from there on.  The eye of the view itself may be far off, where other things
  /// lined up that changed nothing; or only there.
  [[nodiscard]] std::vector<Accident> lasting_before(const PathRoot& root,
                                                     const WalkView& view) const;
  [[nodiscard]] std::vector<Accident> lasting_after(const PathRoot& root,
                                                    const WalkView& view) const;

 private:
  struct Looked {
    PathRoot at;
    WalkViewPtr view;
  };
  [[nodiscard]] Looked look_between(const PathRoot& from, const PathRoot& to) const;
  [[nodiscard]] WalkViewPtr look_after(const PathRoot& root);
  [[nodiscard]] std::vector<Accident> common_accidents(const Rational& u,
                                                       const Rational& v) const;
  [[nodiscard]] bool may_change(const PathCandidates::ByRoot::value_type& candidates,
                                const WalkView& view) const;
  [[nodiscard]] std::vector<PathEvent> name(
      const PathCandidates::ByRoot::value_type& candidates, const WalkView& before,
      const WalkView& after) const;

  const PathScene* scene_;
  const SightPath* path_;
  const Look* look_;
  PathCandidates candidates_;
  PathRoot here_{Rational(0)}, end_;
  WalkViewPtr now_;
};

}  // namespace sightline::internal
