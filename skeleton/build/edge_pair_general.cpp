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

// The ends of an open part of the curve and all critical positions between them, in
// order: where the line lies in the plane of one of the faces, or meets a side of one.
std::vector<CurveCut> EdgePairs::stops_in(const Outer& outer, const EeeCurve& curve,
                                          const CurveInterval& open,
                                          std::span<const int> faces) {
  std::vector<CurveCut> stops;
  const auto add = [&](const CurveCut& cut) {
    if (curve.compare(open.from, cut) == Sign::Negative &&
        curve.compare(cut, open.to) == Sign::Negative) {
      stops.push_back(cut);
    }
  };
  const int own[] = {carriers_.of_ridge[outer.first], curve.middle(),
                     carriers_.of_ridge[outer.last]};
  ++node_stamp_;
  for (const int face : faces) {
    hear_stop();
    add_plane_stops(outer, curve, face, add);
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
  return stops;
}

// Where the line's contact with the first edge, or with the last, lies in the plane of
// the face.
template <class Add>
void EdgePairs::add_plane_stops(const Outer& outer, const EeeCurve& curve, int face,
                                const Add& add) const {
  const auto& o = outer.points;
  const PlaneSide& plane = g_.face_plane(face);
  const PlaneValues p = plane_values(plane, o.at(o.p[0]), o.at(o.p[1]));
  if (p.sign0 == -p.sign1 && p.sign0 != Sign::Zero) {
    add(plane_cut({p.at0.value, p.at1.value, p.at0.error, p.at1.error, {}, {}},
                  CurveCutKind::OnPlane, face));
  }
  const PlaneValues q = plane_values(plane, o.at(o.q[0]), o.at(o.q[1]));
  if (q.sign0 == -q.sign1 && q.sign0 != Sign::Zero) {
    const BoundedLinear l = at_last_edge(curve, q, face);
    if (l.sign0 == -l.sign1 && l.sign0 != Sign::Zero) {
      add(plane_cut(l, CurveCutKind::OnFar, face));
    }
  }
}

// Which outer contacts of a line are end contacts; nullopt when the line is not free.
// `drawn`: and when an end contact of it is not drawn.  `faces`: all that may block.
std::optional<std::array<bool, 2>> EdgePairs::state_of(
    const Outer& outer, const std::optional<std::array<ExactPoint, 2>>& line,
    std::span<const int> faces, const Stretch& stretch, bool drawn) const {
  if (!line) return std::nullopt;
  const Ridge& first = g_.ridges()[outer.first];
  const Ridge& last = g_.ridges()[outer.last];
  const LineScan scan(scene_, faces, (*line)[0], (*line)[1]);
  if (!g_.polygon()) {
    return is_free(g_, scan) ? std::optional(stretch.ends) : std::nullopt;
  }
  const auto ends = blocked_ends(g_, scan);
  const bool possible = ends && ((*ends)[0] ? first.can_end() : first.can_graze()) &&
                        ((*ends)[1] ? last.can_end() : last.can_graze());
  if (!possible) return std::nullopt;
  const bool seen = !drawn || ((!(*ends)[0] || !first.touched ||
                                drawn_end(g_, first, scan, false, Eye((*line)[1]))) &&
                               (!(*ends)[1] || !last.touched ||
                                drawn_end(g_, last, scan, true, Eye((*line)[0]))));
  return seen ? ends : std::nullopt;
}

std::vector<EdgePairs::Stretch> EdgePairs::free_parts(const Outer& outer,
                                                      const EeeCurve& curve,
                                                      const Stretch& stretch) {
  const std::vector<int> faces = view_.all_faces();
  const std::vector<CurveCut> stops = stops_in(outer, curve, stretch.part, faces);
  const Ridge& first = g_.ridges()[outer.first];
  const Ridge& last = g_.ridges()[outer.last];
  std::vector<Stretch> free;
  std::optional<CurveCut> begin;
  std::optional<std::array<bool, 2>> state;  // from `begin` on
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    hear_stop_now();
    const auto s = curve.between(stops[i], stops[i + 1]);
    const auto line = s ? curve.points_at(*s) : std::nullopt;
    auto here = state_of(outer, line, faces, stretch, true);
    // Between edges that others touch all of a segment may be inside.
    if (here && g_.borders_others(first) && g_.borders_others(last) &&
        g_.in_material(along((*line)[0], (*line)[1], Rational(1, 2)))) {
      here.reset();
    }
    if (begin && i > 0) {
      // The arc goes on through a critical line that is free itself.
      const auto stop = curve.points_at(stops[i]);
      if (here != state ||
          (stop && state_of(outer, stop, faces, stretch, false) != state)) {
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
