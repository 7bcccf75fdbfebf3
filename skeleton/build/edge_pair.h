// The EEE line sets between two outer edges: every middle edge's curve in their square of
// parameters, cut down to where all three support and nothing blocks.

#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <vector>

#include "linespace/blockers/edge_view.h"
#include "linespace/lines/line_name.h"
#include "linespace/sight/line_probe.h"
#include "linespace/silhouettes/plane_values.h"
#include "linespace/silhouettes/silhouettes.h"
#include "linespace/space/shaft.h"
#include "linespace/swaths/carriers.h"
#include "linespace/swaths/eee_curve.h"
#include "linespace/swaths/pair_cells.h"
#include "skeleton/build/part.h"
#include "skeleton/graph.h"
#include "skeleton/nodes/known_lines.h"

namespace sightline::internal {

/// A node as it is found, by what determines its line.
struct FoundNode {
  NodeKind kind = NodeKind::EEEE;
  bool self = false, end = false;
  /// Found by an arc of solid mode.
  bool grazes = true;
  /// EEEE and Degenerate: which of the two lines.
  bool rising = false;
  /// EEEE: arcs between other outer edges may end there too.
  bool elsewhere = false;
  /// Polygon mode: the first, the last contact is an end contact.
  std::array<bool, 2> ends{};
  std::uint8_t count = 0;
  std::array<Generator, 4> generators{};
  std::array<Point, 2> segment;
  /// All generators in order, where the line has more than four; `generators` is not
  /// used then.
  std::vector<Generator> all;
  LineName line;  ///< as of NodeContacts
};

struct FoundArc {
  SkeletonArc arc;  ///< without node numbers
  std::array<FoundNode, 2> ends;
};

/// A plane's values along the first edge as a polynomial in s.
[[nodiscard]] inline BoundedLinear linear(const PlaneValues& v) {
  return {v.at0.value, v.at1.value, v.at0.error, v.at1.error, v.sign0, v.sign1};
}

/// Visits pairs of ridges; keeps scratch, so one per thread.
class EdgePairs {
 public:
  EdgePairs(const Silhouettes& silhouettes, const Carriers& carriers,
            const EeePart& part);

  /// Appends the arcs between ridge i and all ridges of higher number; breaks off, with
  /// some of them, once `stop` says so.
  void visit(int i, const std::function<bool()>& stop, std::vector<FoundArc>& out);

 private:
  struct Outer {  // one order of the two edges
    OuterPair points;
    int first, last;  // ridges
    // Planes a and b of the first edge at the last one's points and the reverse.
    std::array<PlaneValues, 2> first_planes, last_planes;
  };

  struct Subtree {
    std::uint32_t node;
    EdgeView::Pieces open;  // of the first edge: from which it is not hidden
  };

  [[nodiscard]] bool may_pair(int i, Subtree& at);
  void visit_group(int i, const Subtree& group, std::vector<FoundArc>& out);
  void visit_pair(int i, int j, std::vector<FoundArc>& out);
  [[nodiscard]] static bool share_facet(const Ridge& a, const Ridge& b);
  [[nodiscard]] bool gather(const Outer& outer);
  void add_to_cells(const Outer& outer, int face);
  [[nodiscard]] bool may_be_middle(const Outer& outer, int m, bool outer_through) const;
  [[nodiscard]] bool is_of(const Ridge& ridge, int face) const;
  [[nodiscard]] bool enters_only(int face) const;
  [[nodiscard]] const std::array<PlaneValues, 2>& planes_of(const Outer& outer, int face);
  void visit_middles(const Outer& outer, bool turned, std::vector<FoundArc>& out);
  void visit_curve(const Outer& outer, int middle, bool turned,
                   std::vector<FoundArc>& out);
  struct Stretch {
    CurveInterval part;
    Sign f0;
    std::array<bool, 2> ends;  // polygon mode: the outer contacts are end contacts
  };
  struct Constraint {
    BoundedLinear values;
    CurveCut cut;
    bool times_f0 = false;              // its sign is that of the values times that of F0
    bool zero0 = false, zero1 = false;  // at the ends
  };
  bool add_constraint(const BoundedLinear& values, const CurveCut& cut,
                      bool times_f0 = false);
  [[nodiscard]] static bool same_everywhere(const Constraint& x, const Constraint& y);
  // In the k-th plane at an edge; not yet enclosed.
  [[nodiscard]] static CurveCut plane_cut_at(const Ridge& r, int k, CurveCutKind kind) {
    return {kind, false, r.facets[k], {r.points[1 - k], r.points[k], r.thirds[k]}, 0, 1};
  }
  [[nodiscard]] bool constrain_to_square(const Outer& outer, const EeeCurve& curve);
  [[nodiscard]] bool constrain_at_middle(const Outer& outer, const Ridge& middle,
                                         bool& degenerate);
  [[nodiscard]] bool constrain_at_last(const Outer& outer, bool& degenerate);
  void constrain_at_first(const Outer& outer, const EeeCurve& curve, bool& degenerate);
  void find_stretches(const Outer& outer, const Ridge& middle, const EeeCurve& curve,
                      bool& degenerate);
  void find_blocked(const Outer& outer, const Ridge& middle, const EeeCurve& curve,
                    const CurveInterval& stretch, Sign f0, bool turned, bool& covered,
                    bool& degenerate);
  void block(const Outer& outer, const EeeCurve& curve, int face,
             const CurveInterval& stretch, Sign f0, Sign entry, bool& degenerate);
  [[nodiscard]] bool restrict_to(const EeeCurve& curve, const BoundedLinear& l,
                                 Sign wanted, CurveCutKind kind, int face);
  [[nodiscard]] CurveCut plane_cut(const BoundedLinear& l, CurveCutKind kind,
                                   int face) const;
  // The plane's values at the last edge's contact, times F0 - F1.
  [[nodiscard]] BoundedLinear at_last_edge(const EeeCurve& curve, const PlaneValues& q,
                                           int face) const {
    return curve.at_last_edge(q.at0, q.at1, plane_points(scene_, face));
  }
  void bury(const Outer& outer, const EeeCurve& curve, const CurveInterval& stretch,
            Sign f0);
  // Some face that pierces one of the three edges is such.
  template <class Is>
  [[nodiscard]] bool any_pierced(const Outer& outer, int middle, const Is& is) const {
    const int ridges[] = {outer.first, middle, outer.last};
    return std::any_of(std::begin(ridges), std::end(ridges), [&](int ridge) {
      const auto& faces = g_.ridges()[ridge].pierced_by;
      return std::any_of(faces.begin(), faces.end(), is);
    });
  }
  [[nodiscard]] bool passes_pierced(const Outer& outer, const EeeCurve& curve, int middle,
                                    const CurveInterval& open);
  [[nodiscard]] bool ends_at_pierced(const Outer& outer, const EeeCurve& curve,
                                     int middle, const CurveCut& cut);
  [[nodiscard]] std::vector<CurveInterval> open_parts(const EeeCurve& curve,
                                                      const CurveInterval& stretch);
  void add_arc(const Outer& outer, const EeeCurve& curve, int middle,
               const Stretch& stretch, std::vector<FoundArc>& out);
  [[nodiscard]] std::optional<PlaneSide> plane_of_pencil(const Outer& outer,
                                                         const EeeCurve& curve) const;
  [[nodiscard]] bool free_in_plane(const Outer& outer, const EeeCurve& curve,
                                   int middle) const;
  [[nodiscard]] std::vector<Stretch> free_parts(const Outer& outer, const EeeCurve& curve,
                                                const Stretch& open);
  [[nodiscard]] std::vector<CurveCut> stops_in(const Outer& outer, const EeeCurve& curve,
                                               const CurveInterval& open,
                                               std::span<const int> faces);
  template <class Add>
  void add_plane_stops(const Outer& outer, const EeeCurve& curve, int face,
                       const Add& add) const;
  [[nodiscard]] std::optional<std::array<bool, 2>> state_of(
      const Outer& outer, const std::optional<std::array<ExactPoint, 2>>& line,
      std::span<const int> faces, const Stretch& stretch, bool drawn) const;
  [[nodiscard]] std::vector<Rational> in_plane_stops(const Outer& outer,
                                                     const EeeCurve& curve,
                                                     std::span<const int> faces) const;
  [[nodiscard]] FoundNode node_at(const Outer& outer, const EeeCurve& curve, int middle,
                                  const CurveCut& cut, const Stretch& stretch);
  void name_by_cut(const Outer& outer, const EeeCurve& curve, int middle,
                   const CurveCut& cut, FoundNode& node);
  [[nodiscard]] bool is_single(const Outer& outer, const EeeCurve& curve,
                               int fourth) const;
  [[nodiscard]] std::array<bool, 2> ends_at(const Outer& outer, const EeeCurve& curve,
                                            const CurveCut& cut,
                                            const Stretch& stretch) const;
  [[nodiscard]] Sign side_of_corner(const Outer& outer, const EeeCurve& curve,
                                    const CurveCut& cut, int face, Sign f0) const;
  [[nodiscard]] bool ends_at_corner(const Outer& outer, const EeeCurve& curve,
                                    const CurveCut& cut, int corner, Sign f0) const;
  [[nodiscard]] bool may_touch_more(const Outer& outer, const EeeCurve& curve, int middle,
                                    const CurveCut& cut);
  [[nodiscard]] bool corner_may_touch_more(const Outer& outer, const EeeCurve& curve,
                                           const CurveCut& cut) const;
  [[nodiscard]] bool may_meet_face_corner(const Outer& outer, const EeeCurve& curve,
                                          const CurveCut& cut);
  [[nodiscard]] bool may_meet_other_edge(const Outer& outer, const EeeCurve& curve,
                                         int middle, const CurveCut& cut);
  [[nodiscard]] bool any_touched(std::span<const Generator> edges) const;
  void list_contacts(const Outer& outer, const EeeCurve& curve, const CurveCut& cut,
                     FoundNode& node);
  [[nodiscard]] bool rises_at(std::span<const Generator> edges,
                              const std::optional<std::array<ExactPoint, 2>>& line,
                              bool beyond_other) const;
  [[nodiscard]] bool may_touch_beyond(const Outer& outer, const EeeCurve& curve,
                                      const CurveCut& cut, const FoundNode& node);

  [[nodiscard]] const BoundedForm& form_of(const Outer& outer, int carrier);
  [[nodiscard]] const BoundedLinear& beside_last(const Outer& outer, int point);

  const Silhouettes& g_;
  const Scene& scene_;
  const Carriers& carriers_;
  const EeePart& selection_;

  EdgeView view_;              // from the first edge at hand
  EdgeView::Pieces open_ = 0;  // of the first edge, for the group at hand

  // The pair at hand.
  std::vector<EdgeView::Part> first_parts_;  // of the first edge
  std::vector<std::int32_t> faces_;
  std::vector<std::int32_t> others_;  // of neither edge
  std::uint32_t pair_stamp_ = 0;
  std::vector<std::uint32_t> face_stamp_;
  std::vector<std::array<PlaneValues, 2>> face_planes_;
  PairCells cells_;
  std::vector<PairCells::Side> cell_sides_;
  std::vector<std::uint32_t> middle_stamp_;
  std::vector<std::uint8_t> middle_allowed_;
  std::vector<std::uint32_t> form_stamp_;
  std::vector<BoundedForm> forms_;
  std::vector<std::uint32_t> point_stamp_;
  std::vector<BoundedLinear> beside_last_;

  // The curve at hand.
  std::vector<std::int32_t> blockers_;
  std::vector<Constraint> constraints_;
  std::vector<Stretch> stretches_;
  std::vector<CurveInterval> closed_, parts_, next_;

  // The node at hand.
  LineProbe probe_;
  KnownLines known_;
  std::uint32_t node_stamp_ = 0;
  std::vector<std::uint32_t> node_stamps_;
};

}  // namespace sightline::internal
