#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <utility>

#include "skeleton/drawn_internal.h"
#include "skeleton/edge_cuts_internal.h"
#include "skeleton/node_contacts_internal.h"

namespace sightline::internal {
namespace {

double norm1(const Point& p) { return p.cwiseAbs().sum(); }

// A point off the plane through a, b, c, which are not on one line.
Point off_plane(const Point& a, const Point& b, const Point& c) {
  for (int i = 0; i < 3; ++i) {
    Point w = a;
    w[i] = a[i] > 0 ? -a[i] : a[i] < 0 ? -a[i] : 1.0;
    if (orient3d(a, b, c, w) != Sign::Zero) return w;
  }
  // Not reached: the three points differ from a along the three axes.
  return a;
}

}  // namespace

Eye::Eye(ExactPoint at)
    : at_(std::move(at)), rounded_(rounded(at_)), error_(4 * kUnit * norm1(rounded_)) {}

// orient3d changes by at most |b - a| |c - a| |x - y| between x and y.
Sign Eye::side(const Point& a, const Point& b, const Point& c) const {
  const PlaneSide plane({a, b, c});
  const BoundedValue v = plane.value(rounded_);
  const double error = v.error + 1.01 * norm1(b - a) * norm1(c - a) * error_;
  if (std::abs(v.value) > error) return internal::sign_of(v.value);
  const int s = exact_orient(exact_point(a), exact_point(b), exact_point(c), at_).sign();
  return static_cast<Sign>(s);
}

EdgeFan::EdgeFan(const Generators& generators, const Point& e0, const Point& e1)
    : g_(generators), scene_(generators.scene()), e0_(e0), e1_(e1) {}

void EdgeFan::add_half(int face, std::int32_t third, bool own) {
  const Face& f = scene_.faces()[face];
  Leaf leaf{third, f.facet, false, false, own};
  if (g_.solid_behind(face)) {
    const Point w = off_plane(e0_, e1_, scene_.point(third));
    const bool after = orient3d(e0_, e1_, scene_.point(third), w) == Sign::Positive;
    const bool behind = g_.face_plane(face)(w) == Sign::Negative;
    (after == behind ? leaf.solid_after : leaf.solid_before) = true;
  }
  leaves_.push_back(leaf);
}

void EdgeFan::add(int face, bool own) {
  const PlaneSide& plane = g_.face_plane(face);
  if (plane(e0_) != Sign::Zero || plane(e1_) != Sign::Zero) return;
  const InPlaneSide left_of(scene_, face);
  int left = -1, right = -1, on = 0;
  for (const int p : scene_.face_points(face)) {
    const Sign s = left_of(e0_, e1_, scene_.point(p));
    if (s == Sign::Positive) left = p;
    if (s == Sign::Negative) right = p;
    on += s == Sign::Zero;
  }
  if ((left < 0 || right < 0) && on < 2) return;
  if (left >= 0) add_half(face, left, own);
  if (right >= 0) add_half(face, right, own);
}

// Counter-clockwise from one leaf to another.
EdgeFan::Angle EdgeFan::angle(const Leaf& from, const Leaf& to) const {
  const Point& p = scene_.point(from.third);
  const Point& q = scene_.point(to.third);
  const Sign s = orient3d(e0_, e1_, p, q);
  if (s != Sign::Zero) return s == Sign::Positive ? Angle::FirstHalf : Angle::SecondHalf;
  const Point w = off_plane(e0_, e1_, p);
  const bool same = orient3d(e0_, e1_, w, p) == orient3d(e0_, e1_, w, q);
  return same ? Angle::Same : Angle::Opposite;
}

// In the turn that begins at the first leaf.
bool EdgeFan::before(const Leaf& a, const Leaf& b) const {
  const Angle x = angle(leaves_[0], a);
  const Angle y = angle(leaves_[0], b);
  return x != y ? x < y : angle(a, b) == Angle::FirstHalf;
}

void EdgeFan::close() {
  sectors_.clear();
  if (leaves_.empty()) return;
  std::vector<Leaf> sorted = leaves_;
  std::sort(sorted.begin() + 1, sorted.end(),
            [&](const Leaf& a, const Leaf& b) { return before(a, b); });
  std::vector<Leaf> distinct;
  for (const Leaf& leaf : sorted) {
    if (!distinct.empty() && angle(distinct.back(), leaf) == Angle::Same) {
      distinct.back().solid_after |= leaf.solid_after;
      distinct.back().solid_before |= leaf.solid_before;
      distinct.back().own |= leaf.own;
    } else {
      distinct.push_back(leaf);
    }
  }
  leaves_ = std::move(distinct);
  const int n = static_cast<int>(leaves_.size());
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    const Angle a = angle(leaves_[i], leaves_[j]);
    const Turn turn = a == Angle::FirstHalf  ? Turn::Narrow
                      : a == Angle::Opposite ? Turn::Flat
                                             : Turn::Wide;
    sectors_.push_back({i, j, turn, !leaves_[i].solid_after && !leaves_[j].solid_before});
  }
}

bool EdgeFan::ends_along(int leaf) const {
  const int n = static_cast<int>(sectors_.size());
  const Sector& after = sectors_[leaf];
  const Sector& before = sectors_[(leaf + n - 1) % n];
  const auto shut = [](const Sector& s) { return !s.free || s.turn == Turn::Narrow; };
  return shut(after) && shut(before) && (after.free || before.free);
}

std::optional<EdgeContact> EdgeFan::look(const Eye& eye) const {
  const int n = static_cast<int>(leaves_.size());
  std::vector<Sign> side;  // Positive: the eye is in the half turn after the leaf
  for (int i = 0; i < n; ++i) {
    const Point& p = scene_.point(leaves_[i].third);
    side.push_back(eye.side(e0_, e1_, p));
    if (side.back() != Sign::Zero) continue;
    const Point w = off_plane(e0_, e1_, p);
    if (eye.side(e0_, e1_, w) != orient3d(e0_, e1_, w, p)) continue;
    return ends_along(i) ? EdgeContact::End : EdgeContact::Graze;
  }
  for (const Sector& s : sectors_) {
    const bool after = side[s.from] == Sign::Positive;
    const bool before = side[s.to] == Sign::Negative;
    const bool inside = s.turn == Turn::Narrow ? after && before
                        : s.turn == Turn::Flat ? after
                                               : s.from == s.to || after || before;
    if (!inside) continue;
    if (!s.free) return std::nullopt;
    const bool own = leaves_[s.from].own || leaves_[s.to].own;
    if (s.turn == Turn::Flat || !own) return EdgeContact::None;
    if (s.turn == Turn::Narrow) return EdgeContact::End;
    // Grazes where the sector goes on beyond the edge.
    return s.from != s.to && after && before ? EdgeContact::End : EdgeContact::Graze;
  }
  return EdgeContact::None;
}

bool drawn_end(const Generators& g, const Ridge& ridge, const LineScan& scan, bool last,
               const Eye& eye) {
  const Scene& scene = g.scene();
  const Rational t = last ? 1 : 0;
  EdgeFan fan(g, scene.point(ridge.points[0]), scene.point(ridge.points[1]));
  for (int c = 0; c < scan.size(); ++c) {
    if (scan.from(c) > t || scan.to(c) < t) continue;
    for (const int f : scan.faces_at(c, t)) {
      fan.add(f, share(std::span(&scene.faces()[f].facet, 1), ridge.all_facets));
    }
  }
  fan.close();
  return fan.contact(eye) != EdgeContact::None;
}

bool drawn_corner(const Generators& g, const Star& star, const Eye& eye) {
  const Scene& scene = g.scene();
  const Point& v = scene.point(star.point);
  const auto& rays = star.rays;
  const auto n = static_cast<int>(rays.size());
  const auto at = [&](int ray) -> const Point& { return scene.point(rays[ray]); };
  // Of two rays and the eye, of three rays: the turn of each about v.
  std::vector<Sign> seen(static_cast<std::size_t>(n) * n, Sign::Zero);
  const auto turn = [&](int i, int j) {
    return seen[static_cast<std::size_t>(i) * n + j];
  };
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      const Sign s = eye.side(v, at(i), at(j));
      seen[static_cast<std::size_t>(i) * n + j] = s;
      seen[static_cast<std::size_t>(j) * n + i] = -s;
    }
  }
  for (const Star::Sector& s : star.sectors) {
    if (turn(s.from, s.to) == Sign::Zero) return true;  // edge-on
  }
  // From the ray towards the eye one meets the sector.
  const auto hides = [&](const Star::Sector& s, int ray) {
    if (s.from == ray || s.to == ray) return false;
    const Sign beyond = orient3d(v, at(s.from), at(s.to), at(ray));
    if (beyond == Sign::Zero || beyond == turn(s.from, s.to)) return false;
    // Seen along the line the ray is between the sector's sides, or looks like one.
    const Sign inside = turn(s.from, s.to);
    return turn(s.from, ray) != -inside && turn(ray, s.to) != -inside;
  };
  std::vector<int> drawn;
  for (int r = 0; r < n; ++r) {
    if (std::any_of(star.sectors.begin(), star.sectors.end(),
                    [&](const Star::Sector& s) { return hides(s, r); })) {
      continue;
    }
    EdgeFan fan(g, v, at(r));
    for (const Star::Sector& s : star.sectors) {
      const int face = scene.facets()[s.facet].faces[0];
      if (s.from == r || s.to == r) {
        fan.add_half(face, rays[s.from == r ? s.to : s.from]);
      } else if (orient3d(v, at(s.from), at(s.to), at(r)) == Sign::Zero &&
                 turn(s.from, r) == turn(s.from, s.to) &&
                 turn(r, s.to) == turn(s.from, s.to)) {
        fan.add_half(face, rays[s.from]);
        fan.add_half(face, rays[s.to]);
      }
    }
    fan.close();
    if (fan.from_inside(eye)) return false;
    if (star.along_edge[r] != 0 && fan.contact(eye) != EdgeContact::None)
      drawn.push_back(r);
  }
  const bool straight = drawn.size() == 2 && collinear(v, at(drawn[0]), at(drawn[1]));
  return !drawn.empty() && !straight;
}

}  // namespace sightline::internal
