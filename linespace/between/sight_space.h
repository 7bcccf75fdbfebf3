// The segments between two triangles, and what blocks them, as bilinear functions.
//
// A segment from p = sum_j alpha_j a_j to q = sum_k beta_k b_k is a point (alpha, beta)
// of a product of two triangles, the *sight space*.  Whatever decides whether it is
// blocked is a sign of a function that is linear in p and linear in q: the side of an
// edge, the side of a plane on which p or q lies.  Such a *form* is known by its values
// at the nine corner pairs (a_j, b_k); its value elsewhere is their mean with weights
// alpha_j beta_k, and where the nine have one sign, so has all of the sight space.  A
// closed occluder blocks where a few forms, its *blocker*, all have given signs or
// vanish.

#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <unordered_map>
#include <vector>

#include "linespace/numbers/rational.h"
#include "linespace/predicates.h"
#include "linespace/scene.h"

namespace sightline::internal {

using Triangle = std::array<Point, 3>;
/// Weights of a point of a triangle: not negative, sum 1.
using Weights = std::array<double, 3>;

using ExactWeights = std::array<Rational, 3>;

/// A segment of a sight space, by its ends' weights.
struct SightPoint {
  /// Multiples of 2^-52, sum exactly 1; or `exact`, rounded.
  Weights alpha, beta;
  /// The weights, sum 1, where doubles do not hold them; null: alpha and beta are exact.
  std::shared_ptr<const std::array<ExactWeights, 2>> exact = nullptr;
};
/// The weights of p, and of q.
[[nodiscard]] std::array<ExactWeights, 2> weights_of(const SightPoint& s);

/// What a form measures; occluder corners are counted within one convex piece.
enum class FormKind : std::uint8_t {
  EdgeSide,   ///< orient3d(p, q, corner, next corner)
  FromPlane,  ///< orient3d(first three corners, p)
  ToPlane,    ///< orient3d(first three corners, q)
  // The rest only where a, b and the occluder lie in one plane, with an apex off it:
  CornerSide,  ///< orient3d(p, q, corner, apex)
  FromEdge,    ///< orient3d(corner, next corner, apex, p)
  ToEdge       ///< orient3d(corner, next corner, apex, q)
};

struct FormName {
  FormKind kind;
  int piece;
  int corner;
};

/// The points that FormKind's comments list: what a form is made of.  An edge is listed
/// from its lexicographically smaller end.
using FormPoints = std::array<Point, 3>;

/// Which of the two points a form depends on.
enum class Dependence : std::uint8_t { Both, From, To };

/// Values at the corner pairs (j, k), at position 3 j + k, each off by at most its error;
/// all times a power of two that brings the largest into [1/2, 1).
struct CornerValues {
  std::array<double, 9> value{};
  std::array<double, 9> error{};

  /// The value is certainly 0 or of that sign at each of the nine.
  [[nodiscard]] bool certainly(int sign) const;
};

struct Form {
  FormName name;
  Dependence depends = Dependence::Both;
  CornerValues at;
  /// 1, -1: at all corners 0 or of that sign, exactly; 2: all exactly 0; 0: neither.
  std::int8_t constant = 0;
};

/// A piece with the side from which it is crossed: front 1, from the side of its plane
/// on which orient3d of its first three corners is positive.
struct FacingPiece {
  int piece;
  std::int8_t front;
};

/// One way in which an occluder blocks: where sign * form >= 0 for all of its parts, see
/// SightSpace::parts.
struct Blocker {
  struct Part {
    int form;
    std::int8_t sign;
    auto operator<=>(const Part&) const = default;
  };
  int piece;             ///< -1 for a patch, and for two blockers in one
  int first, count = 0;  ///< of its parts
  /// Two blockers of which one has `shared` as a part, the other its opposite.  Where all
  /// their other parts hold, one of the two blocks: a line that passes inside the
  /// silhouette of both meets one of them, on whichever side of their common edge.
  std::array<int, 2> halves{-1, -1};
  Part shared{-1, 0};  ///< as halves[0] has it
  /// A connected surface that blocks by its outline: position in patches().
  int patch = -1;
};

/// A convex planar occluder, at least three corners, the first three not collinear.
struct Piece {
  int occluder;
  std::vector<Point> corners;
};

/// Tables for one pair of triangles.  Occluders can be added as they are found.
class SightSpace {
 public:
  /// The triangles must have area.  All coordinates are those of the caller's question
  /// times 2^scaled_by.
  SightSpace(const Triangle& a, const Triangle& b, int scaled_by = 0);

  /// Adds all ways in which the piece blocks, alone and together with pieces that share
  /// an edge's line with it; those that block no open set of segments are left out.
  void add(int number, const Piece& piece);

  /// How a crossing of the piece is known to lie between p and q: because the whole piece
  /// lies between the planes of a and b, or all of a and all of b on opposite sides of
  /// its plane; because the segment has them so, which takes two parts; or never.
  enum class Between : std::uint8_t { Always, WhereItsPlaneDivides, Never };
  [[nodiscard]] Between between(const Piece& piece, int front) const;

  /// Pieces with the side from which they are crossed; common sides, with the very same
  /// corners, cancel when they are passed in opposite directions, and what remains is the
  /// patch's outline.  A line that has every side of the outline on the same hand winds
  /// around it, and so meets the patch.
  struct PatchPiece {
    FacingPiece facing;
    const Piece* piece;
  };
  /// False, and nothing added, when no open set of segments passes it so, or its outline
  /// is empty.  Requires that no piece is never between.
  bool add_patch(std::span<const PatchPiece> patch);
  [[nodiscard]] const std::vector<std::vector<FacingPiece>>& patches() const {
    return patches_;
  }

  [[nodiscard]] const Triangle& a() const { return a_; }
  [[nodiscard]] const Triangle& b() const { return b_; }
  [[nodiscard]] std::span<const Form> forms() const { return forms_; }
  [[nodiscard]] std::span<const Blocker> blockers() const { return blockers_; }
  /// Only forms that are not constant; none: the blocker blocks everything.
  [[nodiscard]] std::span<const Blocker::Part> parts(const Blocker& blocker) const {
    return {parts_.data() + blocker.first, static_cast<std::size_t>(blocker.count)};
  }

  [[nodiscard]] const FormPoints& points(int form) const { return points_[form]; }

  /// CornerValues are the form's values times 2 to the minus this, in the units of the
  /// caller's question: each form has degree 3 in the coordinates.
  [[nodiscard]] int exponent(int form) const { return exponents_[form] - 3 * scaled_by_; }

  /// Exact corner values of a form of this space, on the scale of CornerValues.
  [[nodiscard]] std::array<Rational, 9> exact(int form) const;

  /// Whether the blocker blocks the segment, exactly.
  [[nodiscard]] bool blocks(const Blocker& blocker, const SightPoint& s) const;

 private:
  // Lines of edges, by direction and moment, rounded: equal keys are a hint.
  struct Key {
    std::array<double, 6> numbers;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const;
  };

  int form(const FormName& name, const Piece& piece, bool* reversed);
  int new_form(const FormName& name, const FormPoints& x);
  [[nodiscard]] Key line_key(const Point& from, const Point& to) const;
  void add_blocker(int number, std::span<const Blocker::Part> parts);
  void store(Blocker blocker, std::span<const Blocker::Part> parts);
  void join_neighbours();
  void join(int b, int other, const Blocker::Part& shared);
  void add_coplanar(int number, const Piece& piece);

  Triangle a_, b_;
  Point apex_;  // off the common plane, if there is one
  std::vector<Form> forms_;
  std::vector<int> exponents_;  // of the scale, per form, in the units of a_ and b_
  std::vector<FormPoints> points_;
  std::vector<Blocker> blockers_;
  std::vector<Blocker::Part> parts_;
  std::vector<std::vector<FacingPiece>> patches_;
  // Side of b of a's plane and of a of b's plane; 0: not on one side.
  int b_of_a_ = 0, a_of_b_ = 0;
  std::unordered_map<Key, std::vector<int>, KeyHash> edge_forms_;
  // For each form that is an edge's: the blockers it is a part of.
  std::unordered_map<int, std::vector<std::pair<int, std::int8_t>>> users_;
  std::set<std::vector<Blocker::Part>> joined_;
  std::size_t neighbours_known_ = 0;  // blockers up to here were joined to others
  double size_ = 1;                   // of the largest coordinate, a power of two
  int scaled_by_;
};

/// The outline of a patch: sides of pieces from their lexicographically smaller end, and
/// how often they are passed in that direction; those that cancel are left out.
struct OutlineSide {
  int piece, corner;  ///< one of the pieces that have it
  int times;
};
template <class CornersOf>  // std::span<const Point>(int piece)
[[nodiscard]] std::vector<OutlineSide> outline(std::span<const FacingPiece> patch,
                                               CornersOf corners_of);

/// 1 or -1 when all points are on that side of the triangle's plane or on it, and one is
/// off it; 0 otherwise.
[[nodiscard]] int side_of_plane(const Triangle& plane, std::span<const Point> points);

/// A point off the plane of the triangle, with coordinates near its own.
[[nodiscard]] Point apex_off(const Triangle& triangle);

template <class CornersOf>
std::vector<OutlineSide> outline(std::span<const FacingPiece> patch,
                                 CornersOf corners_of) {
  const auto less = [](const Point& u, const Point& v) {
    return std::lexicographical_compare(u.data(), u.data() + 3, v.data(), v.data() + 3);
  };
  const auto both_less = [&](const std::array<Point, 2>& x,
                             const std::array<Point, 2>& y) {
    if (x[0] != y[0]) return less(x[0], y[0]);
    return less(x[1], y[1]);
  };
  std::map<std::array<Point, 2>, OutlineSide, decltype(both_less)> sides(both_less);
  for (const auto& [piece, front] : patch) {
    const std::span<const Point> corners = corners_of(piece);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      std::array<Point, 2> ends{corners[i], corners[(i + 1) % corners.size()]};
      const bool reversed = less(ends[1], ends[0]);
      if (reversed) std::swap(ends[0], ends[1]);
      const auto [known, is_new] =
          sides.try_emplace(ends, OutlineSide{piece, static_cast<int>(i), 0});
      known->second.times += reversed ? -front : front;
    }
  }
  std::vector<OutlineSide> left;
  for (const auto& [ends, side] : sides) {
    if (side.times != 0) left.push_back(side);
  }
  return left;
}

/// orient3d's determinant, exactly.
[[nodiscard]] Rational exact_orient3d(const ExactPoint& a, const ExactPoint& b,
                                      const ExactPoint& c, const ExactPoint& d);

/// The value of a form in rationals.
[[nodiscard]] Rational exact_form_value(FormKind kind, const FormPoints& points,
                                        const ExactPoint& p, const ExactPoint& q);

}  // namespace sightline::internal
