// Edges that faces pierce, in EdgePairs: where they are buried in material, and whether
// lines meet them where a face does.

#include <algorithm>

#include "skeleton/build/edge_pair.h"

namespace sightline::internal {

// Adds the parts of a stretch where an outer contact is buried.  A buried stretch of an
// edge lies, seen from the face at its beginning, on the side of the edge's second end;
// seen from the face at its end, on the side of the first.
void EdgePairs::bury(const Outer& outer, const EeeCurve& curve,
                     const CurveInterval& stretch, Sign f0) {
  const auto add = [&](const std::vector<BuriedStretch>& buried, const auto& keep_side) {
    for (const BuriedStretch& b : buried) {
      parts_.assign(1, stretch);
      if ((b.from < 0 || keep_side(b.from, 1)) && (b.to < 0 || keep_side(b.to, 0))) {
        closed_.push_back(parts_[0]);
      }
    }
  };
  add(g_.ridges()[outer.first].buried, [&](int face, int end) {
    const PlaneValues& p = planes_of(outer, face)[0];
    return restrict_to(curve, linear(p), end == 0 ? p.sign0 : p.sign1,
                       CurveCutKind::OnPlane, face);
  });
  add(g_.ridges()[outer.last].buried, [&](int face, int end) {
    const PlaneValues& q = planes_of(outer, face)[1];
    // The values at Q are times F0 - F1, which has the sign of F0.
    return restrict_to(curve, at_last_edge(curve, q, face),
                       f0 * (end == 0 ? q.sign0 : q.sign1), CurveCutKind::OnFar, face);
  });
}

// Whether, inside the open part, a line may pass the point where a face pierces one of
// the edges.  Where such a line crosses the face's plane, the face blocks the lines on
// one side of it at least, and it is not inside an open part.  So it lies in the plane;
// or all lines of the curve pass that point of the last edge.
bool EdgePairs::passes_pierced(const Outer& outer, const EeeCurve& curve, int middle,
                               const CurveInterval& open) {
  const auto vanishes_inside = [&](const BoundedLinear& l, CurveCutKind kind, int face) {
    if (l.constant()) return l.sign0 == Sign::Zero;
    if (l.sign0 == Sign::Zero || l.sign1 == Sign::Zero) return false;
    const CurveCut cut = plane_cut(l, kind, face);
    return curve.compare(open.from, cut) == Sign::Negative &&
           curve.compare(cut, open.to) == Sign::Negative;
  };
  const auto& last = g_.ridges()[outer.last].pierced_by;
  const bool all_pass = std::any_of(last.begin(), last.end(), [&](int face) {
    const BoundedLinear l = at_last_edge(curve, planes_of(outer, face)[1], face);
    return l.constant() && l.sign0 == Sign::Zero;
  });
  return all_pass || any_pierced(outer, middle, [&](int face) {
           const auto& [p, q] = planes_of(outer, face);
           if (q.sign0 == q.sign1 && q.sign0 != Sign::Zero) return false;
           return vanishes_inside(linear(p), CurveCutKind::OnPlane, face) &&
                  vanishes_inside(at_last_edge(curve, q, face), CurveCutKind::OnFar,
                                  face);
         });
}

// Whether, at a cut, an outer contact lies in the plane of a face that pierces one of the
// edges.
bool EdgePairs::ends_at_pierced(const Outer& outer, const EeeCurve& curve, int middle,
                                const CurveCut& cut) {
  const auto vanishes = [&](const BoundedLinear& l, CurveCutKind kind, int face) {
    if (l.constant()) return l.sign0 == Sign::Zero;
    if (l.sign0 == Sign::Zero) return cut.kind == CurveCutKind::Start;
    if (l.sign1 == Sign::Zero) return cut.kind == CurveCutKind::End;
    const CurveCut at = plane_cut(l, kind, face);
    return at.hi >= cut.lo && at.lo <= cut.hi && curve.compare(at, cut) == Sign::Zero;
  };
  return any_pierced(outer, middle, [&](int face) {
    const auto& [p, q] = planes_of(outer, face);
    return vanishes(linear(p), CurveCutKind::OnPlane, face) ||
           vanishes(at_last_edge(curve, q, face), CurveCutKind::OnFar, face);
  });
}

}  // namespace sightline::internal
