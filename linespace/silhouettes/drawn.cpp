#include "linespace/silhouettes/drawn.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <utility>

#include "linespace/sight/free_segment.h"
#include "linespace/swaths/edge_cuts.h"

namespace sightline::internal {
namespace {

double norm1(const Point& p) { return p.cwiseAbs().sum(); }

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

EdgeFan::EdgeFan(const Silhouettes& silhouettes, const Point& e0, const Point& e1)
    : g_(silhouettes), scene_(silhouettes.scene()), e0_(e0), e1_(e1) {}

void EdgeFan::add_half(int face, std::int32_t third, bool own) {
  const Face& f = scene_.faces()[face];
  Leaf leaf{third, f.facet, false, false, own};
  if (g_.solid_behind(face)) {
    const Point w = point_off_plane(e0_, e1_, scene_.point(third));
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
  const Point w = point_off_plane(e0_, e1_, p);
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
    const Point w = point_off_plane(e0_, e1_, p);
    if (eye.side(e0_, e1_, w) != orient3d(e0_, e1_, w, p)) continue;
    if (!sectors_[i].free && !sectors_[(i + n - 1) % n].free) return std::nullopt;
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

bool drawn_end(const Silhouettes& g, const Ridge& ridge, const LineScan& scan, bool last,
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

namespace {

// The faces at a corner as an eye sees them that looks along a line to it.
class CornerView {
 public:
  CornerView(const Silhouettes& g, const Star& star, const Eye& eye)
      : g_(g), star_(star), eye_(eye), v_(g.scene().point(star.point)) {
    const int n = count();
    turns_.assign(static_cast<std::size_t>(n) * n, Sign::Zero);
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        const Sign s = eye.side(v_, at(i), at(j));
        turns_[static_cast<std::size_t>(i) * n + j] = s;
        turns_[static_cast<std::size_t>(j) * n + i] = -s;
      }
    }
  }

  // The line lies in the plane of this sector, of some sector.
  [[nodiscard]] bool edge_on(const Star::Sector& s) const {
    return turn(s.from, s.to) == Sign::Zero;
  }
  [[nodiscard]] bool edge_on() const {
    return std::ranges::any_of(star_.sectors, [&](const auto& s) { return edge_on(s); });
  }

  // The line is strictly inside a closed shell there.
  [[nodiscard]] bool in_material() const {
    std::vector<std::int32_t> shells;
    for (const Star::Sector& s : star_.sectors) shells.push_back(shell_of(s));
    sort_unique(shells);
    return std::ranges::any_of(shells, [&](int shell) { return inside(shell); });
  }

  // Lines are drawn there, and not one straight line only.  Requires that no sector is
  // edge-on.
  [[nodiscard]] bool drawn() const {
    std::vector<int> drawn;
    for (int r = 0; r < count(); ++r) {
      if (hidden(r, -1)) continue;
      if (star_.along_edge[r] != 0 && fan_at(r, -1).contact(eye_) != EdgeContact::None)
        drawn.push_back(r);
    }
    const bool straight = drawn.size() == 2 && collinear(v_, at(drawn[0]), at(drawn[1]));
    return !drawn.empty() && !straight;
  }

 private:
  [[nodiscard]] int count() const { return static_cast<int>(star_.rays.size()); }
  [[nodiscard]] const Point& at(int ray) const {
    return g_.scene().point(star_.rays[ray]);
  }
  // Seen along the line, from one ray to the other about v.
  [[nodiscard]] Sign turn(int i, int j) const {
    return turns_[static_cast<std::size_t>(i) * count() + j];
  }
  [[nodiscard]] int shell_of(const Star::Sector& s) const {
    return g_.shell(g_.scene().facets()[s.facet].faces[0]);
  }
  [[nodiscard]] bool on_line(int ray) const {
    for (int other = 0; other < count(); ++other) {
      if (turn(ray, other) != Sign::Zero) return false;
    }
    return true;
  }

  // From the ray towards the eye one meets the sector.
  [[nodiscard]] bool hides(const Star::Sector& s, int ray) const {
    if (s.from == ray || s.to == ray || edge_on(s)) return false;
    const Sign inside = turn(s.from, s.to);
    const Sign beyond = orient3d(v_, at(s.from), at(s.to), at(ray));
    if (beyond == Sign::Zero || beyond == inside) return false;
    // Seen along the line the ray is between the sector's sides, or looks like one.
    return turn(s.from, ray) != -inside && turn(ray, s.to) != -inside;
  }

  // The ray runs inside the sector.
  [[nodiscard]] bool contains(const Star::Sector& s, int ray) const {
    if (orient3d(v_, at(s.from), at(s.to), at(ray)) != Sign::Zero) return false;
    const Sign whole = turn(s.from, s.to);
    if (whole != Sign::Zero) {
      return turn(s.from, ray) == whole && turn(ray, s.to) == whole;
    }
    const InPlaneSide left_of(g_.scene(), g_.scene().facets()[s.facet].faces[0]);
    const Sign turns = left_of(v_, at(s.from), at(s.to));
    return left_of(v_, at(s.from), at(ray)) == turns &&
           left_of(v_, at(ray), at(s.to)) == turns;
  }

  // By the sectors of a shell, or of all (-1).
  [[nodiscard]] bool hidden(int ray, int shell) const {
    return std::ranges::any_of(star_.sectors, [&](const Star::Sector& s) {
      return (shell < 0 || shell_of(s) == shell) && hides(s, ray);
    });
  }
  [[nodiscard]] EdgeFan fan_at(int ray, int shell) const {
    EdgeFan fan(g_, v_, at(ray));
    for (const Star::Sector& s : star_.sectors) {
      if (shell >= 0 && shell_of(s) != shell) continue;
      const int face = g_.scene().facets()[s.facet].faces[0];
      if (s.from == ray || s.to == ray) {
        fan.add_half(face, star_.rays[s.from == ray ? s.to : s.from]);
      } else if (contains(s, ray)) {
        fan.add_half(face, star_.rays[s.from]);
        fan.add_half(face, star_.rays[s.to]);
      }
    }
    fan.close();
    return fan;
  }

  // Of the rays on a shell that nothing of it hides each tells whether the line is
  // inside.  They agree, but where it runs along a face: that has the inside on one side.
  [[nodiscard]] bool inside(int shell) const {
    bool inside = false;
    for (int r = 0; r < count(); ++r) {
      const bool own = std::ranges::any_of(star_.sectors, [&](const Star::Sector& s) {
        return shell_of(s) == shell && (s.from == r || s.to == r);
      });
      if (!own || on_line(r) || hidden(r, shell)) continue;
      if (!fan_at(r, shell).from_inside(eye_)) return false;
      inside = true;
    }
    return inside;
  }

  const Silhouettes& g_;
  const Star& star_;
  const Eye& eye_;
  const Point& v_;
  std::vector<Sign> turns_;  // of each ray to each
};

}  // namespace

bool drawn_corner(const Silhouettes& g, const Star& star, const Eye& eye) {
  const CornerView view(g, star, eye);
  return !view.in_material() && (view.edge_on() || view.drawn());
}

}  // namespace sightline::internal
