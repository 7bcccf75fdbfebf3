#include "tests/support/naive_boxes.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Lazy_exact_nt.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "tests/support/generators.h"

namespace sightline::testing {
namespace {

using Number = CGAL::Lazy_exact_nt<CGAL::Exact_rational>;
using Vector = std::array<Number, 3>;

Vector exact(const Point& p) { return {Number(p[0]), Number(p[1]), Number(p[2])}; }

struct Range {
  Number from, to;
};

/// Parameters t at which from + t * direction is in the closed box; nullopt when none.
std::optional<Range> inside(const AlignedBox& box, const Vector& from,
                            const Vector& direction, Range range) {
  for (int i = 0; i < 3; ++i) {
    const Number lo = Number(box.min[i]) - from[i];
    const Number hi = Number(box.max[i]) - from[i];
    const int sign = static_cast<int>(CGAL::sign(direction[i]));
    if (sign == 0) {
      if (lo > 0 || hi < 0) return std::nullopt;
      continue;
    }
    range.from = std::max(range.from, Number((sign > 0 ? lo : hi) / direction[i]));
    range.to = std::min(range.to, Number((sign > 0 ? hi : lo) / direction[i]));
    if (range.from > range.to) return std::nullopt;
  }
  return range;
}

}  // namespace

struct BoxUnion::Impl {
  std::vector<AlignedBox> boxes;

  /// Solid in the octant next to p towards the given signs.
  [[nodiscard]] bool solid(const Point& p, const std::array<int, 3>& towards) const {
    return std::ranges::any_of(boxes, [&](const AlignedBox& box) {
      for (int i = 0; i < 3; ++i) {
        if (towards[i] > 0 ? p[i] < box.min[i] || p[i] >= box.max[i]
                           : p[i] <= box.min[i] || p[i] > box.max[i]) {
          return false;
        }
      }
      return true;
    });
  }
};

namespace {

/// What the line and one box have in common.
struct Meeting {
  Range range;
  const AlignedBox* box;
};

/// Some line near the one through a and a + direction touches none of the boxes for
/// parameters in [contact.from - margin, contact.to + margin].
bool free_line_near(const std::vector<Meeting>& touched, const Vector& a,
                    const Vector& direction, const Range& contact) {
  // Coordinates are multiples of 2^-20 or so: shifts and tilts of at most 2^-50, seen
  // over a stretch that is 2^-30 longer than the contact at each end, stay near it.
  const Number margin = std::ldexp(1.0, -30);
  const Range seen = {contact.from - margin, contact.to + margin};
  // A line that passes under one box and then over the next crosses their level just
  // where they take turns: tilts must pivot there, separately for each coordinate.
  std::vector<Number> pivots;
  for (const Meeting& m : touched) {
    pivots.push_back(m.range.from);
    pivots.push_back(m.range.to);
  }
  Random random(12345);
  // The place of such a crossing is a shift over a tilt, and must itself be as small as
  // other shifts: hence the last scale, a product of two others.
  const auto tiny = [&] {
    const int scales[] = {-50, -60, -70, -130};
    const double size = random.uniform(0.25, 1) * (random.one_in(2) ? 1 : -1);
    return Number(std::ldexp(size, scales[random.integer(0, 3)]));
  };
  for (int trial = 0; trial < 600; ++trial) {
    Vector from = a, step = direction;
    for (int i = 0; i < 3; ++i) {
      const Number tilt = tiny();
      const int pivot = random.integer(0, static_cast<int>(pivots.size()) - 1);
      from[i] += tiny() - tilt * pivots[pivot];
      step[i] += tilt;
    }
    if (std::ranges::none_of(touched, [&](const Meeting& m) {
          return inside(*m.box, from, step, seen).has_value();
        })) {
      return true;
    }
  }
  return false;
}

}  // namespace

BoxUnion::BoxUnion(const PolygonSoup& soup) : impl_(std::make_unique<Impl>()) {
  for (const PolygonSoup::Group& group : soup.groups) {
    AlignedBox box;
    box.min.fill(HUGE_VAL);
    box.max.fill(-HUGE_VAL);
    for (const int f : group.faces) {
      for (const int v : soup.polygons[f]) {
        for (int i = 0; i < 3; ++i) {
          box.min[i] = std::min(box.min[i], soup.vertices[v][i]);
          box.max[i] = std::max(box.max[i], soup.vertices[v][i]);
        }
      }
    }
    if (group.faces.size() != 6) throw std::invalid_argument("not a box");
    for (const int f : group.faces) {
      for (const int v : soup.polygons[f]) {
        for (int i = 0; i < 3; ++i) {
          const double x = soup.vertices[v][i];
          if (x != box.min[i] && x != box.max[i])
            throw std::invalid_argument("not a box");
        }
      }
    }
    impl_->boxes.push_back(box);
  }
}
BoxUnion::~BoxUnion() = default;
BoxUnion::BoxUnion(BoxUnion&&) noexcept = default;

bool BoxUnion::is_corner(const Point& p) const {
  for (int axis = 0; axis < 3; ++axis) {
    bool same = true;
    for (int i = 0; i < 8; ++i) {
      std::array<int, 3> towards = {i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1};
      const bool here = impl_->solid(p, towards);
      towards[axis] = -towards[axis];
      same = same && here == impl_->solid(p, towards);
    }
    if (same) return false;
  }
  return true;
}

bool BoxUnion::is_ridge(const Point& p, int axis) const {
  for (const int along : {-1, 1}) {
    int solid = 0;
    for (int i = 0; i < 4; ++i) {
      std::array<int, 3> towards;
      towards[axis] = along;
      towards[(axis + 1) % 3] = i & 1 ? 1 : -1;
      towards[(axis + 2) % 3] = i & 2 ? 1 : -1;
      solid += impl_->solid(p, towards);
    }
    if (solid != 1) return false;
  }
  return true;
}

BoxUnion::Judgement BoxUnion::judge(const Point& a, const Point& b) const {
  const Vector from = exact(a);
  Vector direction = exact(b);
  for (int i = 0; i < 3; ++i) direction[i] -= from[i];

  std::vector<Meeting> meetings;
  Judgement result{true, false};
  for (const AlignedBox& box : impl_->boxes) {
    // The whole line first: at an end of the segment it matters whether the line goes on
    // into the box.
    const auto whole = inside(box, from, direction, {Number(-1000000), Number(1000000)});
    if (!whole || whole->to < 0 || whole->from > 1) continue;
    bool in_plane = false;
    for (int i = 0; i < 3; ++i) {
      in_plane =
          in_plane || (direction[i] == 0 && (a[i] == box.min[i] || a[i] == box.max[i]));
    }
    result.edge_on = result.edge_on || in_plane;
    if (!in_plane && whole->from < whole->to) return {false, result.edge_on};
    meetings.push_back(
        {{std::max(whole->from, Number(0)), std::min(whole->to, Number(1))}, &box});
  }
  std::ranges::sort(meetings, [](const Meeting& x, const Meeting& y) {
    return x.range.from < y.range.from;
  });
  for (std::size_t i = 0; i < meetings.size() && result.free;) {
    Range contact = meetings[i].range;
    std::vector<Meeting> touched;
    for (; i < meetings.size() && meetings[i].range.from <= contact.to; ++i) {
      contact.to = std::max(contact.to, meetings[i].range.to);
      touched.push_back(meetings[i]);
    }
    // Off the interior of the one box it touches, a line can be shifted away.
    if (touched.size() == 1) continue;
    result.free = free_line_near(touched, from, direction, contact);
  }
  return result;
}

}  // namespace sightline::testing
