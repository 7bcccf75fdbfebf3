// Which faces of a scene see each other, exactly.
//
// The same decision as polygon_visibility, with all faces of a scene as occluders.  The
// occluders are looked up only where a segment runs that nothing known blocks, so that
// the cost follows what hides, not the size of the scene.

#pragma once

#include <memory>
#include <span>
#include <vector>

#include "linespace/polygon_visibility.h"
#include "linespace/scene.h"

namespace sightline {

/// The answer for face a and face b.
struct FacePairAnswer {
  int a, b;
  VisibilityAnswer answer;
  /// The faces that were looked at as occluders: with the question of these alone,
  /// check_cover verifies a cover.
  std::vector<int> occluders;
  /// With a seam: the polygons that these are grown to, as the cover numbers them.
  std::vector<int> pieces;
};

/// The answer for two sets of faces.
struct GroupAnswer {
  /// Visible when some pair is, Hidden when all are hidden.
  Verdict verdict = Verdict::Undecided;
  /// A visible pair, or nothing.  The pairs are asked in passes, each with more effort
  /// than the one before; this is the first pair, in order of the given faces, that the
  /// first successful pass finds visible.
  std::optional<FacePairAnswer> visible;
  /// The first pair that is undecided, unless a visible one is told.
  std::optional<FacePairAnswer> undecided;
  /// Every pair in order of the given faces, when asked for.
  std::vector<FacePairAnswer> pairs;
  std::int64_t pairs_hidden = 0, pairs_undecided = 0;
  VisibilityCost cost;
  StageCounts predicates;
};

/// Keeps a reference to the scene.  Immutable; safe to ask from several threads.
class FaceVisibility {
 public:
  /// The request's budget, stop and progress count.  Throws Stopped.
  /// seam: every face counts as an occluder grown by seam/2 in its own plane (seams.h),
  /// in scene units, finite, from 0 on.
  explicit FaceVisibility(const Scene& scene, const Request& request = {},
                          double seam = 0);
  ~FaceVisibility();
  FaceVisibility(FaceVisibility&&) noexcept;

  /// Does some segment from a's interior to b's interior miss every other face?  Faces in
  /// a's plane do not block at a, nor those in b's plane at b: two faces back to back
  /// make a sheet that sees to both sides.  Faces in one plane do not see each other.
  /// Throws InvalidInput for a face that the scene lacks.
  [[nodiscard]] FacePairAnswer between(int a, int b,
                                       const VisibilityRequest& request = {}) const;

  /// Whether some face of `as` sees some face of `bs`, not counting segments inside a
  /// convex solid that start on one of its faces and end on another: the face's own
  /// solid, or one glued to a part of it (a room, `Object::inside_out`, is air inside and
  /// none). So it does not matter how faces are cut. With all_pairs every pair is decided
  /// as by between(a, b) and listed.  A visible pair ends the question: what the other
  /// pairs would cost does not count.  On `request.threads` threads; the answer, and the
  /// pair that is told, are the same for any number.
  [[nodiscard]] GroupAnswer between(std::span<const int> as, std::span<const int> bs,
                                    bool all_pairs,
                                    const VisibilityRequest& request = {}) const;

  /// The faces that, grown, meet the closed segment between a and b, ascending; those
  /// that do not block between a and b are left out.
  [[nodiscard]] std::vector<int> met(int a, int b,
                                     const std::array<ExactPosition, 2>& segment) const;

  /// The question that a pair's cover answers.
  [[nodiscard]] VisibilityQuestion question_of(const FacePairAnswer& pair) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sightline
