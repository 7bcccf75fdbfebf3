// Is some segment of a sight space free, or do the blockers cover it?  A search that ends
// with a free segment or with a cover.
//
// A cell is a part of the sight space: a product of two smaller triangles, its domain, on
// which some forms have given signs, its path.  Each step looks for a segment in the
// cell. The smallest of the cell's forms is made large, first over a linear relaxation (a
// matrix game on the nine corner pairs), then by a few linear programs around the best
// point.
// - The relaxation has no solution: its multipliers prove that the cell is empty.
// - A segment is found and nothing blocks it: done, with a witness.
// - A segment is found and something blocks it: one blocker is subtracted.  What is left
//   of the cell is a cell per part of the blocker.
// - The cell may be a sliver between bilinear surfaces: the domain is halved, on which
//   relaxations are four times as sharp.
// In the spirit of Nirenstein, Blake and Gain (2002), who subtract blockers in Pluecker
// space; here no polytope is built and cells are held by signs alone.

#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "linespace/between/sight_space.h"
#include "linespace/polygon_visibility.h"

namespace sightline::internal {

/// What a step of the cover does; children follow their parent in preorder.
struct CoverNode {
  enum class Kind : std::uint8_t {
    Split,      ///< two children: form `index` has sign `sign`, then the opposite one
    HalveFrom,  ///< two children: corner i = `index` of the first triangle is moved to
                ///< the middle of its side to corner i + 1; then corner i + 1 is
    HalveTo,    ///< the same for the second triangle
    Blocked,    ///< leaf: blocker `index` blocks all of the cell
    Empty       ///< leaf: `count` shares from `index` on prove it empty
  };
  Kind kind;
  std::int8_t sign;
  std::int32_t index;
  std::int32_t count;
};

/// A share of an emptiness proof: a polynomial in the weights alpha and beta of the
/// domain's corners that is positive inside the cell.  It is
///     weight * (sign * form) [* (sign' * other)] [* alpha_i ...] [* beta_k ...],
/// the signs being those of the path, the forms not scaled.  Made homogeneous of degree 2
/// in alpha and in beta, the shares sum up to a polynomial without a positive
/// coefficient.
struct CoverShare {
  int form;
  int other = -1;
  std::array<std::int8_t, 2> alpha{-1, -1};  ///< corners, -1 for none
  std::array<std::int8_t, 2> beta{-1, -1};
  double weight = 1;
  int exact = -1;  ///< position in `exact_weights` when weight is only near it
};

struct Cover {
  std::vector<CoverNode> nodes;
  std::vector<CoverShare> shares;
  std::vector<Rational> exact_weights;
};

struct SearchTerms {
  Precision precision = Precision::Exact;
  std::uint64_t seed = 1;
  /// Segments spread over the space, at most 64: a blocker that blocks more of them is
  /// tried first.
  std::vector<SightPoint> pool;
  bool keep_cover = false;
  /// The search ends, undecided, when it has looked at more cells.
  std::int64_t most_cells = std::numeric_limits<std::int64_t>::max();
  /// Asked now and then; true ends the search.
  std::function<bool()> stop;
  /// Has the last word on a segment that no known blocker blocks.  May add blockers to
  /// the space instead.  Null: free.
  std::function<bool(const SightPoint&)> confirm;
};

enum class SearchOutcome { Free, Covered, Undecided };

struct SearchResult {
  SearchOutcome outcome;
  /// Undecided: because it had looked at `most_cells`.
  bool out_of_effort = false;
  /// Undecided: the pieces whose edges and planes bound the first cell that was given up.
  std::vector<int> stuck_between;
  /// The same cell's width, as the longer of its two triangles' longest sides; infinite
  /// where the search was ended from outside.
  double stuck_width = std::numeric_limits<double>::infinity();
  std::optional<SightPoint> segment;
  Cover cover;  ///< when kept, covered and certified
  /// Covered: no cell was decided in a way that the cover cannot hold.
  bool certified = true;
  VisibilityCost counts;
};

[[nodiscard]] SearchResult search_cover(SightSpace& space, const SearchTerms& terms);

}  // namespace sightline::internal
