#include "linespace/light/family_scan.h"

#include <algorithm>

namespace sightline::internal {
namespace {

template <class T>
Four<T> contact_point(const Four<T>& g0, const Four<T>& g1, const T& at0, const T& at1) {
  return combination(at1, g0, at0, g1);
}

}  // namespace

const std::vector<ScannedPiece>& FamilyScan::scan(const LineFamily& family,
                                                  std::span<const FamilyContact> contacts,
                                                  int farthest,
                                                  const Four<Approx>* plane) {
  pieces_.clear();
  scratch_.clear();
  // 1. Where the lines meet all generators and the source.
  find_lit(family, contacts, farthest);
  if (lit_.empty()) return pieces_;
  // 2. What they may meet on the way, and where that changes.
  find_candidates(family, plane);
  const bool any_wanted = std::ranges::any_of(
      candidates_, [&](int f) { return front_wanted_[f] != 0 || back_wanted_[f] != 0; });
  if (!any_wanted) return pieces_;
  cuts_.clear();
  add_face_cuts(family, contacts);
  const std::vector<FamilyCut> all = cuts_;
  // 3. One line between any two cuts.
  for (const Interval& lit : lit_) {
    cuts_ = {lit.from};
    for (const FamilyCut& cut : all) {
      if (family.compare(lit.from, cut) == Sign::Negative &&
          family.compare(cut, lit.to) == Sign::Negative) {
        cuts_.push_back(cut);
      }
    }
    cuts_.push_back(lit.to);
    sort_cuts(family);
    open_.clear();
    for (std::size_t i = 0; i + 1 < cuts_.size(); ++i) {
      std::vector<Met> met;
      const FamilyLine line(family, between(family, cuts_[i], cuts_[i + 1]));
      if (auto found = first_met(line, contacts)) met = std::move(*found);
      std::erase_if(met, [&](const Met& m) {
        return (m.front ? front_wanted_ : back_wanted_)[m.face] == 0;
      });
      std::vector<ScannedPiece> going_on;
      for (ScannedPiece& piece : open_) {
        const bool on = std::ranges::any_of(met, [&](const Met& m) {
          return m.face == piece.face && m.front == piece.front;
        });
        if (on) {
          going_on.push_back(std::move(piece));
        } else {
          piece.to = cuts_[i];
          pieces_.push_back(std::move(piece));
        }
      }
      for (const Met& m : met) {
        const bool known = std::ranges::any_of(going_on, [&](const ScannedPiece& p) {
          return m.face == p.face && m.front == p.front;
        });
        if (!known) going_on.push_back({m.face, m.front, cuts_[i], {}});
      }
      open_.swap(going_on);
    }
    for (ScannedPiece& piece : open_) {
      piece.to = lit.to;
      pieces_.push_back(std::move(piece));
    }
  }
  return pieces_;
}

bool FamilyScan::reaches_freely(const LineFamily& family,
                                std::span<const FamilyContact> contacts) {
  const FamilyLine line(family, 0.5);
  if (!reaches_source(line, contacts, -1)) return false;
  FamilyRegion region(space_.size());
  region.add(family, 0.5, 0.5);
  find_near(region);
  candidates_ = near_;
  return first_met(line, contacts).has_value();
}

void FamilyScan::find_near(const FamilyRegion& region) {
  near_.clear();
  space_.face_tree().traverse(
      [&](const Box& box) { return region.may_meet(box); },
      [&](std::uint32_t f) {
        if (in_front_[f] != 0 && region.may_meet(space_.faces()[f].box)) {
          near_.push_back(static_cast<int>(f));
        }
      });
  std::ranges::sort(near_);
}

void FamilyScan::sort_cuts(const LineFamily& family) {
  std::stable_sort(cuts_.begin(), cuts_.end(),
                   [&](const FamilyCut& a, const FamilyCut& b) {
                     return family.compare(a, b) == Sign::Negative;
                   });
  const auto last = std::unique(cuts_.begin(), cuts_.end(),
                                [&](const FamilyCut& a, const FamilyCut& b) {
                                  return family.compare(a, b) == Sign::Zero;
                                });
  cuts_.erase(last, cuts_.end());
}

Ring FamilyScan::between(const LineFamily& family, FamilyCut& a, FamilyCut& b) {
  if (!(a.hi < b.lo)) {
    family.refine(a);
    family.refine(b);
  }
  const double s = a.hi + 0.5 * (b.lo - a.hi);
  if (a.hi < s && s < b.lo) return s;
  // Closer than doubles tell apart.
  return number_between(family.exact(a), family.exact(b));
}

void FamilyScan::find_lit(const LineFamily& family,
                          std::span<const FamilyContact> contacts, int farthest) {
  lit_.clear();
  cuts_ = {LineFamily::start(), LineFamily::end()};
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const FamilyContact& c = contacts[i];
    if (c.at != FamilyContact::At::OnEdge) {
      family.add_plane_root(patch_.plane, c.at == FamilyContact::At::First,
                            {CutCause::Kind::Limit, -1, -1}, cuts_);
      continue;
    }
    std::array<FormOf<Approx>, 2> forms;
    std::array<std::optional<Sign>, 2> signs;
    for (int k = 0; k < 2; ++k) {
      forms[k] = family.form(*c.joins[k]);
      signs[k] = family.constant_sign(forms[k]);
    }
    if (signs[0] && signs[1] && *signs[0] == *signs[1]) return;
    for (int k = 0; k < 2; ++k) {
      family.add_roots(*c.joins[k], forms[k],
                       {CutCause::Kind::Generator, k, static_cast<int>(i)}, cuts_);
    }
  }
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    family.add_roots(sides_[i], family.form(sides_[i]),
                     {CutCause::Kind::SourceSide, static_cast<int>(i), -1}, cuts_);
  }
  sort_cuts(family);
  bool goes_on = false;
  for (std::size_t i = 0; i + 1 < cuts_.size(); ++i) {
    const FamilyLine line(family, between(family, cuts_[i], cuts_[i + 1]));
    if (!reaches_source(line, contacts, farthest)) {
      goes_on = false;
      continue;
    }
    if (goes_on) {
      lit_.back().to = cuts_[i + 1];
    } else {
      lit_.push_back({cuts_[i], cuts_[i + 1]});
    }
    goes_on = true;
  }
}

bool FamilyScan::reaches_source(const FamilyLine& line,
                                std::span<const FamilyContact> contacts, int farthest) {
  for (const FamilyContact& c : contacts) {
    if (c.at == FamilyContact::At::OnEdge &&
        line.side_to(*c.joins[0]) != -line.side_to(*c.joins[1])) {
      return false;
    }
  }
  if (!on_source(line)) return false;
  std::vector<Height> heights;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    heights.push_back(height_of(line, contacts[i], static_cast<int>(i)));
    if (sign(line, heights.back(), contacts) == Sign::Negative) return false;
  }
  if (farthest < 0) return true;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (static_cast<int>(i) != farthest &&
        compare(line, heights[i], heights[farthest], contacts) == Sign::Positive) {
      return false;
    }
  }
  return true;
}

// The line passes through a closed face of the patch.
bool FamilyScan::on_source(const FamilyLine& line) const {
  return std::ranges::any_of(patch_.faces, [&](int face) {
    bool left = false;
    bool right = false;
    for (const LightFace::Side& side : space_.faces()[face].sides) {
      const Sign s = side.forward ? line.side_to(*side.line) : -line.side_to(*side.line);
      left = left || s == Sign::Positive;
      right = right || s == Sign::Negative;
      if (left && right) return false;
    }
    return left || right;  // else the line lies in the plane
  });
}

// Faces that some lit line of the family may pass the inside of.
void FamilyScan::find_candidates(const LineFamily& family, const Four<Approx>* plane) {
  FamilyRegion region(space_.size());
  if (plane != nullptr) region.set_plane(*plane);
  for (const Interval& lit : lit_) region.add(family, lit.from.lo, lit.to.hi);
  find_near(region);
  candidates_.clear();
  for (const int f : near_) {
    bool left = false;
    bool right = false;
    for (const LightFace::Side& side : space_.faces()[f].sides) {
      const auto s = family.constant_sign(family.form(*side.line));
      if (!s) continue;
      const Sign turned = side.forward ? *s : -*s;
      left = left || turned == Sign::Positive;
      right = right || turned == Sign::Negative;
      if (left && right) break;
    }
    if (!(left && right)) candidates_.push_back(f);
  }
}

void FamilyScan::add_face_cuts(const LineFamily& family,
                               std::span<const FamilyContact> contacts) {
  std::vector<const LightLine*> done;
  for (const int f : candidates_) {
    const LightFace& face = space_.faces()[f];
    for (std::size_t k = 0; k < face.sides.size(); ++k) {
      const LightLine* line = face.sides[k].line;
      if (std::ranges::find(done, line) != done.end()) continue;
      done.push_back(line);
      family.add_roots(*line, family.form(*line),
                       {CutCause::Kind::FaceSide, f, static_cast<int>(k)}, cuts_);
    }
  }
  for (const FamilyContact& c : contacts) {
    if (c.moves_on == nullptr) continue;
    for (const int f : c.moves_on->pierced_by) {
      const LightPlane& plane = space_.faces()[f].plane;
      const CutCause cause{CutCause::Kind::Pierce, f, -1};
      if (c.at != FamilyContact::At::OnEdge) {
        family.add_plane_root(plane, c.at == FamilyContact::At::First, cause, cuts_);
        continue;
      }
      // The contact is in the plane where the line passes this combination of the joins,
      // which is the line from the point beside the edge to where the edge is pierced.
      const auto combined = [&]<class T>(const Six<T>& j0, const Six<T>& j1,
                                         const Four<T>& p, const Four<T>& g0,
                                         const Four<T>& g1) {
        const T at0 = value(p, g0);
        const T at1 = value(p, g1);
        Six<T> out;
        for (int i = 0; i < 6; ++i) out[i] = at0 * j1[i] - at1 * j0[i];
        return out;
      };
      const auto& [g0, g1] = c.edge->ends;
      const auto& [j0, j1] = c.joins;
      scratch_.push_back(
          {c.edge->ends, combined(j0->near, j1->near, plane.near, g0->near, g1->near),
           combined(j0->exact, j1->exact, plane.exact, g0->exact, g1->exact)});
      family.add_roots(scratch_.back(), family.form(scratch_.back()), cause, cuts_);
    }
  }
  if (space_.crossings().empty()) return;
  std::vector<std::uint8_t> among(space_.faces().size(), 0);
  for (const int f : candidates_) among[f] = 1;
  for (std::size_t i = 0; i < space_.crossings().size(); ++i) {
    const FaceCut& c = space_.crossings()[i];
    if (among[c.faces[0]] == 0 || among[c.faces[1]] == 0) continue;
    family.add_roots(*c.line, family.form(*c.line),
                     {CutCause::Kind::Crossing, static_cast<int>(i), -1}, cuts_);
  }
}

std::optional<std::vector<FamilyScan::Met>> FamilyScan::first_met(
    const FamilyLine& line, std::span<const FamilyContact> contacts) {
  std::vector<Height> at;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    at.push_back(height_of(line, contacts[i], static_cast<int>(i)));
  }
  Height top = at[0];
  for (const Height& h : at) {
    if (compare(line, h, top, contacts) == Sign::Positive) top = h;
  }
  std::vector<Height> nearest;
  for (const int f : candidates_) {
    if (!passes_inside(line, f)) continue;
    const Height h = height_of_face(line, f);
    if (sign(line, h, contacts) != Sign::Positive) continue;
    if (compare(line, h, top, contacts) != Sign::Positive) return std::nullopt;
    const Sign order =
        nearest.empty() ? Sign::Negative : compare(line, h, nearest[0], contacts);
    if (order == Sign::Negative) nearest.clear();
    if (order != Sign::Positive) nearest.push_back(h);
  }
  std::vector<Met> met;
  for (const Height& h : nearest) {
    // The source's plane is in front of the face iff the contacts come from its front.
    // The contact that is farthest from the source lies before the face.
    const LightPlane& plane = space_.faces()[h.face].plane;
    const auto& c = contacts[static_cast<std::size_t>(top.contact)];
    const Four<Approx>* near = nullptr;
    Four<Approx> on_edge;
    if (c.at == FamilyContact::At::OnEdge) {
      on_edge = contact_point(c.edge->ends[0]->near, c.edge->ends[1]->near,
                              side(line.line(), c.joins[0]->near),
                              side(line.line(), c.joins[1]->near));
      near = &on_edge;
    } else {
      near = c.at == FamilyContact::At::First ? &line.first() : &line.last();
    }
    const auto exact_point = [&]() -> Four<Ring> {
      if (c.at == FamilyContact::At::First) return line.exact_first();
      if (c.at == FamilyContact::At::Last) return line.exact_last();
      return contact_point(c.edge->ends[0]->exact, c.edge->ends[1]->exact,
                           side(line.exact_line(), c.joins[0]->exact),
                           side(line.exact_line(), c.joins[1]->exact));
    };
    const Sign at_contact = decide(value(plane.near, *near),
                                   [&] { return value(plane.exact, exact_point()); });
    const Sign weight = decide((*near)[3], [&] { return exact_point()[3]; });
    met.push_back({h.face, at_contact == weight});
  }
  return met;
}

// Strictly, or through one seam, beyond which the surface goes on: a whole pencil may lie
// in the plane of one.
bool FamilyScan::passes_inside(const FamilyLine& line, int face) const {
  Sign first = Sign::Zero;
  bool on_seam = false;
  for (const LightFace::Side& side : space_.faces()[face].sides) {
    const Sign s = side.forward ? line.side_to(*side.line) : -line.side_to(*side.line);
    if (s == Sign::Zero) {
      if (!side.seam || on_seam) return false;
      on_seam = true;
      continue;
    }
    if (first == Sign::Zero) first = s;
    if (s != first) return false;
  }
  return first != Sign::Zero;
}

FamilyScan::Height FamilyScan::height_of_face(const FamilyLine& line, int face) const {
  const Four<Approx>& plane = space_.faces()[face].plane.near;
  const Approx at_x = value(plane, line.first());
  const Approx at_y = value(plane, line.last());
  const Approx high_x = value(patch_.plane.near, line.first());
  const Approx high_y = value(patch_.plane.near, line.last());
  return {high_x * at_y - high_y * at_x, line.first()[3] * at_y - line.last()[3] * at_x,
          face, -1};
}

FamilyScan::Height FamilyScan::height_of(const FamilyLine& line, const FamilyContact& c,
                                         int number) const {
  Four<Approx> p;
  if (c.at == FamilyContact::At::OnEdge) {
    p = contact_point(c.edge->ends[0]->near, c.edge->ends[1]->near,
                      side(line.line(), c.joins[0]->near),
                      side(line.line(), c.joins[1]->near));
  } else {
    p = c.at == FamilyContact::At::First ? line.first() : line.last();
  }
  return {value(patch_.plane.near, p), p[3], -1, number};
}

std::array<Ring, 2> FamilyScan::exact(const FamilyLine& line, const Height& h,
                                      std::span<const FamilyContact> contacts) const {
  const Four<Ring>& x = line.exact_first();
  const Four<Ring>& y = line.exact_last();
  if (h.face >= 0) {
    const Four<Ring>& plane = space_.faces()[h.face].plane.exact;
    const Ring at_x = value(plane, x);
    const Ring at_y = value(plane, y);
    return {value(patch_.plane.exact, x) * at_y - value(patch_.plane.exact, y) * at_x,
            x[3] * at_y - y[3] * at_x};
  }
  const FamilyContact& c = contacts[static_cast<std::size_t>(h.contact)];
  Four<Ring> p;
  if (c.at == FamilyContact::At::OnEdge) {
    p = contact_point(c.edge->ends[0]->exact, c.edge->ends[1]->exact,
                      side(line.exact_line(), c.joins[0]->exact),
                      side(line.exact_line(), c.joins[1]->exact));
  } else {
    p = c.at == FamilyContact::At::First ? x : y;
  }
  return {value(patch_.plane.exact, p), p[3]};
}

Sign FamilyScan::compare(const FamilyLine& line, const Height& a, const Height& b,
                         std::span<const FamilyContact> contacts) const {
  if (a.face == b.face && a.contact == b.contact) return Sign::Zero;
  if (is_certain(a.den) && is_certain(b.den)) {
    const Approx difference = a.num / a.den - b.num / b.den;
    if (is_certain(difference)) {
      return difference.v > 0 ? Sign::Positive : Sign::Negative;
    }
  }
  const auto [n, d] = exact(line, a, contacts);
  const auto [m, e] = exact(line, b, contacts);
  return sign_of(Ring(n * e - m * d)) * sign_of(d) * sign_of(e);
}

Sign FamilyScan::sign(const FamilyLine& line, const Height& a,
                      std::span<const FamilyContact> contacts) const {
  if (is_certain(a.num) && is_certain(a.den)) {
    return (a.num.v > 0) == (a.den.v > 0) ? Sign::Positive : Sign::Negative;
  }
  const auto [n, d] = exact(line, a, contacts);
  return sign_of(n) * sign_of(d);
}

}  // namespace sightline::internal
