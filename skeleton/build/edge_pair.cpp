#include "skeleton/build/edge_pair.h"

#include <algorithm>
#include <cmath>

#include "linespace/blockers/occluder_shadow.h"
#include "linespace/lines/rounded_root.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal {

EdgePairs::EdgePairs(const Silhouettes& silhouettes, const Carriers& carriers,
                     const EeePart& part)
    : g_(silhouettes),
      scene_(silhouettes.scene()),
      carriers_(carriers),
      selection_(part),
      view_(silhouettes),
      face_stamp_(scene_.faces().size(), 0),
      face_planes_(scene_.faces().size()),
      middle_stamp_(silhouettes.ridges().size(), 0),
      middle_allowed_(silhouettes.ridges().size(), 0),
      form_stamp_(carriers.all.size(), 0),
      forms_(carriers.all.size()),
      point_stamp_(scene_.points().size(), 0),
      beside_last_(scene_.points().size()),
      probe_(silhouettes),
      node_stamps_(carriers.all.size(), 0) {}

void EdgePairs::visit(int i, const std::function<bool()>& stop,
                      std::vector<FoundArc>& out) {
  if (!selection_.has(i)) return;
  const Bvh& tree = g_.ridge_tree();
  if (tree.empty()) return;
  view_.begin(i);
  std::vector<Subtree> stack{{0, view_.pieces()}};
  while (!stack.empty() && !stop()) {
    Subtree at = stack.back();
    stack.pop_back();
    if (!may_pair(i, at)) continue;
    if (g_.ridge_group(at.node).begins) {
      view_.look_at(tree.node(at.node).box, at.open);
      visit_group(i, at, out);
      view_.look_away();
      continue;
    }
    const std::uint32_t child = tree.node(at.node).first;
    stack.push_back({child + 1, at.open});
    stack.push_back({child, at.open});
  }
}

// False: no ridge below can be the last of a pair; else leaves the pieces of the first
// from which it can.
bool EdgePairs::may_pair(int i, Subtree& at) {
  const Box& box = g_.ridge_tree().node(at.node).box;
  if (g_.ridge_group(at.node).highest <= i) return false;
  if (!selection_.may_pair(i, view_.box(), at.node, box)) return false;
  if (view_.never_touched_from(box) || view_.hides(box)) return false;
  const bool cut = at.open != 0;
  at.open = view_.open(at.open, box);
  return !cut || at.open != 0;
}

void EdgePairs::visit_group(int i, const Subtree& group, std::vector<FoundArc>& out) {
  const Bvh& tree = g_.ridge_tree();
  std::vector<Subtree> stack{group};
  while (!stack.empty()) {
    Subtree at = stack.back();
    stack.pop_back();
    if (at.node != group.node && !may_pair(i, at)) continue;
    const Bvh::Node& node = tree.node(at.node);
    if (node.count == 0) {
      stack.push_back({node.first + 1, at.open});
      stack.push_back({node.first, at.open});
      continue;
    }
    open_ = at.open;
    for (std::uint32_t k = 0; k < node.count; ++k) {
      const int j = static_cast<int>(tree.items()[node.first + k]);
      hear_stop();
      if (j > i && selection_.has(j) && selection_.has_outer(i, j) &&
          !g_.ridge_sides(node.first + k)
               .never_touched_from(view_.end(0), view_.end(1))) {
        visit_pair(i, j, out);
      }
    }
  }
}

// A line that meets two sides of a facet lies in its plane: those are the lines of that
// plane, not of three edges.
bool EdgePairs::share_facet(const Ridge& a, const Ridge& b) {
  return share(a.all_facets, b.all_facets);
}

void EdgePairs::visit_pair(int i, int j, std::vector<FoundArc>& out) {
  const Ridge& r = g_.ridges()[i];
  const Ridge& s = g_.ridges()[j];
  for (const int o : r.objects) {
    if (g_.convex_solid(o) && share(std::span(&o, 1), s.objects)) return;
  }
  Outer outer;
  outer.points = {&scene_, r.points, s.points};
  outer.first = i;
  outer.last = j;
  const Point& q0 = scene_.point(s.points[0]);
  const Point& q1 = scene_.point(s.points[1]);
  // A line grazes an edge iff the other point is not on the same side of both planes.
  const auto never_touches = [](const Ridge& ridge, const std::array<PlaneValues, 2>& v) {
    return v[0].sign0 == v[0].sign1 && v[1].sign0 == v[1].sign1 &&
           v[0].sign0 == v[1].sign0 && v[0].sign0 != Sign::Zero &&
           ridge.contact(v[0].sign0, v[0].sign0) == EdgeContact::None;
  };
  outer.first_planes = {plane_values(r.a, q0, q1), plane_values(r.b, q0, q1)};
  if (never_touches(r, outer.first_planes)) return;
  const Point& p0 = view_.end(0);
  const Point& p1 = view_.end(1);
  outer.last_planes = {plane_values(s.a, p0, p1), plane_values(s.b, p0, p1)};
  if (never_touches(s, outer.last_planes)) return;
  if (share_facet(r, s)) return;
  if (view_.hides(q0, q1)) return;
  hear_stop_now();
  if (!gather(outer)) return;
  visit_middles(outer, false, out);
  // Where the middle edge and the last are coplanar, s is constant: the other way round.
  Outer turned;
  turned.points = {&scene_, s.points, r.points};
  turned.first = j;
  turned.last = i;
  turned.first_planes = outer.last_planes;
  turned.last_planes = outer.first_planes;
  visit_middles(turned, true, out);
}

namespace {

PairCells::Linear on_edge(const PlaneValues& v) {
  return {v.at0.value, v.at1.value, std::max(v.at0.error, v.at1.error),
          v.sign0 == Sign::Zero, v.sign1 == Sign::Zero};
}

}  // namespace

// Faces that may meet a segment between the two edges, and the middle edges among their
// sides; false when there are none.
bool EdgePairs::gather(const Outer& outer) {
  const Ridge& first = g_.ridges()[outer.first];
  const Ridge& last = g_.ridges()[outer.last];
  // With a new stamp all that is kept by face, point, ridge or carrier is out of date.
  ++pair_stamp_;
  const Point& p0 = view_.end(0);
  const Point& p1 = view_.end(1);
  const Point& q0 = scene_.point(last.points[0]);
  const Point& q1 = scene_.point(last.points[1]);
  // 1. A part through a group, with neither edge on it: some line between the two must
  // come near the group.
  const bool outer_through =
      selection_.goes_through(outer.first) || selection_.goes_through(outer.last);
  if (!outer_through && !Shaft(p0, p1, q0, q1).may_meet(selection_.through_box) &&
      !selection_.may_reach(view_.box(), box_of(std::array<Point, 2>{q0, q1}))) {
    return false;
  }
  // 2. The faces that may meet a segment between the edges, and the parts of the first
  // edge: from some of them one face is known to hide all of the last edge.
  if (!view_.look(open_, q0, q1, first_parts_, faces_)) return false;
  // 3. The square of the two edges' parameters is divided into cells; a cell that one
  // face hides, or where an edge is not grazed, has no line.
  cells_.begin({{on_edge(outer.first_planes[0]), on_edge(outer.first_planes[1])},
                touched_on(first),
                (p1 - p0).norm(),
                visible_range(first.buried)},
               {{on_edge(outer.last_planes[0]), on_edge(outer.last_planes[1])},
                touched_on(last),
                (q1 - q0).norm(),
                visible_range(last.buried)});
  // Faces at the outer edges themselves are not met by lines that support there.
  others_.clear();
  for (const int face : faces_) {
    if (is_of(first, face) || is_of(last, face)) continue;
    others_.push_back(face);
    add_to_cells(outer, face);
  }
  // 4. Sides of faces that cross a cell which stays open are middle edges, if they may be
  // any: asked of many cells, answered once for a pair.
  const std::function<bool(int)> is_middle = [&](int m) {
    if (middle_stamp_[m] != pair_stamp_) {
      middle_stamp_[m] = pair_stamp_;
      middle_allowed_[m] = may_be_middle(outer, m, outer_through);
    }
    return middle_allowed_[m] != 0;
  };
  // 5. Each part is divided into cells on its own.  That one face hides a part is
  // remembered: of other edges near the last one it is likely to hide them, too.
  for (std::size_t k = 0; k < first_parts_.size(); ++k) {
    const EdgeView::Part& part = first_parts_[k];
    if (part.hidden_by >= 0) {
      cells_.hide(part.from, part.to, occluder_key(g_, part.hidden_by));
      continue;
    }
    const int hidden_by = cells_.divide(part.from, part.to, is_middle);
    if (hidden_by >= 0) view_.remember(k, hidden_by);
  }
  // Where no middle edge crosses an open cell, no line meets three edges.
  cells_.finish();
  return !cells_.middles().empty();
}

// Tells the cells of a face that may meet a segment between the edges, unless both edges
// lie on one side of its plane, or in it: then no segment crosses the plane.
void EdgePairs::add_to_cells(const Outer& outer, int face) {
  const auto& [p, q] = planes_of(outer, face);
  if (p.sign0 == p.sign1 && p.sign0 == q.sign0 && p.sign0 == q.sign1) return;
  const bool front_only = enters_only(face);
  if (front_only && p.sign0 == Sign::Negative && p.sign1 == Sign::Negative) return;
  cell_sides_.clear();
  for (const auto& side : carriers_.of_face(face)) {
    // A side in one plane with both edges is no middle edge: all their lines meet it.
    const BoundedForm& form = form_of(outer, side.carrier);
    const int middle = form.vanishes() ? -1 : carriers_.ridge[side.carrier];
    cell_sides_.push_back({&form, middle, side.forward});
  }
  cells_.add_face(face, occluder_key(g_, face), front_only, on_edge(p), on_edge(q),
                  cell_sides_);
}

// Ridge m can be grazed between the two edges, as far as it is told without a line, and
// is of the part.  `outer_through`: one of the outer edges is on the group to go through.
bool EdgePairs::may_be_middle(const Outer& outer, int m, bool outer_through) const {
  const Ridge& first = g_.ridges()[outer.first];
  const Ridge& last = g_.ridges()[outer.last];
  const Ridge& ridge = g_.ridges()[m];
  const bool own =
      std::any_of(ridge.objects.begin(), ridge.objects.end(), [&](const std::int32_t& o) {
        return g_.convex_solid(o) && (share(std::span(&o, 1), first.objects) ||
                                      share(std::span(&o, 1), last.objects));
      });
  return !own && ridge.can_graze() && &ridge != &first && &ridge != &last &&
         selection_.has(m) &&
         (outer_through || selection_.by_lines || selection_.goes_through(m)) &&
         !share_facet(ridge, first) && !share_facet(ridge, last);
}

// A line that supports there does not meet the face elsewhere: of its convex solid, or in
// the plane of a face at the edge.
bool EdgePairs::is_of(const Ridge& ridge, int face) const {
  const Face& f = scene_.faces()[face];
  if (std::find(ridge.objects.begin(), ridge.objects.end(), f.object) ==
      ridge.objects.end()) {
    return false;
  }
  if (g_.convex_solid(f.object)) return true;
  const auto& sides = scene_.edges()[ridge.edge].sides;
  return std::any_of(sides.begin(), sides.end(), [&](const Edge::Side& side) {
    return scene_.faces()[side.face].facet == f.facet;
  });
}

// From the first edge, outside a closed solid, a segment must enter it.
bool EdgePairs::enters_only(int face) const {
  const int object = scene_.faces()[face].object;
  return scene_.objects()[object].closed &&
         !boxes_meet(g_.object_box(object), view_.box());
}

// The face's plane along the first and the last edge.
const std::array<PlaneValues, 2>& EdgePairs::planes_of(const Outer& outer, int face) {
  auto& both = face_planes_[face];
  if (face_stamp_[face] != pair_stamp_) {
    face_stamp_[face] = pair_stamp_;
    const PlaneSide& plane = g_.face_plane(face);
    const auto& o = outer.points;
    both = {plane_values(plane, o.at(o.p[0]), o.at(o.p[1])),
            plane_values(plane, o.at(o.q[0]), o.at(o.q[1]))};
  }
  return both;
}

const BoundedForm& EdgePairs::form_of(const Outer& outer, int carrier) {
  if (form_stamp_[carrier] != pair_stamp_) {
    form_stamp_[carrier] = pair_stamp_;
    forms_[carrier] = outer.points.form(carriers_.all[carrier]);
  }
  return forms_[carrier];
}

// The plane of the last edge and a point, at the first edge's ends.
const BoundedLinear& EdgePairs::beside_last(const Outer& outer, int point) {
  BoundedLinear& l = beside_last_[point];
  if (point_stamp_[point] != pair_stamp_) {
    point_stamp_[point] = pair_stamp_;
    const auto& o = outer.points;
    const PlaneSide plane({o.at(o.q[0]), o.at(o.q[1]), o.at(point)});
    const auto v = plane_values(plane, o.at(o.p[0]), o.at(o.p[1]));
    l = {v.at0.value, v.at1.value, v.at0.error, v.at1.error, v.sign0, v.sign1};
  }
  return l;
}

void EdgePairs::visit_middles(const Outer& outer, bool turned,
                              std::vector<FoundArc>& out) {
  bool fresh = !turned;
  for (const int m : cells_.middles()) {
    const Ridge& r = g_.ridges()[m];
    const auto& last = g_.ridges()[outer.last].points;
    const auto& first = g_.ridges()[outer.first].points;
    const auto coplanar = [&](const std::array<std::int32_t, 2>& e) {
      return orient3d(scene_.point(e[0]), scene_.point(e[1]), scene_.point(r.points[0]),
                      scene_.point(r.points[1])) == Sign::Zero;
    };
    // Usually neither is.  A middle edge coplanar with both is left out.
    if (turned) {
      if (!coplanar(first) || coplanar(last)) continue;
    } else if (coplanar(last)) {
      continue;
    }
    if (!fresh) {
      ++pair_stamp_;
      fresh = true;
    }
    visit_curve(outer, m, turned, out);
  }
}

void EdgePairs::visit_curve(const Outer& outer, int middle, bool turned,
                            std::vector<FoundArc>& out) {
  const Ridge& r = g_.ridges()[middle];
  const int carrier = carriers_.of_ridge[middle];
  const BoundedLinear& w0 = beside_last(outer, r.points[0]);
  const BoundedLinear& w1 = beside_last(outer, r.points[1]);
  if (w0.constant() && w1.constant() && w0.sign0 == w1.sign0) return;
  const EeeCurve curve(outer.points, carriers_.all, carrier, form_of(outer, carrier));
  const auto touched_along = [&](int ridge) {
    return g_.ridges()[ridge].touched_along();
  };
  const bool touched =
      r.touched_along() || touched_along(outer.first) || touched_along(outer.last);
  bool degenerate = touched;  // or lines of the curve lie in the plane of a face
  find_stretches(outer, r, curve, degenerate);
  for (std::size_t i = 0; i < stretches_.size(); ++i) {
    const Stretch stretch = stretches_[i];
    if (!cells_.faces_along(curve.form(), turned, stretch.part.from.lo,
                            stretch.part.to.hi, blockers_)) {
      continue;
    }
    bool covered = false;
    find_blocked(outer, r, curve, stretch.part, stretch.f0, turned, covered, degenerate);
    if (covered) continue;
    for (const CurveInterval& part : open_parts(curve, stretch.part)) {
      const Stretch open{part, stretch.f0, stretch.ends};
      const bool all_free =
          !passes_pierced(outer, curve, middle, part) &&
          (!degenerate || (!touched && free_in_plane(outer, curve, middle)));
      if (all_free) {
        add_arc(outer, curve, middle, open, out);
        continue;
      }
      for (const Stretch& free : free_parts(outer, curve, open)) {
        add_arc(outer, curve, middle, free, out);
      }
    }
  }
}

void EdgePairs::add_arc(const Outer& outer, const EeeCurve& curve, int middle,
                        const Stretch& stretch, std::vector<FoundArc>& out) {
  const CurveInterval& part = stretch.part;
  const Ridge& first = g_.ridges()[outer.first];
  const Ridge& between = g_.ridges()[middle];
  const Ridge& last = g_.ridges()[outer.last];
  FoundArc found;
  found.arc = SkeletonArc::eee({first.edge, between.edge, last.edge});
  found.arc.ends = stretch.ends;
  found.arc.range = rounded_range(curve.rounded(part.from), curve.rounded(part.to));
  found.arc.self = share(first.objects, between.objects) ||
                   share(between.objects, last.objects) ||
                   share(first.objects, last.objects);
  found.ends = {node_at(outer, curve, middle, part.from, stretch),
                node_at(outer, curve, middle, part.to, stretch)};
  out.push_back(std::move(found));
}

// Appends what the lines of the curve must fulfil: a sign of `values`, which are linear
// in s and change sign at `cut`.  True when they are zero all along.
bool EdgePairs::add_constraint(const BoundedLinear& values, const CurveCut& cut,
                               bool times_f0) {
  Constraint c{values, cut, times_f0};
  c.zero0 = values.sign0 == Sign::Zero;
  c.zero1 = values.sign1 == Sign::Zero;
  if (!values.constant()) {
    // Zero at an end: inside it has the sign of the other.
    if (c.values.sign0 == Sign::Zero) c.values.sign0 = c.values.sign1;
    if (c.values.sign1 == Sign::Zero) c.values.sign1 = c.values.sign0;
  }
  if (!c.values.constant()) enclose_root(values, c.cut);
  constraints_.push_back(c);
  return c.values.sign0 == Sign::Zero;
}

// Two constraints have one sign, the same and all along.  A zero all along decides
// nothing: those lines lie in the plane of a face.
bool EdgePairs::same_everywhere(const Constraint& x, const Constraint& y) {
  return x.values.constant() && y.values.constant() && x.values.sign0 == y.values.sign0 &&
         x.values.sign0 != Sign::Zero;
}

// 0, 1: F0 and F1, of opposite signs inside the square.  False: nowhere so.
bool EdgePairs::constrain_to_square(const Outer& outer, const EeeCurve& curve) {
  const auto& o = outer.points;
  const BoundedForm& f = curve.form();
  const Carrier& carrier = carriers_.all[curve.middle()];
  for (int b = 0; b < 2; ++b) {
    BoundedLinear l{f.f[0][b], f.f[1][b], f.error, f.error, {}, {}};
    for (int a = 0; a < 2; ++a) {
      Sign& s = a == 0 ? l.sign0 : l.sign1;
      if (std::abs(f.f[a][b]) > f.error) {
        s = internal::sign_of(f.f[a][b]);
      } else {
        s = orient3d(o.at(o.p[a]), o.at(o.q[b]), o.at(carrier.points[0]),
                     o.at(carrier.points[1]));
      }
    }
    const bool vanishes = add_constraint(l, {CurveCutKind::Far, false, o.q[b], {}, 0, 1});
    if (vanishes) return false;  // all lines through one end: no three edges
  }
  return !same_everywhere(constraints_[0], constraints_[1]);
}

// 2, 3: the middle edge's ends, on opposite sides of the plane of P(s) and the last edge.
// 4, 5: planes at the middle edge, at P(s).  False: the edge is nowhere grazed.
bool EdgePairs::constrain_at_middle(const Outer& outer, const Ridge& middle,
                                    bool& degenerate) {
  for (const std::int32_t w : middle.points) {
    const bool vanishes =
        add_constraint(beside_last(outer, w), {CurveCutKind::Middle, false, w, {}, 0, 1});
    if (vanishes) return false;
  }
  if (same_everywhere(constraints_[2], constraints_[3])) return false;
  const auto& o = outer.points;
  for (int k = 0; k < 2; ++k) {
    const PlaneSide& plane = k == 0 ? middle.a : middle.b;
    degenerate |= add_constraint(linear(plane_values(plane, o.at(o.p[0]), o.at(o.p[1]))),
                                 plane_cut_at(middle, k, CurveCutKind::OnPlane));
  }
  return !same_everywhere(constraints_[4], constraints_[5]);
}

// 6, 7: planes at the last edge, at P(s).  False: the edge is nowhere touched.
bool EdgePairs::constrain_at_last(const Outer& outer, bool& degenerate) {
  const Ridge& last = g_.ridges()[outer.last];
  for (int k = 0; k < 2; ++k) {
    degenerate |= add_constraint(linear(outer.last_planes[k]),
                                 plane_cut_at(last, k, CurveCutKind::OnPlane));
  }
  if (!same_everywhere(constraints_[6], constraints_[7])) return true;
  const Sign side = constraints_[6].values.sign0;
  return last.contact(side, side) != EdgeContact::None;
}

// 8, 9: planes at the first edge, at Q(t(s)).
void EdgePairs::constrain_at_first(const Outer& outer, const EeeCurve& curve,
                                   bool& degenerate) {
  const Ridge& first = g_.ridges()[outer.first];
  for (int k = 0; k < 2; ++k) {
    const PlaneValues& v = outer.first_planes[k];
    const CurveCut cut = plane_cut_at(first, k, CurveCutKind::OnFirst);
    if (v.sign0 == v.sign1) {
      // Of one sign all along the last edge, whatever t.
      degenerate |= add_constraint(linear(v), cut);
    } else {
      degenerate |=
          add_constraint(curve.at_last_edge(v.at0, v.at1, cut.plane), cut, true);
    }
  }
}

// The parts of the curve inside the square and of the middle edge, between the outer
// ones, where all three support.
void EdgePairs::find_stretches(const Outer& outer, const Ridge& middle,
                               const EeeCurve& curve, bool& degenerate) {
  stretches_.clear();
  constraints_.clear();
  // 1. The ten conditions that a line of the curve must fulfil.  Each is a sign of a
  // polynomial that is linear in s, so that it changes once at most.
  if (!constrain_to_square(outer, curve)) return;
  if (!constrain_at_middle(outer, middle, degenerate)) return;
  if (!constrain_at_last(outer, degenerate)) return;
  constrain_at_first(outer, curve, degenerate);
  // 2. Those that change, in the order of their cuts along the curve; the others have
  // their sign everywhere.
  std::array<const Constraint*, 10> order;
  int count = 0;
  for (const Constraint& c : constraints_) {
    if (!c.values.constant()) order[count++] = &c;
  }
  std::sort(order.begin(), order.begin() + count,
            [&](const Constraint* x, const Constraint* y) {
              return curve.compare(x->cut, y->cut) == Sign::Negative;
            });
  // 3. All signs at the curve's start; from one cut to the next they stay.
  std::array<Sign, 10> sign;
  for (int k = 0; k < 10; ++k) sign[k] = constraints_[k].values.sign0;
  const Ridge& first = g_.ridges()[outer.first];
  const Ridge& last = g_.ridges()[outer.last];
  const auto& o = outer.points;
  const Carrier& carrier = carriers_.all[curve.middle()];
  // The middle contact lies between the outer ones, not beyond one of them, iff F0 has
  // the sign of orient3d(Q0, Q1, middle edge): see EeeCurve::order_at().
  const Sign beside = orient3d(o.at(o.q[0]), o.at(o.q[1]), o.at(carrier.points[0]),
                               o.at(carrier.points[1]));
  // A zero all along is in the plane of a face: left to the contacts of single lines.
  const auto differ = [](Sign x, Sign y) { return x != y || x == Sign::Zero; };
  // 4. Along the curve: a stretch wherever all ten are right, and the two cuts differ.
  CurveCut from = curve_start();
  for (int k = 0; k <= count; ++k) {
    const CurveCut to = k < count ? order[k]->cut : curve_end();
    const auto at_first = [&](int c) {
      return constraints_[c].times_f0 ? sign[c] * sign[0] : sign[c];
    };
    // The outer edges may be end contacts, too; the middle one must be grazed.
    const EdgeContact last_contact = last.contact(sign[6], sign[7]);
    const EdgeContact first_contact = first.contact(at_first(8), at_first(9));
    // Opposite signs: of F0 and F1, of the middle edge's ends, of the planes at that
    // edge.
    if (sign[0] != sign[1] && sign[2] != sign[3] && differ(sign[4], sign[5]) &&
        last_contact != EdgeContact::None && first_contact != EdgeContact::None &&
        sign[0] == beside && curve.compare(from, to) == Sign::Negative) {
      // The sign of F0 goes with it: that of F0 - F1, which blockers are asked by.
      stretches_.push_back(
          {{from, to},
           sign[0],
           {first_contact == EdgeContact::End, last_contact == EdgeContact::End}});
    }
    // Beyond the cut one sign has changed.  Cuts that coincide change one after the
    // other, with an empty stretch between.
    if (k == count) break;
    const auto c = static_cast<std::size_t>(order[k] - constraints_.data());
    sign[c] = constraints_[c].values.sign1;
    from = to;
  }
}

void EdgePairs::find_blocked(const Outer& outer, const Ridge& middle,
                             const EeeCurve& curve, const CurveInterval& stretch, Sign f0,
                             bool turned, bool& covered, bool& degenerate) {
  closed_.clear();
  std::size_t known = 0;  // of closed_: they do not cover the stretch
  const auto covers = [&] {
    for (; known < closed_.size(); ++known) {
      const CurveInterval& c = closed_[known];
      if (c.from.same_as(stretch.from) && c.to.same_as(stretch.to)) return true;
    }
    return false;
  };
  bury(outer, curve, stretch, f0);
  covered = covers();
  for (std::size_t i = 0; i < blockers_.size() && !covered; ++i) {
    const int face = blockers_[i];
    if (is_of(middle, face)) continue;
    const Sign entry = turned ? Sign::Negative : Sign::Positive;
    block(outer, curve, face, stretch, f0, entry, degenerate);
    if (!enters_only(face)) {
      block(outer, curve, face, stretch, f0, -entry, degenerate);
    }
    covered = covers();
  }
}

// Where the values of a face's plane along an outer edge change sign.
CurveCut EdgePairs::plane_cut(const BoundedLinear& l, CurveCutKind kind, int face) const {
  CurveCut cut{kind, false, scene_.faces()[face].facet, plane_points(scene_, face), 0, 1};
  enclose_root(l, cut);
  return cut;
}

// Cuts the part at hand, the only one in parts_, down to where a linear polynomial has
// the wanted sign: a face's plane along an outer edge, as the kind of cut says.  False
// when nothing is left.
bool EdgePairs::restrict_to(const EeeCurve& curve, const BoundedLinear& l, Sign wanted,
                            CurveCutKind kind, int face) {
  if (!l.ever(wanted)) return false;
  if (l.sign0 != -wanted && l.sign1 != -wanted) return true;
  const CurveCut cut = plane_cut(l, kind, face);
  CurveInterval& part = parts_[0];
  if (l.sign0 == wanted) {
    if (curve.compare(cut, part.to) == Sign::Negative) part.to = cut;
  } else if (curve.compare(part.from, cut) == Sign::Negative) {
    part.from = cut;
  }
  return curve.compare(part.from, part.to) == Sign::Negative;
}

// Adds the parts of a stretch where the segment passes the face from its front (entry
// Positive) or from its back.
void EdgePairs::block(const Outer& outer, const EeeCurve& curve, int face,
                      const CurveInterval& stretch, Sign f0, Sign entry,
                      bool& degenerate) {
  const auto& [p, q] = planes_of(outer, face);
  if (p.sign0 != entry && p.sign1 != entry) return;
  if (q.sign0 != -entry && q.sign1 != -entry) return;
  parts_.assign(1, stretch);
  if (p.sign0 != p.sign1 &&
      !restrict_to(curve, linear(p), entry, CurveCutKind::OnPlane, face)) {
    return;
  }
  if (q.sign0 != q.sign1 && !restrict_to(curve, at_last_edge(curve, q, face), -entry * f0,
                                         CurveCutKind::OnFar, face)) {
    return;
  }
  // From the front to the back the sides, counter-clockwise, have negative forms, which
  // have the sign of H times that of F0 - F1, and that is the sign of F0.
  for (const auto& side : carriers_.of_face(face)) {
    const Sign wanted = side.forward ? -entry * f0 : entry * f0;
    next_.clear();
    bool zero = false;
    for (const CurveInterval& part : parts_) {
      curve.where(side.carrier, form_of(outer, side.carrier), wanted, part, next_, zero);
    }
    degenerate |= zero;
    parts_.swap(next_);
    if (parts_.empty()) return;
  }
  closed_.insert(closed_.end(), parts_.begin(), parts_.end());
}

std::vector<CurveInterval> EdgePairs::open_parts(const EeeCurve& curve,
                                                 const CurveInterval& stretch) {
  std::sort(closed_.begin(), closed_.end(),
            [&](const CurveInterval& a, const CurveInterval& b) {
              return curve.compare(a.from, b.from) == Sign::Negative;
            });
  std::vector<CurveInterval> open;
  CurveCut at = stretch.from;
  for (const CurveInterval& c : closed_) {
    if (curve.compare(at, c.from) == Sign::Negative) open.push_back({at, c.from});
    if (curve.compare(at, c.to) == Sign::Negative) at = c.to;
  }
  if (curve.compare(at, stretch.to) == Sign::Negative) open.push_back({at, stretch.to});
  return open;
}

}  // namespace sightline::internal
