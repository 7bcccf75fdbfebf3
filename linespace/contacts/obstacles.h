// What blocks near a line: obstacles to a point that moves in the plane across it.
//
// To first order a line near L is a point w(x) = w0 + w1 x of the plane across L that
// moves at constant velocity, x being time:
// - a face that L crosses at x_i is an obstacle at that instant: a closed *sector* of the
//   plane (all of it, a half-plane, or an angle at a corner);
// - a face that contains a stretch [x_i, x_j] of L is a *barrier* meanwhile: one ray or
//   two opposite rays that w must not cross.
// A motion that crosses a ray just at an instant is decided by the second order: when, in
// proportion to its distance from L, it crosses, against the *slopes* of the edges there.
// The contact blocks iff no w in general position avoids all of them.

#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "linespace/contacts/seen_along.h"

namespace sightline::internal::contacts {

/// What a face is to a moving point w: see above.
enum class Obstacle : std::uint8_t { None, Full, Sector, Barrier };

struct SectorAt {
  int instant;
  const Corner *start, *end;  // counter-clockwise
};

/// One side of a face in a plane with L: along `ray` it is up from `from` to `to`.  Its
/// ends lie on the lines from there to two corners; none where the judged part of L ends.
/// from = to where the face meets L in a corner.
struct Fin {
  Rational from, to;
  const Corner *from_side, *to_side;
  const Ray* ray;
};

inline bool contains_inside(const SectorAt& s, const Ray& r) {
  return cross(s.start->u, r) > 0 && cross(r, s.end->u) > 0;
}

/// Directions just counter-clockwise of r are in the sector.
inline bool contains_after(const SectorAt& s, const Ray& r) {
  return same_direction(s.start->u, r) || contains_inside(s, r);
}

/// Directions just clockwise of r are in the sector.
inline bool contains_before(const SectorAt& s, const Ray& r) {
  return same_direction(s.end->u, r) || contains_inside(s, r);
}

/// The union of the closed sectors is the whole plane: no sector's end is followed by a
/// gap.
[[nodiscard]] bool covers(std::span<const SectorAt> sectors);

/// Each sector's end is inside another sector or the beginning of another one, along the
/// same side: closed to first and second order.  May be false of closed ones that share
/// no corners.
[[nodiscard]] bool sealed(std::span<const SectorAt> sectors);

/// Some motion in either sense crosses the ray just at the instant of these sectors;
/// `order` compares the slopes of two corners.
template <class Order>
bool crossable(const Ray& ray, std::span<const SectorAt> sectors, Order&& order) {
  std::vector<const Corner*> right, left;
  for (const SectorAt& s : sectors) {
    if (contains_inside(s, ray)) return false;
    if (same_direction(s.end->u, ray)) right.push_back(s.end);
    if (same_direction(s.start->u, ray)) left.push_back(s.start);
  }
  int sign = 0;  // of the slopes on the right less those on the left
  for (const Corner* r : right) {
    for (const Corner* l : left) {
      const int here = r == l ? 0 : order(*r, *l);
      if (here == 0 || here == -sign) return false;
      sign = here;
    }
  }
  return true;
}

/// The unit of distances along a ray, the same for all that have its direction.
inline const Ring& coordinate(const Ray& r) { return sign_of(r.x) != 0 ? r.x : r.y; }

inline Rational measure(const Ray& r) { return abs(rational(gmpq(coordinate(r)))); }

/// Where in time a motion may cross a ray, in second order: open intervals of slopes.
struct Opening {
  std::optional<Rational> low, high;
};
struct Openings {
  std::vector<Opening> intervals;
  bool bounded = false;  // not all slopes
};

using CornerTimes = std::function<Rational(const Corner&)>;

/// A motion whose w is on a ray, at distance r, at time t crosses it at t + r k to second
/// order, k being ours to choose.  A sector's side on that ray runs from (t, L) to
/// (t + r s, distance r), s being its slope: a sector on the side that w leaves must be
/// met after the crossing, k < s, one on the side that w enters before it.  A fin along
/// the ray must not be up.  All k that do, counter-clockwise for sense > 0; unless
/// `exact` is asked for, a single interval may be replaced by another one.
[[nodiscard]] Openings openings(int sense, const Ray& ray, const Rational& t,
                                std::span<const SectorAt> sectors,
                                std::span<const Fin* const> fins,
                                const CornerTimes& corner_time, bool exact);

/// The fins along each ray, for each direction that some fin has.
[[nodiscard]] std::vector<std::vector<const Fin*>> by_direction(
    std::span<const Fin> fins);

/// Adds the instants at which one of the fins along a ray begins or ends; false: none of
/// them is up for any time.  Where one fin goes on as another, without a gap between
/// them, nothing happens.
bool add_instants(std::span<const Fin* const> along, const CornerTimes& corner_time,
                  std::vector<Rational>& instants);

}  // namespace sightline::internal::contacts
