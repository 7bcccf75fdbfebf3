// Exact positions along an edge, and unions of intervals between them.

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "linespace/contacts/contact.h"
#include "linespace/generator.h"
#include "linespace/predicates.h"
#include "linespace/scene.h"

namespace sightline::internal {

/// What cuts the edge at a position.
enum class CutKind : std::uint8_t {
  Start,    ///< the edge's first end point
  End,      ///< its second
  Side,     ///< a blocker's side: its plane with the viewpoint crosses the edge there
  Support,  ///< the plane of a face at the viewpoint
  Saddle,   ///< the plane of two edges at the viewpoint
  Pierce    ///< the edge enters a face
};

/// A position on an edge: where a plane through three scene points crosses it.
struct Cut {
  CutKind kind;
  /// Side: scene edge id; Support and Pierce: facet id; Saddle: none (-1).
  std::int32_t feature = -1;
  /// Point ids of the plane; unused for Start and End.
  std::array<std::int32_t, 3> plane{-1, -1, -1};
  /// Enclosure of the parameter: 0 at the edge's start, 1 at its end.
  double lo = 0, hi = 0;
  /// The parameter itself where no three scene points span the plane; kept alive by the
  /// VertexView that the cut belongs to.
  const Rational* exact = nullptr;

  [[nodiscard]] double parameter() const { return 0.5 * (lo + hi); }
};

inline Cut start_cut() { return {CutKind::Start, -1, {-1, -1, -1}, 0, 0}; }
inline Cut end_cut() { return {CutKind::End, -1, {-1, -1, -1}, 1, 1}; }

/// The cut where a plane's values at the edge's two ends, of opposite signs, vanish in
/// between.
[[nodiscard]] Cut make_cut(CutKind kind, std::int32_t feature,
                           const std::array<std::int32_t, 3>& plane,
                           const BoundedValue& at_start, const BoundedValue& at_end);

/// A cut at a given parameter strictly between 0 and 1; keeps a pointer to it.
[[nodiscard]] Cut exact_cut(const Rational& parameter);

/// The exact parameter of a cut along the edge from `start` to `end`.
[[nodiscard]] Rational exact_parameter(const Scene& scene, const LineThrough& edge,
                                       const Cut& cut);

/// The same as a double, off by at most kRangeError (at precision Double: as enclosed).
[[nodiscard]] double rounded_parameter(const Scene& scene, const LineThrough& edge,
                                       const Cut& cut);

/// Order of two cuts along the edge from `start` to `end`: exact.
[[nodiscard]] Sign compare(const Scene& scene, const LineThrough& edge, const Cut& a,
                           const Cut& b);

/// An interval of an edge between two cuts.
struct CutInterval {
  Cut from, to;
};

/// A union of closed intervals of an edge, kept sorted and disjoint.
class CutUnion {
 public:
  CutUnion(const Scene& scene, const LineThrough& edge) : scene_(&scene), edge_(edge) {}

  /// Adds [from, to]; nothing when from is not before to.
  void add(const Cut& from, const Cut& to);
  [[nodiscard]] bool covers_all() const {
    return intervals_.size() == 1 && intervals_[0].from.kind == CutKind::Start &&
           intervals_[0].to.kind == CutKind::End;
  }
  /// The open intervals of (Start, End) that no added interval meets, in order.
  [[nodiscard]] std::vector<CutInterval> complement() const;
  [[nodiscard]] std::span<const CutInterval> intervals() const { return intervals_; }
  [[nodiscard]] bool empty() const { return intervals_.empty(); }

 private:
  [[nodiscard]] int order(const Cut& a, const Cut& b) const {
    return static_cast<int>(compare(*scene_, edge_, a, b));
  }

  const Scene* scene_;
  LineThrough edge_;
  std::vector<CutInterval> intervals_;
};

}  // namespace sightline::internal
