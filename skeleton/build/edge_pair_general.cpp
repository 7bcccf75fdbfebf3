// The general way of EdgePairs, for lines in the planes of faces or along touched edges:
// a stretch of a curve is cut at every critical position, and the contacts of one exact
// line decide between any two.

#include <algorithm>
#include <utility>

#include "linespace/sight/plane_crossings.h"
#include "linespace/silhouettes/drawn.h"
#include "linespace/swaths/edge_cuts.h"
#include "linespace/work/stop_scope.h"
#include "skeleton/build/edge_pair.h"
#include "skeleton/nodes/node_contacts.h"

namespace sightline::internal {

std::vector<EdgePairs::Stretch> EdgePairs::free_parts(const Outer& outer,
                                                      const EeeCurve& curve,
                                                      const Stretch& stretch) {
  const CurveInterval& open = stretch.part;
  std::vector<CurveCut> stops;
  const auto add = [&](const CurveCut& cut) {
    if (curve.compare(open.from, cut) == Sign::Negative &&
        curve.compare(cut, open.to) == Sign::Negative) {
      stops.push_back(cut);
    }
  };
  const auto& o = outer.points;
  const int own[] = {carriers_.of_ridge[outer.first], curve.middle(),
                     carriers_.of_ridge[outer.last]};
  ++node_stamp_;
  const std::vector<int> faces = view_.all_faces();
  for (const int face : faces) {
    hear_stop();
    const PlaneSide& plane = g_.face_plane(face);
    const std::array<std::int32_t, 3> points = plane_points(scene_, face);
    const int facet = scene_.faces()[face].facet;
    const PlaneValues p = plane_values(plane, o.at(o.p[0]), o.at(o.p[1]));
    if (p.sign0 == -p.sign1 && p.sign0 != Sign::Zero) {
      CurveCut cut{CurveCutKind::OnPlane, false, facet, points, 0, 1};
      enclose_root({p.at0.value, p.at1.value, p.at0.error, p.at1.error, {}, {}}, cut);
      add(cut);
    }
    const PlaneValues q = plane_values(plane, o.at(o.q[0]), o.at(o.q[1]));
    if (q.sign0 == -q.sign1 && q.sign0 != Sign::Zero) {
      const BoundedLinear l = curve.at_last_edge(q.at0, q.at1, points);
      if (l.sign0 == -l.sign1 && l.sign0 != Sign::Zero) {
        CurveCut cut{CurveCutKind::OnFar, false, facet, points, 0, 1};
        enclose_root(l, cut);
        add(cut);
      }
    }
    for (const auto& side : carriers_.of_face(face)) {
      if (node_stamps_[side.carrier] == node_stamp_) continue;
      node_stamps_[side.carrier] = node_stamp_;
      if (std::find(std::begin(own), std::end(own), side.carrier) != std::end(own)) {
        continue;
      }
      next_.clear();
      bool zero = false;
      curve.where(side.carrier, form_of(outer, side.carrier), Sign::Positive, open, next_,
                  zero);
      for (const CurveInterval& part : next_) {
        add(part.from);
        add(part.to);
      }
    }
  }
  for (const Rational& s : in_plane_stops(outer, curve, faces)) add(curve.cut_at(s));
  std::sort(stops.begin(), stops.end(), [&](const CurveCut& a, const CurveCut& b) {
    hear_stop();
    return curve.compare(a, b) == Sign::Negative;
  });
  stops.erase(std::unique(stops.begin(), stops.end(),
                          [&](const CurveCut& a, const CurveCut& b) {
                            return curve.compare(a, b) == Sign::Zero;
                          }),
              stops.end());
  stops.insert(stops.begin(), open.from);
  stops.push_back(open.to);

  // Which outer contacts are end contacts; nullopt when the line is not free.
  using State = std::optional<std::array<bool, 2>>;
  const Ridge& first = g_.ridges()[outer.first];
  const Ridge& last = g_.ridges()[outer.last];
  const auto state_of = [&](const std::optional<std::array<ExactPoint, 2>>& line,
                            bool drawn) -> State {
    if (!line) return std::nullopt;
    const LineScan scan(scene_, faces, (*line)[0], (*line)[1]);
    if (!g_.polygon()) return is_free(g_, scan) ? State(stretch.ends) : std::nullopt;
    const State ends = blocked_ends(g_, scan);
    const bool possible = ends && ((*ends)[0] ? first.can_end() : first.can_graze()) &&
                          ((*ends)[1] ? last.can_end() : last.can_graze());
    if (!possible) return std::nullopt;
    const bool seen = !drawn || ((!(*ends)[0] || !first.touched ||
                                  drawn_end(g_, first, scan, false, Eye((*line)[1]))) &&
                                 (!(*ends)[1] || !last.touched ||
                                  drawn_end(g_, last, scan, true, Eye((*line)[0]))));
    return seen ? ends : std::nullopt;
  };
  std::vector<Stretch> free;
  std::optional<CurveCut> begin;
  State state;  // from `begin` on
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    hear_stop_now();
    const auto s = curve.between(stops[i], stops[i + 1]);
    const auto line = s ? curve.points_at(*s) : std::nullopt;
    State here = state_of(line, true);
    // Between edges that others touch all of a segment may be inside.
    if (here && g_.borders_others(first) && g_.borders_others(last) &&
        g_.in_material(along((*line)[0], (*line)[1], Rational(1, 2)))) {
      here.reset();
    }
    if (begin && i > 0) {
      // The arc goes on through a critical line that is free itself.
      const auto stop = curve.points_at(stops[i]);
      if (here != state || (stop && state_of(stop, false) != state)) {
        free.push_back({{*begin, stops[i]}, stretch.f0, *state});
        begin.reset();
      }
    }
    if (here && !begin) {
      begin = stops[i];
      state = here;
    }
  }
  if (begin) free.push_back({{*begin, stops.back()}, stretch.f0, *state});
  return free;
}

std::vector<Rational> EdgePairs::in_plane_stops(const Outer& outer, const EeeCurve& curve,
                                                std::span<const int> faces) const {
  const auto& middle = carriers_.all[curve.middle()].points;
  return pencil_stops(scene_, {outer.points.p, middle, outer.points.q}, faces);
}

}  // namespace sightline::internal
