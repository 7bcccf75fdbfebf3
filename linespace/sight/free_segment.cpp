#include "linespace/sight/free_segment.h"

#include <algorithm>
#include <utility>

#include "linespace/work/stop_scope.h"

namespace sightline::internal {
namespace {

// Whether the contact blocks a part of the line that begins and ends outside material.
bool blocks_part(const Silhouettes& g, const LineScan& scan, int contact,
                 const Rational& lo, const Rational& hi) {
  return scan.blocked_between(contact, lo, hi,
                              [&](int face) { return g.solid_behind(face); });
}

// Whether it blocks the part (0, 1) together with what it meets at one of its ends.
bool blocks_with_end(const Silhouettes& g, const LineScan& scan, int contact,
                     bool at_one) {
  Rational low = at_one ? 0 : -1;
  Rational high = at_one ? 2 : 1;
  for (const Rational& t : scan.instants(contact)) {
    if (!at_one && t < 0 && t > low) low = t;
    if (at_one && t > 1 && t < high) high = t;
  }
  return at_one ? blocks_part(g, scan, contact, 0, (high + 1) / 2)
                : blocks_part(g, scan, contact, low / 2, 1);
}

// Two faces of closed objects on the line at t lie on each other front to front: the line
// is inside the union there.
bool pressed_at(const Silhouettes& g, const LineScan& scan, int contact,
                const Rational& t) {
  const Scene& scene = g.scene();
  const std::vector<int> faces = scan.faces_at(contact, t);
  const auto opposite = [&](int f, int h) {
    for (const int p : scene.corners()) {
      hear_stop();
      const Sign s = g.face_plane(f)(scene.point(p));
      if (s != Sign::Zero) return s == -g.face_plane(h)(scene.point(p));
    }
    return false;
  };
  const auto coplanar = [&](int f, int h) {
    const auto corners = scene.face_points(h);
    return std::all_of(corners.begin(), corners.end(), [&](int p) {
      return g.face_plane(f)(scene.point(p)) == Sign::Zero;
    });
  };
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const int f = faces[i];
      const int h = faces[j];
      if (g.solid_behind(f) && g.solid_behind(h) && coplanar(f, h) && opposite(f, h))
        return true;
    }
  }
  return false;
}

// Where a contact that runs along faces is inside the union: somewhere in (0, 1), just
// before 0, just after 1.
struct Pressed {
  bool inside = false;
  std::array<bool, 2> beyond{};
};
Pressed pressed_parts(const Silhouettes& g, const LineScan& scan, int contact) {
  Pressed result;
  if (scan.is_point(contact)) return result;
  std::vector<Rational> stops = scan.instants(contact);
  stops.insert(stops.end(), {0, 1});
  std::sort(stops.begin(), stops.end());
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const Rational& from = stops[i];
    const Rational& to = stops[i + 1];
    const bool before = to == 0;
    const bool after = from == 1;
    if (from == to || (!before && !after && (from < 0 || to > 1))) continue;
    if (!pressed_at(g, scan, contact, (from + to) / 2)) continue;
    (before ? result.beyond[0] : after ? result.beyond[1] : result.inside) = true;
  }
  return result;
}

// The segment comes into a part of the contact, if it comes from where it begins (step
// 1) or ends (-1).
bool is_entered(const Silhouettes& g, const LineScan& scan, int contact, int step) {
  if (scan.is_point(contact)) return false;
  const std::vector<Rational> at = scan.instants(contact);
  const std::size_t n = at.size();
  return step > 0 ? !blocks_part(g, scan, contact, at[0] - 1, at[1])
                  : !blocks_part(g, scan, contact, at[n - 2], at[n - 1] + 1);
}

}  // namespace

bool meets_segment(const LineScan& scan, int contact) {
  return scan.to_against(contact, 0) >= 0 && scan.from_against(contact, 1) <= 0;
}

bool blocks_segment(const Silhouettes& g, const LineScan& scan, int contact) {
  if (scan.from_against(contact, 0) >= 0 && scan.to_against(contact, 1) <= 0)
    return scan.blocked(contact);
  Rational low = -1;
  Rational high = 2;
  for (const Rational& t : scan.instants(contact)) {
    if (t < 0 && t > low) low = t;
    if (t > 1 && t < high) high = t;
  }
  return blocks_part(g, scan, contact, low / 2, (high + 1) / 2);
}

std::optional<Rational> blocked_beyond(const Silhouettes& g, const LineScan& scan,
                                       int contact, const Rational& start, int step) {
  if (!scan.blocked(contact)) return std::nullopt;
  if (scan.is_point(contact)) {
    const Rational& t = scan.from(contact);
    return (step > 0 ? start < t : t < start) ? std::optional(t) : std::nullopt;
  }
  std::vector<Rational> at = scan.instants(contact);
  if (step < 0) std::reverse(at.begin(), at.end());
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Rational& t = at[i];
    if (step > 0 ? t <= start : start <= t) continue;
    const Rational beyond =
        i + 1 < at.size() ? Rational((t + at[i + 1]) / 2) : Rational(t + step);
    const bool blocked = step > 0 ? blocks_part(g, scan, contact, start, beyond)
                                  : blocks_part(g, scan, contact, beyond, start);
    if (blocked) return t;
  }
  return std::nullopt;
}

bool is_free(const Silhouettes& g, const LineScan& scan) {
  for (int i = 0; i < scan.size(); ++i) {
    if (meets_segment(scan, i) && blocks_segment(g, scan, i)) return false;
  }
  return true;
}

bool free_between(const Silhouettes& g, const LineScan& scan) {
  for (int c = 0; c < scan.size(); ++c) {
    if (scan.to_against(c, 0) <= 0 || scan.from_against(c, 1) >= 0) continue;
    const bool within = scan.from_against(c, 0) > 0 && scan.to_against(c, 1) < 0;
    if (within ? scan.blocked(c) : blocks_part(g, scan, c, 0, 1)) return false;
  }
  return true;
}

std::optional<std::array<bool, 2>> blocked_ends(const Silhouettes& g,
                                                const LineScan& scan) {
  std::array<bool, 2> ends{};
  for (int i = 0; i < scan.size(); ++i) {
    if (!meets_segment(scan, i)) continue;
    if (scan.is_point(i)) {
      if (!scan.blocked(i)) continue;
      const bool at_0 = scan.from_against(i, 0) == 0;
      if (!at_0 && scan.from_against(i, 1) != 0) return std::nullopt;
      ends[at_0 ? 0 : 1] = true;
      continue;
    }
    if (!blocks_segment(g, scan, i)) continue;
    const Pressed pressed = pressed_parts(g, scan, i);
    if (pressed.inside) return std::nullopt;
    const std::array<bool, 2> beyond = pressed.beyond;
    ends = {ends[0] || beyond[0], ends[1] || beyond[1]};
    const bool at_0 = scan.from_against(i, 0) <= 0;
    const bool at_1 = scan.to_against(i, 1) >= 0;
    const bool inside = scan.to_against(i, 0) > 0 && scan.from_against(i, 1) < 0;
    if (inside && blocks_part(g, scan, i, 0, 1)) return std::nullopt;
    const bool first = at_0 && !beyond[0] && blocks_with_end(g, scan, i, false);
    const bool last = at_1 && !beyond[1] && blocks_with_end(g, scan, i, true);
    // Neither alone but both together.
    const bool together = !first && !last && !beyond[0] && !beyond[1];
    ends[0] |= first || (at_0 && together);
    ends[1] |= last || (at_1 && together);
  }
  return ends;
}

std::optional<Rational> stop_in(const Silhouettes& g, const LineScan& scan, int contact,
                                int step) {
  return blocked_beyond(g, scan, contact, Rational(1, 2), step);
}

FreeEnd last_contact(const Silhouettes& g, const LineScan& scan, int contact, int step) {
  for (;;) {
    auto stop = stop_in(g, scan, contact, step);
    if (stop) return {contact, std::move(stop)};
    const int next = contact + step;
    if (next < 0 || next >= scan.size()) return {contact, {}};
    if (scan.blocked(next) && !is_entered(g, scan, next, step)) return {contact, {}};
    contact = next;
  }
}

}  // namespace sightline::internal
