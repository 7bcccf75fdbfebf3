// Which contacts of a line block: what obstacles their faces are, and whether a motion
// passes them all.

#include <algorithm>
#include <array>
#include <utility>

#include "linespace/contacts/line_scan.h"
#include "linespace/contacts/motion.h"
#include "linespace/work/stop_scope.h"

namespace sightline::internal::contacts {

Rational Scan::corner_t(const Corner& c) const {
  return quotient_times_scale(c.v, direction[k]);
}

// The slopes of two sides from a position on L to corners that are in one direction seen
// along L: ((x_p - x) / |u_p|) against the same of q.
int Scan::compare_slopes(const Corner& p, const Corner& q, int position) const {
  const Position& at = positions[position];
  const auto ahead = [&](const Corner& c) {
    return Ring(Ring(c.v * at.den) - Ring(at.num * direction[k]));
  };
  // Both coordinates have one sign.
  const int sign =
      sign_of(Ring(ahead(p) * coordinate(q.u)) - Ring(ahead(q) * coordinate(p.u)));
  return sign * sign_of(coordinate(p.u)) * sign_of(direction[k]);
}

// The sides of an edge-on face, cut to the part from lo to hi.
void Scan::add_fins(const Hit& hit, const Rational* lo, const Rational* hi,
                    std::vector<Fin>& fins) const {
  const int n = static_cast<int>(scene->face_points(hit.face).size());
  const auto at = [&](int i) -> const Corner& {
    return corners[loops[hit.loop + (i + n) % n]];
  };
  for (const int sign : {1, -1}) {
    const auto on_this_side = [&](int i) {
      return sign * dot(at(i).u, corners[hit.start].u) > 0;
    };
    int first = 0;
    while (first < n && (!on_this_side(first) || on_this_side(first - 1))) ++first;
    if (first == n) continue;
    int last = first;
    while (on_this_side(last + 1)) ++last;
    // The side before `first` meets L in its own corner or inside, both numbered so.
    const bool forwards = hit.from_at == (first + n - 1) % n;
    const Corner &entry = at(first), &exit = at(last);
    Fin fin{t(hit.from), t(hit.to), forwards ? &entry : &exit, forwards ? &exit : &entry,
            &entry.u};
    if (hit.obstacle == Obstacle::None) {
      if ((lo != nullptr && fin.from <= *lo) || (hi != nullptr && fin.to >= *hi))
        continue;
    } else {
      if (lo != nullptr && fin.from <= *lo) {
        fin.from = *lo;
        fin.from_side = nullptr;
      }
      if (hi != nullptr && fin.to >= *hi) {
        fin.to = *hi;
        fin.to_side = nullptr;
      }
      if (fin.from >= fin.to) continue;
    }
    fins.push_back(std::move(fin));
  }
}

// The faces in a plane with L that are met at t, which is inside their stretches, cut the
// plane across L into cells; those that are material.
void Scan::add_material(int contact, const Rational& at,
                        const std::function<bool(int)>& solid_behind,
                        std::vector<Material>& out) const {
  // 1. Across L each face is one leaf, or two opposite ones where L runs through its
  // inside.  Faces in one direction share a leaf.
  struct Leaf {
    Corner corner;
    bool after = false, before = false;  // material counter-clockwise, clockwise of it
  };
  std::vector<Leaf> leaves;
  const auto opposite = [](const Corner& c) { return Corner{-1, c.v, -c.u}; };
  const auto add = [&](Corner corner, bool after, bool before) {
    const auto known = std::ranges::find_if(
        leaves, [&](const Leaf& l) { return same_direction(l.corner.u, corner.u); });
    Leaf& leaf =
        known == leaves.end() ? leaves.emplace_back(Leaf{std::move(corner)}) : *known;
    leaf.after |= after;
    leaf.before |= before;
  };
  bool any = false;
  for (int h = first_hit[contact]; h < first_hit[contact + 1]; ++h) {
    // Faces that L leaves before `at`, or meets only after it, are no leaves there.
    const Hit& hit = hits[h];
    if (hit.obstacle != Obstacle::Barrier || t(hit.from) >= at || t(hit.to) <= at)
      continue;
    // On which hand of its leaf the face has its material: a point w off the face's plane
    // tells the hand that the plane's back is on.
    const bool solid = solid_behind(hit.face);
    any |= solid;
    const auto points = scene->face_points(hit.face);
    const Corner& reference = corners[hit.start];
    const std::array<Point, 3> plane{scene->point(points[0]), scene->point(points[1]),
                                     scene->point(points[2])};
    const Point w = point_off_plane(plane[0], plane[1], plane[2]);
    const bool behind = orient3d(plane[0], plane[1], plane[2], w) == Sign::Negative;
    const int turn = cross(reference.u, seen(-1, w).u);  // w's plane is not L's: not 0
    const bool after = solid && (turn > 0) == behind;
    const bool before = solid && !after;
    // Which of the two opposite leaves the face has: by the sides of L its corners are
    // on.  At the opposite leaf the hands are exchanged.
    bool ahead = false, back = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int side = dot(corners[loops[hit.loop + i]].u, reference.u);
      ahead |= side > 0;
      back |= side < 0;
    }
    if (ahead) add(reference, after, before);
    if (back) add(opposite(reference), before, after);
  }
  // Sheets alone enclose no material.
  if (!any) return;
  // 2. The leaves in counter-clockwise order cut the plane across L into cells.
  std::sort(leaves.begin() + 1, leaves.end(), [&](const Leaf& p, const Leaf& q) {
    // By the turn from the first leaf: its half turn, its opposite, the other half.
    const auto half = [&](const Leaf& l) {
      const int side = cross(leaves[0].corner.u, l.corner.u);
      return side > 0 ? 0 : side == 0 ? 1 : 2;
    };
    const int a = half(p), b = half(q);
    return a != b ? a < b : cross(p.corner.u, q.corner.u) > 0;
  });
  // 3. A cell is material when the leaf before or after it says so.  An obstacle is at
  // most a half turn, so that a cell of more is two.
  // Positions are kept without `scale`, as those of all hits.
  const Rational x = at / rational(scale);
  const int position = add_position(ring(mpq_numref(x.backend().data())),
                                    ring(mpq_denref(x.backend().data())));
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const Leaf& from = leaves[i];
    const Leaf& to = leaves[(i + 1) % leaves.size()];
    if (!from.after && !to.before) continue;
    // Counter-clockwise: less than a half turn, a half, more, or all of it.
    const int turn = &from == &to ? -1 : cross(from.corner.u, to.corner.u);
    if (turn >= 0) {
      out.push_back({position, from.corner, to.corner});
    } else {
      out.push_back({position, from.corner, opposite(from.corner)});
      out.push_back({position, opposite(from.corner), to.corner});
    }
  }
}

// Just after lo and just before hi.
std::vector<Scan::Material> Scan::material_at_ends(
    int contact, const Rational& lo, const Rational& hi,
    const std::function<bool(int)>& solid_behind) const {
  const bool along_solid = std::any_of(
      hits.begin() + first_hit[contact], hits.begin() + first_hit[contact + 1],
      [&](const Hit& h) {
        return h.obstacle == Obstacle::Barrier && solid_behind(h.face) &&
               ((t(h.from) <= lo && lo < t(h.to)) || (t(h.from) < hi && hi <= t(h.to)));
      });
  if (!along_solid) return {};
  Rational first = hi;
  Rational last = lo;
  for (int h = first_hit[contact]; h < first_hit[contact + 1]; ++h) {
    for (const int position : {hits[h].from, hits[h].to}) {
      const Rational& at = t(position);
      if (lo < at && at < first) first = at;
      if (last < at && at < hi) last = at;
    }
  }
  std::vector<Material> out;
  add_material(contact, (lo + first) / 2, solid_behind, out);
  if (last > lo) add_material(contact, (last + hi) / 2, solid_behind, out);
  return out;
}

// Adds a sector at a position at or beyond those of the sectors before.
void Scan::add_sector(int position, const Corner* start, const Corner* end,
                      Sectors& out) const {
  const bool later = !out.at.empty() && compare(out.at.back(), position) != 0;
  const int instant = out.at.empty() ? 0 : out.sectors.back().instant + (later ? 1 : 0);
  out.sectors.push_back({instant, start, end});
  out.at.push_back(position);
}

// The sectors at which the faces of the contact are crossed strictly between lo and hi,
// and those of the material just after lo and just before hi, in order.  False: a face is
// crossed in its inside, so that the contact blocks.
bool Scan::add_sectors(int contact, const Rational* lo, const Rational* hi,
                       std::span<const Material> material, Sectors& out) const {
  const auto inside = [&](int position) {
    return (lo == nullptr || t(position) > *lo) && (hi == nullptr || t(position) < *hi);
  };
  const auto is_first = [&](const Material& m) {
    return m.position == material.front().position;
  };
  for (const Material& m : material) {
    if (is_first(m)) add_sector(m.position, &m.start, &m.end, out);
  }
  for (const Hit& h : hits_of(contact)) {
    hear_stop();
    if (h.obstacle != Obstacle::Full && h.obstacle != Obstacle::Sector) continue;
    if (!inside(h.from)) continue;
    if (h.obstacle == Obstacle::Full) return false;
    add_sector(h.from, &corners[h.start], &corners[h.end], out);
  }
  for (const Material& m : material) {
    if (!is_first(m)) add_sector(m.position, &m.start, &m.end, out);
  }
  return true;
}

// The sectors of one instant, which is at this position, leave no way: not a direction is
// free, and no ray can be crossed just then.
bool Scan::block_at_once(std::span<const SectorAt> now, int position) const {
  if (sealed(now)) return true;
  return covers(now) && std::none_of(now.begin(), now.end(), [&](const SectorAt& s) {
           return crossable(s.end->u, now, slope_order(position));
         });
}

// Adds the sides of the sectors of one instant, each direction once.  Rays inside of the
// union of the sectors do not matter.
void Scan::add_rays(std::span<const SectorAt> now, int position,
                    std::vector<const Ray*>& rays) const {
  const auto matters = [&](const Ray& r) {
    const auto contains = [&](auto&& side) {
      return std::any_of(now.begin(), now.end(),
                         [&](const SectorAt& s) { return side(s, r); });
    };
    return !contains(contains_after) || !contains(contains_before) ||
           crossable(r, now, slope_order(position));
  };
  for (const SectorAt& s : now) {
    for (const Corner* c : {s.start, s.end}) {
      hear_stop();
      if (std::none_of(rays.begin(), rays.end(),
                       [&](const Ray* r) { return same_direction(*r, c->u); }) &&
          matters(c->u)) {
        rays.push_back(&c->u);
      }
    }
  }
}

// Whether all of the contact blocks.
bool Scan::blocks(int contact) const {
  blocked.resize(contact_to.size());
  std::optional<bool>& known = blocked[static_cast<std::size_t>(contact)];
  if (!known) known = judge(contact, nullptr, nullptr);
  return *known;
}

// Whether the contact blocks the part of the line from lo to hi, or all of it.  First it
// looks for a line at rest, then for an instant at which nothing passes, and only then
// for a motion.
bool Scan::judge(int contact, const Rational* lo, const Rational* hi,
                 const std::function<bool(int)>* solid_behind) const {
  // A part of the line that begins or ends along a wall has the wall's material in the
  // way of those nearby lines that are within it there.
  const std::vector<Material> material =
      solid_behind != nullptr ? material_at_ends(contact, *lo, *hi, *solid_behind)
                              : std::vector<Material>{};
  // Lines that pass all of a contact pass any part of it, but for that material.
  if (lo != nullptr && material.empty() && !blocks(contact)) return false;
  // 1. The faces that are crossed: sectors, in order along the line.  One that is crossed
  // in its inside is met by every line nearby.
  Sectors crossed;
  if (!add_sectors(contact, lo, hi, material, crossed)) return true;
  auto& [sectors, at] = crossed;
  // 2. A direction that no sector covers: the line moved off that way, parallel to
  // itself, is free.  Barriers do not stop it, since it crosses none.
  if (!covers(sectors)) return false;
  // 3. Instant by instant: whether the sectors of one instant alone block everything.  If
  // not, a motion may pass between their sides.
  std::vector<const Ray*> rays;
  for (std::size_t first = 0, last; first < sectors.size(); first = last) {
    for (last = first; last < sectors.size(); ++last) {
      if (sectors[last].instant != sectors[first].instant) break;
    }
    const auto now = std::span(sectors).subspan(first, last - first);
    if (block_at_once(now, at[first])) return true;
    add_rays(now, at[first], rays);
  }

  // 4. The faces in a plane with the line are barriers while they last: their beginnings
  // and ends are instants, too.
  std::vector<Fin> fins;
  for (const Hit& h : hits_of(contact)) {
    hear_stop();
    if (h.loop >= 0) add_fins(h, lo, hi, fins);
  }
  const auto directions = by_direction(fins);
  // Rays along which something is up for a while matter, like the sides of sectors.
  const CornerTimes corner_time = [&](const Corner& c) { return corner_t(c); };
  std::vector<Rational> instants;
  for (const int position : at) instants.push_back(t(position));
  for (const auto& along : directions) {
    if (add_instants(along, corner_time, instants)) rays.push_back(along.front()->ray);
  }
  // 5. Number the instants of both kinds in one order, and search for a motion.
  std::sort(instants.begin(), instants.end());
  instants.erase(std::unique(instants.begin(), instants.end()), instants.end());
  for (std::size_t i = 0; i < sectors.size(); ++i) {
    sectors[i].instant = static_cast<int>(
        std::lower_bound(instants.begin(), instants.end(), t(at[i])) - instants.begin());
  }
  return !some_motion_passes(std::move(instants), sectors, directions, rays, corner_time);
}

}  // namespace sightline::internal::contacts
