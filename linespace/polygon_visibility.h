// Do two polygons see each other among occluders?  Exactly, with a proof either way.
//
// `polygon_visibility` decides whether some segment from a's interior to b's interior
// misses every closed occluder.  "Visible" comes with such a segment, in numbers that are
// exactly what they say; "hidden" with a cover of the segments between a and b, which
// check_cover (visibility_cover.h) verifies by itself.
// Method, cost and measurements: docs/polygon_visibility.md.

#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "linespace/exact_position.h"
#include "linespace/predicates.h"
#include "linespace/request.h"
#include "linespace/scene.h"

namespace sightline {

class VisibilityCover;

/// Corners of a convex polygon in order, either way around.  One that is not exactly
/// planar is cut into triangles.
using Polygon = std::vector<Point>;

struct VisibilityQuestion {
  Polygon a, b;
  std::vector<Polygon> occluders;
};

enum class Verdict : std::uint8_t {
  Visible,
  Hidden,
  /// Stopped or over budget.  (Or an opening, if there is one, is narrower than 2^-50 of
  /// a and b and could not be decided in exact numbers either; no such question is
  /// known.)
  Undecided
};

struct VisibilityRequest : Request {
  /// Segments tried first: an eighth of them evenly spread, the others on walks from the
  /// least blocked of these; with samples_only all are spread.
  int samples = 4096;
  /// Stop there: the answer is Visible, with a witness, or Undecided.
  bool samples_only = false;
  std::uint64_t seed = 1;
  bool keep_cover = false;
};

struct VisibilityCost {
  std::int64_t samples = 0;      ///< segments tried before the search
  std::int64_t cells = 0;        ///< parts of the space of segments looked at
  std::int64_t games = 0;        ///< linear programs in doubles
  std::int64_t exact_games = 0;  ///< linear programs in rationals
  std::int64_t halvings = 0;     ///< of a cell's triangles
  std::int64_t exact_cells = 0;  ///< cells decided by arranging curves
  std::int64_t undecided = 0;    ///< cells given up
};
VisibilityCost& operator+=(VisibilityCost& sum, const VisibilityCost& cost);

struct VisibilityAnswer {
  Verdict verdict = Verdict::Undecided;
  /// Visible: from a's interior to b's interior, missing every closed occluder.
  std::optional<std::array<ExactPosition, 2>> witness;
  /// Hidden, when asked for; null when a cell was too narrow for the proofs that a cover
  /// holds, and was decided without one.
  std::shared_ptr<const VisibilityCover> cover;
  /// Undecided: occluders beside the place that was given up first, ascending; none where
  /// the search was ended before it knew any.
  std::vector<int> occluders;
  /// Undecided: an opening there is at most this wide, in scene units; infinite where the
  /// search was ended from outside.
  double width = std::numeric_limits<double>::infinity();
  VisibilityCost cost;
};

/// Occluders block as closed sets: two that touch leave no gap, and so does one that a or
/// b touches from behind.  One without area, a segment or a point, hides nothing, but the
/// witness misses it.  The answer does not depend on order or orientation of anything;
/// which witness is given does.  With Precision::Double, signs are taken as rounding
/// gives them: "hidden" may be wrong, a witness is still checked. Throws InvalidInput,
/// naming the polygon ("a", "b", "occluders[3]"), for one without corners, coordinates
/// that are not admissible, a polygon that is not convex, and an a or b without area.
/// Cost: microseconds where a random segment is free; otherwise grows with the number of
/// occluders that must work together to hide, not with all of them.
[[nodiscard]] VisibilityAnswer polygon_visibility(const VisibilityQuestion& question,
                                                  const VisibilityRequest& request = {});

}  // namespace sightline
